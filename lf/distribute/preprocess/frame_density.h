// SPDX-License-Identifier: Apache-2.0
// Measures whether the LF cameras are dense enough for a frame, so that a photographer knows this
// before hours of rendering. Only recorded LF images count, because virtual ones show what the
// recorded ones show, or a guess.
//
// Every LF camera whose rays pass through the lens shows a point at depth z once in a frame that is
// focused at z_f. Two LF cameras whose rays meet the lens plane at a distance s from each other
// show the point
//
//   delta(z) = f s |1 / z - 1 / z_f|
//
// elements apart (f: the frame's focal length in elements). A displacement up to about one element
// looks like blur, a larger one like double edges. The displacement would be one element if the LF
// cameras were s / delta apart.
#pragma once

#include <cstddef>
#include <optional>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {

struct FrameDensity {
  // number of LF cameras whose line to the focus point of the plate's middle passes through the
  // lens
  size_t cameras_in_lens = 0;
  double camera_distance_w = 0;  // s, the distance of neighbouring LF cameras in the lens plane
  LensCoverage coverage;         // how the LF cameras cover the lens; bokeh is cut off elsewhere
  // Diameter of the smallest lens around the same centre through which each of nine elements,
  // spread over the plate, has a ray. Infinite if none of the LF cameras around the lens sees the
  // focus point of one of these elements.
  double least_aperture_w = 0;
  // The nearest and farthest depth of the scene along the frame's optical axis, and the
  // displacement delta of points at these depths, in elements (formula above).
  DepthRange depths;
  double near_displacement_px = 0;
  double far_displacement_px = 0;

  // Return the larger of the two displacements, and the depth where it occurs.
  double MostDisplacement_px() const;
  double DepthOfMost_w() const;
};

// Largest distance, in elements, at which two copies of an edge still look like one edge.
inline constexpr double kDoubleEdge_px = 2;

// Returns true if virtual LF images would help a frame (lfdensify): neighbouring LF cameras show
// the ends of the scene as double edges, and the light field has no virtual LF images yet.
bool WantsVirtual(const FrameDensity& density, bool has_virtual);

// Measures the density for a frame. If the depths are not known, or there are no LF cameras around
// the lens, it assumes depths from 0.75 to 1.25 times the focus distance.
//   depths  depths of the scene, along the optical axes of the LF cameras; unset: not known
FrameDensity DensityOf(const ImageIndex& index, const RenderCamera& frame,
                       const std::optional<DepthRange>& depths);

}  // namespace lf
