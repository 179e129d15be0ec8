// SPDX-License-Identifier: Apache-2.0
// Reads JPEG 2000 files (JP2 and bare codestreams) by OpenJPEG, which is loaded when the first such
// file is read.
#include <fmt/format.h>

#include "lf/pixels/files/picture_decoder.h"

#ifdef LF_OPENJPEG_LIBRARY_NAME
#include <openjpeg.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "lf/core/loaded_library.h"

namespace lf {
namespace {

struct OpenJpegCalls {
  LoadedLibrary library{LF_OPENJPEG_LIBRARY_NAME};
  LF_LOADED(opj_create_decompress);
  LF_LOADED(opj_decode);
  LF_LOADED(opj_destroy_codec);
  LF_LOADED(opj_end_decompress);
  LF_LOADED(opj_image_destroy);
  LF_LOADED(opj_read_header);
  LF_LOADED(opj_set_default_decoder_parameters);
  LF_LOADED(opj_set_error_handler);
  LF_LOADED(opj_set_info_handler);
  LF_LOADED(opj_set_warning_handler);
  LF_LOADED(opj_setup_decoder);
  LF_LOADED(opj_stream_default_create);
  LF_LOADED(opj_stream_destroy);
  LF_LOADED(opj_stream_set_read_function);
  LF_LOADED(opj_stream_set_seek_function);
  LF_LOADED(opj_stream_set_skip_function);
  LF_LOADED(opj_stream_set_user_data);
  LF_LOADED(opj_stream_set_user_data_length);
};

const OpenJpegCalls& OpenJpeg() {
  static const OpenJpegCalls calls;
  return calls;
}

struct DestroyCodec {
  void operator()(opj_codec_t* codec) const { OpenJpeg().opj_destroy_codec(codec); }
};
struct DestroyStream {
  void operator()(opj_stream_t* stream) const { OpenJpeg().opj_stream_destroy(stream); }
};
struct DestroyImage {
  void operator()(opj_image_t* image) const { OpenJpeg().opj_image_destroy(image); }
};

class Jpeg2000Decoder : public PictureDecoder {
 public:
  explicit Jpeg2000Decoder(const FileBytes& file) : file_(file) {}

  const ImageFileInfo& info() const override { return info_; }
  std::string IccProfile() const override {
    if (image_->icc_profile_buf == nullptr) return "";
    return {reinterpret_cast<const char*>(image_->icc_profile_buf), image_->icc_profile_len};
  }

  Result<void> Open() {
    const std::string start = StartOf(file_, 4);
    const bool is_bare = start.starts_with("\xff\x4f");
    codec_.reset(OpenJpeg().opj_create_decompress(is_bare ? OPJ_CODEC_J2K : OPJ_CODEC_JP2));
    stream_.reset(OpenJpeg().opj_stream_default_create(OPJ_TRUE));
    if (!codec_ || !stream_) throw std::bad_alloc();
    OpenJpeg().opj_set_error_handler(codec_.get(), KeepMessage, this);
    OpenJpeg().opj_set_warning_handler(codec_.get(), IgnoreMessage, nullptr);
    OpenJpeg().opj_set_info_handler(codec_.get(), IgnoreMessage, nullptr);
    OpenJpeg().opj_stream_set_read_function(stream_.get(), ReadBytes);
    OpenJpeg().opj_stream_set_skip_function(stream_.get(), SkipBytes);
    OpenJpeg().opj_stream_set_seek_function(stream_.get(), Seek);
    OpenJpeg().opj_stream_set_user_data(stream_.get(), this, nullptr);
    OpenJpeg().opj_stream_set_user_data_length(stream_.get(), file_.size_bytes);
    opj_dparameters_t parameters;
    OpenJpeg().opj_set_default_decoder_parameters(&parameters);
    if (OpenJpeg().opj_setup_decoder(codec_.get(), &parameters) == OPJ_FALSE) return Damaged();
    opj_image_t* image = nullptr;
    const bool has_head =
        OpenJpeg().opj_read_header(stream_.get(), codec_.get(), &image) == OPJ_TRUE;
    image_.reset(image);
    if (!has_head) return Damaged();
    return ReadHeader();
  }

  Result<void> Read(StoredImage* image) override {
    if (OpenJpeg().opj_decode(codec_.get(), stream_.get(), image_.get()) == OPJ_FALSE ||
        OpenJpeg().opj_end_decompress(codec_.get(), stream_.get()) == OPJ_FALSE)
      return Damaged();
    if (image_->numcomps != static_cast<OPJ_UINT32>(info_.channels))
      return InputError(fmt::format(
          "{}: is a JPEG 2000 file with a palette, which is not read: convert it to PNG",
          file_.name));
    for (int c = 0; c < info_.channels; ++c) {
      const opj_image_comp_t& component = image_->comps[c];
      if (component.data == nullptr || component.w != static_cast<OPJ_UINT32>(info_.width) ||
          component.h != static_cast<OPJ_UINT32>(info_.height))
        return Damaged();
    }
    if (info_.bits == 8)
      CopyValues(&Resized<uint8_t>(info_.width, info_.height, info_.channels, image));
    else
      CopyValues(&Resized<uint16_t>(info_.width, info_.height, info_.channels, image));
    return {};
  }

