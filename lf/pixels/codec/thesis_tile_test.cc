// SPDX-License-Identifier: Apache-2.0
// Compares the thesis's profile with the thesis itself: with its sections 2.5.1, 2.5.2, 4.2.2 and
// 5.4, implemented here in real numbers without any code of pixels/codec/.
#include "lf/pixels/codec/thesis_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "lf/pixels/codec/lf_image_codec.h"

namespace lf {
namespace {

using Line = std::vector<double>;
using Plane = std::vector<Line>;  // [height][width]

// Returns the averages a = (x + y) / 2 of all pairs of neighbours x, y, then the differences
// d = (x - y) / 2 (thesis 2.5.1). If the number of values is odd, the last value is its own
// average.
Line Transformed(const Line& line) {
  Line averages, differences;
  for (size_t i = 0; i + 1 < line.size(); i += 2) {
    averages.push_back((line[i] + line[i + 1]) / 2);
    differences.push_back((line[i] - line[i + 1]) / 2);
  }
  if (line.size() % 2 == 1) averages.push_back(line.back());
  averages.insert(averages.end(), differences.begin(), differences.end());
  return averages;
}

// Reverses Transformed(): x = a + d, y = a - d (Eq. 2.20, 2.21).
Line Restored(const Line& line) {
  const size_t low = (line.size() + 1) / 2;
  Line values;
  for (size_t i = 0; low + i < line.size(); ++i) {
    values.push_back(line[i] + line[low + i]);
    values.push_back(line[i] - line[low + i]);
  }
  if (line.size() % 2 == 1) values.push_back(line[low - 1]);
  return values;
}

template <class Step>
void ForRows(Plane& plane, size_t width, size_t height, const Step& step) {
  for (size_t y = 0; y < height; ++y) {
    const Line line = step(Line(plane[y].begin(), plane[y].begin() + width));
    std::copy(line.begin(), line.end(), plane[y].begin());
  }
}

template <class Step>
void ForColumns(Plane& plane, size_t width, size_t height, const Step& step) {
  for (size_t x = 0; x < width; ++x) {
    Line line(height);
    for (size_t y = 0; y < height; ++y) line[y] = plane[y][x];
    line = step(line);
    for (size_t y = 0; y < height; ++y) plane[y][x] = line[y];
  }
}

// Compresses one picture as the thesis does: transforms its planes, drops details below the
// threshold, and maps the range from the least to the largest coefficient to q values.
class ThesisCodec {
 public:
  ThesisCodec(std::vector<Plane> planes, const CodecSettings& settings) : planes_(planes) {
    for (Plane& plane : planes_) {
      if (plane.empty() || plane[0].empty()) continue;
      size_t width = plane[0].size(), height = plane.size();
      for (int level = 0; level < settings.levels; ++level) {
        ForRows(plane, width, height, Transformed);
        ForColumns(plane, width, height, Transformed);
        width = (width + 1) / 2, height = (height + 1) / 2;
      }
      for (size_t y = 0; y < plane.size(); ++y)
        for (size_t x = 0; x < plane[y].size(); ++x) {
          const bool is_detail = x >= width || y >= height;
          double& c = plane[y][x];
          if (is_detail && std::abs(c) < settings.threshold) c = 0;
          low_ = std::min(low_, c), high_ = std::max(high_, c);
        }
    }
    for (Plane& plane : planes_)
      for (Line& line : plane)
        for (double& c : line) c = Quantized(c, settings.quantizer);
  }

  std::vector<Plane> Decoded(int levels) const {
    std::vector<Plane> planes = planes_;
    for (Plane& plane : planes) {
      if (plane.empty() || plane[0].empty()) continue;
      std::vector<std::pair<size_t, size_t>> sizes;
      for (size_t w = plane[0].size(), h = plane.size(), i = 0; i < static_cast<size_t>(levels);
           ++i, w = (w + 1) / 2, h = (h + 1) / 2)
        sizes.emplace_back(w, h);
      for (int level = levels - 1; level >= 0; --level) {
        ForColumns(plane, sizes[level].first, sizes[level].second, Restored);
        ForRows(plane, sizes[level].first, sizes[level].second, Restored);
      }
    }
    return planes;
  }

 private:
  // Returns the nearest of q values that are spread evenly over the range (halves are rounded up),
  // as a multiple of 1 / 1024 (doc/formats/lf_image.md).
  double Quantized(double c, int q) const {
    if (high_ == low_) return c;
    const double code = std::floor((c - low_) * (q - 1) / (high_ - low_) + 0.5);
    return low_ + std::floor(code * (high_ - low_) * 1024 / (q - 1) + 0.5) / 1024;
  }

