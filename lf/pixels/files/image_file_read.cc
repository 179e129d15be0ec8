#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/files_nearby.h"
#include "lf/pixels/files/exif_exposure.h"
#include "lf/pixels/files/exposure_facts.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/image_probe.h"
#include "lf/pixels/files/layers.h"
#include "lf/pixels/files/open_image_io.h"
#include "lf/pixels/files/read_jpeg.h"
#include "lf/pixels/files/read_raw.h"
#include "lf/pixels/files/stored_value.h"

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

// A file on disk that repeats short reads. The system may return fewer bytes than the file has, or
// be interrupted, and OpenImageIO would take that for the end of the file.
class PatientFile : public OIIO::Filesystem::IOFile {
 public:
  explicit PatientFile(const std::string& name) : IOFile(name, Read) {}
  size_t pread(void* to, size_t size, int64_t offset) override {
    constexpr int kMostTries = 3;
    size_t done = 0;
    for (int tries = 0; done < size && tries < kMostTries;) {
      const size_t count = IOFile::pread(static_cast<char*>(to) + done, size - done,
                                         offset + static_cast<int64_t>(done));
      tries = count > 0 ? 0 : tries + 1;
      done += count;
    }
    return done;
  }
};

// A file on disk or in memory, with the name that messages use.
struct FileSource {
  OIIO::Filesystem::IOProxy& file;
  std::string name;
};

// A decoder that has read the header.
struct OpenImage {
  std::string name;
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  std::vector<int> channel_order;  // indices into the file's channels, in our order
};

// Returns the bits of the stored type: 8 or 16 for unsigned integers, 32 if any channel becomes
// float.
int StoredBits(const OIIO::ImageSpec& spec) {
  int bits = 8;
  for (int channel = 0; channel < spec.nchannels; ++channel) {
    const OIIO::TypeDesc type = spec.channelformat(channel);
    if (type == OIIO::TypeDesc::UINT8) continue;
    bits = std::max(bits, type == OIIO::TypeDesc::UINT16 ? 16 : 32);
  }
  return bits;
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

Result<OpenImage> OpenPicture(const FileSource& source, ImageFormat format) {
  ConfigureOpenImageIo();
  const std::string& name = source.name;
  OpenImage image{name, OIIO::ImageInput::create(PluginName(format)), {}, {}};
  if (!image.input)
    return InputError(fmt::format("{}: this OpenImageIO cannot read {} files: {}", name,
                                  PluginName(format), OIIO::geterror()));
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours are not multiplied by alpha
  image.input->set_ioproxy(&source.file);
  if (!image.input->open(name, image.spec, wishes)) {
    const std::string remarks = image.input->geterror();
    LF_RETURN_IF_ERROR(CheckRemarks(remarks, name));
    return InputError(fmt::format("{}: truncated or damaged {} file", name, PluginName(format)));
  }
  image.channel_order.resize(std::max(image.spec.nchannels, 0));
  std::iota(image.channel_order.begin(), image.channel_order.end(), 0);
  if (format == ImageFormat::kExr) {
    LF_ASSIGN_OR_RETURN(image.channel_order, ColoursFirst(image.spec.channelnames, name));
  }
  return image;
}

Result<OpenImage> Open(const FileSource& source, ImageFormat format) {
  LF_ASSIGN_OR_RETURN(OpenImage image, OpenPicture(source, format));
  LF_RETURN_IF_ERROR(CheckSize(image.spec, source.name));
  return image;
}

ImageFileInfo InfoOf(const OpenImage& image) {
  const int bits = StoredBits(image.spec);
  ImageFileInfo info{
      image.spec.width, image.spec.height, image.spec.nchannels, bits, bits == 32, {}, 1, {}};
  const int orientation = image.spec.get_int_attribute("Orientation", 1);
  if (orientation >= 1 && orientation <= 8) info.orientation = orientation;
  for (const int channel : image.channel_order)
    info.channel_names.push_back(image.spec.channel_name(channel));
  return info;
}

// Reads all pixels, packed as stored (`type` unknown) or converted to `type`.
Result<void> ReadPixels(OpenImage& image, OIIO::TypeDesc type, void* pixels) {
  const bool read = image.input->read_image(0, 0, 0, image.spec.nchannels, type, pixels);
  const std::string remarks = image.input->geterror();
  LF_RETURN_IF_ERROR(CheckRemarks(remarks, image.name));
  if (!read) return InputError(fmt::format("{}: truncated or damaged", image.name));
  return {};
}

// Makes `stored` an Image<T> of the size that `spec` states, and returns it. Reuses its memory if
// possible.
template <class T>
Image<T>& Resized(const OIIO::ImageSpec& spec, StoredImage* stored) {
  if (!std::holds_alternative<Image<T>>(*stored)) stored->emplace<Image<T>>();
  Image<T>& image = std::get<Image<T>>(*stored);
  image.Resize(spec.width, spec.height, spec.nchannels);
  return image;
}

template <class T>
Result<void> ReadSimply(OpenImage& image, StoredImage* stored) {
  return ReadPixels(image, OIIO::BaseTypeFromC<T>::value,
                    Resized<T>(image.spec, stored).pixels().data());
}

// Reads channels of any types, in any order.
Result<void> ReadMixed(OpenImage& image, StoredImage* stored) {
  const OIIO::ImageSpec& spec = image.spec;
  const size_t pixel_bytes = spec.pixel_bytes(true);
  std::vector<std::byte> packed(spec.image_pixels() * pixel_bytes);
  LF_RETURN_IF_ERROR(ReadPixels(image, OIIO::TypeUnknown, packed.data()));
  Image<float>& floats = Resized<float>(spec, stored);
  for (int y = 0; y < spec.height; ++y)
    for (size_t i = 0; i < image.channel_order.size(); ++i) {
      const int channel = image.channel_order[i];
      FloatsOf(spec.channelformat(channel),
               packed.data() + static_cast<size_t>(y) * spec.width * pixel_bytes +
                   spec.pixel_bytes(0, channel, true),
               pixel_bytes, spec.width, floats.row(y) + i, image.channel_order.size());
    }
  return {};
}

Result<void> ReadFloats(OpenImage& image, StoredImage* stored) {
  const bool simple =
      image.spec.channelformats.empty() &&
      (image.spec.format == OIIO::TypeDesc::HALF || image.spec.format == OIIO::TypeDesc::FLOAT) &&
      std::is_sorted(image.channel_order.begin(), image.channel_order.end());
  return simple ? ReadSimply<float>(image, stored) : ReadMixed(image, stored);
}

Result<void> ReadStored(OpenImage& image, StoredImage* stored) {
  switch (StoredBits(image.spec)) {
    case 8:
      return ReadSimply<uint8_t>(image, stored);
    case 16:
      return ReadSimply<uint16_t>(image, stored);
    default:
      return ReadFloats(image, stored);
  }
}

Result<ImageFileInfo> InfoFrom(const FileSource& source) {
  const ByteSource bytes = SourceOf(source.file);
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(bytes, source.name));
  if (format == ImageFormat::kJpeg) {
    LF_ASSIGN_OR_RETURN(const JpegReader jpeg, JpegReader::Open(bytes, source.name));
    return jpeg.info();
  }
  if (format == ImageFormat::kRaw) {
    LF_ASSIGN_OR_RETURN(const RawReader raw,
                        RawReader::Open(bytes, source.file.size(), source.name));
    return raw.info();
  }
  LF_ASSIGN_OR_RETURN(const OpenImage image, Open(source, format));
  return InfoOf(image);
}

