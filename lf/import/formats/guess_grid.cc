// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/guess_grid.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "lf/pixels/files/image_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr int kFewestPixels = 8;  // of a view, across

// Removes the number at the end of a text; nullopt if there is none of up to three digits.
std::optional<int> TakeNumberAtEnd(std::string_view* text) {
  size_t begin = text->size();
  while (begin > 0 && std::isdigit(static_cast<unsigned char>((*text)[begin - 1]))) --begin;
  const std::string_view digits = text->substr(begin);
  if (digits.empty() || digits.size() > 3) return std::nullopt;
  int number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  text->remove_suffix(digits.size());
  return number;
}

// Returns the green channel, or the only one.
template <class T>
Image<float> PlaneOf(const Image<T>& image) {
  const int channels = image.channels(), channel = channels >= 3 ? 1 : 0;
  Image<float> plane(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      plane.at(x, y) = static_cast<float>(image.row(y)[x * channels + channel]);
  return plane;
}

Image<float> Transposed(const Image<float>& image) {
  Image<float> turned(image.height(), image.width());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) turned.at(y, x) = image.at(x, y);
  return turned;
}

// Returns the means of squares of `step` pixels.
Image<float> Reduced(const Image<float>& image, int step) {
  Image<float> small(image.width() / step, image.height() / step);
  for (int y = 0; y < small.height() * step; ++y)
    for (int x = 0; x < small.width() * step; ++x)
      small.at(x / step, y / step) += image.at(x, y) / static_cast<float>(step * step);
  return small;
}

// Returns the correlation of a picture with itself, moved to the left by `lag` pixels; 0 if one of
// the two parts has no contrast.
double Correlation(const Image<float>& image, int lag) {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0, count = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x + lag < image.width(); ++x) {
      const double left = image.at(x, y), right = image.at(x + lag, y);
      a += left;
      b += right;
      aa += left * left;
      bb += right * right;
      ab += left * right;
      ++count;
    }
  if (count == 0) return 0;
  const double spread = std::sqrt((aa - a * a / count) * (bb - b * b / count));
  return spread > 0 ? (ab - a * b / count) / spread : 0;
}

// Returns how many views lie side by side across a picture; nullopt if that is not certain.
std::optional<int> TilesAcross(const Image<float>& picture) {
  constexpr double kLeast = 0.5, kDip = 0.3;
  constexpr int kFewestReduced = 6;  // pixels of a view in the reduced picture
  // Parallax between neighbouring views must be small in the reduced picture.
  const int step = std::clamp(picture.width() / 256, 4, 16);
  const Image<float> small = Reduced(picture, step);
  std::vector<double> correlations, least = {1};  // index: lag; least: the minimum up to it
  for (int lag = 0; lag <= small.width() / 2 + 1; ++lag) {
    correlations.push_back(Correlation(small, lag));
    least.push_back(std::min(least.back(), correlations.back()));
  }
  for (int count = small.width() / kFewestReduced; count >= 2; --count) {
    if (picture.width() % count != 0) continue;
    const double lag = static_cast<double>(picture.width()) / count / step;
    const auto before = static_cast<size_t>(lag);
    if (before + 1 >= correlations.size()) continue;
    const double part = lag - std::floor(lag);
    const double similar = (1 - part) * correlations[before] + part * correlations[before + 1];
    if (similar >= kLeast && similar >= least[before] + kDip) return count;
  }
  return std::nullopt;
}

// Returns a picture of at most 512 of the rows, from which the mean of 31 pixels around each in its
// row is subtracted.
Image<float> DetailsOf(const Image<float>& picture) {
  constexpr int kMostRows = 512, kRadius = 15;
  const int stride = std::max(1, picture.height() / kMostRows);
  Image<float> details(picture.width(), (picture.height() + stride - 1) / stride);
  for (int y = 0; y < details.height(); ++y) {
    const float* const row = picture.row(y * stride);
    std::vector<double> sums = {0};
    for (int x = 0; x < picture.width(); ++x) sums.push_back(sums.back() + row[x]);
    for (int x = 0; x < picture.width(); ++x) {
      const int begin = std::max(0, x - kRadius), end = std::min(picture.width(), x + kRadius + 1);
      const double mean =
          (sums[static_cast<size_t>(end)] - sums[static_cast<size_t>(begin)]) / (end - begin);
      details.at(x, y) = static_cast<float>(row[x] - mean);
    }
  }
  return details;
}

// Returns how much the mean of the values depends on their position in the period: the variance of
// the `period` means, less the variance that they would have by chance.
double VarianceOfPeriod(std::span<const double> values, int period) {
  std::vector<double> sums(static_cast<size_t>(period)), squares = sums, counts = sums;
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t place = i % static_cast<size_t>(period);
    sums[place] += values[i];
    squares[place] += values[i] * values[i];
    ++counts[place];
  }
  double all = 0, all_squares = 0, chance = 0;
  for (size_t place = 0; place < sums.size(); ++place) {
    const double mean = sums[place] / counts[place];
    all += mean / period;
    all_squares += mean * mean / period;
    chance += (squares[place] / counts[place] - mean * mean) / counts[place] / period;
  }
  return all_squares - all * all - chance;
}

