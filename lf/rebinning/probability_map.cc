// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/probability_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/core/check.h"
#include "lf/rebinning/probability_steps.h"

namespace lf {
namespace {

// Returns the stored value of a linear value: 0 for black, 1 for white. Response curves must be
// ascending.
double StoredOf(const RadianceEncoding& encoding, double radiance) {
  switch (encoding.transfer) {
    case Transfer::kSrgb:
      return SrgbFromLinear(radiance);
    case Transfer::kLinear:
      return radiance;
    case Transfer::kResponse: {
      const std::vector<double>& curve = encoding.response;
      const auto above = std::upper_bound(curve.begin() + 1, curve.end() - 1, radiance);
      const double low = above[-1], step = *above - low;
      const double part = step > 0 ? std::clamp((radiance - low) / step, 0.0, 1.0) : 0;
      return (static_cast<double>(above - 1 - curve.begin()) + part) /
             static_cast<double>(curve.size() - 1);
    }
  }
  return radiance;
}

// Returns the squares of 2 x 2 pixels that a rectangle of pixels touches, as a rectangle whose unit
// is such a square.
PixelRect Quads(const PixelRect& rect) {
  return {rect.x_begin >> 1, rect.y_begin >> 1, (rect.x_end + 1) >> 1, (rect.y_end + 1) >> 1};
}

}  // namespace

std::vector<uint16_t> StoredValueTable(const RadianceEncoding& encoding) {
  std::vector<uint16_t> table(65536);
  for (size_t v = 0; v < table.size(); ++v) {
    const double radiance = (static_cast<double>(v) - encoding.pedestal) / encoding.Scale();
    const double stored = std::clamp(StoredOf(encoding, radiance), 0.0, 1.0);
    table[v] = static_cast<uint16_t>(std::lround(65535 * stored));
  }
  return table;
}

SmoothingTaps MakeTaps(double sigma_px) {
  LF_CHECK(sigma_px >= 0 && sigma_px <= kMostSigma_px);
  const int radius = static_cast<int>(std::ceil(3 * sigma_px));
  std::vector<double> exact(radius + 1, 1);
  double sum = 1;
  for (int i = 1; i <= radius; ++i) {
    exact[i] = std::exp(-i * i / (2 * sigma_px * sigma_px));
    sum += 2 * exact[i];
  }
  SmoothingTaps taps;
  uint32_t around = 0;
  for (int i = 0; i <= radius; ++i) {
    taps.values.push_back(
        static_cast<uint32_t>(std::lround(exact[i] / sum * SmoothingTaps::kTapSum)));
    if (i > 0) around += 2 * taps.values.back();
  }
  taps.values[0] = SmoothingTaps::kTapSum - around;
  return taps;
}

ProbabilityParameters MakeParameters(const ProbabilityOptions& options, bool is_mosaic) {
  LF_CHECK(options.alpha >= 0 && options.alpha <= kMostAlpha);
  LF_CHECK(options.beta >= 0 && options.xi >= 0 && options.xi <= 1);
  const double scale = is_mosaic ? 0.5 : 1;  // number of grey values per LF pixel along an axis
  ProbabilityParameters parameters;
  parameters.taps = MakeTaps(scale * options.sigma_px);
  parameters.second_taps = MakeTaps(scale * options.second_sigma_px);
  parameters.alpha = static_cast<uint32_t>(std::lround(256 * options.alpha));
  parameters.beta = static_cast<uint32_t>(std::lround(65535 * std::min(options.beta, 2.0)));
  parameters.xi = static_cast<uint32_t>(std::lround(65535 * options.xi));
  return parameters;
}

GreyRows::GreyRows(const LfPixels& pixels, const PixelRect& part,
                   const std::vector<uint16_t>& stored_values)
    : pixels_(pixels),
      stored_(stored_values.data()),
      plane_(pixels.bayer == BayerPattern::kNone ? part : Quads(part)) {
  LF_CHECK(stored_values.size() == 65536);
}

// Returns the green of the pair of pixels in row y that contains column x. If that green is outside
// the rectangle, returns the nearest green of the row that is inside, or the first pixel of the row
// if there is none.
uint16_t GreyRows::GreenOfPair(int x, int y) const {
  if (BayerChannel(pixels_.bayer, x, y) != 1) x ^= 1;
  const PixelRect& rect = pixels_.rect;
  if (x < rect.x_begin) x += 2;
  if (x >= rect.x_end) x -= 2;
  if (x < rect.x_begin) x = rect.x_begin;
  return pixels_.radiance.at(x - rect.x_begin, y - rect.y_begin);
}

void GreyRows::Read(int y, uint16_t* out) const {
  const PixelRect& rect = pixels_.rect;
  if (pixels_.bayer == BayerPattern::kNone) {
    const uint16_t* v = pixels_.radiance.row(plane_.y_begin + y - rect.y_begin) +
                        static_cast<size_t>(plane_.x_begin - rect.x_begin) * LfPixels::kRgbLanes;
    for (int x = 0; x < width(); ++x, v += LfPixels::kRgbLanes)
      out[x] = stored_[(v[0] + 2u * v[1] + v[2] + 2) >> 2];
    return;
  }
  const int top = 2 * (plane_.y_begin + y);
  const int y0 = std::max(top, rect.y_begin), y1 = std::min(top + 1, rect.y_end - 1);
  const auto mean = [this](uint16_t a, uint16_t b) {
    return static_cast<uint16_t>((stored_[a] + stored_[b] + 1) >> 1);
  };
  // Away from the borders, the greens of a row are two pixels apart.
  const int odd0 = BayerChannel(pixels_.bayer, 0, y0) == 1 ? 0 : 1;
  const int odd1 = BayerChannel(pixels_.bayer, 0, y1) == 1 ? 0 : 1;
  const uint16_t* const row0 = pixels_.radiance.row(y0 - rect.y_begin);
  const uint16_t* const row1 = pixels_.radiance.row(y1 - rect.y_begin);
  for (int x = 0; x < width(); ++x) {
    const int left = 2 * (plane_.x_begin + x);
    if (left < rect.x_begin || left + 2 > rect.x_end)
      out[x] = mean(GreenOfPair(left, y0), GreenOfPair(left, y1));
    else
      out[x] = mean(row0[left + odd0 - rect.x_begin], row1[left + odd1 - rect.x_begin]);
  }
}

void SpreadOverPixels(const LfPixels& pixels, const PixelRect& rect, const PixelRect& plane,
                      const Image<uint16_t>& of_plane, Image<uint16_t>* p) {
  p->Resize(rect.width(), rect.height(), 1);
  const bool is_mosaic = pixels.bayer != BayerPattern::kNone;
  for (int y = 0; y < rect.height(); ++y) {
    uint16_t* const out = p->row(y);
    const int row = rect.y_begin + y;
    const uint16_t* const in = of_plane.row((is_mosaic ? row >> 1 : row) - plane.y_begin);
    if (is_mosaic)
      for (int x = 0; x < rect.width(); ++x) out[x] = in[((rect.x_begin + x) >> 1) - plane.x_begin];
    else
      std::copy_n(in + (rect.x_begin - plane.x_begin), rect.width(), out);
  }
  if (!pixels.any_masked) return;
  for (int y = 0; y < rect.height(); ++y)
    for (int x = 0; x < rect.width(); ++x)
      if (pixels.IsMasked(rect.x_begin + x - pixels.rect.x_begin,
                          rect.y_begin + y - pixels.rect.y_begin))
        p->at(x, y) = 0;
}

int PixelsAround(const ProbabilityOptions& options, bool is_mosaic) {
  const ProbabilityParameters parameters = MakeParameters(options, is_mosaic);
  const int around = parameters.taps.radius() + 1 + parameters.second_taps.radius();
  return is_mosaic ? 2 * around + 1 : around;
}

void ProbabilityMap(const LfPixels& pixels, const PixelRect& rect,
                    const std::vector<uint16_t>& stored_values, const ProbabilityOptions& options,
                    Image<uint16_t>* p) {
  LF_CHECK(Intersection(rect, pixels.rect) == rect || rect.empty());
  p->Resize(0, 0, 1);
  if (rect.empty()) return;
  const bool is_mosaic = pixels.bayer != BayerPattern::kNone;
  const ProbabilityParameters parameters = MakeParameters(options, is_mosaic);
  const int around = PixelsAround(options, is_mosaic);
  const GreyRows grey(pixels,
                      Intersection({rect.x_begin - around, rect.y_begin - around,
                                    rect.x_end + around, rect.y_end + around},
                                   pixels.rect),
                      stored_values);
  static thread_local Image<uint16_t> of_plane;
  ProbabilityPlane(parameters, grey, &of_plane);
  if (parameters.second_taps.radius() > 0) {
    const Image<uint16_t> once = of_plane;
    SmoothedPlane(parameters.second_taps, once, &of_plane);
  }
  SpreadOverPixels(pixels, rect, grey.plane(), of_plane, p);
}

}  // namespace lf
