// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/develop_opacity.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

#include "lf/core/check.h"
#include "lf/film/develop/channel_fill.h"
#include "lf/film/develop/completion_share.h"
#include "lf/film/develop/guard_share.h"

namespace lf {

Image<float> DevelopOpacity(const SensorPlate& plate, const DevelopOptions& options,
                            const std::function<bool()>& is_interrupted, ThreadPool& pool) {
  LF_CHECK(plate.has_opacity() && options.opaque > options.transparent);
  const int width = plate.width(), height = plate.height();
  const uint32_t rays_needed = std::max(options.smooth_below, 1u);
  Image<float> mean(width, height);
  Image<uint32_t> count(width, height);
  std::atomic<bool> is_thin = false;
  pool.ForEach(static_cast<size_t>(height), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      ElementSum rays = plate.At(x, y, SensorPlate::kOpacityChannel), all;
      double densified = 0;
      if (plate.is_guarded()) {
        densified = GuardShareOf(plate, options, x, y).densified;
        if (densified > 0) all = plate.At(x, y, plate.all_opacity_channel());
        if (rays.count == 0) std::swap(rays, all);
      }
      count.at(x, y) = KnownCount(options.completion, x, y, rays.count);
      if (count.at(x, y) < rays_needed) is_thin = true;
      const double share = CompletionShareOf(options.completion, x, y, rays.count);
      if (rays.count == 0 && share == 0) continue;
      double average = rays.count > 0 ? rays.Mean() : 0;
      if (all.count > 0) average += densified * (all.Mean() - average);
      if (share > 0) average += share * (options.completion->opacity.at(x, y) - average);
      mean.at(x, y) = static_cast<float>((average - options.transparent) /
                                         (options.opaque - options.transparent));
    }
  });
  Image<float> opacity = mean;
  if (is_thin) {
    const ChannelFill fill(mean, count, 0, rays_needed, options.fill_radius_px, is_interrupted);
    pool.ForEach(static_cast<size_t>(height), [&](size_t row) {
      const int y = static_cast<int>(row);
      ChannelFill::Scratch scratch;
      int filled = 0;
      if (is_interrupted()) return;
      for (int x = 0; x < width; ++x) {
        if (count.at(x, y) >= rays_needed) continue;
        if (++filled % ChannelFill::kFillsPerQuestion == 0 && is_interrupted()) return;
        opacity.at(x, y) = fill.At(x, y, scratch);
      }
    });
  }
  for (float& value : opacity.pixels()) value = std::clamp(value, 0.0F, 1.0F);
  return opacity;
}

}  // namespace lf
