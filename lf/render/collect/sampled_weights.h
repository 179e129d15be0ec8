// SPDX-License-Identifier: Apache-2.0
// Samples the weights of LF images in some elements of a frame, which are the crossings of some
// columns and rows of its plate.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {

class SampledWeights {
 public:
  //   lenses  the lenses of all instants of a frame, at least one; they must outlive the object
  //   columns, rows  of elements of the plate
  SampledWeights(std::span<const FrameLens> lenses, std::vector<int> columns,
                 std::vector<int> rows);

  // Writes the weight of an LF image in each sampled element, summed over the lenses, to
  // weights[row * number of columns + column]. It is 0 if the LF image does not contain the focus
  // point of the element, or if its ray misses a lens whose opening is tested
  // (FrameLens::tests_opening()). Without lens weights, each lens adds 1. Any thread may call it.
  void Of(LfImageId id, std::span<double> weights) const;

  // Calls body(element, weight, position_px) for each lens and each sampled element in which the LF
  // image has such a weight above 0. `element` is row * number of columns + column, and position_px
  // where the LF image shows the focus point of the element.
  void ForEach(LfImageId id,
               const std::function<void(size_t element, double weight, const Vec2& position_px)>&
                   body) const;

 private:
  const std::span<const FrameLens> lenses_;
  const std::vector<int> columns_, rows_;
  std::vector<std::vector<std::optional<Vec3>>> focus_;  // [lens][row * columns + column]
  std::vector<ApertureTest> openings_;                   // of each lens
  std::vector<LensPlane> planes_;                        // of each lens
};

}  // namespace lf
