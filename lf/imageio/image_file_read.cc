#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>

#include "lf/core/file.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/image_probe.h"
#include "lf/imageio/open_image_io.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kMaxValues = uint64_t{1} << 32;

ByteSource SourceOf(OIIO::Filesystem::IOProxy& file) {
  return [&file](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (to.empty() || offset >= file.size()) return 0;
    return file.pread(to.data(), std::min<uint64_t>(to.size(), file.size() - offset),
                      static_cast<int64_t>(offset));
  };
}

// libjpeg fills what it cannot decode with grey and only warns, libtiff goes on with the next row:
// whatever a decoder remarks means pixels that were not recorded. Stuffing between the segments of
// a JPEG alone is harmless, and some cameras write it.
Result<void> CheckRemarks(const std::string& remarks, const std::string& name) {
  for (size_t begin = 0; begin < remarks.size();) {
    const size_t end = std::min(remarks.find('\n', begin), remarks.size());
    const std::string line = remarks.substr(begin, end - begin);
    if (!line.empty() && line.find("extraneous bytes before marker") == std::string::npos)
      return InputError(fmt::format("{}: truncated or damaged: {}", name, line));
    begin = end + 1;
  }
  return {};
}

// A decoder at the start of its pixels.
struct OpenImage {
  std::string name;
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  std::vector<int> channel_order;  // as we give them: indices into the file's order
};

// The stored type of every channel: 8 and 16 for unsigned integers, 32 for what becomes float.
int StoredBits(const OIIO::ImageSpec& spec) {
  int bits = 8;
  for (int channel = 0; channel < spec.nchannels; ++channel) {
    const OIIO::TypeDesc type = spec.channelformat(channel);
    if (type == OIIO::TypeDesc::UINT8) continue;
    bits = std::max(bits, type == OIIO::TypeDesc::UINT16 ? 16 : 32);
  }
  return bits;
}

std::vector<int> ColoursFirst(const std::vector<std::string>& names, size_t channel_count) {
  std::vector<int> order(channel_count);
  std::iota(order.begin(), order.end(), 0);
  const auto rank = [&](int channel) -> size_t {
    if (static_cast<size_t>(channel) >= names.size() || names[channel].size() != 1) return 4;
    return std::min<size_t>(std::string_view("RGBA").find(names[channel]), 4);
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  return order;
}

Result<void> CheckSize(const OIIO::ImageSpec& spec, const std::string& name) {
  if (spec.deep || spec.depth > 1)
    return InputError(fmt::format("{}: holds deep or volume data, not a picture", name));
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
    return InputError(fmt::format("{}: claims {} x {} pixels of {} channels", name, spec.width,
                                  spec.height, spec.nchannels));
  LF_RETURN_IF_ERROR(CheckPixelCount(spec.width, spec.height, name));
  if (spec.image_pixels() * spec.nchannels > kMaxValues)
    return InputError(
        fmt::format("{}: claims {} x {} pixels of {} channels, more than the {} "
                    "values that are read",
                    name, spec.width, spec.height, spec.nchannels, kMaxValues));
  return {};
}

Result<OpenImage> Open(OIIO::Filesystem::IOProxy& file, ImageFormat format,
                       const std::string& name) {
  ConfigureOpenImageIo();
  OpenImage image{name, OIIO::ImageInput::create(PluginName(format)), {}, {}};
  if (!image.input)
    return InputError(fmt::format("{}: this OpenImageIO cannot read {} files: {}", name,
                                  PluginName(format), OIIO::geterror()));
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // alpha stays beside the colours
  image.input->set_ioproxy(&file);
  if (!image.input->open(name, image.spec, wishes)) {
    const std::string remarks = image.input->geterror();
    LF_RETURN_IF_ERROR(CheckRemarks(remarks, name));
    return InputError(fmt::format("{}: truncated or damaged {} file", name, PluginName(format)));
  }
  LF_RETURN_IF_ERROR(CheckSize(image.spec, name));
  image.channel_order = ColoursFirst(
      format == ImageFormat::kExr ? image.spec.channelnames : std::vector<std::string>{},
      image.spec.nchannels);
  return image;
}

ImageFileInfo InfoOf(const OpenImage& image) {
  const int bits = StoredBits(image.spec);
  ImageFileInfo info{
      image.spec.width, image.spec.height, image.spec.nchannels, bits, bits == 32, {}};
  for (const int channel : image.channel_order)
    info.channel_names.push_back(image.spec.channel_name(channel));
  return info;
}

// Reads all pixels, packed as stored (`type` unknown) or converted to `type`.
Result<void> ReadPixels(OpenImage& image, OIIO::TypeDesc type, void* pixels) {
  const bool read = image.input->read_image(0, 0, 0, image.spec.nchannels, type, pixels);
  LF_RETURN_IF_ERROR(CheckRemarks(image.input->geterror(), image.name));
  if (!read) return InputError(fmt::format("{}: truncated or damaged", image.name));
  return {};
}

template <class T>
Result<StoredImage> ReadIntegers(OpenImage& image) {
  Image<T> pixels(image.spec.width, image.spec.height, image.spec.nchannels);
  LF_RETURN_IF_ERROR(ReadPixels(image, OIIO::BaseTypeFromC<T>::value, pixels.pixels().data()));
  return StoredImage(std::move(pixels));
}

template <class T>
float ValueAt(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<float>(value);
}

// The value itself: OpenImageIO would scale integers to [0, 1].
float FloatOf(OIIO::TypeDesc type, const std::byte* bytes) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return ValueAt<uint8_t>(bytes);
    case OIIO::TypeDesc::INT8:
      return ValueAt<int8_t>(bytes);
    case OIIO::TypeDesc::UINT16:
      return ValueAt<uint16_t>(bytes);
    case OIIO::TypeDesc::INT16:
      return ValueAt<int16_t>(bytes);
    case OIIO::TypeDesc::UINT32:
      return ValueAt<uint32_t>(bytes);
    case OIIO::TypeDesc::INT32:
      return ValueAt<int32_t>(bytes);
    case OIIO::TypeDesc::UINT64:
      return ValueAt<uint64_t>(bytes);
    case OIIO::TypeDesc::INT64:
      return ValueAt<int64_t>(bytes);
    default:
      break;
  }
  float value = 0;
  OIIO::convert_pixel_values(type, bytes, OIIO::TypeDesc::FLOAT, &value, 1);
  return value;
}

