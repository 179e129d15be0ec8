// SPDX-License-Identifier: Apache-2.0
// The readers of all image files but JPEG and camera raw files. Internal to this folder.
//
// Each uses the library of its format, such as libpng, or none if the pixels lie in the file as
// they are. A library for all formats, such as OpenImageIO, would load some 250 further libraries
// into every program. The libraries of formats that few people use, which load many others
// themselves, are loaded when the first such file is read (core/loaded_library.h).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "lf/core/result.h"
#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_header.h"

namespace lf {

// Returns the type of the values of a StoredImage that is not EXR.
inline PixelType TypeOfValues(const ImageFileInfo& info) {
  if (info.is_float || info.bits == 32) return PixelType::kFloat;
  return info.bits == 16 ? PixelType::kUint16 : PixelType::kUint8;
}

// A file whose header has been read. Its pixels can be decoded once. One thread at a time may use
// it.
class PictureDecoder {
 public:
  virtual ~PictureDecoder() = default;
  virtual const ImageFileInfo& info() const = 0;
  virtual ColourFacts colours() const { return {TypeOfValues(info())}; }
  virtual StatedProjection projection() const { return {}; }
  // Returns the colour profile (ICC) that the header states; "" if there is none.
  virtual std::string IccProfile() const { return ""; }
  // Returns the Exif data of a file whose format keeps them in a part of their own, from their TIFF
  // header on; "" if there are none.
  virtual std::string Exif() const { return ""; }
  // Number of parts that hold colours. Only the first part is decoded.
  virtual int picture_count() const { return 1; }
  // Returns the text that the header states under this key; "" if there is none.
  virtual std::string Text(const char* /*key*/) const { return ""; }
  // Decodes all pixels. `image` becomes an Image of the type that info() states, in the same memory
  // if possible. kInput: the file is truncated or damaged anywhere, even if the library could guess
  // what is missing.
  virtual Result<void> Read(StoredImage* image) = 0;
  // Returns true if ReadPart() reads only the rows of the part.
  virtual bool has_rows_on_disk() const { return false; }
  // Decodes at least the pixels `wanted`, which must contain a pixel of the picture, as Read()
  // does. Returns the rectangle that it decoded: the whole picture, unless the format allows less
  // work.
  virtual Result<PixelRect> ReadPart(const PixelRect& /*wanted*/, StoredImage* image) {
    LF_RETURN_IF_ERROR(Read(image));
    return PixelRect{0, 0, info().width, info().height};
  }
};

// Returns a decoder whose Open() has read the header.
template <class Decoder>
Result<std::unique_ptr<PictureDecoder>> Opened(const FileBytes& file) {
  auto decoder = std::make_unique<Decoder>(file);
  LF_RETURN_IF_ERROR(decoder->Open());
  return std::unique_ptr<PictureDecoder>(std::move(decoder));
}

// These functions read the header. `file` must outlive the decoder, and must have passed
// ProbeImage(). kInput: the file is truncated or damaged, is larger than ReadImage() allows, or is
// of a kind that is not read; the message says which.
Result<std::unique_ptr<PictureDecoder>> OpenPng(const FileBytes& file);
Result<std::unique_ptr<PictureDecoder>> OpenTiff(const FileBytes& file);
Result<std::unique_ptr<PictureDecoder>> OpenExr(const FileBytes& file);
Result<std::unique_ptr<PictureDecoder>> OpenNetpbm(const FileBytes& file);  // PPM, PGM, PBM, PAM
Result<std::unique_ptr<PictureDecoder>> OpenPfm(const FileBytes& file);     // grey or colour
Result<std::unique_ptr<PictureDecoder>> OpenBmp(const FileBytes& file);
Result<std::unique_ptr<PictureDecoder>> OpenRadiance(const FileBytes& file);  // .hdr

// These functions also return kInput if the program was built without the library of the format, or
// if the library is not installed where the program runs. The message names it.
Result<std::unique_ptr<PictureDecoder>> OpenWebp(const FileBytes& file);
Result<std::unique_ptr<PictureDecoder>> OpenJpeg2000(const FileBytes& file);
Result<std::unique_ptr<PictureDecoder>> OpenJpegXl(const FileBytes& file);
Result<std::unique_ptr<PictureDecoder>> OpenHeif(const FileBytes& file);  // HEIC, AVIF

// Returns the error of a format whose library is missing.
//   format   as NameOf() names it
//   library  such as "libwebp"
Error MissingLibrary(const std::string& name, const char* format, const char* library);
// Returns the error of a format whose library is not installed where the program runs.
//   library  its file, such as "libheif.so.1"
//   package  the package of Debian that it is in
Error MissingAtRunTime(const std::string& name, const char* format, const char* library,
                       const char* package);

// kInput if a picture has no pixel, or more pixels or values than ReadImage() allows.
Result<void> CheckPictureSize(int64_t width, int64_t height, int64_t channels,
                              const std::string& name);

// Makes `stored` an Image<T> of this size, and returns it. Reuses its memory if possible.
template <class T>
Image<T>& Resized(int width, int height, int channels, StoredImage* stored) {
  if (!std::holds_alternative<Image<T>>(*stored)) stored->emplace<Image<T>>();
  Image<T>& image = std::get<Image<T>>(*stored);
  image.Resize(width, height, channels);
  return image;
}

}  // namespace lf
