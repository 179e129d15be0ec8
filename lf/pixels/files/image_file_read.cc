// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/files_nearby.h"
#include "lf/pixels/files/colour_profile.h"
#include "lf/pixels/files/exif_exposure.h"
#include "lf/pixels/files/exposure_facts.h"
#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/image_probe.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/pixels/files/picture_view.h"
#include "lf/pixels/files/read_jpeg.h"
#include "lf/pixels/files/read_raw.h"
#include "lf/pixels/files/reduced_jpeg.h"
#include "lf/pixels/files/rows_on_disk.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Opens a file that is neither JPEG nor raw.
Result<std::unique_ptr<PictureDecoder>> Open(const FileBytes& file, ImageFormat format) {
  switch (format) {
    case ImageFormat::kPng:
      return OpenPng(file);
    case ImageFormat::kTiff:
      return OpenTiff(file);
    case ImageFormat::kExr:
      return OpenExr(file);
    case ImageFormat::kNetpbm:
      return OpenNetpbm(file);
    case ImageFormat::kPfm:
      return OpenPfm(file);
    case ImageFormat::kBmp:
      return OpenBmp(file);
    case ImageFormat::kRadiance:
      return OpenRadiance(file);
    case ImageFormat::kWebp:
      return OpenWebp(file);
    case ImageFormat::kJpeg2000:
      return OpenJpeg2000(file);
    case ImageFormat::kJpegXl:
      return OpenJpegXl(file);
    case ImageFormat::kHeif:
      return OpenHeif(file);
    case ImageFormat::kJpeg:
    case ImageFormat::kRaw:
      break;
  }
  LF_CHECK(false);
}

// Opens a file that is neither JPEG nor raw. kInput also if it holds several pictures.
Result<std::unique_ptr<PictureDecoder>> OpenSingle(const FileBytes& file, ImageFormat format) {
  LF_ASSIGN_OR_RETURN(std::unique_ptr<PictureDecoder> picture, Open(file, format));
  if (picture->picture_count() > 1)
    return InputError(
        fmt::format("{}: holds {} pictures, such as the planes of a focus stack, and one is "
                    "expected: give a file with one picture, such as a frame of the folder that "
                    "lffocus stack writes without .exr",
                    file.name, picture->picture_count()));
  return picture;
}

Result<ImageFileInfo> InfoFrom(const FileBytes& file) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
  if (format == ImageFormat::kJpeg) {
    LF_ASSIGN_OR_RETURN(const JpegReader jpeg, JpegReader::Open(file.read, file.name));
    return jpeg.info();
  }
  if (format == ImageFormat::kRaw) {
    LF_ASSIGN_OR_RETURN(const RawReader raw,
                        RawReader::Open(file.read, file.size_bytes, file.name));
    return raw.info();
  }
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> picture, OpenSingle(file, format));
  return picture->info();
}

Result<PictureHeader> HeaderFrom(const FileBytes& file) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
  if (format == ImageFormat::kJpeg || format == ImageFormat::kRaw) {
    LF_ASSIGN_OR_RETURN(const ImageFileInfo info, InfoFrom(file));
    return PictureHeader{info, {TypeOfValues(info)}};
  }
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> picture, OpenSingle(file, format));
  return PictureHeader{picture->info(), picture->colours(), picture->projection()};
}

Result<std::string> TextFrom(const FileBytes& file, const char* key) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
  if (format == ImageFormat::kJpeg || format == ImageFormat::kRaw) return std::string();
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> picture, Open(file, format));
  return picture->Text(key);
}

Result<std::string> ProfileFrom(const FileBytes& file) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
  if (format == ImageFormat::kRaw) return std::string();
  if (format == ImageFormat::kJpeg) {
    LF_ASSIGN_OR_RETURN(JpegReader jpeg, JpegReader::Open(file.read, file.name));
    return jpeg.IccProfile();
  }
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> picture, Open(file, format));
  return picture->IccProfile();
}

Result<ExposureFacts> ExposureFrom(const FileBytes& file) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
  if (format == ImageFormat::kWebp || format == ImageFormat::kHeif) {
    LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> picture, Open(file, format));
    const std::string exif = picture->Exif();
    return ExposureOfExif(FileInMemory(exif, file.name).read, ImageFormat::kTiff);
  }
  if (format != ImageFormat::kRaw) return ExposureOfExif(file.read, format);
  LF_ASSIGN_OR_RETURN(const RawReader raw, RawReader::Open(file.read, file.size_bytes, file.name));
  return raw.exposure();
}

