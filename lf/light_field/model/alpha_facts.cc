// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/alpha_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

namespace lf {
namespace {

constexpr double kTransparent = 1 / 64.;
constexpr double kOpaque = 0.98;
constexpr double kSameColour = 3 / 255.;  // largest difference of a channel, as a share of white
using Colour = std::array<float, 3>;

// Reads colours and alpha of one image, as shares of the largest storable value, and light.
template <class T>
class AlphaImage {
 public:
  AlphaImage(const RadianceEncoding& encoding, const Image<T>& stored, const ChannelUse& use)
      : encoding_(encoding), stored_(stored), use_(use) {
    if constexpr (!std::is_floating_point_v<T>)
      if (const int bits = int{8 * sizeof(T)}; LevelsFit(encoding, bits))
        table_ = LightTable(encoding, bits);
  }
  int width() const { return stored_.width(); }
  int height() const { return stored_.height(); }

  // Returns alpha from 0 to 1; NaN becomes 0.
  double Alpha(int x, int y) const {
    const double alpha = stored_.at(x, y, *use_.alpha) / kWhite;
    return alpha > 0 ? std::min(alpha, 1.) : 0;
  }
  Colour ColourAt(int x, int y) const {
    Colour colour;
    for (int c = 0; c < 3; ++c) {
      const double value = stored_.at(x, y, use_.colours == 3 ? c : 0) / kWhite;
      colour[static_cast<size_t>(c)] = static_cast<float>(std::isnan(value) ? 0 : value);
    }
    return colour;
  }
  // Returns the radiance, from 0 to max_radiance, of a share of the largest storable value; 0 if
  // the file has too few bits for the levels of the encoding.
  double LightOf(float share) const {
    if constexpr (std::is_floating_point_v<T>) {
      return share > 0 ? std::min<double>(share, encoding_.max_radiance) : 0;
    } else {
      if (table_.empty()) return 0;
      const auto value = static_cast<size_t>(std::lround(share * kWhite));
      return std::clamp(table_[value], 0., encoding_.max_radiance);
    }
  }
  double LightAt(int x, int y) const {
    const Colour colour = ColourAt(x, y);
    return LightOf(colour[0]) + LightOf(colour[1]) + LightOf(colour[2]);
  }

