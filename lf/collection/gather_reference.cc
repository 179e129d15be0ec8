#include <cmath>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/gather.h"
#include "lf/collection/gather_law.h"
#include "lf/core/check.h"

namespace lf {

std::optional<std::array<uint16_t, 3>> InterpolatePixels(const LfPixels& pixels, int width_px,
                                                         int height_px, double x_px, double y_px) {
  LF_DCHECK(pixels.bayer == BayerPattern::kNone);
  const double left = std::floor(x_px - 0.5), top = std::floor(y_px - 0.5);
  if (!(left >= 0 && left + 1 < width_px && top >= 0 && top + 1 < height_px)) return std::nullopt;
  const int column = static_cast<int>(left) - pixels.rect.x_begin;
  const int row = static_cast<int>(top) - pixels.rect.y_begin;
  LF_CHECK(column >= 0 && column + 1 < pixels.rect.width() && row >= 0 &&
           row + 1 < pixels.rect.height());
  for (const int y : {row, row + 1})
    if (pixels.IsMasked(column, y) || pixels.IsMasked(column + 1, y)) return std::nullopt;
  constexpr uint32_t kOne = 256;
  const auto right_weight = static_cast<uint32_t>(std::floor((x_px - 0.5 - left) * kOne + 0.5));
  const auto lower_weight = static_cast<uint32_t>(std::floor((y_px - 0.5 - top) * kOne + 0.5));
  const uint16_t* upper =
      pixels.radiance.row(row) + static_cast<ptrdiff_t>(column) * LfPixels::kRgbLanes;
  const uint16_t* lower =
      pixels.radiance.row(row + 1) + static_cast<ptrdiff_t>(column) * LfPixels::kRgbLanes;
  std::array<uint16_t, 3> value;
  for (int c = 0; c < 3; ++c) {
    const uint32_t above =
        upper[c] * (kOne - right_weight) + upper[c + LfPixels::kRgbLanes] * right_weight;
    const uint32_t below =
        lower[c] * (kOne - right_weight) + lower[c + LfPixels::kRgbLanes] * right_weight;
    const uint64_t sum = uint64_t{above} * (kOne - lower_weight) + uint64_t{below} * lower_weight;
    value[c] = static_cast<uint16_t>((sum + kOne * kOne / 2) / (kOne * kOne));
  }
  return value;
}

bool RaysArriveAround(const Intrinsics& k, const DistortionMap& map, double x_px, double y_px) {
  const double left = std::floor(x_px - 0.5) + 0.5, top = std::floor(y_px - 0.5) + 0.5;
  for (const double y : {top, top + 1})
    for (const double x : {left, left + 1})
      if (!IdealPosition(k, map, x, y)) return false;
  return true;
}

uint64_t GatherReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                         const RenderCamera& render_camera, SensorPlate* plate,
                         const RayWeights& weights) {
  const Intrinsics& k = lf_camera.intrinsics;
  const GatherLaw law(lf_camera, render_camera);
  uint64_t accepted = 0;
  for (int y = 0; y < plate->height(); ++y)
    for (int x = 0; x < plate->width(); ++x) {
      const std::optional<Vec2> p = law.Position(x, y);
      if (!p) continue;
      const auto value = InterpolatePixels(pixels, k.width_px, k.height_px, p->x(), p->y());
      if (!value) continue;
      const uint64_t weight = weights.At(x, y);
      for (int channel = 0; channel < SensorPlate::kChannels; ++channel)
        plate->Add(x, y, channel, {weight * (*value)[channel], weight});
      ++accepted;
    }
  return accepted;
}

}  // namespace lf
