// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/transmission_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>

#include "lf/core/image.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostPixels = size_t{1} << 24;
constexpr int kMostChannels = 4;

// Returns the value as a share of the type's white, from 0 to 1.
template <class T>
double ShareOf(T value) {
  if constexpr (std::is_floating_point_v<T>)
    return std::isnan(value) ? 0 : std::clamp<double>(value, 0, 1);
  else
    return static_cast<double>(value) / std::numeric_limits<T>::max();
}

template <class T>
Image<uint8_t> SharesOf(const Image<T>& picture) {
  const bool has_alpha = picture.channels() == 2 || picture.channels() == 4;
  const int colours = picture.channels() - (has_alpha ? 1 : 0);
  Image<uint8_t> shares(picture.width(), picture.height());
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      double sum = 0;
      for (int c = 0; c < colours; ++c) sum += ShareOf(picture.at(x, y, c));
      const double alpha = has_alpha ? ShareOf(picture.at(x, y, colours)) : 1;
      shares.at(x, y) = static_cast<uint8_t>(std::lround(255 * alpha * sum / colours));
    }
  return shares;
}

}  // namespace

Result<Transmission> ReadTransmissionFile(const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const ImageFileInfo info, ReadImageInfo(file));
  if (static_cast<size_t>(info.width) * static_cast<size_t>(info.height) > kMostPixels ||
      info.channels > kMostChannels)
    return InputError(fmt::format(
        "{}: {} x {} pixels with {} channels; expected at most {} pixels, and grey or R, G, B, "
        "each with or without alpha",
        file.string(), info.width, info.height, info.channels, kMostPixels));
  LF_ASSIGN_OR_RETURN(const StoredImage stored, ReadImage(file));
  return Transmission::Of(
      std::visit([](const auto& picture) { return SharesOf(picture); }, stored));
}

ReadTransmission PicturesBeside(const fs::path& camera_path) {
  return [folder = camera_path.parent_path()](const std::string& file) {
    return ReadTransmissionFile(folder / file);
  };
}

}  // namespace lf
