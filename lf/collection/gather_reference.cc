// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/cubic_weights.h"
#include "lf/collection/gather.h"
#include "lf/collection/gather_model.h"
#include "lf/core/check.h"

namespace lf {

namespace {

// Returns the value of a ray in one colour, interpolated between the four nearest pixels. `right`
// and `down` are the distances of the ray from the upper left one of these, in 1/256 px. pixel(dx,
// dy) returns the value of the pixel dx columns to the right of the upper left one and dy rows
// below it.
template <class Pixel>
uint16_t Bilinear(const Pixel& pixel, uint32_t right, uint32_t down) {
  constexpr uint32_t kOne = 256;
  const uint32_t above = pixel(0, 0) * (kOne - right) + pixel(1, 0) * right;
  const uint32_t below = pixel(0, 1) * (kOne - right) + pixel(1, 1) * right;
  const uint64_t sum = uint64_t{above} * (kOne - down) + uint64_t{below} * down;
  return static_cast<uint16_t>((sum + uint64_t{kOne} * kOne / 2) / (uint64_t{kOne} * kOne));
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

std::optional<RgbRay> InterpolatePixels(const LfPixels& pixels, int width_px, int height_px,
                                        double x_px, double y_px, const GatherSampling& sampling) {
  LF_DCHECK(pixels.bayer == BayerPattern::kNone);
  const double left = std::floor(x_px - 0.5), top = std::floor(y_px - 0.5);
  if (!(left >= 0 && left + 1 < width_px && top >= 0 && top + 1 < height_px)) return std::nullopt;
  // The position in 1/256 px, counted from the upper left knot of the image. (A knot is where a
  // value of the image stands: the centre of a pixel, or midway between pixels if
  // prefilter.is_even.) Positions beyond the outermost knots are moved to these.
  constexpr int64_t kOne = 256;
  const int less = sampling.prefilter.is_even ? 1 : 0;
  const auto from_knot = [&](double position_px, int size_px) {
    const double knot_px = less == 1 ? 1 : 0.5;
    const auto position = static_cast<int64_t>(std::floor((position_px - knot_px) * kOne + 0.5));
    return std::clamp<int64_t>(position, 0, kOne * (size_px - 1 - less));
  };
  const int64_t x = from_knot(x_px, width_px), y = from_knot(y_px, height_px);
  const int image_column = std::min(static_cast<int>(x / kOne), width_px - 2 - less);
  const int image_row = std::min(static_cast<int>(y / kOne), height_px - 2 - less);
  auto right = static_cast<uint32_t>(x - kOne * image_column);
  auto down = static_cast<uint32_t>(y - kOne * image_row);
  if (sampling.filter == PixelFilter::kNearest) {
    right = right < kOne / 2 ? 0 : kOne;
    down = down < kOne / 2 ? 0 : kOne;
  }
  const int column = image_column - pixels.rect.x_begin, row = image_row - pixels.rect.y_begin;
  LF_CHECK(column >= 0 && column + 1 < pixels.rect.width() && row >= 0 &&
           row + 1 < pixels.rect.height());
  // True if the four pixels, and `outer` more rows and columns on each side, are all loaded and
  // unmasked.
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
  const bool is_cubic = sampling.is_cubic && has_all(1);
  RgbRay ray = {};
  for (int c = 0; c < 3; ++c) {
    const auto pixel = [&](int dx, int dy) -> uint32_t {
      return pixels.radiance.at(column + dx, row + dy, c);
    };
    ray[c] = is_cubic ? Bicubic(pixel, right, down) : Bilinear(pixel, right, down);
  }
  return ray;
}

bool RaysArriveAround(const Intrinsics& k, const DistortionMap& map, double x_px, double y_px) {
  const double left = std::floor(x_px - 0.5) + 0.5, top = std::floor(y_px - 0.5) + 0.5;
  for (const double y : {top, top + 1})
    for (const double x : {left, left + 1})
      if (!IdealPosition(k, map, x, y)) return false;
  return true;
}

uint64_t GatherReference(const PinholeCamera& lf_camera, const LfPixels& recorded,
                         const RenderCamera& render_camera, SensorPlate* plate,
                         const RayWeights& weights, const PixelReading& reading) {
  const Intrinsics& k = lf_camera.intrinsics;
  const GatherSampling sampling = SamplingOf(lf_camera, render_camera, reading);
  LfPixels filtered;
  if (!sampling.prefilter.changes_nothing())
    FilterPixelsReference(sampling.prefilter, recorded, &filtered);
  const LfPixels& pixels = sampling.prefilter.changes_nothing() ? recorded : filtered;
  const int samples = sampling.samples;
  // Returns the ray of element (x, y); none if the LF image did not record it.
  const auto ray_of = [&](const GatherModel& model, int x, int y) -> std::optional<RgbRay> {
    std::array<uint32_t, 3> sum = {};
    uint32_t rays = 0;
    for (int i = 0; i < samples * samples; ++i) {
      const std::optional<Vec2> p =
          model.Position(x * samples + i % samples, y * samples + i / samples);
      if (!p) continue;
      const auto ray = InterpolatePixels(pixels, k.width_px, k.height_px, p->x(), p->y(), sampling);
      if (!ray) continue;
      for (int c = 0; c < 3; ++c) sum[c] += (*ray)[c];
      ++rays;
    }
    if (rays == 0) return std::nullopt;
    RgbRay mean = {};
    for (int c = 0; c < 3; ++c) mean[c] = static_cast<uint16_t>((sum[c] + rays / 2) / rays);
    return mean;
  };
  uint64_t accepted = 0;
  ForEachPiece(render_camera, [&](const RenderCamera& piece) {
    const GatherModel model(lf_camera, WithFinerPlate(piece, samples));
    const PixelRect elements = ElementsOf(piece);
    for (int y = elements.y_begin; y < elements.y_end; ++y)
      for (int x = elements.x_begin; x < elements.x_end; ++x) {
        const auto ray = ray_of(model, x, y);
        if (!ray) continue;
        const uint64_t weight = weights.At(x, y);
        for (int channel = 0; channel < SensorPlate::kChannels; ++channel)
          plate->Add(x, y, channel, {weight * (*ray)[channel], weight});
        ++accepted;
      }
  });
  return accepted;
}

}  // namespace lf
