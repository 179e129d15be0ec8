// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/develop.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "lf/film/develop/channel_fill.h"
#include "lf/film/develop/completion_share.h"
#include "lf/film/develop/develop_opacity.h"
#include "lf/film/develop/guard_share.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {
namespace {

constexpr int kChannels = SensorPlate::kChannels;

// Returns true if the images of the completion are those that the plate needs.
bool Fits(const Completion& completion, const SensorPlate& plate) {
  const auto has_size_of_plate = [&](const Image<float>& image) {
    return image.width() == plate.width() && image.height() == plate.height();
  };
  return has_size_of_plate(completion.rgb) && has_size_of_plate(completion.share) &&
         (plate.has_opacity() ? has_size_of_plate(completion.opacity) : completion.opacity.empty());
}

// Computes the averages, ray counts and coverage of the elements of row y. Returns, for each
// channel, true if an element of the row must be filled or smoothed.
std::array<bool, kChannels> AverageRow(const SensorPlate& plate, const DevelopOptions& options,
                                       uint32_t rays_needed, int y, DevelopedFrame& frame,
                                       std::atomic<uint64_t>& doubtful_count, Image<float>& mean) {
  std::array<bool, kChannels> is_thin = {};
  for (int x = 0; x < plate.width(); ++x) {
    int collected = 0;
    GuardShare guard;
    if (plate.is_guarded()) {
      guard = GuardShareOf(plate, options, x, y);
      frame.densified.at(x, y) = static_cast<float>(guard.densified);
      frame.trust.at(x, y) = static_cast<float>(guard.trust);
      if (guard.is_doubtful) ++doubtful_count;
    }
    for (int c = 0; c < kChannels; ++c) {
      ElementSum rays = plate.At(x, y, c), all;
      if (guard.densified > 0) all = plate.At(x, y, plate.all_rays_channel() + c);
      if (rays.count == 0) std::swap(rays, all);
      frame.ray_count.at(x, y, c) = static_cast<uint32_t>(
          std::min<uint64_t>(rays.count, std::numeric_limits<uint32_t>::max()));
      is_thin[c] |= KnownCount(options.completion, x, y, rays.count) < rays_needed;
      const double share = CompletionShareOf(options.completion, x, y, rays.count);
      if (rays.count == 0 && share == 0) continue;
      double average = 0;
      if (rays.count > 0) {
        ++collected;
        average = rays.Mean();
      }
      if (all.count > 0) average += guard.densified * (all.Mean() - average);
      if (share > 0) average += share * (options.completion->rgb.at(x, y, c) - average);
      mean.at(x, y, c) = static_cast<float>((average - options.pedestal) / options.scale);
    }
    frame.coverage.at(x, y) = static_cast<float>(collected) / kChannels;
    if (options.completion != nullptr)
      frame.interpolated.at(x, y) = static_cast<float>(
          CompletionShareOf(options.completion, x, y, static_cast<uint64_t>(collected)));
  }
  return is_thin;
}

}  // namespace

DevelopedFrame Develop(const SensorPlate& plate, const DevelopOptions& options, ThreadPool& pool) {
  LF_CHECK(options.scale > 0 && options.fill_radius_px >= 0);
  LF_CHECK(options.completion == nullptr || Fits(*options.completion, plate));
  LF_CHECK(!plate.is_guarded() || options.opaque > options.transparent);
  const int width = plate.width(), height = plate.height();
  const uint32_t rays_needed = std::max(options.smooth_below, 1u);
  DevelopedFrame frame{Image<float>(width, height, kChannels),
                       Image<uint32_t>(width, height, kChannels), Image<float>(width, height)};
  if (options.completion != nullptr) frame.interpolated = Image<float>(width, height);
  if (plate.is_guarded()) frame.densified = frame.trust = Image<float>(width, height);
  Image<float> mean(width, height, kChannels);
  std::atomic<bool> is_ended = false;
  const auto ends = [&] {
    if (!is_ended && options.is_interrupted && options.is_interrupted()) is_ended = true;
    return is_ended.load();
  };
  std::vector<std::array<bool, kChannels>> row_is_thin(height);
  std::atomic<uint64_t> doubtful_count = 0;
  pool.ForEach(height, [&](size_t y) {
    if (ends()) return;
    row_is_thin[y] =
        AverageRow(plate, options, rays_needed, static_cast<int>(y), frame, doubtful_count, mean);
  });
  frame.doubtful_count = doubtful_count;

  Image<uint32_t> known;
  if (options.completion != nullptr) {
    known = frame.ray_count;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < kChannels; ++c)
          known.at(x, y, c) = KnownCount(options.completion, x, y, known.at(x, y, c));
  }
  const Image<uint32_t>& count = options.completion != nullptr ? known : frame.ray_count;
  std::array<std::optional<ChannelFill>, kChannels> fills;
  pool.ForEach(kChannels, [&](size_t c) {
    if (std::any_of(row_is_thin.begin(), row_is_thin.end(),
                    [c](const auto& row) { return row[c]; }))
      fills[c].emplace(mean, count, static_cast<int>(c), rays_needed, options.fill_radius_px, ends);
  });
  if (is_ended) return frame;
  const bool adds_opacity = options.adds_opacity && !plate.has_opacity();
  if (plate.has_opacity()) frame.opacity = DevelopOpacity(plate, options, ends, pool);
  if (adds_opacity) frame.opacity = Image<float>(width, height);

  const Mat3 srgb_from_camera =
      options.linear_srgb_from_camera *
      Vec3(options.white_balance[0], options.white_balance[1], options.white_balance[2])
          .asDiagonal();
  pool.ForEach(height, [&](size_t row) {
    const int y = static_cast<int>(row);
    ChannelFill::Scratch scratch;
    int filled = 0;  // number of values (channels of elements) filled in this row
    if (ends()) return;
    for (int x = 0; x < width; ++x) {
      Vec3 camera_rgb;
      bool has_light = false;
      for (int c = 0; c < kChannels; ++c) {
        has_light |= count.at(x, y, c) > 0;
        if (count.at(x, y, c) >= rays_needed) {
          camera_rgb[c] = mean.at(x, y, c);
          continue;
        }
        if (++filled % ChannelFill::kFillsPerQuestion == 0 && ends()) return;
        camera_rgb[c] = fills[c]->At(x, y, scratch);
        has_light |= ChannelFill::Found(scratch);
      }
      if (adds_opacity) frame.opacity.at(x, y) = has_light ? 1 : 0;
      const Vec3 srgb = srgb_from_camera * camera_rgb;
      for (int c = 0; c < kChannels; ++c) frame.rgb.at(x, y, c) = static_cast<float>(srgb[c]);
    }
  });
  return frame;
}

}  // namespace lf
