// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/square_weights.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "lf/camera/ray_through.h"
#include "lf/render/collect/around_lens.h"

namespace lf {

SquareWeights::SquareWeights(std::span<const FrameLens> lenses) : lenses_(lenses) {
  const Intrinsics& plate = lenses.front().camera().pinhole.intrinsics;
  step_ = EffectiveStep(plate);
  width_px_ = plate.width_px;
  height_px_ = plate.height_px;
  std::tie(columns_, rows_) = EffectiveSquares(plate);
  focus_.resize(lenses.size());
  for (size_t l = 0; l < lenses.size(); ++l) {
    openings_.emplace_back(lenses[l].camera().aperture);
    planes_.emplace_back(lenses[l].camera());
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        focus_[l].push_back(
            FocusPointOfElement(lenses[l].camera(), ElementX(column) + 0.5, ElementY(row) + 0.5));
  }
}

int SquareWeights::ElementX(int column) const {
  return std::min(column * step_ + step_ / 2, width_px_ - 1);
}
int SquareWeights::ElementY(int row) const {
  return std::min(row * step_ + step_ / 2, height_px_ - 1);
}

double SquareWeights::ShareOfPlate(int column, int row) const {
  const int width = std::min(step_, width_px_ - column * step_);
  const int height = std::min(step_, height_px_ - row * step_);
  return static_cast<double>(width) * height / (static_cast<double>(width_px_) * height_px_);
}

void SquareWeights::Of(LfImageId id, std::span<double> weights) const {
  std::fill(weights.begin(), weights.end(), 0.0);
  for (size_t l = 0; l < lenses_.size(); ++l) {
    const FrameLens& lens = lenses_[l];
    if (!lens.Takes(id)) continue;
    const RayThrough ray(lens.light_field().Camera(id), lens.camera().pinhole.ForwardWorld());
    const RayWeights of_rays = lens.WeightsOf(id);
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) {
        const size_t square = static_cast<size_t>(row) * columns_ + column;
        const std::optional<Vec3>& point = focus_[l][square];
        if (!point) continue;
        if (lens.tests_opening() &&
            !openings_[l].Contains(planes_[l].PointOfLine(ray.centre_world(), *point)))
          continue;
        if (!IsSeenBy(ray, *point)) continue;
        weights[square] += of_rays.At(ElementX(column), ElementY(row));
      }
  }
}

}  // namespace lf
