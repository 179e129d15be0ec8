#include "lf/pixels/files/write_jpeg.h"

// jpeglib.h uses FILE and size_t without including them.
#include <cstdio>
#include <cstdlib>
//
#include <jpeglib.h>

#include <csetjmp>

#include "lf/core/check.h"

namespace lf {
namespace {

struct Errors {
  jpeg_error_mgr manager;
  jmp_buf jump;
  char message[JMSG_LENGTH_MAX] = {};
};

// Owns libjpeg's resources. No object with a destructor is created between setjmp and the calls.
struct Encoder {
  Encoder() {
    compress.err = jpeg_std_error(&errors.manager);
    compress.client_data = &errors;
    errors.manager.error_exit = [](j_common_ptr common) {
      auto* of_call = static_cast<Errors*>(common->client_data);
      common->err->format_message(common, of_call->message);
      longjmp(of_call->jump, 1);
    };
  }
  ~Encoder() {
    jpeg_destroy_compress(&compress);
    std::free(bytes);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  bool Run(const ImageView<const uint8_t>& pixels, int quality) {
    if (setjmp(errors.jump) != 0) return false;
    jpeg_create_compress(&compress);
    jpeg_mem_dest(&compress, &bytes, &size);
    compress.image_width = static_cast<JDIMENSION>(pixels.width);
    compress.image_height = static_cast<JDIMENSION>(pixels.height);
    compress.input_components = 3;
    compress.in_color_space = JCS_RGB;
    jpeg_set_defaults(&compress);
    jpeg_set_quality(&compress, quality, TRUE);
    jpeg_start_compress(&compress, TRUE);
    while (compress.next_scanline < compress.image_height) {
      auto* row = const_cast<JSAMPLE*>(pixels.row(static_cast<int>(compress.next_scanline)));
      jpeg_write_scanlines(&compress, &row, 1);
    }
    jpeg_finish_compress(&compress);
    return true;
  }

  Errors errors{};
  jpeg_compress_struct compress{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT: libjpeg's type
};

}  // namespace

Result<std::string> EncodeJpeg(ImageView<const uint8_t> pixels, int quality) {
  LF_CHECK(!pixels.empty() && pixels.channels == 3 && quality >= 1 && quality <= 100);
  Encoder encoder;
  if (!encoder.Run(pixels, quality))
    return OutputError(std::string("a JPEG cannot be encoded: ") + encoder.errors.message);
  return std::string(reinterpret_cast<const char*>(encoder.bytes), encoder.size);
}

}  // namespace lf
