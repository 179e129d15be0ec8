// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/picture_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lf/film/develop/colour_space.h"
#include "lf/film/develop/display.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_header.h"

namespace lf {
namespace {

// Returns the index of each of R, G and B, and of alpha (-1: none), among the channels of a file.
Result<std::array<int, 4>> ColoursOf(const std::filesystem::path& path, const ImageFileInfo& info) {
  if (info.raw && !info.raw->is_monochrome)
    return InputError(
        fmt::format("{}: is a mosaic of a camera raw file, expected a picture with R, G and B: "
                    "develop it first",
                    path.string()));
  const auto index_of = [&](const std::string& name) {
    const auto found = std::find(info.channel_names.begin(), info.channel_names.end(), name);
    return found == info.channel_names.end() ? -1
                                             : static_cast<int>(found - info.channel_names.begin());
  };
  if (info.channels == 1) return std::array{0, 0, 0, -1};
  const std::array named = {index_of("R"), index_of("G"), index_of("B"), index_of("A")};
  if (named[0] >= 0 && named[1] >= 0 && named[2] >= 0) return named;
  if (info.channels == 2 && (named[3] == 1 || !info.is_float)) return std::array{0, 0, 0, 1};
  if (!info.is_float && info.channels >= 3) return std::array{0, 1, 2, info.channels > 3 ? 3 : -1};
  return InputError(fmt::format("{}: has the channels {}, expected R, G and B, or a single one",
                                path.string(), fmt::join(info.channel_names, ", ")));
}

// Returns the linear light of each value that an integer may have.
template <class T>
std::vector<float> LightOfValues() {
  constexpr int kMost = std::numeric_limits<T>::max();
  std::vector<float> light(kMost + 1);
  for (int i = 0; i <= kMost; ++i)
    light[i] = static_cast<float>(LinearFromDisplay(static_cast<double>(i) / kMost));
  return light;
}

Image<float> RgbOf(const Image<float>& stored, const std::array<int, 4>& channels) {
  Image<float> rgb(stored.width(), stored.height(), 3);
  for (int y = 0; y < rgb.height(); ++y)
    for (int x = 0; x < rgb.width(); ++x)
      for (int c = 0; c < 3; ++c) rgb.at(x, y, c) = stored.at(x, y, channels[c]);
  return rgb;
}

template <class T>
Image<float> RgbOf(const Image<T>& stored, const std::array<int, 4>& channels) {
  const std::vector<float> light = LightOfValues<T>();
  Image<float> rgb(stored.width(), stored.height(), 3);
  for (int y = 0; y < rgb.height(); ++y)
    for (int x = 0; x < rgb.width(); ++x) {
      const float alpha = channels[3] < 0 ? 1
                                          : static_cast<float>(stored.at(x, y, channels[3])) /
                                                std::numeric_limits<T>::max();
      for (int c = 0; c < 3; ++c) rgb.at(x, y, c) = light[stored.at(x, y, channels[c])] * alpha;
    }
  return rgb;
}

Primaries PrimariesOf(const std::array<float, 8>& xy) {
  const auto point = [&](int i) { return Vec2(xy[2 * i], xy[2 * i + 1]); };
  return {point(0), point(1), point(2), point(3)};
}

// Returns true if a file states the primaries of sRGB, as files do, in single precision. A matrix
// between the two would change the last bits of the light.
bool AreOfSrgb(const std::array<float, 8>& xy) {
  const Primaries srgb = PrimariesOf(ColourSpace::kRec709);
  const std::array points = {srgb.red, srgb.green, srgb.blue, srgb.white};
  for (size_t i = 0; i < points.size(); ++i)
    if (xy[2 * i] != static_cast<float>(points[i].x()) ||
        xy[2 * i + 1] != static_cast<float>(points[i].y()))
      return false;
  return true;
}

}  // namespace

Result<PictureLight> ReadPictureLight(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(const PictureHeader header, ReadPictureHeader(path));
  LF_ASSIGN_OR_RETURN(const ImageWithInfo file, ReadImageWithInfo(path));
  LF_ASSIGN_OR_RETURN(const auto channels, ColoursOf(path, file.info));
  PictureLight picture;
  picture.rgb = std::visit([&](const auto& stored) { return RgbOf(stored, channels); }, file.image);
  const auto* const floats = std::get_if<Image<float>>(&file.image);
  if (floats == nullptr) return picture;
  if (header.colours.chromaticities && !AreOfSrgb(*header.colours.chromaticities))
    Multiply(LinearFromLinear(PrimariesOf(ColourSpace::kRec709),
                              PrimariesOf(*header.colours.chromaticities)),
             &picture.rgb);
  const auto& names = file.info.channel_names;
  if (const auto found = std::find(names.begin(), names.end(), "coverage"); found != names.end()) {
    const int channel = static_cast<int>(found - names.begin());
    picture.coverage.emplace(floats->width(), floats->height());
    for (int y = 0; y < floats->height(); ++y)
      for (int x = 0; x < floats->width(); ++x)
        picture.coverage->at(x, y) = floats->at(x, y, channel);
  }
  return picture;
}

Result<PictureLight> PictureLightOf(const StoredImage& image) {
  constexpr std::array<std::array<int, 4>, 4> kChannels = {
      {{0, 0, 0, -1}, {0, 0, 0, 1}, {0, 1, 2, -1}, {0, 1, 2, 3}}};
  const int count = std::visit([](const auto& stored) { return stored.channels(); }, image);
  if (count > 4) return InputError(fmt::format("has {} channels, expected 1 to 4", count));
  PictureLight picture;
  picture.rgb =
      std::visit([&](const auto& stored) { return RgbOf(stored, kChannels[count - 1]); }, image);
  return picture;
}

}  // namespace lf
