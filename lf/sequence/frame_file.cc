#include "lf/sequence/frame_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/sequence/display.h"

namespace lf {
namespace {

// The encoder for files clips and rounds what it is given in [0, 1]. None if interrupted.
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

// What a stored value looks like on an 8-bit display: integers are display values already.
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

// The first three channels.
template <class T>
Image<uint8_t> Picture(const Image<T>& image) {
  Image<uint8_t> picture(image.width(), image.height(), 3);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) picture.at(x, y, c) = DisplayStep{}(image.at(x, y, c));
  return picture;
}

Result<void> WriteExrFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                           bool as_half, const ImageMetadata& metadata,
                           const std::function<bool()>& is_interrupted) {
  std::vector<ExrChannel> channels;
  for (const auto& [name, channel] : {std::pair("R", 0), std::pair("G", 1), std::pair("B", 2)})
    channels.push_back({name, frame.rgb.view(), channel, as_half});
  for (const auto& [name, channel] :
       {std::pair("count.R", 0), std::pair("count.G", 1), std::pair("count.B", 2)})
    channels.push_back({name, frame.ray_count.view(), channel});
  channels.push_back({"coverage", frame.coverage.view(), 0, as_half});
  if (!frame.effective_count.empty())
    channels.push_back({"effective", frame.effective_count.view(), 0, as_half});
  if (!frame.interpolated.empty())
    channels.push_back({"interpolated", frame.interpolated.view(), 0, as_half});
  return WriteExr(path, channels, metadata, is_interrupted);
}

}  // namespace

std::optional<FrameFormat> ParseFrameFormat(std::string_view name) {
  if (name == "exr") return FrameFormat::kExrHalf;
  if (name == "exr-float") return FrameFormat::kExrFloat;
  if (name == "png") return FrameFormat::kPng8;
  if (name == "png16") return FrameFormat::kPng16;
  return std::nullopt;
}

const char* NameOf(FrameFormat format) {
  constexpr const char* kNames[] = {"exr", "exr-float", "png", "png16"};
  return kNames[static_cast<int>(format)];
}

std::filesystem::path FramePath(const std::filesystem::path& folder, FrameId frame,
                                FrameFormat format) {
  const bool exr = format == FrameFormat::kExrHalf || format == FrameFormat::kExrFloat;
  return folder / fmt::format("frame_{:04}.{}", frame.value, exr ? "exr" : "png");
}

Result<void> WriteFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                        FrameFormat format, const ImageMetadata& metadata,
                        const std::function<bool()>& is_interrupted) {
  switch (format) {
    case FrameFormat::kExrHalf:
      return WriteExrFrame(path, frame, true, metadata, is_interrupted);
    case FrameFormat::kExrFloat:
      return WriteExrFrame(path, frame, false, metadata, is_interrupted);
    case FrameFormat::kPng8:
    case FrameFormat::kPng16:
      break;
  }
  const std::optional<Image<float>> display = DisplayValues(frame.rgb, is_interrupted);
  if (!display)
    return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", path.string())};
  return WriteImage(path, display->view(), {"R", "G", "B"},
                    format == FrameFormat::kPng8 ? PixelType::kUint8 : PixelType::kUint16, metadata,
                    is_interrupted);
}

Image<uint8_t> DisplayImage(const DevelopedFrame& frame) { return Picture(frame.rgb); }

Result<Image<uint8_t>> ReadDisplayImage(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(const StoredImage stored, ReadImage(path));
  return std::visit(
      [&](const auto& image) -> Result<Image<uint8_t>> {
        if (image.channels() < 3)
          return InputError(fmt::format("{}: has {} channels, a frame has R, G and B",
                                        path.string(), image.channels()));
        return Picture(image);
      },
      stored);
}

}  // namespace lf