  std::vector<Plane> planes_;
  double low_ = 1e9, high_ = -1e9;
};

// The position of the pixels of a plane in the image. Pixels of a mosaic are sorted by their
// position in each 2 x 2 square (Figure 4.6), pixels of other images by channel.
struct Sorting {
  int first_x, first_y, pitch, channel;
};

std::vector<Sorting> SortingOf(PixelLayout layout) {
  if (layout == PixelLayout::kMosaic)
    return {{0, 0, 2, 0}, {1, 0, 2, 0}, {0, 1, 2, 0}, {1, 1, 2, 0}};
  if (layout == PixelLayout::kGrey) return {{0, 0, 1, 0}};
  return {{0, 0, 1, 0}, {0, 0, 1, 1}, {0, 0, 1, 2}};
}

template <class Pixel>
Image<Pixel> ByTheThesis(const Image<Pixel>& image, PixelLayout layout,
                         const CodecSettings& settings) {
  std::vector<Plane> planes;
  for (const Sorting& from : SortingOf(layout)) {
    Plane plane;
    for (int y = from.first_y; y < image.height(); y += from.pitch) {
      plane.emplace_back();
      for (int x = from.first_x; x < image.width(); x += from.pitch)
        plane.back().push_back(image.at(x, y, from.channel));
    }
    planes.push_back(plane);
  }
  const std::vector<Plane> decoded = ThesisCodec(planes, settings).Decoded(settings.levels);
  Image<Pixel> result(image.width(), image.height(), image.channels());
  size_t p = 0;
  for (const Sorting& to : SortingOf(layout)) {
    for (size_t y = 0; y < decoded[p].size(); ++y)
      for (size_t x = 0; x < decoded[p][y].size(); ++x) {
        const double most = std::numeric_limits<Pixel>::max();
        result.at(static_cast<int>(to.first_x + x * to.pitch),
                  static_cast<int>(to.first_y + y * to.pitch), to.channel) =
            static_cast<Pixel>(std::clamp(std::floor(decoded[p][y][x] + 0.5), 0.0, most));
      }
    ++p;
  }
  return result;
}

// Returns waves with noise, so that details lie on both sides of every threshold.
template <class Pixel>
Image<Pixel> NoisyWaves(std::mt19937& random, int width, int height, int channels) {
  Image<Pixel> image(width, height, channels);
  const double most = std::numeric_limits<Pixel>::max();
  const double fx = 0.02 + (random() % 100) / 300.0, fy = 0.02 + (random() % 100) / 300.0;
  const double noise = (random() % 4) * 0.02;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        const double wave = 0.5 + 0.45 * std::sin(fx * x + c) * std::cos(fy * y);
        const double dice = (random() % 2001 - 1000.0) / 1000;
        image.at(x, y, c) =
            static_cast<Pixel>(std::lround(std::clamp(wave + noise * dice, 0.0, 1.0) * most));
      }
  return image;
}

template <class Pixel>
void ExpectTheThesis(std::mt19937& random, int width, int height, PixelLayout layout,
                     const CodecSettings& settings) {
  const Image<Pixel> image =
      NoisyWaves<Pixel>(random, width, height, layout == PixelLayout::kRgb ? 3 : 1);
  DecodedPart part;
  ASSERT_TRUE(DecodeImage(EncodeImage(image, layout, settings), &part));
  ASSERT_EQ(std::get<Image<Pixel>>(part.pixels).pixels(),
            ByTheThesis(image, layout, settings).pixels())
      << width << "x" << height << ", layout " << static_cast<int>(layout) << ", levels "
      << settings.levels << ", threshold " << settings.threshold << ", q " << settings.quantizer;
}

// The cases are the rows of Table 5.3, the mapping to a byte and to q values (5.4), thresholds that
// some coefficients equal exactly, and odd sizes.
TEST(ThesisTile, GivesThePixelsOfTheThesissCodec) {
  std::mt19937 random(1);
  struct Row {
    int levels;
    double threshold;
  };
  const Row rows[] = {{1, 2}, {1, 4}, {1, 8}, {2, 0.5}, {2, 2}, {2, 4}, {3, 4}, {5, 0.25}, {1, 0}};
  for (const Row& row : rows)
    for (const int q : {256, 1024, 2, 7, 100, 4097, 65536})
      for (const PixelLayout layout : {PixelLayout::kMosaic, PixelLayout::kGrey, PixelLayout::kRgb})
        for (const auto& [width, height] :
             {std::pair(64, 48), std::pair(37, 61), std::pair(1, 5), std::pair(2, 1)}) {
          const CodecSettings settings{CodecProfile::kThesis, row.levels, row.threshold, q};
          ExpectTheThesis<uint8_t>(random, width, height, layout, settings);
          CodecSettings deep = settings;
          deep.threshold *= 256;
          ExpectTheThesis<uint16_t>(random, width, height, layout, deep);
        }
}

// The thesis has no tiles, so tiles must not change the result.
TEST(ThesisTile, TilesGiveThePixelsOfTheWholeImage) {
  std::mt19937 random(2);
  for (const PixelLayout layout : {PixelLayout::kMosaic, PixelLayout::kRgb})
    for (const int levels : {1, 5}) {
      const CodecSettings settings{CodecProfile::kThesis, levels, 4, 300};
      ExpectTheThesis<uint8_t>(random, 1100, 39, layout, settings);
      ExpectTheThesis<uint8_t>(random, 21, 1027, layout, settings);
    }
}

// 10 12 / 14 20 has the average 14 and the details -2, -3 and 1 (Eq. 2.20, 2.21). A threshold of 2
// drops the 1 alone. The range of 17 is mapped to 18 values, which hold every coefficient: without
// the 1 the decoded pixels are 9 13 / 15 19.
TEST(ThesisTile, AThresholdDropsWhatIsBelowItAndKeepsWhatIsOnIt) {
  Image<uint8_t> image(2, 2);
  image.at(0, 0) = 10, image.at(1, 0) = 12, image.at(0, 1) = 14, image.at(1, 1) = 20;
  DecodedPart part;
  const CodecSettings settings{CodecProfile::kThesis, 1, 2, 18};
  ASSERT_TRUE(DecodeImage(EncodeImage(image, PixelLayout::kGrey, settings), &part));
  const auto& decoded = std::get<Image<uint8_t>>(part.pixels);
  EXPECT_EQ(decoded.at(0, 0), 9);
  EXPECT_EQ(decoded.at(1, 0), 13);
  EXPECT_EQ(decoded.at(0, 1), 15);
  EXPECT_EQ(decoded.at(1, 1), 19);
}

}  // namespace
}  // namespace lf
