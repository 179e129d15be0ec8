#include "lf/rebinning/probability_map.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"
#include "lf/rebinning/probability_law.h"

namespace lf {
namespace {

// Where black is 0 and white 1; response curves rise.
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

// The green of a row of two pixels that holds column x; inside of the rectangle, if there is one.
uint16_t GreenOfPair(const LfPixels& pixels, int x, int y) {
  if (BayerChannel(pixels.bayer, x, y) != 1) x ^= 1;
  const PixelRect& rect = pixels.rect;
  if (x < rect.x_begin) x += 2;
  if (x >= rect.x_end) x -= 2;
  if (x < rect.x_begin) x = rect.x_begin;
  return pixels.radiance.at(x - rect.x_begin, y - rect.y_begin);
}

// Of the 2 x 2 pixels of a mosaic that a rectangle touches.
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

ProbabilityLaw MakeLaw(const ProbabilityOptions& options, bool is_mosaic) {
  LF_CHECK(options.alpha >= 0 && options.alpha <= kMostAlpha);
  LF_CHECK(options.beta >= 0 && options.xi >= 0 && options.xi < 1);
  const double scale = is_mosaic ? 0.5 : 1;  // of greys in LF pixels
  ProbabilityLaw law;
  law.taps = MakeTaps(scale * options.sigma_px);
  law.second_taps = MakeTaps(scale * options.second_sigma_px);
  law.alpha = static_cast<uint32_t>(std::lround(256 * options.alpha));
  law.beta = static_cast<uint32_t>(std::lround(65535 * std::min(options.beta, 2.0)));
  law.xi = static_cast<uint32_t>(std::lround(65535 * options.xi));
  return law;
}

Image<uint16_t> GreyPlane(const LfPixels& pixels, const std::vector<uint16_t>& stored_values) {
  LF_CHECK(stored_values.size() == 65536);
  const PixelRect& rect = pixels.rect;
  const uint16_t* const stored = stored_values.data();
  if (pixels.bayer == BayerPattern::kNone) {
    Image<uint16_t> grey(rect.width(), rect.height());
    for (int y = 0; y < rect.height(); ++y) {
      const uint16_t* v = pixels.radiance.row(y);
      uint16_t* const out = grey.row(y);
      for (int x = 0; x < rect.width(); ++x, v += LfPixels::kRgbLanes)
        out[x] = stored[(v[0] + 2u * v[1] + v[2] + 2) >> 2];
    }
    return grey;
  }
  const PixelRect quads = Quads(rect);
  Image<uint16_t> grey(quads.width(), quads.height());
  for (int y = 0; y < grey.height(); ++y)
    for (int x = 0; x < grey.width(); ++x) {
      const int left = 2 * (quads.x_begin + x), top = 2 * (quads.y_begin + y);
      const int y0 = std::max(top, rect.y_begin), y1 = std::min(top + 1, rect.y_end - 1);
      grey.at(x, y) = static_cast<uint16_t>(
          (stored[GreenOfPair(pixels, left, y0)] + stored[GreenOfPair(pixels, left, y1)] + 1) >> 1);
    }
  return grey;
}

Image<uint16_t> OfEveryPixel(const LfPixels& pixels, Image<uint16_t> of_plane) {
  const PixelRect& rect = pixels.rect;
  if (pixels.bayer != BayerPattern::kNone) {
    const PixelRect quads = Quads(rect);
    Image<uint16_t> spread(rect.width(), rect.height());
    for (int y = 0; y < rect.height(); ++y) {
      const uint16_t* const in = of_plane.row(((rect.y_begin + y) >> 1) - quads.y_begin);
      for (int x = 0; x < rect.width(); ++x)
        spread.at(x, y) = in[((rect.x_begin + x) >> 1) - quads.x_begin];
    }
    of_plane = std::move(spread);
  }
  if (pixels.any_masked)
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        if (pixels.IsMasked(x, y)) of_plane.at(x, y) = 0;
  return of_plane;
}

int PixelsAround(const ProbabilityOptions& options, bool is_mosaic) {
  const ProbabilityLaw law = MakeLaw(options, is_mosaic);
  const int around = law.taps.radius() + 1 + law.second_taps.radius();
  return is_mosaic ? 2 * around + 1 : around;
}

Image<uint16_t> ProbabilityMap(const LfPixels& pixels, const std::vector<uint16_t>& stored_values,
                               const ProbabilityOptions& options) {
  if (pixels.rect.empty()) return {};
  const ProbabilityLaw law = MakeLaw(options, pixels.bayer != BayerPattern::kNone);
  Image<uint16_t> p = ProbabilityPlane(law, GreyPlane(pixels, stored_values).view());
  if (law.second_taps.radius() > 0) p = SmoothedPlane(law.second_taps, p.view());
  return OfEveryPixel(pixels, std::move(p));
}

}  // namespace lf