// Returns how many views lie under a lenslet across a picture; nullopt if that is not certain.
std::optional<int> ViewsUnderLenslets(const Image<float>& picture) {
  // Photographs and mosaics reach 0.005, most of them a tenth of that.
  constexpr double kCertain = 0.02, kEqual = 0.8;
  constexpr int kMostViews = 32, kMostLag = 16;
  const int width = picture.width();
  const int most = std::min(kMostViews, width / kFewestPixels);
  if (most < 2 || width <= kMostLag) return std::nullopt;
  const Image<float> details = DetailsOf(picture);
  double power = 0;
  for (const float value : details.pixels()) power += double{value} * value;
  power /= static_cast<double>(width);
  if (power <= 0) return std::nullopt;
  std::vector<double> scores(static_cast<size_t>(most) + 1);
  for (int lag = 1; lag <= kMostLag; ++lag) {
    std::vector<double> products(static_cast<size_t>(width - lag));
    for (int y = 0; y < details.height(); ++y)
      for (int x = 0; x + lag < width; ++x)
        products[static_cast<size_t>(x)] +=
            double{details.at(x, y)} * details.at(x + lag, y) / power;
    for (int count = 2; count <= most; ++count)
      if (width % count == 0)
        scores[static_cast<size_t>(count)] =
            std::max(scores[static_cast<size_t>(count)], VarianceOfPeriod(products, count));
  }
  // Each multiple of a period is also one.
  const double best = *std::max_element(scores.begin(), scores.end());
  if (best < kCertain) return std::nullopt;
  const auto first = std::find_if(scores.begin(), scores.end(),
                                  [&](double score) { return score >= kEqual * best; });
  return static_cast<int>(first - scores.begin());
}

std::optional<std::array<int, 2>> OnBothAxes(
    const Image<float>& picture, std::optional<int> (*count_across)(const Image<float>& picture)) {
  const std::optional<int> columns = count_across(picture);
  const std::optional<int> rows = columns ? count_across(Transposed(picture)) : std::nullopt;
  return rows ? std::optional(std::array{*columns, *rows}) : std::nullopt;
}

}  // namespace

std::optional<std::array<int, 2>> GridAtEndOfName(std::string_view file_name) {
  std::string_view stem = file_name.substr(0, file_name.rfind('.'));
  const std::optional<int> rows = TakeNumberAtEnd(&stem);
  if (!rows || !(stem.ends_with('x') || stem.ends_with('X'))) return std::nullopt;
  stem.remove_suffix(1);
  const std::optional<int> columns = TakeNumberAtEnd(&stem);
  if (!columns || *columns * *rows < 2) return std::nullopt;
  if (!stem.empty() && std::isalnum(static_cast<unsigned char>(stem.back()))) return std::nullopt;
  return std::array{*columns, *rows};
}

std::optional<std::array<int, 2>> FindTiles(const Image<float>& picture) {
  return OnBothAxes(picture, TilesAcross);
}

std::optional<std::array<int, 2>> FindLenslets(const Image<float>& picture) {
  return OnBothAxes(picture, ViewsUnderLenslets);
}

bool HoldsGridOfCameras(const Image<float>& picture, const std::array<int, 2>& grid) {
  constexpr double kClearly = 0.95;
  const auto [columns, rows] = grid;
  const int width = picture.width() / columns, height = picture.height() / rows;
  if (columns < 2 || rows < 2 || width < 1 || height < 1) return false;
  const auto difference = [&](std::array<int, 2> one, std::array<int, 2> other) {
    double sum = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        sum += std::abs(double{picture.at(one[0] * width + x, one[1] * height + y)} -
                        picture.at(other[0] * width + x, other[1] * height + y));
    return sum;
  };
  double below = 0, along = 0;
  for (int row = 0; row + 1 < rows; ++row) {
    below += difference({0, row}, {0, row + 1});
    // A quilt begins below: its rows continue in the row above.
    along += difference({columns - 1, row + 1}, {0, row});
  }
  return below < kClearly * along;
}

std::optional<PictureGrid> GuessPictureGrid(const fs::path& picture) {
  const Result<ImageWithInfo> read = ReadImageWithInfo(picture);
  if (!read || read->info.raw) return std::nullopt;
  const Image<float> plane =
      std::visit([]<class T>(const Image<T>& image) { return PlaneOf(image); }, read->image);
  if (const std::optional<PictureGrid> quilt = PictureGridOfName(picture.filename().string());
      quilt && quilt->layout == PictureLayout::kQuilt) {
    if (!HoldsGridOfCameras(plane, quilt->grid)) return quilt;
    return PictureGrid{.layout = PictureLayout::kMosaic, .grid = quilt->grid};
  }
  const std::optional<std::array<int, 2>> named = GridAtEndOfName(picture.filename().string());
  const bool is_named =
      named && plane.width() % (*named)[0] == 0 && plane.height() % (*named)[1] == 0 &&
      plane.width() / (*named)[0] >= kFewestPixels && plane.height() / (*named)[1] >= kFewestPixels;
  const std::optional<std::array<int, 2>> tiles = FindTiles(plane);
  const std::optional<std::array<int, 2>> lenslets = tiles ? std::nullopt : FindLenslets(plane);
  if (lenslets && (!is_named || *lenslets == *named))
    return PictureGrid{.layout = PictureLayout::kLenslets, .grid = *lenslets};
  if (is_named) return PictureGrid{.layout = PictureLayout::kMosaic, .grid = *named};
  if (!tiles) return std::nullopt;
  return PictureGrid{.layout = PictureLayout::kMosaic, .grid = *tiles};
}

}  // namespace lf
