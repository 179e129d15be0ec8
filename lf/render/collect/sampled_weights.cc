// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/sampled_weights.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "lf/camera/ray_through.h"
#include "lf/render/collect/around_lens.h"

namespace lf {

SampledWeights::SampledWeights(std::span<const FrameLens> lenses, std::vector<int> columns,
                               std::vector<int> rows)
    : lenses_(lenses), columns_(std::move(columns)), rows_(std::move(rows)), focus_(lenses.size()) {
  for (size_t l = 0; l < lenses.size(); ++l) {
    openings_.emplace_back(lenses[l].camera().aperture);
    planes_.emplace_back(lenses[l].camera());
    for (const int y : rows_)
      for (const int x : columns_)
        focus_[l].push_back(FocusPointOfElement(lenses[l].camera(), x + 0.5, y + 0.5));
  }
}

void SampledWeights::Of(LfImageId id, std::span<double> weights) const {
  std::fill(weights.begin(), weights.end(), 0.0);
  ForEach(id, [&](size_t element, double weight, const Vec2&) { weights[element] += weight; });
}

void SampledWeights::ForEach(
    LfImageId id,
    const std::function<void(size_t element, double weight, const Vec2& position_px)>& body) const {
  for (size_t l = 0; l < lenses_.size(); ++l) {
    const FrameLens& lens = lenses_[l];
    if (!lens.Takes(id)) continue;
    const RayThrough ray(lens.light_field().Camera(id), lens.camera().pinhole.ForwardWorld());
    const RayWeights of_rays = lens.WeightsOf(id);
    size_t element = 0;
    for (const int y : rows_)
      for (const int x : columns_) {
        const size_t at = element++;
        const std::optional<Vec3>& point = focus_[l][at];
        if (!point) continue;
        if (lens.tests_opening() &&
            !openings_[l].Contains(planes_[l].PointOfLine(ray.centre_world(), *point)))
          continue;
        const std::optional<Vec2> position = SeenAt(ray, *point);
        if (!position) continue;
        if (const uint32_t weight = of_rays.At(x, y)) body(at, weight, *position);
      }
  }
}

}  // namespace lf
