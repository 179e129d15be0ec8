#include <algorithm>
#include <cmath>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/cubic_weights.h"
#include "lf/collection/gather.h"
#include "lf/collection/gather_law.h"
#include "lf/core/check.h"

namespace lf {

namespace {

// One colour, from the pixels around and distances in 1/256 from the upper left one of the nearest
// four. pixel(dx, dy) counts from it.
template <class Pixel>
uint16_t Bilinear(const Pixel& pixel, uint32_t right, uint32_t down) {
  constexpr uint32_t kOne = 256;
  const uint32_t above = pixel(0, 0) * (kOne - right) + pixel(1, 0) * right;
  const uint32_t below = pixel(0, 1) * (kOne - right) + pixel(1, 1) * right;
  const uint64_t sum = uint64_t{above} * (kOne - down) + uint64_t{below} * down;
  return static_cast<uint16_t>((sum + kOne * kOne / 2) / (kOne * kOne));
}

template <class Pixel>
uint16_t Bicubic(const Pixel& pixel, uint32_t right, uint32_t down) {
  const auto rounded = [](int64_t value, int bits) {
    return (value + (int64_t{1} << (bits - 1))) >> bits;
  };
  const CubicTaps d = CubicTapsAt(static_cast<int>(down), kCubicDownBits);
  const CubicTaps c = CubicTapsAt(static_cast<int>(right), kCubicRightBits);
  int64_t sum = 0;
  for (int k = 0; k < 4; ++k) {
    int64_t column = 0;
    for (int i = 0; i < 4; ++i) column += int64_t{d[i]} * pixel(k - 1, i - 1);
    sum += c[k] * rounded(column, kCubicColumnShift);
  }
  return static_cast<uint16_t>(std::clamp<int64_t>(rounded(sum, kCubicShift), 0, 65535));
}

}  // namespace

std::optional<std::array<uint16_t, 3>> InterpolatePixels(const LfPixels& pixels, int width_px,
                                                         int height_px, double x_px, double y_px,
                                                         PixelFilter filter) {
  LF_DCHECK(pixels.bayer == BayerPattern::kNone);
  const int outer = OuterPixels(filter);
  const double left = std::floor(x_px - 0.5), top = std::floor(y_px - 0.5);
  if (!(left >= outer && left + 1 + outer < width_px && top >= outer &&
        top + 1 + outer < height_px))
    return std::nullopt;
  const int column = static_cast<int>(left) - pixels.rect.x_begin;
  const int row = static_cast<int>(top) - pixels.rect.y_begin;
  LF_CHECK(column >= outer && column + 1 + outer < pixels.rect.width() && row >= outer &&
           row + 1 + outer < pixels.rect.height());
  for (int dy = -outer; dy <= 1 + outer; ++dy)
    for (int dx = -outer; dx <= 1 + outer; ++dx)
      if (pixels.IsMasked(column + dx, row + dy)) return std::nullopt;
  constexpr uint32_t kOne = 256;
  auto right = static_cast<uint32_t>(std::floor((x_px - 0.5 - left) * kOne + 0.5));
  auto down = static_cast<uint32_t>(std::floor((y_px - 0.5 - top) * kOne + 0.5));
  if (filter == PixelFilter::kNearest) {
    right = right < kOne / 2 ? 0 : kOne;
    down = down < kOne / 2 ? 0 : kOne;
  }
  std::array<uint16_t, 3> value;
  for (int c = 0; c < 3; ++c) {
    const auto pixel = [&](int dx, int dy) -> uint32_t {
      return pixels.radiance.at(column + dx, row + dy, c);
    };
    value[c] = filter == PixelFilter::kBicubic ? Bicubic(pixel, right, down)
                                               : Bilinear(pixel, right, down);
  }
  return value;
}

bool RaysArriveAround(const Intrinsics& k, const DistortionMap& map, double x_px, double y_px,
                      int outer_pixels) {
  const double left = std::floor(x_px - 0.5) + 0.5, top = std::floor(y_px - 0.5) + 0.5;
  for (int dy = -outer_pixels; dy <= 1 + outer_pixels; ++dy)
    for (int dx = -outer_pixels; dx <= 1 + outer_pixels; ++dx)
      if (!IdealPosition(k, map, left + dx, top + dy)) return false;
  return true;
}

uint64_t GatherReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                         const RenderCamera& render_camera, SensorPlate* plate,
                         const RayWeights& weights, PixelFilter filter) {
  const Intrinsics& k = lf_camera.intrinsics;
  const GatherSampling sampling = SamplingOf(lf_camera, render_camera, filter);
  const int samples = sampling.samples;
  const GatherLaw law(lf_camera, WithFinerPlate(render_camera, samples), sampling.filter);
  // The ray of element (x, y).
  const auto ray_of = [&](int x, int y) -> std::optional<std::array<uint16_t, 3>> {
    std::array<uint32_t, 3> sum = {};
    for (int i = 0; i < samples * samples; ++i) {
      const std::optional<Vec2> p =
          law.Position(x * samples + i % samples, y * samples + i / samples);
      if (!p) return std::nullopt;
      const auto value =
          InterpolatePixels(pixels, k.width_px, k.height_px, p->x(), p->y(), sampling.filter);
      if (!value) return std::nullopt;
      for (int c = 0; c < 3; ++c) sum[c] += (*value)[c];
    }
    const auto count = static_cast<uint32_t>(samples * samples);
    std::array<uint16_t, 3> mean;
    for (int c = 0; c < 3; ++c) mean[c] = static_cast<uint16_t>((sum[c] + count / 2) / count);
    return mean;
  };
  uint64_t accepted = 0;
  for (int y = 0; y < plate->height(); ++y)
    for (int x = 0; x < plate->width(); ++x) {
      const auto value = ray_of(x, y);
      if (!value) continue;
      const uint64_t weight = weights.At(x, y);
      for (int channel = 0; channel < SensorPlate::kChannels; ++channel)
        plate->Add(x, y, channel, {weight * (*value)[channel], weight});
      ++accepted;
    }
  return accepted;
}

}  // namespace lf
