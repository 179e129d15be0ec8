// SPDX-License-Identifier: Apache-2.0
// A plane sweep: tests at many distances how much the LF images behind a lens differ at each
// element. Where they agree, there is a surface. Internal to this folder.
//
// For an element, a distance and a set of n views, with the roots r of the light that the views
// have there (sweep_sums.h), the cost is the variance
//
//   (n sum r^2 - (sum r)^2) / (n (n - 1)),   summed over R, G and B,
//
// of sums that are integers, so that it does not depend on the order of the views. Five sets of
// views are compared: the whole lens and its left, right, lower and upper halves. Where a near
// surface hides a far one from a part of the lens, a half that sees the far surface alone agrees.
// Costs are means over a window of elements.
//
// Beside the border of a surface, a window has the texture of the border although the element has
// none. The element's own cost then is low at many distances: it rises only where the border moves
// over the element. The confidence of such an element is multiplied by kDoubtful.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/analysis/depth/lens_views.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// The largest number of views for which n sum r^2 fits into 64 bits.
inline constexpr size_t kMostSweptViews = 4096;
// A distance has a cost only if at least this number of views sees the element.
inline constexpr uint32_t kLeastViews = 3;

// Factor of the confidence of depths that the element itself does not confirm.
inline constexpr float kDoubtful = 0.45f;

struct SweepOptions {
  // Distances along the optical axis, even in 1 / distance, the nearest first; at least 3. Depths
  // are found between the first and the last, but not at them.
  std::vector<double> distances_w;
  int window_radius = 2;  // windows have 2 r + 1 elements across and down
  // Number of distances, at least 1, from one to another between which a point moves by about one
  // element in the views at the rim of the lens.
  size_t element_step = 2;
};

// The result for one element.
struct SweptDepth {
  // Index of the distance, with a fraction; negative: no distance has a cost.
  float index = -1;
  // From 0 to 1: how much lower the cost is than at other distances. 0 if the best distance is the
  // first or the last.
  float confidence = 0;
  // Mean of the roots of R, G and B (lens_views.h) in the views that agree best, at this distance.
  std::array<uint16_t, 3> roots = {};
};

// Finds the depths of the elements of `tile`, which must lie in the part of the plate that the
// views were loaded for.
//   depths  receives one result for each element, row by row
void SweepTile(std::span<const LensView> views, const RenderCamera& frame,
               const SweepOptions& options, const PixelRect& tile, std::vector<SweptDepth>* depths);

}  // namespace lf