// Channels of any types, in any order.
Result<StoredImage> ReadMixed(OpenImage& image) {
  const OIIO::ImageSpec& spec = image.spec;
  const size_t pixel_bytes = spec.pixel_bytes(true);
  std::vector<std::byte> stored(spec.image_pixels() * pixel_bytes);
  LF_RETURN_IF_ERROR(ReadPixels(image, OIIO::TypeUnknown, stored.data()));
  Image<float> pixels(spec.width, spec.height, spec.nchannels);
  float* value = pixels.pixels().data();
  std::vector<size_t> offsets;
  for (const int channel : image.channel_order)
    offsets.push_back(spec.pixel_bytes(0, channel, true));
  for (const std::byte* pixel = stored.data(); pixel != stored.data() + stored.size();
       pixel += pixel_bytes)
    for (size_t i = 0; i < offsets.size(); ++i)
      *value++ = FloatOf(spec.channelformat(image.channel_order[i]), pixel + offsets[i]);
  return StoredImage(std::move(pixels));
}

Result<StoredImage> ReadFloats(OpenImage& image) {
  const bool simple =
      image.spec.channelformats.empty() &&
      (image.spec.format == OIIO::TypeDesc::HALF || image.spec.format == OIIO::TypeDesc::FLOAT) &&
      std::is_sorted(image.channel_order.begin(), image.channel_order.end());
  if (!simple) return ReadMixed(image);
  Image<float> pixels(image.spec.width, image.spec.height, image.spec.nchannels);
  LF_RETURN_IF_ERROR(ReadPixels(image, OIIO::TypeDesc::FLOAT, pixels.pixels().data()));
  return StoredImage(std::move(pixels));
}

Result<ImageFileInfo> InfoFrom(OIIO::Filesystem::IOProxy& file, const std::string& name) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(SourceOf(file), name));
  LF_ASSIGN_OR_RETURN(const OpenImage image, Open(file, format, name));
  return InfoOf(image);
}

Result<StoredImage> PixelsFrom(OIIO::Filesystem::IOProxy& file, const std::string& name) {
  const ByteSource source = SourceOf(file);
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(source, name));
  if (format == ImageFormat::kPng) LF_RETURN_IF_ERROR(CheckPngIsComplete(source, name));
  LF_ASSIGN_OR_RETURN(OpenImage image, Open(file, format, name));
  switch (StoredBits(image.spec)) {
    case 8:
      return ReadIntegers<uint8_t>(image);
    case 16:
      return ReadIntegers<uint16_t>(image);
    default:
      return ReadFloats(image);
  }
}

// What a decoder throws becomes an error; out of memory is main's business.
template <class Read>
auto WithoutThrowing(const std::string& name, const Read& read) -> decltype(read()) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return InputError(fmt::format("{}: truncated or damaged: {}", name, error.what()));
  }
}

}  // namespace

Result<ImageFileInfo> ReadImageInfo(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    return InputError(fmt::format("{}: is not a file", name));
  OIIO::Filesystem::IOFile file(name, OIIO::Filesystem::IOProxy::Read);
  if (!file.opened())
    return InputError(fmt::format("{}: cannot be read: {}", name, std::strerror(errno)));
  return WithoutThrowing(name, [&] { return InfoFrom(file, name); });
}

Result<ImageFileInfo> ReadImageInfoBytes(std::string_view bytes, const std::string& name) {
  OIIO::Filesystem::IOMemReader file(const_cast<char*>(bytes.data()), bytes.size());
  return WithoutThrowing(name, [&] { return InfoFrom(file, name); });
}

Result<StoredImage> ReadImage(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(path));
  return ReadImageBytes(bytes, path.string());
}

Result<StoredImage> ReadImageBytes(std::string_view bytes, const std::string& name) {
  OIIO::Filesystem::IOMemReader file(const_cast<char*>(bytes.data()), bytes.size());
  return WithoutThrowing(name, [&] { return PixelsFrom(file, name); });
}

}  // namespace lf
