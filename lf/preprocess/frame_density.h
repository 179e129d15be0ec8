// Whether the LF cameras stand densely enough for a frame: what a photographer should know before a
// night's work.
//
// What lies at depth z appears in a frame focused at z_f in as many copies as LF cameras look
// through the lens. Two whose rays cross the lens plane s apart show it
//
//   delta(z) = f s |1 / z - 1 / z_f|
//
// elements apart (f: the frame's focal length in elements): as blur while that is about an element,
// as double edges above. So delta asks for LF cameras s / delta apart.
#pragma once

#include <cstddef>
#include <optional>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/lens_weights/lens_coverage.h"
#include "lf/selection/image_index.h"

namespace lf {

struct FrameDensity {
  size_t cameras_in_lens = 0;    // as the middle of the plate sees it
  double camera_distance_w = 0;  // s, in the lens plane
  LensCoverage coverage;         // bokeh are cut off where the lens is not covered
  // Diameter of the smallest lens with which each of nine places of the plate has a ray; infinite
  // where none of the LF cameras around sees one of them.
  double least_aperture_w = 0;
  // delta(z) at the ends of the scene's depths, and these as seen by the frame.
  DepthRange depths;
  double near_displacement_px = 0;
  double far_displacement_px = 0;

  // The larger one, and where.
  double MostDisplacement_px() const;
  double DepthOfMost_w() const;
};

// Where depths are not known, a quarter before and behind the focus distance is asked.
//   depths  of the scene, along the optical axes of the LF cameras
FrameDensity DensityOf(const ImageIndex& index, const RenderCamera& frame,
                       const std::optional<DepthRange>& depths);

}  // namespace lf
