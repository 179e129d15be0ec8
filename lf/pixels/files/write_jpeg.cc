// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/write_jpeg.h"

#include <fmt/format.h>

// jpeglib.h uses FILE and size_t without including them.
#include <cstdio>
#include <cstdlib>
//
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <string_view>

#include "lf/core/check.h"
#include "lf/pixels/files/picture_encoder.h"
#include "lf/pixels/files/row_blocks.h"

namespace lf {
namespace {

struct Errors {
  jpeg_error_mgr manager;
  jmp_buf jump;
  char message[JMSG_LENGTH_MAX] = {};
};

struct JpegKind {
  int width = 0;
  int height = 0;
  int channels = 3;  // 3: sRGB; 1: grey
  int quality = 95;
  bool full_chroma = false;  // false: chroma is halved in both directions
};

// Owns libjpeg's resources. Its functions return false if libjpeg reports an error, which
// `errors.message` then describes.
struct Encoder {
  Encoder() {
    compress.err = jpeg_std_error(&errors.manager);
    compress.client_data = &errors;
    errors.manager.error_exit = [](j_common_ptr common) {
      auto* of_call = static_cast<Errors*>(common->client_data);
      common->err->format_message(common, of_call->message);
      longjmp(of_call->jump, 1);
    };
    errors.manager.output_message = [](j_common_ptr) {};
  }
  ~Encoder() {
    jpeg_destroy_compress(&compress);
    std::free(bytes);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // Calls `calls`, which may create no object with a destructor, because longjmp() would skip it.
  template <class Calls>
  bool Run(const Calls& calls) {
    if (setjmp(errors.jump) != 0) return false;
    calls();
    return true;
  }

  bool Begin(const JpegKind& kind) {
    return Run([&] {
      jpeg_create_compress(&compress);
      jpeg_mem_dest(&compress, &bytes, &size);
      compress.image_width = static_cast<JDIMENSION>(kind.width);
      compress.image_height = static_cast<JDIMENSION>(kind.height);
      compress.input_components = kind.channels;
      compress.in_color_space = kind.channels == 3 ? JCS_RGB : JCS_GRAYSCALE;
      jpeg_set_defaults(&compress);
      jpeg_set_quality(&compress, kind.quality, TRUE);
      if (kind.full_chroma)
        compress.comp_info[0].h_samp_factor = compress.comp_info[0].v_samp_factor = 1;
      jpeg_start_compress(&compress, TRUE);
    });
  }

  // Writes `text` as a comment; must follow Begin(). A text that is longer than a segment can be
  // becomes several comments.
  bool WriteComment(std::string_view text) {
    constexpr size_t kMostBytes = 65533;
    return Run([&] {
      for (std::string_view rest = text; !rest.empty();
           rest.remove_prefix(std::min(rest.size(), kMostBytes)))
        jpeg_write_marker(&compress, JPEG_COM, reinterpret_cast<const JOCTET*>(rest.data()),
                          static_cast<unsigned>(std::min(rest.size(), kMostBytes)));
    });
  }

  // Writes `count` rows, which are row_step bytes apart.
  bool WriteRows(const uint8_t* rows, size_t row_step, int count) {
    return Run([&] {
      for (int i = 0; i < count; ++i) {
        auto* row = const_cast<JSAMPLE*>(rows + row_step * static_cast<size_t>(i));
        jpeg_write_scanlines(&compress, &row, 1);
      }
    });
  }

  bool Finish() {
    return Run([&] { jpeg_finish_compress(&compress); });
  }

  std::string Bytes() const { return {reinterpret_cast<const char*>(bytes), size}; }

  Errors errors{};
  jpeg_compress_struct compress{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT: libjpeg's type
};

}  // namespace

Result<std::string> EncodeJpeg(ImageView<const uint8_t> pixels, int quality) {
  LF_CHECK(!pixels.empty() && pixels.channels == 3 && quality >= 1 && quality <= 100);
  Encoder encoder;
  if (!encoder.Begin({pixels.width, pixels.height, pixels.channels, quality, false}) ||
      !encoder.WriteRows(pixels.data, pixels.stride, pixels.height) || !encoder.Finish())
    return OutputError(std::string("a JPEG cannot be encoded: ") + encoder.errors.message);
  return encoder.Bytes();
}

Result<std::string> EncodeJpegRows(const PictureRows& picture) {
  LF_CHECK(picture.channels == 1 || picture.channels == 3);
  LF_CHECK(picture.type == PixelType::kUint8);
  constexpr int kQuality = 95;
  Encoder encoder;
  const auto checked = [&](bool done) -> Result<void> {
    if (done) return {};
    return OutputError(
        fmt::format("{}: cannot be encoded: {}", picture.name, encoder.errors.message));
  };
  LF_RETURN_IF_ERROR(
      checked(encoder.Begin({picture.width, picture.height, picture.channels, kQuality, true})));
  LF_RETURN_IF_ERROR(checked(encoder.WriteComment(LinesOf(picture.metadata))));
  LF_RETURN_IF_ERROR(
      EncodeInBlocks(picture, [&](const std::byte* rows, size_t row_bytes, int count) {
        return checked(encoder.WriteRows(reinterpret_cast<const uint8_t*>(rows), row_bytes, count));
      }));
  LF_RETURN_IF_ERROR(checked(encoder.Finish()));
  return encoder.Bytes();
}

}  // namespace lf