Result<ExposureFacts> ExposureFrom(const FileSource& source) {
  const ByteSource bytes = SourceOf(source.file);
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(bytes, source.name));
  if (format != ImageFormat::kRaw) return ExposureOfExif(bytes, format);
  LF_ASSIGN_OR_RETURN(const RawReader raw, RawReader::Open(bytes, source.file.size(), source.name));
  return raw.exposure();
}

Result<void> PartOfJpeg(const ByteSource& bytes, const std::string& name,
                        const WantedPixels& wanted, ImagePart* part) {
  LF_ASSIGN_OR_RETURN(JpegReader jpeg, JpegReader::Open(bytes, name));
  part->info = jpeg.info();
  LF_ASSIGN_OR_RETURN(const PixelRect rect, wanted(part->info));
  if (!std::holds_alternative<Image<uint8_t>>(part->image)) part->image.emplace<Image<uint8_t>>();
  LF_ASSIGN_OR_RETURN(part->rect, jpeg.Read(rect, &std::get<Image<uint8_t>>(part->image)));
  return {};
}

Result<void> PartOfRaw(const ByteSource& bytes, const FileSource& source,
                       const WantedPixels& wanted, ImagePart* part) {
  LF_ASSIGN_OR_RETURN(RawReader raw, RawReader::Open(bytes, source.file.size(), source.name));
  if (const auto rect = wanted(raw.info()); !rect) return rect.error();
  if (!std::holds_alternative<Image<uint16_t>>(part->image)) part->image.emplace<Image<uint16_t>>();
  LF_RETURN_IF_ERROR(raw.Read(&std::get<Image<uint16_t>>(part->image)));
  part->info = raw.info();
  part->rect = {0, 0, part->info.width, part->info.height};
  return {};
}

