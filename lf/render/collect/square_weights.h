// SPDX-License-Identifier: Apache-2.0
// Samples the weights of LF images over the plate of a frame: a plate is divided into squares of
// EffectiveStep() x EffectiveStep() elements (frame_lens.h), and the middle element of each square
// stands for the square.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {

class SquareWeights {
 public:
  //   lenses  the lenses of all instants of a frame, at least one; they must outlive the object
  explicit SquareWeights(std::span<const FrameLens> lenses);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  // Returns the number of elements of a square divided by that of the plate. Squares at the right
  // and lower edges are cut.
  double ShareOfPlate(int column, int row) const;

  // Writes the weight of an LF image in each square, summed over the lenses, to
  // weights[row * columns() + column]. It is 0 if the LF image does not contain the focus point of
  // the middle element, or if its ray misses a lens whose opening is tested
  // (FrameLens::tests_opening()). Without lens weights, each lens adds 1. Any thread may call it.
  void Of(LfImageId id, std::span<double> weights) const;

 private:
  int ElementX(int column) const;
  int ElementY(int row) const;

  const std::span<const FrameLens> lenses_;
  int step_, width_px_, height_px_, columns_, rows_;
  std::vector<std::vector<std::optional<Vec3>>> focus_;  // [lens][row * columns + column]
  std::vector<ApertureTest> openings_;                   // of each lens
  std::vector<LensPlane> planes_;                        // of each lens
};

}  // namespace lf
