// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/squeeze_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "lf/core/check.h"
#include "lf/film/develop/display.h"

namespace lf {
namespace {

// The shares of the old pixels [first, first + shares.size()) in a new pixel, in one direction.
struct PixelShares {
  int first = 0;
  std::vector<double> shares;  // their sum is 1
};

std::vector<PixelShares> SharesOf(int old_count, int new_count) {
  std::vector<PixelShares> all(static_cast<size_t>(new_count));
  const double step = static_cast<double>(old_count) / new_count;
  for (int i = 0; i < new_count; ++i) {
    PixelShares& pixel = all[static_cast<size_t>(i)];
    const double begin = i * step, end = (i + 1) * step;
    pixel.first = std::min(static_cast<int>(begin), old_count - 1);
    double sum = 0;
    for (int k = pixel.first; k < old_count && (k < end || sum == 0); ++k) {
      pixel.shares.push_back(std::max(0.0, std::min(end, k + 1.0) - std::max<double>(begin, k)));
      sum += pixel.shares.back();
    }
    for (double& share : pixel.shares) share /= sum;
  }
  return all;
}

template <class T>
bool HasOwnAlpha(const Image<T>& image) {
  return !std::is_floating_point_v<T> && (image.channels() == 2 || image.channels() == 4);
}

// Returns the light of each display value from 0 to `white`.
std::vector<double> LightOfValues(int white) {
  std::vector<double> light;
  for (int value = 0; value <= white; ++value)
    light.push_back(LinearFromDisplay(static_cast<double>(value) / white));
  return light;
}

// Returns the light of the pixels of a row, multiplied by alpha.
template <class T>
std::vector<double> LightOfRow(const Image<T>& image, int y) {
  const auto channels = static_cast<size_t>(image.channels());
  const T* const row = image.row(y);
  std::vector<double> light(row, row + channels * static_cast<size_t>(image.width()));
  if constexpr (!std::is_floating_point_v<T>) {
    constexpr double kWhite = std::numeric_limits<T>::max();
    static const std::vector<double> linear = LightOfValues(std::numeric_limits<T>::max());
    const bool has_alpha = HasOwnAlpha(image);
    for (size_t i = 0; i < light.size(); i += channels) {
      const double alpha = has_alpha ? light[i + channels - 1] / kWhite : 1;
      for (size_t c = 0; c < channels; ++c)
        light[i + c] = has_alpha && c + 1 == channels ? alpha : alpha * linear[row[i + c]];
    }
  }
  return light;
}

// Writes light, multiplied by alpha, as the pixels of a row.
template <class T>
void StoreRow(const std::vector<double>& light, int y, Image<T>* image) {
  const auto channels = static_cast<size_t>(image->channels());
  T* const row = image->row(y);
  if constexpr (std::is_floating_point_v<T>) {
    std::transform(light.begin(), light.end(), row, [](double v) { return static_cast<T>(v); });
  } else {
    constexpr double kWhite = std::numeric_limits<T>::max();
    const auto stored = [](double display) {
      return static_cast<T>(std::floor(std::clamp(display, 0.0, 1.0) * kWhite + 0.5));
    };
    const bool has_alpha = HasOwnAlpha(*image);
    for (size_t i = 0; i < light.size(); i += channels) {
      const double alpha = has_alpha ? light[i + channels - 1] : 1;
      for (size_t c = 0; c < channels; ++c)
        row[i + c] = has_alpha && c + 1 == channels
                         ? stored(alpha)
                         : stored(alpha > 0 ? DisplayFromLinear(light[i + c] / alpha) : 0);
    }
  }
}

template <class T>
Image<T> SqueezedImage(const Image<T>& view, int width, int height) {
  LF_CHECK(width <= view.width() && height <= view.height());
  const auto channels = static_cast<size_t>(view.channels());
  const std::vector<PixelShares> columns = SharesOf(view.width(), width);
  const std::vector<PixelShares> rows = SharesOf(view.height(), height);
  Image<T> squeezed(width, height, view.channels());
  // The last row that was read is kept, because two new rows may share it.
  int known = -1;
  std::vector<double> narrow;  // light of the row `known`, in the new columns
  for (int y = 0; y < height; ++y) {
    const PixelShares& part = rows[static_cast<size_t>(y)];
    std::vector<double> light(channels * static_cast<size_t>(width), 0.0);
    for (size_t k = 0; k < part.shares.size(); ++k) {
      if (const int source = part.first + static_cast<int>(k); source != known) {
        const std::vector<double> wide = LightOfRow(view, source);
        narrow.assign(light.size(), 0.0);
        for (size_t x = 0; x < columns.size(); ++x)
          for (size_t j = 0; j < columns[x].shares.size(); ++j)
            for (size_t c = 0; c < channels; ++c)
              narrow[x * channels + c] +=
                  columns[x].shares[j] *
                  wide[(static_cast<size_t>(columns[x].first) + j) * channels + c];
        known = source;
      }
      for (size_t i = 0; i < light.size(); ++i) light[i] += part.shares[k] * narrow[i];
    }
    StoreRow(light, y, &squeezed);
  }
  return squeezed;
}

}  // namespace

StoredImage Squeezed(const StoredImage& view, int width, int height) {
  return std::visit(
      [&](const auto& image) { return StoredImage(SqueezedImage(image, width, height)); }, view);
}

}  // namespace lf