Result<void> PartOfJpeg(const FileBytes& file, const WantedPixels& wanted, ImagePart* part) {
  LF_ASSIGN_OR_RETURN(JpegReader jpeg, JpegReader::Open(file.read, file.name));
  part->info = jpeg.info();
  part->icc_profile = jpeg.IccProfile();
  LF_ASSIGN_OR_RETURN(const PixelRect rect, wanted(part->info));
  if (!std::holds_alternative<Image<uint8_t>>(part->image)) part->image.emplace<Image<uint8_t>>();
  LF_ASSIGN_OR_RETURN(part->rect, jpeg.Read(rect, &std::get<Image<uint8_t>>(part->image)));
  return {};
}

Result<int> ReducedFrom(const FileBytes& file, const WantedReduction& wanted, ImagePart* part) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
  if (format != ImageFormat::kJpeg) return 1;
  LF_ASSIGN_OR_RETURN(JpegReader jpeg, JpegReader::Open(file.read, file.name));
  part->info = jpeg.info();
  part->icc_profile = jpeg.IccProfile();
  LF_ASSIGN_OR_RETURN(const int reduction, wanted(part->info));
  if (reduction == 1) return 1;
  if (!std::holds_alternative<Image<uint8_t>>(part->image)) part->image.emplace<Image<uint8_t>>();
  auto& image = std::get<Image<uint8_t>>(part->image);
  LF_RETURN_IF_ERROR(jpeg.ReadReduced(reduction, &image));
  part->rect = {0, 0, image.width(), image.height()};
  return reduction;
}

Result<void> PartOfRaw(const FileBytes& file, const WantedPixels& wanted, ImagePart* part) {
  LF_ASSIGN_OR_RETURN(RawReader raw, RawReader::Open(file.read, file.size_bytes, file.name));
  if (const auto rect = wanted(raw.info()); !rect) return rect.error();
  if (!std::holds_alternative<Image<uint16_t>>(part->image)) part->image.emplace<Image<uint16_t>>();
  LF_RETURN_IF_ERROR(raw.Read(&std::get<Image<uint16_t>>(part->image)));
  part->info = raw.info();
  part->icc_profile.clear();
  part->rect = {0, 0, part->info.width, part->info.height};
  return {};
}

Result<void> PartFrom(const FileBytes& file, const WantedPixels& wanted, ImagePart* part) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
  if (format == ImageFormat::kJpeg) return PartOfJpeg(file, wanted, part);
  if (format == ImageFormat::kRaw) return PartOfRaw(file, wanted, part);
  if (format == ImageFormat::kPng) LF_RETURN_IF_ERROR(CheckPngIsComplete(file.read, file.name));
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> picture, OpenSingle(file, format));
  part->info = picture->info();
  part->icc_profile = picture->IccProfile();
  LF_ASSIGN_OR_RETURN(const PixelRect rect, wanted(part->info));
  LF_ASSIGN_OR_RETURN(part->rect, picture->ReadPart(rect, &part->image));
  return {};
}

Result<PixelRect> All(const ImageFileInfo& info) {
  return PixelRect{0, 0, info.width, info.height};
}

// Turns the exceptions of a decoder into errors, except std::bad_alloc, which callers handle
// (doc/style.md, "Errors").
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
    -> decltype(read(std::declval<const FileBytes&>())) {
  const std::string name = path.string();
  const auto failure = [&](int reason) {
    return Error{KindOfReadFailure(reason),
                 fmt::format("{}: cannot be read: {}{}", name, std::strerror(reason),
                             reason == ENOENT ? FilesNearby(path) : "")};
  };
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    return InputError(fmt::format("{}: is a folder or a device, expected an image file", name));
  DiskFile disk(path);
  if (disk.error() != 0) return failure(disk.error());
  const FileBytes file = {
      [&disk](uint64_t offset, std::span<uint8_t> to) { return disk.Read(offset, to); },
      disk.size_bytes(), name};
  auto result = WithoutThrowing(name, [&] { return read(file); });
  if (disk.error() != 0) return failure(disk.error());
  return result;
}

}  // namespace

