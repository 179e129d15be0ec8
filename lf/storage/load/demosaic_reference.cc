// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <utility>

#include "lf/core/check.h"
#include "lf/storage/load/demosaic.h"
#include "lf/storage/load/demosaic_arithmetic.h"

namespace lf {
namespace {

// A mosaic that continues beyond the borders of its LF image.
class EndlessMosaic {
 public:
  EndlessMosaic(const LfPixels& pixels, int width, int height)
      : pixels_(pixels), width_(width), height_(height) {}

  bool IsMasked(int x, int y) const { return pixels_.IsMasked(Column(x), Row(y)); }
  int Recorded(int x, int y) const { return pixels_.radiance.at(Column(x), Row(y)); }
  // Returns the value of a pixel, made from those around it if it is masked.
  int Value(int x, int y) const {
    if (!IsMasked(x, y)) return Recorded(x, y);
    int sum = 0, count = 0;
    for (const int dy : {-2, 0, 2})
      for (const int dx : {-2, 0, 2})
        if (!IsMasked(x + dx, y + dy)) sum += Recorded(x + dx, y + dy), ++count;
    return count == 0 ? Recorded(x, y) : (2 * sum + count) / (2 * count);
  }

 private:
  int Column(int x) const {
    const int column = Mirrored(x, width_) - pixels_.rect.x_begin;
    LF_CHECK(column >= 0 && column < pixels_.rect.width());
    return column;
  }
  int Row(int y) const {
    const int row = Mirrored(y, height_) - pixels_.rect.y_begin;
    LF_CHECK(row >= 0 && row < pixels_.rect.height());
    return row;
  }

  const LfPixels& pixels_;
  int width_, height_;
};

// Numbers at pixels, each of which is computed when it is asked for first.
class Numbers {
 public:
  Numbers(const PixelRect& rect, std::function<float(int, int)> number_at)
      : x_begin_(rect.x_begin - kMargin),
        y_begin_(rect.y_begin - kMargin),
        number_at_(std::move(number_at)),
        numbers_(rect.width() + 2 * kMargin, rect.height() + 2 * kMargin, 1, std::nanf("")) {}

  float operator()(int x, int y) const {
    float& number = numbers_.at(x - x_begin_, y - y_begin_);
    if (std::isnan(number)) number = number_at_(x, y);
    return number;
  }

 private:
  static constexpr int kMargin = 13;  // no step needs numbers further away

  int x_begin_, y_begin_;
  std::function<float(int, int)> number_at_;
  mutable Image<float> numbers_;
};

struct Direction {
  int dx, dy;
};

// One of the estimates whose mean is taken.
struct WeighedEstimate {
  float value, gradient;
};

// Returns the mean with the weights 1 / gradient, all multiplied by the product of all gradients.
float MeanOfEstimates(const std::array<WeighedEstimate, 4>& e, float share_of_last_two) {
  std::array<float, 4> weights{}, terms{};
  for (size_t i = 0; i < 4; ++i) {
    const size_t other_pair = i < 2 ? 2 : 0;
    const float product = e[other_pair].gradient * e[other_pair + 1].gradient;
    weights[i] = e[i ^ 1].gradient * product * (i < 2 ? 1 : share_of_last_two);
    terms[i] = weights[i] * e[i].value;
  }
  return ((terms[0] + terms[1]) + (terms[2] + terms[3])) /
         ((weights[0] + weights[1]) + (weights[2] + weights[3]));
}

constexpr std::array<Direction, 4> kCompass = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
constexpr std::array<Direction, 4> kDiagonals = {{{-1, -1}, {1, 1}, {1, -1}, {-1, 1}}};

// The steps of demosaic.h, each for one pixel, with the constants that are written there.
class ReferencePicture {
 public:
  ReferencePicture(const EndlessMosaic& mosaic, BayerPattern bayer,
                   const RadianceEncoding& encoding, const PixelRect& rect)
      : bayer_(bayer),
        mosaic_(mosaic),
        levels_(encoding),
        roots_(rect, [this](int x, int y) { return Root(x, y); }),
        green_(rect, [this](int x, int y) { return Green(x, y); }),
        opposites_{Numbers(rect, [this](int x, int y) { return Opposite(x, y, 0); }),
                   Numbers(rect, [this](int x, int y) { return Opposite(x, y, 2); })} {}
  ReferencePicture(const ReferencePicture&) = delete;

  uint16_t Level(int x, int y, int channel) const {
    const auto c = static_cast<size_t>(channel);
    if (ChannelAt(x, y) == channel) return static_cast<uint16_t>(mosaic_.Value(x, y));
    const float root = channel == 1           ? green_(x, y)
                       : ChannelAt(x, y) == 1 ? AtGreen(x, y, channel)
                                              : opposites_[c / 2](x, y);
    const float radiance = root * std::fabs(root) - 0.01f;
    const float level = std::floor(radiance * levels_.inverse[c] + (levels_.pedestal + 0.5f));
    return static_cast<uint16_t>(std::clamp(level, 0.f, 65535.f));
  }

 private:
  int ChannelAt(int x, int y) const { return BayerChannel(bayer_, x, y); }