 private:
  static void KeepMessage(const char* message, void* self) {
    auto& kept = static_cast<Jpeg2000Decoder*>(self)->message_;
    if (kept[0] == '\0') std::snprintf(kept, sizeof kept, "%s", message);
  }
  static void IgnoreMessage(const char*, void*) {}
  static OPJ_SIZE_T ReadBytes(void* to, OPJ_SIZE_T count, void* self) {
    auto& decoder = *static_cast<Jpeg2000Decoder*>(self);
    const size_t done = decoder.file_.read(decoder.offset_, {static_cast<uint8_t*>(to), count});
    decoder.offset_ += done;
    return done == 0 ? static_cast<OPJ_SIZE_T>(-1) : done;
  }
  static OPJ_OFF_T SkipBytes(OPJ_OFF_T count, void* self) {
    auto& decoder = *static_cast<Jpeg2000Decoder*>(self);
    if (count < 0 || static_cast<uint64_t>(count) > decoder.file_.size_bytes - decoder.offset_)
      return -1;
    decoder.offset_ += static_cast<uint64_t>(count);
    return count;
  }
  static OPJ_BOOL Seek(OPJ_OFF_T offset, void* self) {
    auto& decoder = *static_cast<Jpeg2000Decoder*>(self);
    if (offset < 0 || static_cast<uint64_t>(offset) > decoder.file_.size_bytes) return OPJ_FALSE;
    decoder.offset_ = static_cast<uint64_t>(offset);
    return OPJ_TRUE;
  }

  Error Damaged() const {
    std::string reason = message_[0] == '\0' ? "wrong bits" : message_;
    while (!reason.empty() && static_cast<unsigned char>(reason.back()) <= ' ') reason.pop_back();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    return InputError(
        fmt::format("{}: truncated or damaged JPEG 2000 file: {}", file_.name, reason));
  }

  Error NotRead(const std::string& what) const {
    return InputError(
        fmt::format("{}: is a JPEG 2000 file {}, which is not read: convert it to PNG or TIFF",
                    file_.name, what));
  }

  Result<void> ReadHeader() {
    const opj_image_t& image = *image_;
    const OPJ_UINT32 count = image.numcomps;
    if (count < 1 || count > 4) return NotRead(fmt::format("of {} channels", count));
    if (image.color_space == OPJ_CLRSPC_SYCC || image.color_space == OPJ_CLRSPC_EYCC)
      return NotRead("of YCC colours");
    if (image.color_space == OPJ_CLRSPC_CMYK) return NotRead("of CMYK colours");
    OPJ_UINT32 bits = 0;
    for (OPJ_UINT32 c = 0; c < count; ++c) {
      const opj_image_comp_t& component = image.comps[c];
      if (component.dx != 1 || component.dy != 1) return NotRead("of subsampled colours");
      if (component.sgnd != 0) return NotRead("of signed values");
      if (component.prec < 1 || component.prec > 16)
        return NotRead(fmt::format("of {} bits", component.prec));
      bits = std::max(bits, component.prec);
    }
    if (image.x1 <= image.x0 || image.y1 <= image.y0) return Damaged();
    const auto width = int64_t{image.x1} - image.x0, height = int64_t{image.y1} - image.y0;
    LF_RETURN_IF_ERROR(CheckPictureSize(width, height, count, file_.name));
    info_.width = static_cast<int>(width);
    info_.height = static_cast<int>(height);
    info_.channels = static_cast<int>(count);
    info_.bits = bits <= 8 ? 8 : 16;
    info_.channel_names = count < 3 ? std::vector<std::string>{"Y", "A"}
                                    : std::vector<std::string>{"R", "G", "B", "A"};
    info_.channel_names.resize(count);
    return {};
  }

  // Copies the values, scaled from the bits of each channel to the full range, rounded.
  template <class T>
  void CopyValues(Image<T>* pixels) const {
    for (int c = 0; c < info_.channels; ++c) {
      const opj_image_comp_t& component = image_->comps[c];
      const int64_t highest = (int64_t{1} << component.prec) - 1;
      constexpr int64_t kFull = std::numeric_limits<T>::max();
      const OPJ_INT32* value = component.data;
      for (int y = 0; y < info_.height; ++y)
        for (int x = 0; x < info_.width; ++x) {
          const int64_t inside = std::clamp<int64_t>(*value++, 0, highest);
          pixels->at(x, y, c) = static_cast<T>((inside * kFull + highest / 2) / highest);
        }
    }
  }

  const FileBytes& file_;
  uint64_t offset_ = 0;  // position of the next byte that OpenJPEG reads
  char message_[256] = {};
  std::unique_ptr<opj_codec_t, DestroyCodec> codec_;
  std::unique_ptr<opj_stream_t, DestroyStream> stream_;
  std::unique_ptr<opj_image_t, DestroyImage> image_;
  ImageFileInfo info_;
};

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenJpeg2000(const FileBytes& file) {
  if (!OpenJpeg().library.has_all())
    return MissingAtRunTime(file.name, "JPEG 2000", LF_OPENJPEG_LIBRARY_NAME, "libopenjp2-7");
  return Opened<Jpeg2000Decoder>(file);
}

}  // namespace lf

#else

namespace lf {
Result<std::unique_ptr<PictureDecoder>> OpenJpeg2000(const FileBytes& file) {
  return MissingLibrary(file.name, "JPEG 2000", "OpenJPEG (libopenjp2)");
}
}  // namespace lf

#endif
