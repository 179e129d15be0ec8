// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfFramesPerSecond.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <vector>

#include "lf/core/check.h"
#include "lf/pixels/files/picture_encoder.h"

namespace lf {
namespace {

// Moderate compression: a stronger one would make files at most a twentieth smaller, but would take
// most of a frame's encoding time.
constexpr int kZipLevel = 2;

// Receives the bytes that OpenEXR writes.
class OutputStream : public Imf::OStream {
 public:
  OutputStream(const std::string& name, std::string* bytes)
      : OStream(name.c_str()), bytes_(*bytes) {}

  void write(const char from[], int count) override {
    const auto size = static_cast<size_t>(count);
    bytes_.resize(std::max(bytes_.size(), offset_ + size));
    std::copy_n(from, size, bytes_.data() + offset_);
    offset_ += size;
  }
  uint64_t tellp() override { return offset_; }
  void seekp(uint64_t offset) override { offset_ = offset; }

 private:
  std::string& bytes_;
  uint64_t offset_ = 0;
};

Imf::PixelType TypeOf(const ExrChannel& channel) {
  if (std::holds_alternative<ImageView<const uint32_t>>(channel.pixels)) return Imf::UINT;
  return channel.as_half ? Imf::HALF : Imf::FLOAT;
}

// Inserts an entry of the metadata into a header, with the type that the entry has in EXR files.
struct AttributeStep {
  Imf::Header& header;
  const std::string& key;

  void operator()(const std::string& text) const { Insert(Imf::StringAttribute(text)); }
  void operator()(double number) const { Insert(Imf::DoubleAttribute(number)); }
  void operator()(int number) const { Insert(Imf::IntAttribute(number)); }
  void operator()(float number) const { Insert(Imf::FloatAttribute(number)); }
  void operator()(const FrameRate& rate) const {
    Insert(Imf::RationalAttribute(Imf::guessExactFps(rate.per_second)));
  }
  void operator()(const std::array<float, 2>& v) const { Insert(Imf::V2fAttribute({v[0], v[1]})); }
  void operator()(const std::array<float, 8>& xy) const {
    Insert(Imf::ChromaticitiesAttribute(
        {{xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}}));
  }
  void operator()(const std::array<float, 16>& rows) const {
    Imath::M44f matrix;
    std::copy(rows.begin(), rows.end(), matrix.getValue());
    Insert(Imf::M44fAttribute(matrix));
  }

 private:
  void Insert(const Imf::Attribute& attribute) const { header.insert(key, attribute); }
};

Imf::Header HeaderOf(int width, int height, std::span<const ExrChannel> channels,
                     const ImageMetadata& metadata, ExrCompression compression) {
  Imf::Header header(width, height);
  header.compression() =
      compression == ExrCompression::kZips ? Imf::ZIPS_COMPRESSION : Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  for (const ExrChannel& channel : channels)
    header.channels().insert(channel.name, Imf::Channel(TypeOf(channel)));
  for (const auto& [key, value] : metadata) std::visit(AttributeStep{header, key}, value);
  return header;
}

// Gives OpenEXR the rows [begin, end) of all channels: values that are stored as half are converted
// into buffers, all others are read where they are.
class RowsOfChannels {
 public:
  explicit RowsOfChannels(std::span<const ExrChannel> channels)
      : channels_(channels), halves_(channels.size()) {}

  Imf::FrameBuffer Block(int begin, int end) {
    Imf::FrameBuffer buffer;
    for (size_t i = 0; i < channels_.size(); ++i)
      std::visit(
          [&](const auto& view) { buffer.insert(channels_[i].name, SliceOf(i, view, begin, end)); },
          channels_[i].pixels);
    return buffer;
  }

 private:
  template <class T>
  Imf::Slice SliceOf(size_t i, const ImageView<const T>& view, int begin, int end) {
    const Imf::PixelType type = TypeOf(channels_[i]);
    if (type == Imf::HALF) return HalvesOf(view, channels_[i].channel, begin, end, &halves_[i]);
    return Imf::Slice::Make(type, &view.at(0, begin, channels_[i].channel), {0, begin}, view.width,
                            end - begin, sizeof(T) * static_cast<size_t>(view.channels),
                            sizeof(T) * view.stride);
  }
  template <class T>
  static Imf::Slice HalvesOf(const ImageView<const T>& view, int channel, int begin, int end,
                             std::vector<Imath::half>* halves) {
    halves->resize(static_cast<size_t>(view.width) * (end - begin));
    auto to = halves->begin();
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < view.width; ++x)
        *to++ = Imath::half(static_cast<float>(view.at(x, y, channel)));
    return Imf::Slice::Make(Imf::HALF, halves->data(), {0, begin}, view.width, end - begin,
                            sizeof(Imath::half),
                            sizeof(Imath::half) * static_cast<size_t>(view.width));
  }

  std::span<const ExrChannel> channels_;
  std::vector<std::vector<Imath::half>> halves_;
};

}  // namespace

Result<std::string> EncodeExr(const std::string& name, std::span<const ExrChannel> channels,
                              const ImageMetadata& metadata, ExrCompression compression,
                              const std::function<bool()>& is_interrupted) {
  LF_CHECK(!channels.empty());
  const auto [width, height] = std::visit(
      [](const auto& view) { return std::pair(view.width, view.height); }, channels[0].pixels);
  std::string bytes;
  try {
    constexpr int kNoThreads = 0;
    OutputStream stream(name, &bytes);
    Imf::OutputFile file(stream, HeaderOf(width, height, channels, metadata, compression),
                         kNoThreads);
    RowsOfChannels rows(channels);
    for (int begin = 0; begin < height; begin += kBlockRows) {
      if (is_interrupted && is_interrupted())
        return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", name)};
      const int end = std::min(height, begin + kBlockRows);
      file.setFrameBuffer(rows.Block(begin, end));
      file.writePixels(end - begin);
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return OutputError(fmt::format("{}: cannot be encoded: {}", name, error.what()));
  }
  return bytes;
}

}  // namespace lf