  float Root(int x, int y) const {  // step 0
    const float factor = levels_.factor[static_cast<size_t>(ChannelAt(x, y))];
    const float value = static_cast<float>(mosaic_.Value(x, y)) - levels_.pedestal;
    const float radiance = value * factor + 0.01f;
    return radiance < 0 ? -std::sqrt(-radiance) : std::sqrt(radiance);
  }

  float Green(int x, int y) const {  // step 1
    if (ChannelAt(x, y) == 1) return roots_(x, y);
    std::array<WeighedEstimate, 4> estimates{};
    for (size_t i = 0; i < 4; ++i) {
      const auto [dx, dy] = kCompass[i];
      const auto root = [&, dx = dx, dy = dy](int n) { return roots_(x + n * dx, y + n * dy); };
      const float slope = std::fabs(root(1) - root(-1)) + 0.01f;
      const float detail = root(0) - root(2);
      estimates[i] = {root(1) + detail / 2,
                      slope + std::fabs(detail) + std::fabs(root(1) - root(3))};
    }
    const auto [least, most] =
        std::minmax({roots_(x - 1, y), roots_(x + 1, y), roots_(x, y - 1), roots_(x, y + 1)});
    return std::clamp(MeanOfEstimates(estimates, 1), least, most);
  }

  // Returns the pixel of the square of (x, y) that recorded a channel, R or B.
  Direction SiteOf(int x, int y, int channel) const {
    const int column = x - (x & 1), row = y - (y & 1);
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx)
        if (ChannelAt(dx, dy) == channel) return {column + dx, row + dy};
    LF_CHECK(false);
    return {};
  }

  float Gain(int x, int y, int channel) const {  // step 2
    const auto [site_x, site_y] = SiteOf(x, y, channel);
    float products = 0, squares = 0;
    for (int i = -2; i <= 2; ++i) {
      float products_of_column = 0, squares_of_column = 0;
      for (int j = -2; j <= 2; ++j) {
        const int at_x = site_x + 2 * i, at_y = site_y + 2 * j;
        const float c_right = roots_(at_x + 2, at_y) - roots_(at_x, at_y);
        const float c_down = roots_(at_x, at_y + 2) - roots_(at_x, at_y);
        const float g_right = green_(at_x + 2, at_y) - green_(at_x, at_y);
        const float g_down = green_(at_x, at_y + 2) - green_(at_x, at_y);
        products_of_column += c_right * g_right + c_down * g_down;
        squares_of_column += g_right * g_right + g_down * g_down;
      }
      products += products_of_column;
      squares += squares_of_column;
    }
    return std::clamp((products + 0.001f) / (squares + 0.001f), 0.f, 2.f);
  }

  // Returns a colour at (x, y). root(x, y) returns the colour of neighbours.
  template <class RootOf>
  float Colour(int x, int y, int channel, const std::array<Direction, 4>& neighbours,
               const RootOf& root, float share_of_last_two) const {
    const float gain = Gain(x, y, channel);
    std::array<WeighedEstimate, 4> estimates{};
    for (size_t i = 0; i < 4; ++i) {
      const auto [dx, dy] = neighbours[i];
      const float slope = std::fabs(root(x + dx, y + dy) - root(x - dx, y - dy));
      const float detail = green_(x, y) - green_(x + dx, y + dy);
      estimates[i] = {root(x + dx, y + dy) + gain * detail, 0.02f + slope / 2 + std::fabs(detail)};
    }
    return MeanOfEstimates(estimates, share_of_last_two);
  }

  float Opposite(int x, int y, int channel) const {  // step 3
    return Colour(x, y, channel, kDiagonals, roots_, 1);
  }

  float AtGreen(int x, int y, int channel) const {  // step 4
    const bool is_beside = ChannelAt(x + 1, y) == channel;
    const auto [w, e, n, s] = kCompass;
    return Colour(
        x, y, channel, is_beside ? kCompass : std::array{n, s, w, e},
        [&](int at_x, int at_y) {
          return ChannelAt(at_x, at_y) == channel
                     ? roots_(at_x, at_y)
                     : opposites_[static_cast<size_t>(channel) / 2](at_x, at_y);
        },
        0.5f);
  }

  BayerPattern bayer_;
  const EndlessMosaic& mosaic_;
  BalancedLevels levels_;
  Numbers roots_;
  Numbers green_;
  std::array<Numbers, 2> opposites_;  // R and B
};

}  // namespace

void DemosaicReference(const LfPixels& mosaic, int image_width_px, int image_height_px,
                       const RadianceEncoding& encoding, const PixelRect& rect, LfPixels* rgb) {
  *rgb = LfPixels(rect, BayerPattern::kNone);
  rgb->recorded = mosaic.bayer;
  if (rect.empty()) return;
  const EndlessMosaic endless(mosaic, image_width_px, image_height_px);
  const ReferencePicture picture(endless, mosaic.bayer, encoding, rect);
  const auto any_masked = [&](int x, int y) {
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = std::abs(dy) - 2; dx <= 2 - std::abs(dy); ++dx)
        if (endless.IsMasked(x + dx, y + dy)) return true;
    return false;
  };
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const int column = x - rect.x_begin, row = y - rect.y_begin;
      for (int channel = 0; channel < 3; ++channel)
        rgb->radiance.at(column, row, channel) = picture.Level(x, y, channel);
      if (any_masked(x, y)) rgb->Mask(column, row);
    }
}

}  // namespace lf
