// SPDX-License-Identifier: Apache-2.0
#include "lf/live/shrink.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lf/camera/magnification.h"
#include "lf/camera/resolution.h"
#include "lf/collection/prefilter/prefilter.h"
#include "lf/core/check.h"
#include "lf/core/median.h"
#include "lf/render/collect/around_lens.h"

namespace lf {
namespace {

constexpr int kLanes = LfPixels::kRgbLanes;

// Adds up the lanes of the pixels of a square. The ray lane counts the pixels that are not masked.
std::array<uint32_t, kLanes> SumOf(const Image<uint16_t>& pixels, int x, int y, int divisor) {
  std::array<uint32_t, kLanes> sum = {};
  for (int row = y; row < std::min(y + divisor, pixels.height()); ++row) {
    const uint16_t* const values = pixels.row(row);
    for (int i = x * kLanes; i < std::min(x + divisor, pixels.width()) * kLanes; i += kLanes)
      for (int lane = 0; lane < kLanes; ++lane) sum[lane] += values[i + lane];
  }
  return sum;
}

// Returns true if a pixel of the result is masked.
bool ShrinkPlane(const Image<uint16_t>& pixels, int divisor, Image<uint16_t>* shrunken) {
  bool any_masked = false;
  const auto square =
      static_cast<uint32_t>(std::min(divisor, pixels.width()) * std::min(divisor, pixels.height()));
  for (int y = 0; y < shrunken->height(); ++y) {
    uint16_t* mean = shrunken->row(y);
    for (int x = 0; x < shrunken->width(); ++x, mean += kLanes) {
      const std::array<uint32_t, kLanes> sum = SumOf(pixels, x * divisor, y * divisor, divisor);
      const uint32_t count = sum[LfPixels::kRayLane];
      const bool is_masked = count == 0 || 2 * count < square;
      any_masked |= is_masked;
      for (int lane = 0; lane < kLanes; ++lane)
        mean[lane] = is_masked ? 0 : static_cast<uint16_t>((sum[lane] + count / 2) / count);
    }
  }
  return any_masked;
}

}  // namespace

LightField ShrunkField(LightField light_field, int divisor) {
  for (Intrinsics& k : light_field.intrinsics) k = WithLargerPixels(k, divisor);
  light_field.encoding.bayer = BayerPattern::kNone;
  return light_field;
}

void Shrink(const LfPixels& pixels, int divisor, LfPixels* shrunken) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone && divisor >= 1);
  const PixelRect whole = {0, 0, std::max(1, pixels.rect.width() / divisor),
                           std::max(1, pixels.rect.height() / divisor)};
  shrunken->Reset(whole, BayerPattern::kNone);
  if (divisor == 1) {
    shrunken->radiance = pixels.radiance;
    shrunken->opacity = pixels.opacity;
    shrunken->any_masked = pixels.any_masked;
    return;
  }
  shrunken->any_masked = ShrinkPlane(pixels.radiance, divisor, &shrunken->radiance);
  if (pixels.opacity.empty()) return;
  shrunken->opacity.Resize(whole.width(), whole.height(), kLanes);
  ShrinkPlane(pixels.opacity, divisor, &shrunken->opacity);
}

int DivisorFor(const ImageIndex& index, const RenderCamera& frame, int current) {
  constexpr size_t kMeasured = 32;
  // The divisor stays as long as the width of elements is between these limits, because all LF
  // images must be loaded again if it changes, and a drag of the focus should not change it.
  constexpr double kNarrowest_px = 0.5, kWidest_px = 1.3 * kFinerAtMost;
  const std::vector<LfImageId> around = CamerasAroundLens(index, frame);
  if (around.empty()) return std::max(1, current);
  std::vector<double> widths_px;
  const size_t step = (around.size() + kMeasured - 1) / kMeasured;
  for (size_t i = 0; i < around.size(); i += step)
    widths_px.push_back(ElementWidth_px(index.light_field().Camera(around[i]), frame));
  const double width_px = Median(std::move(widths_px));
  if (current > 0 && width_px / current <= kWidest_px && width_px / current >= kNarrowest_px)
    return current;
  constexpr double kRounding = 1e-3;
  const int least = std::max(1, static_cast<int>(std::ceil(width_px / kFinerAtMost - kRounding)));
  for (const int divisor : {1, 2, 3, 4, 6, 8, 12})
    if (least <= divisor) return divisor;
  return (least + 7) / 8 * 8;
}

RenderCamera WithPlateWidth(const RenderCamera& frame, int width_px, int side_px) {
  RenderCamera scaled = frame;
  Intrinsics& k = scaled.pinhole.intrinsics;
  const double factor = std::min({static_cast<double>(width_px) / k.width_px,
                                  static_cast<double>(side_px) / k.width_px,
                                  static_cast<double>(side_px) / k.height_px});
  const auto size = [&](int px) {
    return std::clamp(static_cast<int>(std::lround(px * factor)), 1, side_px);
  };
  ScaleResolution(factor, &k);
  k.width_px = size(k.width_px);
  k.height_px = size(k.height_px);
  return scaled;
}

}  // namespace lf
