// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/frame_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

#include "lf/core/value_named.h"
#include "lf/film/develop/display.h"
#include "lf/film/develop/display_picture.h"
#include "lf/film/develop/display_view.h"

namespace lf {
namespace {

// Returns the sRGB display values of linear light, which the encoder of the file clips to [0, 1]
// and rounds; nullopt if interrupted.
std::optional<Image<float>> DisplayValues(const Image<float>& linear,
                                          const std::function<bool()>& is_interrupted) {
  Image<float> display(linear.width(), linear.height(), linear.channels());
  const size_t row_values = static_cast<size_t>(linear.width()) * linear.channels();
  for (int y = 0; y < linear.height(); ++y) {
    if (is_interrupted && is_interrupted()) return std::nullopt;
    std::transform(linear.row(y), linear.row(y) + row_values, display.row(y),
                   [](float value) { return static_cast<float>(DisplayFromLinear(value)); });
  }
  return display;
}

// Returns colours divided by alpha, in linear light, as PNG needs them; black if alpha is 0.
Image<float> StraightOf(const Image<float>& rgb, const Image<float>& opacity) {
  Image<float> straight = rgb;
  for (int y = 0; y < rgb.height(); ++y)
    for (int x = 0; x < rgb.width(); ++x) {
      const float a = opacity.at(x, y);
      for (int c = 0; c < 3; ++c) straight.at(x, y, c) = a > 0 ? rgb.at(x, y, c) / a : 0;
    }
  return straight;
}

Image<float> WithAlpha(const Image<float>& display, const Image<float>& opacity) {
  Image<float> rgba(display.width(), display.height(), 4);
  for (int y = 0; y < display.height(); ++y)
    for (int x = 0; x < display.width(); ++x) {
      for (int c = 0; c < 3; ++c) rgba.at(x, y, c) = display.at(x, y, c);
      rgba.at(x, y, 3) = opacity.at(x, y);
    }
  return rgba;
}

// Converts a stored value to an 8-bit display value. Integers are display values already.
struct DisplayStep {
  uint8_t operator()(uint8_t display) const { return display; }
  uint8_t operator()(uint16_t display) const {
    return static_cast<uint8_t>((display * 255u + 32767u) / 65535u);
  }
  uint8_t operator()(float linear) const {
    static const Display8 display8;
    return display8(linear);
  }
};

// Returns the 8-bit display value of a stored colour composited over black. `display` is not
// multiplied by alpha, and alpha is a share of linear light.
template <class T>
uint8_t OverBlack(T display, T alpha) {
  static const Display8 display8;
  constexpr double kMost = std::numeric_limits<T>::max();
  return display8(static_cast<float>(LinearFromDisplay(display / kMost) * (alpha / kMost)));
}

// Returns the first three channels as display values, composited over black. In files with alpha,
// floats (EXR) are multiplied by alpha already, and integers (PNG) are not.
template <class T>
Image<uint8_t> Picture(const Image<T>& image) {
  Image<uint8_t> picture(image.width(), image.height(), 3);
  const bool is_straight = std::is_integral_v<T> && image.channels() == 4;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        const T value = image.at(x, y, c);
        if constexpr (std::is_integral_v<T>)
          picture.at(x, y, c) = is_straight && image.at(x, y, 3) < std::numeric_limits<T>::max()
                                    ? OverBlack(value, image.at(x, y, 3))
                                    : DisplayStep{}(value);
        else
          picture.at(x, y, c) = DisplayStep{}(value);
      }
  return picture;
}

// Adds the channels that describe the elements, such as the numbers of rays.
void AddFacts(const DevelopedFrame& frame, bool as_half, std::vector<ExrChannel>* channels) {
  for (int c = 0; c < 3; ++c) channels->push_back({kCountChannels[c], frame.ray_count.view(), c});
  const std::pair<const char*, const Image<float>&> facts[] = {{"coverage", frame.coverage},
                                                               {"effective", frame.effective_count},
                                                               {"interpolated", frame.interpolated},
                                                               {"densified", frame.densified},
                                                               {"trust", frame.trust}};
  for (const auto& [name, values] : facts)
    if (!values.empty()) channels->push_back({name, values.view(), 0, as_half});
}

Result<void> WriteExrFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                           bool as_half, const ImageMetadata& metadata,
                           const std::function<bool()>& is_interrupted,
                           const PictureOptions& options) {
  std::vector<ExrChannel> channels;
  for (const auto& [name, channel] : {std::pair("R", 0), std::pair("G", 1), std::pair("B", 2)})
    channels.push_back({name, frame.rgb.view(), channel, as_half});
  if (!frame.opacity.empty() && options.channels != FrameChannels::kRgb)
    channels.push_back({"A", frame.opacity.view(), 0, as_half});
  if (options.channels == FrameChannels::kAll) AddFacts(frame, as_half, &channels);
  // Depths are never half, which has only 11 significant bits.
  if (!frame.focus_depth_w.empty()) channels.push_back({"Z", frame.focus_depth_w.view(), 0, false});
  return WriteExr(path, channels, metadata, is_interrupted, options.compression);
}

}  // namespace