Result<void> PartFrom(const FileSource& source, const WantedPixels& wanted, ImagePart* part) {
  const ByteSource bytes = SourceOf(source.file);
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(bytes, source.name));
  if (format == ImageFormat::kJpeg) return PartOfJpeg(bytes, source.name, wanted, part);
  if (format == ImageFormat::kRaw) return PartOfRaw(bytes, source, wanted, part);
  if (format == ImageFormat::kPng) LF_RETURN_IF_ERROR(CheckPngIsComplete(bytes, source.name));
  LF_ASSIGN_OR_RETURN(OpenImage image, Open(source, format));
  part->info = InfoOf(image);
  if (const auto rect = wanted(part->info); !rect) return rect.error();
  part->rect = {0, 0, part->info.width, part->info.height};
  return ReadStored(image, &part->image);
}

Result<PixelRect> All(const ImageFileInfo& info) {
  return PixelRect{0, 0, info.width, info.height};
}

// Turns the exceptions of a decoder into errors, except std::bad_alloc, which main() handles.
template <class Read>
auto WithoutThrowing(const std::string& name, const Read& read) -> decltype(read()) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    if (KindOfReadFailure(error) == ErrorKind::kOutput)
      return OutputError(fmt::format("{}: cannot be read: {}", name, error.what()));
    return InputError(fmt::format("{}: truncated or damaged: {}", name, error.what()));
  }
}

// Calls `read` with the file on disk. Only the bytes that `read` requests are read.
template <class Read>
auto FromFile(const fs::path& path, const Read& read)
    -> decltype(read(std::declval<const FileSource&>())) {
  const std::string name = path.string();
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    return InputError(fmt::format("{}: is not a file", name));
  PatientFile file(name);
  if (!file.opened()) {
    const int reason = errno;
    return Error{KindOfReadFailure(reason),
                 fmt::format("{}: cannot be read: {}{}", name, std::strerror(reason),
                             reason == ENOENT ? FilesNearby(path) : "")};
  }
  return WithoutThrowing(name, [&] { return read({file, name}); });
}

}  // namespace

Result<ImageFileInfo> ReadImageInfo(const fs::path& path) {
  return FromFile(path, [](const FileSource& file) { return InfoFrom(file); });
}

Result<ExposureFacts> ReadExposureFacts(const fs::path& path) {
  return FromFile(path, [](const FileSource& file) { return ExposureFrom(file); });
}

Result<ExposureFacts> ReadExposureFactsBytes(std::string_view bytes, const std::string& name) {
  OIIO::Filesystem::IOMemReader file(const_cast<char*>(bytes.data()), bytes.size());
  return WithoutThrowing(name, [&] { return ExposureFrom({file, name}); });
}

Result<ImageFileInfo> ReadImageInfoBytes(std::string_view bytes, const std::string& name) {
  OIIO::Filesystem::IOMemReader file(const_cast<char*>(bytes.data()), bytes.size());
  return WithoutThrowing(name, [&] { return InfoFrom({file, name}); });
}

Result<void> ReadImagePart(const fs::path& path, const WantedPixels& wanted, ImagePart* part) {
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(path));
  return ReadImagePartBytes(bytes, path.string(), wanted, part);
}

Result<void> ReadImagePartBytes(std::string_view bytes, const std::string& name,
                                const WantedPixels& wanted, ImagePart* part) {
  OIIO::Filesystem::IOMemReader file(const_cast<char*>(bytes.data()), bytes.size());
  return WithoutThrowing(name, [&] { return PartFrom({file, name}, wanted, part); });
}

Result<ImageWithInfo> ReadImageWithInfo(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(path));
  return ReadImageWithInfoBytes(bytes, path.string());
}

Result<ImageWithInfo> ReadImageWithInfoBytes(std::string_view bytes, const std::string& name) {
  ImagePart part;
  LF_RETURN_IF_ERROR(ReadImagePartBytes(bytes, name, All, &part));
  return ImageWithInfo{std::move(part.image), std::move(part.info)};
}

Result<StoredImage> ReadImage(const fs::path& path) {
  ImagePart part;
  LF_RETURN_IF_ERROR(ReadImagePart(path, All, &part));
  return std::move(part.image);
}

Result<StoredImage> ReadImageBytes(std::string_view bytes, const std::string& name) {
  ImagePart part;
  LF_RETURN_IF_ERROR(ReadImagePartBytes(bytes, name, All, &part));
  return std::move(part.image);
}

}  // namespace lf
