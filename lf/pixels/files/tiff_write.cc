// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "lf/core/check.h"
#include "lf/pixels/files/libtiff_handle.h"
#include "lf/pixels/files/picture_encoder.h"

namespace lf {
namespace {

size_t BytesOf(PixelType type) {
  LF_CHECK(type != PixelType::kHalf);
  if (type == PixelType::kUint8) return 1;
  return type == PixelType::kUint16 ? 2 : 4;
}

// Sets the tags of the picture. Returns false if libtiff refuses one.
bool SetTags(const PictureRows& picture, TIFF* tiff) {
  const bool is_float = picture.type == PixelType::kFloat;
  const bool has_colours = picture.channels >= 3;
  bool done = true;
  const auto set = [&](uint32_t tag, auto... value) {
    done = TIFFSetField(tiff, tag, value...) == 1 && done;
  };
  set(TIFFTAG_IMAGEWIDTH, static_cast<uint32_t>(picture.width));
  set(TIFFTAG_IMAGELENGTH, static_cast<uint32_t>(picture.height));
  set(TIFFTAG_SAMPLESPERPIXEL, picture.channels);
  set(TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * BytesOf(picture.type)));
  set(TIFFTAG_SAMPLEFORMAT, is_float ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
  set(TIFFTAG_PHOTOMETRIC, has_colours ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  set(TIFFTAG_ROWSPERSTRIP, static_cast<uint32_t>(kBlockRows));
  set(TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  set(TIFFTAG_PREDICTOR, is_float ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
  if (picture.channels > 3) {
    const std::vector<uint16_t> extras(static_cast<size_t>(picture.channels - 3),
                                       EXTRASAMPLE_UNSPECIFIED);
    set(TIFFTAG_EXTRASAMPLES, picture.channels - 3, extras.data());
  }
  const std::string description = LinesOf(picture.metadata);
  if (!description.empty()) set(TIFFTAG_IMAGEDESCRIPTION, description.c_str());
  return done;
}

Result<void> WriteStrips(const PictureRows& picture, const LibtiffHandle& handle) {
  const size_t row_bytes = static_cast<size_t>(picture.width) *
                           static_cast<size_t>(picture.channels) * BytesOf(picture.type);
  std::vector<std::byte> rows(row_bytes *
                              static_cast<size_t>(std::min(kBlockRows, picture.height)));
  for (int begin = 0; begin < picture.height; begin += kBlockRows) {
    if (picture.is_interrupted && picture.is_interrupted())
      return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", picture.name)};
    const int end = std::min(picture.height, begin + kBlockRows);
    for (int y = begin; y < end; ++y)
      picture.pack_row(y, rows.data() + row_bytes * static_cast<size_t>(y - begin));
    const auto size = static_cast<tmsize_t>(row_bytes * static_cast<size_t>(end - begin));
    const auto strip = static_cast<uint32_t>(begin / kBlockRows);
    LF_RETURN_IF_ERROR(
        handle.Check(TIFFWriteEncodedStrip(handle.tiff(), strip, rows.data(), size) == size));
  }
  return {};
}

}  // namespace

Result<std::string> EncodeTiff(const PictureRows& picture, double largest_classic_bytes) {
  LF_CHECK(picture.width > 0 && picture.height > 0 && picture.channels > 0);
  // The uncompressed size decides, because the compressed size is not known yet.
  const double bytes_of_pixels = static_cast<double>(picture.width) * picture.height *
                                 picture.channels * static_cast<double>(BytesOf(picture.type));
  std::string bytes;
  LF_ASSIGN_OR_RETURN(
      const std::unique_ptr<LibtiffHandle> handle,
      LibtiffHandle::OpenToWrite(picture.name, bytes_of_pixels > largest_classic_bytes, &bytes));
  LF_RETURN_IF_ERROR(handle->Check(SetTags(picture, handle->tiff())));
  LF_RETURN_IF_ERROR(WriteStrips(picture, *handle));
  LF_RETURN_IF_ERROR(handle->Check(TIFFWriteDirectory(handle->tiff()) == 1));
  handle->Close();
  LF_RETURN_IF_ERROR(handle->Check(true));
  return bytes;
}

}  // namespace lf