std::optional<FrameFormat> ParseFrameFormat(std::string_view name) {
  return ValueNamed(name, {FrameFormat::kExrHalf, FrameFormat::kExrFloat, FrameFormat::kPng8,
                           FrameFormat::kPng16});
}

const char* NameOf(FrameFormat format) {
  constexpr const char* kNames[] = {"exr", "exr-float", "png", "png16"};
  return kNames[static_cast<int>(format)];
}

bool IsExr(FrameFormat format) {
  return format == FrameFormat::kExrHalf || format == FrameFormat::kExrFloat;
}

std::optional<FrameChannels> ParseFrameChannels(std::string_view name) {
  return ValueNamed(name, {FrameChannels::kAll, FrameChannels::kRgba, FrameChannels::kRgb});
}

const char* NameOf(FrameChannels channels) {
  constexpr const char* kNames[] = {"all", "rgba", "rgb"};
  return kNames[static_cast<int>(channels)];
}

std::filesystem::path FramePath(const std::filesystem::path& folder, FrameId frame,
                                FrameFormat format) {
  return folder / fmt::format("frame_{:04}.{}", frame.value, IsExr(format) ? "exr" : "png");
}

Result<void> WriteFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                        FrameFormat format, const ImageMetadata& metadata,
                        const std::function<bool()>& is_interrupted,
                        const PictureOptions& options) {
  const DisplayView* const view = options.view.get();
  switch (format) {
    case FrameFormat::kExrHalf:
      return WriteExrFrame(path, frame, true, metadata, is_interrupted, options);
    case FrameFormat::kExrFloat:
      return WriteExrFrame(path, frame, false, metadata, is_interrupted, options);
    case FrameFormat::kPng8:
    case FrameFormat::kPng16:
      break;
  }
  const bool has_alpha = !frame.opacity.empty();
  std::optional<Image<float>> display =
      has_alpha ? StraightOf(frame.rgb, frame.opacity) : frame.rgb;
  if (view != nullptr)
    view->Apply(&*display);
  else
    display = DisplayValues(*display, is_interrupted);
  if (!display)
    return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", path.string())};
  std::vector<std::string> names = {"R", "G", "B"};
  if (has_alpha) {
    names.emplace_back("A");
    display = WithAlpha(*display, frame.opacity);
  }
  return WriteImage(path, display->view(), names,
                    format == FrameFormat::kPng8 ? PixelType::kUint8 : PixelType::kUint16, metadata,
                    is_interrupted, view == nullptr || view->is_srgb());
}

Result<Image<uint8_t>> DisplayPicture(const StoredImage& stored, const std::string& name) {
  return std::visit(
      [&](const auto& image) -> Result<Image<uint8_t>> {
        if (image.channels() < 3)
          return InputError(fmt::format("{}: has {} channels, expected at least R, G and B", name,
                                        image.channels()));
        return Picture(image);
      },
      stored);
}

Result<Image<uint8_t>> ReadDisplayImage(const std::filesystem::path& path, ColourSpace colours) {
  LF_ASSIGN_OR_RETURN(StoredImage stored, ReadImage(path));
  if (auto* const light = std::get_if<Image<float>>(&stored);
      light != nullptr && light->channels() >= 3)
    ConvertToRec709(colours, light);
  return DisplayPicture(stored, path.string());
}

}  // namespace lf
