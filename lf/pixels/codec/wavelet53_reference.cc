// SPDX-License-Identifier: Apache-2.0
// The formulas of wavelet53.h, applied to one line of values at a time.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "lf/pixels/codec/wavelet53_kernels.h"

namespace lf {
namespace {

// Returns the value modulo the range of T.
template <class T>
T Wrapped(int64_t value) {
  return static_cast<T>(static_cast<std::make_unsigned_t<T>>(value));
}
template <class T>
T Sum(T a, T b) {
  return Wrapped<T>(int64_t{a} + b);
}
template <class T>
T Difference(T a, T b) {
  return Wrapped<T>(int64_t{a} - b);
}

template <class T>
T Predicted(T left, T right) {
  return static_cast<T>(Sum(left, right) >> 1);
}
template <class T>
T Update(T left, T right) {
  return static_cast<T>(Sum(Sum(left, right), T{2}) >> 2);
}

template <class T>
std::vector<T> SynthesizeLine(const std::vector<T>& low, const std::vector<T>& high) {
  const int n = static_cast<int>(low.size() + high.size());
  std::vector<T> x(n);
  if (n == 1) return low;
  const int last = static_cast<int>(high.size()) - 1;
  for (int i = 0; 2 * i < n; ++i)
    x[2 * i] = Difference(low[i], Update(high[std::max(i - 1, 0)], high[std::min(i, last)]));
  for (int i = 0; 2 * i + 1 < n; ++i)
    x[2 * i + 1] = Sum(high[i], Predicted(x[2 * i], x[2 * i + 2 < n ? 2 * i + 2 : 2 * i]));
  return x;
}

struct Lines {
  std::vector<int32_t> low, high;
};

Lines AnalyzeLine(const std::vector<int32_t>& x) {
  const int n = static_cast<int>(x.size());
  if (n == 1) return {x, {}};
  Lines lines{std::vector<int32_t>(LowCount(n)), std::vector<int32_t>(HighCount(n))};
  for (int i = 0; 2 * i + 1 < n; ++i)
    lines.high[i] =
        Difference(x[2 * i + 1], Predicted(x[2 * i], x[2 * i + 2 < n ? 2 * i + 2 : 2 * i]));
  const int last = HighCount(n) - 1;
  for (int i = 0; 2 * i < n; ++i)
    lines.low[i] =
        Sum(x[2 * i], Update(lines.high[std::max(i - 1, 0)], lines.high[std::min(i, last)]));
  return lines;
}

template <class T>
T Coefficient(const CodedBand<T>& band, size_t i) {
  const T scaled = Wrapped<T>(int64_t{band.values[i]} * band.step);
  return band.is_doubled ? static_cast<T>(Sum(scaled, T{1}) >> 1) : scaled;
}

}  // namespace

template <class T>
void SynthesizeReference(const CodedBands<T>& bands, T* values) {
  const int width = bands.width, height = bands.height;
  // Transforms the columns: the left half from subbands that are low across, the right half from
  // subbands that are high across.
  std::vector<T> middle(static_cast<size_t>(width) * height);
  const auto columns = [&](Band low_band, Band high_band, int begin) {
    const int count = BandWidth(low_band, width);
    for (int x = 0; x < count; ++x) {
      std::vector<T> low, high;
      for (int y = 0; y < LowCount(height); ++y)
        low.push_back(Coefficient(bands.bands[low_band], static_cast<size_t>(y) * count + x));
      for (int y = 0; y < HighCount(height); ++y)
        high.push_back(Coefficient(bands.bands[high_band], static_cast<size_t>(y) * count + x));
      const std::vector<T> column = SynthesizeLine(low, high);
      for (int y = 0; y < height; ++y)
        middle[static_cast<size_t>(y) * width + begin + x] = column[y];
    }
  };
  columns(kLowLow, kLowHigh, 0);
  columns(kHighLow, kHighHigh, LowCount(width));
  for (int y = 0; y < height; ++y) {
    const T* const row = middle.data() + static_cast<size_t>(y) * width;
    const T* const high = row + LowCount(width);
    const std::vector<T> line = SynthesizeLine(std::vector<T>(row, high),  //
                                               std::vector<T>(high, row + width));
    std::copy(line.begin(), line.end(), values + static_cast<size_t>(y) * width);
  }
}
template void SynthesizeReference(const CodedBands<int16_t>&, int16_t*);
template void SynthesizeReference(const CodedBands<int32_t>&, int32_t*);

template <class T, class Pixel>
void SynthesizePixelsReference(const CodedBands<T>& bands, const PixelScale& scale,
                               ImageView<Pixel> pixels) {
  std::vector<T> values(static_cast<size_t>(bands.width) * bands.height);
  SynthesizeReference(bands, values.data());
  const T half = static_cast<T>((1 << scale.fraction_bits) >> 1);
  for (int y = 0; y < bands.height; ++y)
    for (int x = 0; x < bands.width; ++x) {
      const T value = values[static_cast<size_t>(y) * bands.width + x];
      const T offset = static_cast<T>(scale.adds ? pixels.at(x, y) : scale.offset);
      const T pixel = Sum(static_cast<T>(Sum(value, half) >> scale.fraction_bits), offset);
      pixels.at(x, y) =
          static_cast<Pixel>(std::clamp<int64_t>(pixel, 0, std::numeric_limits<Pixel>::max()));
    }
}
template void SynthesizePixelsReference(const CodedBands<int16_t>&, const PixelScale&,
                                        ImageView<uint8_t>);
template void SynthesizePixelsReference(const CodedBands<int32_t>&, const PixelScale&,
                                        ImageView<uint8_t>);
template void SynthesizePixelsReference(const CodedBands<int32_t>&, const PixelScale&,
                                        ImageView<uint16_t>);

void AnalyzeReference(const int32_t* values, int width, int height,
                      const std::array<int32_t*, kBands>& bands) {
  std::vector<int32_t> middle(static_cast<size_t>(width) * height);
  for (int y = 0; y < height; ++y) {
    const int32_t* const row = values + static_cast<size_t>(y) * width;
    const Lines lines = AnalyzeLine(std::vector<int32_t>(row, row + width));
    int32_t* const out = middle.data() + static_cast<size_t>(y) * width;
    std::copy(lines.low.begin(), lines.low.end(), out);
    std::copy(lines.high.begin(), lines.high.end(), out + lines.low.size());
  }
  for (int x = 0; x < width; ++x) {
    std::vector<int32_t> column(height);
    for (int y = 0; y < height; ++y) column[y] = middle[static_cast<size_t>(y) * width + x];
    const Lines lines = AnalyzeLine(column);
    const bool is_low = x < LowCount(width);
    const int band_x = is_low ? x : x - LowCount(width);
    const auto put = [&](Band band, const std::vector<int32_t>& line) {
      for (size_t y = 0; y < line.size(); ++y)
        bands[band][y * BandWidth(band, width) + band_x] = line[y];
    };
    put(is_low ? kLowLow : kHighLow, lines.low);
    put(is_low ? kLowHigh : kHighHigh, lines.high);
  }
}

double SynthesisNorm(const std::vector<bool>& is_high) {
  // Computes without rounding, for one coefficient far from the ends of a line.
  std::vector<double> x(8, 0.0);
  x[4] = 1;
  for (const bool of_high : is_high) {
    const std::vector<double> zero(x.size(), 0.0);
    const std::vector<double>&low = of_high ? zero : x, &high = of_high ? x : zero;
    std::vector<double> y(2 * x.size());
    for (size_t k = 0; k < x.size(); ++k)
      y[2 * k] = low[k] - (high[k == 0 ? 0 : k - 1] + high[k]) / 4;
    for (size_t k = 0; k < x.size(); ++k)
      y[2 * k + 1] = high[k] + (y[2 * k] + y[k + 1 < x.size() ? 2 * k + 2 : 2 * k]) / 2;
    x = std::move(y);
  }
  double sum = 0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum);
}

}  // namespace lf