Result<bool> HasRowsOnDisk(const fs::path& path) { return ReadRowsOnDisk(path, nullptr, nullptr); }

Result<bool> ReadRowsOnDisk(const fs::path& path, const WantedPixels& wanted, ImagePart* part) {
  return FromFile(path, [&](const FileBytes& file) -> Result<bool> {
    LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(file.read, file.name));
    if (format == ImageFormat::kJpeg || format == ImageFormat::kRaw) return false;
    LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> picture, Open(file, format));
    if (!picture->has_rows_on_disk() || part == nullptr) return picture->has_rows_on_disk();
    part->info = picture->info();
    part->icc_profile = picture->IccProfile();
    LF_ASSIGN_OR_RETURN(const PixelRect rect, wanted(part->info));
    LF_ASSIGN_OR_RETURN(part->rect, picture->ReadPart(rect, &part->image));
    return true;
  });
}

Result<ImageFileInfo> ReadImageInfo(const fs::path& path) {
  if (const std::optional<PictureView> view = PictureViewOf(path)) return ReadViewInfo(*view);
  return FromFile(path, [](const FileBytes& file) { return InfoFrom(file); });
}

Result<PictureHeader> ReadPictureHeader(const fs::path& path) {
  return FromFile(FileOfImage(path), [](const FileBytes& file) { return HeaderFrom(file); });
}

Result<PictureHeader> ReadPictureHeaderBytes(std::string_view bytes, const std::string& name) {
  return WithoutThrowing(name, [&] { return HeaderFrom(FileInMemory(bytes, name)); });
}

Result<std::string> ReadStatedText(const fs::path& path, const char* key) {
  return FromFile(FileOfImage(path), [key](const FileBytes& file) { return TextFrom(file, key); });
}

Result<std::string> ReadIccProfile(const fs::path& path) {
  if (const auto view = PictureViewOf(path); view && view->is_of_array) return std::string();
  return FromFile(FileOfImage(path), [](const FileBytes& file) { return ProfileFrom(file); });
}

Result<ExposureFacts> ReadExposureFacts(const fs::path& path) {
  if (const auto view = PictureViewOf(path); view && view->is_of_array) return ExposureFacts();
  return FromFile(FileOfImage(path), [](const FileBytes& file) { return ExposureFrom(file); });
}

Result<ExposureFacts> ReadExposureFactsBytes(std::string_view bytes, const std::string& name) {
  return WithoutThrowing(name, [&] { return ExposureFrom(FileInMemory(bytes, name)); });
}

Result<ImageFileInfo> ReadImageInfoBytes(std::string_view bytes, const std::string& name) {
  return WithoutThrowing(name, [&] { return InfoFrom(FileInMemory(bytes, name)); });
}

Result<int> ReadReducedJpeg(const fs::path& path, const WantedReduction& wanted, ImagePart* part) {
  if (PictureViewOf(path)) return 1;
  return FromFile(path, [&](const FileBytes& file) { return ReducedFrom(file, wanted, part); });
}

Result<int> ReadReducedJpegBytes(std::string_view bytes, const std::string& name,
                                 const WantedReduction& wanted, ImagePart* part) {
  return WithoutThrowing(name,
                         [&] { return ReducedFrom(FileInMemory(bytes, name), wanted, part); });
}

Result<void> ReadImagePart(const fs::path& path, const WantedPixels& wanted, ImagePart* part) {
  if (const std::optional<PictureView> view = PictureViewOf(path))
    return ReadViewPart(*view, wanted, part);
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(path));
  return ReadImagePartBytes(bytes, path.string(), wanted, part);
}

Result<void> ReadImagePartBytes(std::string_view bytes, const std::string& name,
                                const WantedPixels& wanted, ImagePart* part) {
  return WithoutThrowing(name, [&] { return PartFrom(FileInMemory(bytes, name), wanted, part); });
}

Result<ImageWithInfo> ReadImageWithInfo(const fs::path& path) {
  ImagePart part;
  LF_RETURN_IF_ERROR(ReadImagePart(path, All, &part));
  return ImageWithInfo{std::move(part.image), std::move(part.info)};
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
