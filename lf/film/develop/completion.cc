// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/completion.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lf/core/check.h"
#include "lf/film/develop/channel_fill.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {
namespace {

constexpr int kMostChannels = SensorPlate::kChannels + 1;  // the colours and the opacity

// Calls body(i) once for every i in [0, count), on the threads of the pool if there is one.
void CallForEach(int count, ThreadPool* pool, const std::function<void(int)>& body) {
  if (pool != nullptr)
    return pool->ForEach(static_cast<size_t>(count), [&](size_t i) { body(static_cast<int>(i)); });
  for (int i = 0; i < count; ++i) body(i);
}

// The means of a plate, and where they exist.
struct PlateMeans {
  Image<float> mean;         // [height][width][channels]
  Image<uint32_t> has_rays;  // [height][width][channels] 0 or 1
};

// Computes the means of row y. Sets the share of elements without rays to 0. Returns, for each
// channel, true if an element of the row must be filled.
std::array<bool, kMostChannels> AverageKeptRow(const SensorPlate& plate, int y, PlateMeans& means,
                                               Image<float>& share) {
  std::array<bool, kMostChannels> is_thin = {};
  for (int x = 0; x < plate.width(); ++x) {
    std::array<bool, kMostChannels> is_missing = {};
    bool has_any = false;
    for (int c = 0; c < plate.channels(); ++c) {
      const ElementSum rays = plate.At(x, y, c);
      is_missing[c] = rays.count == 0;
      if (is_missing[c]) continue;
      has_any = true;
      means.has_rays.at(x, y, c) = 1;
      means.mean.at(x, y, c) = static_cast<float>(rays.Mean());
    }
    if (!has_any) share.at(x, y) = 0;
    for (int c = 0; c < plate.channels() && share.at(x, y) > 0; ++c) is_thin[c] |= is_missing[c];
  }
  return is_thin;
}

}  // namespace

Completion CompletionOf(const SensorPlate& plate, Image<float> share, ThreadPool* pool) {
  LF_CHECK(!plate.is_guarded());
  LF_CHECK(share.width() == plate.width() && share.height() == plate.height());
  const int width = plate.width(), height = plate.height(), channels = plate.channels();
  PlateMeans means{Image<float>(width, height, channels), Image<uint32_t>(width, height, channels)};
  std::vector<std::array<bool, kMostChannels>> row_is_thin(height);
  CallForEach(height, pool,
              [&](int y) { row_is_thin[y] = AverageKeptRow(plate, y, means, share); });

  std::array<std::optional<ChannelFill>, kMostChannels> fills;
  CallForEach(channels, pool, [&](int c) {
    if (std::any_of(row_is_thin.begin(), row_is_thin.end(),
                    [c](const auto& row) { return row[c]; }))
      fills[c].emplace(means.mean, means.has_rays, c, 1u, kFillRadius_px, [] { return false; });
  });

  Completion completion{Image<float>(width, height, SensorPlate::kChannels), std::move(share)};
  if (plate.has_opacity()) completion.opacity = Image<float>(width, height);
  CallForEach(height, pool, [&](int y) {
    ChannelFill::Scratch scratch;
    for (int x = 0; x < width; ++x) {
      float& share_here = completion.share.at(x, y);
      std::array<float, kMostChannels> values = {};
      for (int c = 0; c < channels && share_here > 0; ++c) {
        values[c] = means.mean.at(x, y, c);
        if (means.has_rays.at(x, y, c) > 0) continue;
        values[c] = fills[c]->At(x, y, scratch);
        if (!ChannelFill::Found(scratch)) share_here = 0;
      }
      if (share_here == 0) continue;
      std::copy_n(values.begin(), SensorPlate::kChannels, &completion.rgb.at(x, y));
      if (plate.has_opacity()) completion.opacity.at(x, y) = values[SensorPlate::kOpacityChannel];
    }
  });
  return completion;
}

}  // namespace lf
