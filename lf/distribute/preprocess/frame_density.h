// Measures whether the LF cameras are dense enough for a frame, which a photographer should know
// before a night's work.
//
// A point at depth z appears in a frame focused at z_f as many times as LF cameras look through the
// lens. Two LF cameras whose rays cross the lens plane at a distance s show it
//
//   delta(z) = f s |1 / z - 1 / z_f|
//
// elements apart (f: the frame's focal length in elements). This displacement is seen as blur up to
// about one element, and as double edges above. It is reduced to one element if the LF cameras are
// s / delta apart.
#pragma once

#include <cstddef>
#include <optional>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {

struct FrameDensity {
  size_t cameras_in_lens = 0;    // as seen from the middle of the plate
  double camera_distance_w = 0;  // s, in the lens plane
  LensCoverage coverage;         // bokeh are cut off where the lens is not covered
  // Diameter of the smallest lens with which each of nine elements of the plate has a ray. Infinite
  // if one of these is seen by none of the LF cameras around the lens.
  double least_aperture_w = 0;
  // Depths of the scene along the frame's axis, and delta(z) at their ends.
  DepthRange depths;
  double near_displacement_px = 0;
  double far_displacement_px = 0;

  // The larger displacement, and its depth.
  double MostDisplacement_px() const;
  double DepthOfMost_w() const;
};

// If the depths are not known, takes a quarter of the focus distance before and behind the focus
// plane.
//   depths  of the scene, along the optical axes of the LF cameras
FrameDensity DensityOf(const ImageIndex& index, const RenderCamera& frame,
                       const std::optional<DepthRange>& depths);

}  // namespace lf