 private:
  static constexpr double kWhite =
      std::is_floating_point_v<T> ? 1 : static_cast<double>(std::numeric_limits<T>::max());
  const RadianceEncoding& encoding_;
  const Image<T>& stored_;
  const ChannelUse& use_;
  std::vector<double> table_;
};

// Returns which entries of `flags` are true together with all entries up to `radius` before and
// behind them; places beyond the ends count as true. Line `line` begins at line * line_step, and
// its entries are `step` apart.
std::vector<bool> Eroded(const std::vector<bool>& flags, int lines, int line_step, int length,
                         int step, int radius) {
  std::vector<bool> eroded(flags.size());
  for (int line = 0; line < lines; ++line) {
    const auto index = [&](int i) {
      return static_cast<size_t>(line) * static_cast<size_t>(line_step) +
             static_cast<size_t>(i) * static_cast<size_t>(step);
    };
    int false_count = 0;  // within `radius` of i
    for (int i = -radius; i < length; ++i) {
      if (i + radius < length) false_count += !flags[index(i + radius)];
      if (i - radius - 1 >= 0) false_count -= !flags[index(i - radius - 1)];
      if (i >= 0) eroded[index(i)] = false_count == 0;
    }
  }
  return eroded;
}

bool IsSameColour(const Colour& a, const Colour& b) {
  for (size_t c = 0; c < 3; ++c)
    if (!(std::abs(a[c] - b[c]) <= kSameColour)) return false;
  return true;
}

// Returns the median of each channel of at least one colour.
Colour MedianOf(const std::vector<Colour>& colours) {
  Colour median;
  std::vector<float> values(colours.size());
  for (size_t c = 0; c < 3; ++c) {
    std::transform(colours.begin(), colours.end(), values.begin(),
                   [c](const Colour& colour) { return colour[c]; });
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[c] = *middle;
  }
  return median;
}

template <class T>
void MeasureInner(const AlphaImage<T>& image, const std::vector<bool>& is_inner,
                  AlphaFacts* facts) {
  // Colours of a part of the inner pixels, which is enough for shares.
  constexpr size_t kMostColours = 200'000;
  const size_t step = 1 + facts->inner_count / kMostColours;
  std::vector<Colour> colours;
  size_t pair_count = 0, differing_count = 0, number = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const size_t at =
          static_cast<size_t>(y) * static_cast<size_t>(image.width()) + static_cast<size_t>(x);
      if (!is_inner[at] || number++ % step != 0) continue;
      colours.push_back(image.ColourAt(x, y));
      if (x + 1 == image.width() || !is_inner[at + 1]) continue;
      ++pair_count;
      differing_count += !IsSameColour(colours.back(), image.ColourAt(x + 1, y));
    }
  const Colour median = MedianOf(colours);
  const auto same_count = std::count_if(colours.begin(), colours.end(), [&](const Colour& colour) {
    return IsSameColour(colour, median);
  });
  facts->one_colour_share = static_cast<double>(same_count) / static_cast<double>(colours.size());
  if (pair_count > 0)
    facts->detail_share = static_cast<double>(differing_count) / static_cast<double>(pair_count);
  for (size_t c = 0; c < 3; ++c) facts->background[c] = image.LightOf(median[c]);
}

template <class T>
void MeasureEdges(const AlphaImage<T>& image, AlphaFacts* facts) {
  constexpr int kNear = 2;              // pixels; distance of the opaque pixels
  constexpr double kLeastLight = 0.02;  // sum of three channels; darker pixels tell nothing
  // Pixels with less than this share of the light of multiplied colours are in a shadow.
  constexpr double kOtherSurface = 0.25;
  size_t multiplied_count = 0;
  for (int y = kNear; y < image.height() - kNear; ++y)
    for (int x = kNear; x < image.width() - kNear; ++x) {
      const double alpha = image.Alpha(x, y);
      if (alpha < 0.15 || alpha > 0.7) continue;
      ++facts->half_count;
      double light = 0;
      int count = 0;
      for (int j = y - kNear; j <= y + kNear; ++j)
        for (int i = x - kNear; i <= x + kNear; ++i)
          if (image.Alpha(i, j) >= kOpaque) {
            light += image.LightAt(i, j);
            ++count;
          }
      if (count == 0 || light < kLeastLight * count) continue;
      light /= count;
      const double here = image.LightAt(x, y);
      if (here < kOtherSurface * alpha * light) continue;
      ++facts->edge_count;
      multiplied_count += here < std::sqrt(alpha) * light;  // their geometric mean parts the two
    }
  if (facts->edge_count > 0)
    facts->multiplied_share =
        static_cast<double>(multiplied_count) / static_cast<double>(facts->edge_count);
}

template <class T>
AlphaFacts Measure(const RadianceEncoding& encoding, const Image<T>& stored,
                   const ChannelUse& use) {
  const AlphaImage<T> image(encoding, stored, use);
  AlphaFacts facts;
  facts.width = image.width();
  facts.is_float = std::is_floating_point_v<T>;
  facts.is_transparent.reserve(static_cast<size_t>(image.width()) *
                               static_cast<size_t>(image.height()));
  size_t opaque_count = 0;
  int left = image.width(), right = -1, top = image.height(), bottom = -1;  // of opaque pixels
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double alpha = image.Alpha(x, y);
      facts.is_transparent.push_back(alpha <= kTransparent);
      facts.transparent_count += facts.is_transparent.back();
      if (alpha < kOpaque) continue;
      ++opaque_count;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = y;
    }
  if (facts.transparent_count == 0) return facts;
  const int margin_x = image.width() / 50, margin_y = image.height() / 50;
  facts.opaque_spans_image = (left <= margin_x && right >= image.width() - 1 - margin_x) ||
                             (top <= margin_y && bottom >= image.height() - 1 - margin_y);
  facts.opaque_share =
      static_cast<double>(opaque_count) / static_cast<double>(facts.is_transparent.size());
  const int radius = std::clamp(image.width() / 128, 2, 8);
  const std::vector<bool> rows =
      Eroded(facts.is_transparent, image.height(), image.width(), image.width(), 1, radius);
  std::vector<bool> is_inner =
      Eroded(rows, image.width(), 1, image.height(), image.width(), radius);
  facts.inner_count = static_cast<size_t>(std::count(is_inner.begin(), is_inner.end(), true));
  constexpr size_t kLeastInner = 20;
  facts.has_inner =
      facts.inner_count >= kLeastInner && 20 * facts.inner_count >= facts.transparent_count;
  if (!facts.has_inner) {
    is_inner = facts.is_transparent;
    facts.inner_count = facts.transparent_count;
  }
  MeasureInner(image, is_inner, &facts);
  MeasureEdges(image, &facts);
  return facts;
}

}  // namespace

AlphaFacts MeasureAlpha(const RadianceEncoding& encoding, const StoredImage& image,
                        const ChannelUse& use) {
  return std::visit([&](const auto& stored) { return Measure(encoding, stored, use); }, image);
}

}  // namespace lf
