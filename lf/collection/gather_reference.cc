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
  const double left = std::floor(x_px - 0.5), top = std::floor(y_px - 0.5);
  if (!(left >= 0 && left + 1 < width_px && top >= 0 && top + 1 < height_px)) return std::nullopt;
  // In 1/256, from the first pixel of the image.
  constexpr int64_t kOne = 256;
  const auto x = static_cast<int64_t>(std::floor((x_px - 0.5) * kOne + 0.5));
  const auto y = static_cast<int64_t>(std::floor((y_px - 0.5) * kOne + 0.5));
  const int image_column = std::min(static_cast<int>(x / kOne), width_px - 2);
  const int image_row = std::min(static_cast<int>(y / kOne), height_px - 2);
  auto right = static_cast<uint32_t>(x - kOne * image_column);
  auto down = static_cast<uint32_t>(y - kOne * image_row);
  if (filter == PixelFilter::kNearest) {
    right = right < kOne / 2 ? 0 : kOne;
    down = down < kOne / 2 ? 0 : kOne;
  }
  const int column = image_column - pixels.rect.x_begin, row = image_row - pixels.rect.y_begin;
  LF_CHECK(column >= 0 && column + 1 < pixels.rect.width() && row >= 0 &&
           row + 1 < pixels.rect.height());
  // Whether all pixels so many around the four are there.
  const auto has_all = [&](int outer) {
    if (column < outer || column + 1 + outer >= pixels.rect.width() || row < outer ||
        row + 1 + outer >= pixels.rect.height())
      return false;
    for (int dy = -outer; dy <= 1 + outer; ++dy)
      for (int dx = -outer; dx <= 1 + outer; ++dx)
        if (pixels.IsMasked(column + dx, row + dy)) return false;
    return true;
  };
  if (!has_all(0)) return std::nullopt;
  const bool is_cubic = filter == PixelFilter::kBicubic && has_all(1);
  std::array<uint16_t, 3> value;
  for (int c = 0; c < 3; ++c) {
    const auto pixel = [&](int dx, int dy) -> uint32_t {
      return pixels.radiance.at(column + dx, row + dy, c);
    };
    value[c] = is_cubic ? Bicubic(pixel, right, down) : Bilinear(pixel, right, down);
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
                         const RayWeights& weights, PixelFilter filter) {
  const Intrinsics& k = lf_camera.intrinsics;
  const GatherSampling sampling = SamplingOf(lf_camera, render_camera, filter);
  const int samples = sampling.samples;
  const GatherLaw law(lf_camera, WithFinerPlate(render_camera, samples));
  // The ray of element (x, y).
  const auto ray_of = [&](int x, int y) -> std::optional<std::array<uint16_t, 3>> {
    std::array<uint32_t, 3> sum = {};
    uint32_t count = 0;
    for (int i = 0; i < samples * samples; ++i) {
      const std::optional<Vec2> p =
          law.Position(x * samples + i % samples, y * samples + i / samples);
      if (!p) continue;
      const auto value =
          InterpolatePixels(pixels, k.width_px, k.height_px, p->x(), p->y(), sampling.filter);
      if (!value) continue;
      for (int c = 0; c < 3; ++c) sum[c] += (*value)[c];
      ++count;
    }
    if (count == 0) return std::nullopt;
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
