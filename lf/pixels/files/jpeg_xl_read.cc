// SPDX-License-Identifier: Apache-2.0
// Reads JPEG XL files by libjxl, which is loaded when the first such file is read.
#include <fmt/format.h>

#include "lf/pixels/files/picture_decoder.h"

#ifdef LF_JXL_LIBRARY_NAME
#include <jxl/decode.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/loaded_library.h"

namespace lf {
namespace {

struct JxlCalls {
  LoadedLibrary library{LF_JXL_LIBRARY_NAME};
  LF_LOADED(JxlDecoderCreate);
  LF_LOADED(JxlDecoderDestroy);
  LF_LOADED(JxlDecoderSubscribeEvents);
  LF_LOADED(JxlDecoderSetKeepOrientation);
  LF_LOADED(JxlDecoderSetInput);
  LF_LOADED(JxlDecoderCloseInput);
  LF_LOADED(JxlDecoderProcessInput);
  LF_LOADED(JxlDecoderGetBasicInfo);
  LF_LOADED(JxlDecoderGetExtraChannelInfo);
  LF_LOADED(JxlDecoderGetColorAsEncodedProfile);
  LF_LOADED(JxlDecoderSetPreferredColorProfile);
  LF_LOADED(JxlDecoderGetICCProfileSize);
  LF_LOADED(JxlDecoderGetColorAsICCProfile);
  LF_LOADED(JxlDecoderSetImageOutBuffer);
};

const JxlCalls& Jxl() {
  static const JxlCalls calls;
  return calls;
}

struct DestroyJxl {
  void operator()(JxlDecoder* decoder) const { Jxl().JxlDecoderDestroy(decoder); }
};
using JxlDecoderOwner = std::unique_ptr<JxlDecoder, DestroyJxl>;

class JpegXlDecoder : public PictureDecoder {
 public:
  explicit JpegXlDecoder(const FileBytes& file) : file_(file) {}

  const ImageFileInfo& info() const override { return info_; }
  std::string IccProfile() const override { return icc_; }

  Result<void> Open() {
    constexpr size_t kHeadBytes = 65536;
    const std::string start = StartOf(file_, kHeadBytes);
    LF_ASSIGN_OR_RETURN(bool has_head, ReadHead(start, start.size() == file_.size_bytes));
    if (has_head) return {};
    std::string storage;
    LF_ASSIGN_OR_RETURN(has_head, ReadHead(ContentOf(file_, &storage), true));
    LF_CHECK(has_head);
    return {};
  }

  Result<void> Read(StoredImage* image) override {
    std::string storage;
    const std::string_view bytes = ContentOf(file_, &storage);
    const JxlDecoderOwner decoder =
        NewDecoder(bytes, true, JXL_DEC_COLOR_ENCODING | JXL_DEC_FULL_IMAGE);
    bool is_whole = false;
    while (true) {
      switch (Jxl().JxlDecoderProcessInput(decoder.get())) {
        case JXL_DEC_COLOR_ENCODING:
          PreferSrgb(decoder.get());
          break;
        case JXL_DEC_NEED_IMAGE_OUT_BUFFER:
          LF_RETURN_IF_ERROR(SetOutput(decoder.get(), image));
          break;
        case JXL_DEC_FULL_IMAGE:
          is_whole = true;
          break;
        case JXL_DEC_SUCCESS:
          if (is_whole) return {};
          return Damaged();
        default:
          return Damaged();
      }
    }
  }

 private:
  Error Damaged() const {
    return InputError(fmt::format("{}: truncated or damaged JPEG XL file", file_.name));
  }

  static JxlDecoderOwner NewDecoder(std::string_view bytes, bool is_all, int events) {
    const JxlCalls& jxl = Jxl();
    JxlDecoderOwner decoder(jxl.JxlDecoderCreate(nullptr));
    if (!decoder) throw std::bad_alloc();
    LF_CHECK(jxl.JxlDecoderSubscribeEvents(decoder.get(), events) == JXL_DEC_SUCCESS);
    LF_CHECK(jxl.JxlDecoderSetKeepOrientation(decoder.get(), JXL_TRUE) == JXL_DEC_SUCCESS);
    LF_CHECK(jxl.JxlDecoderSetInput(decoder.get(), reinterpret_cast<const uint8_t*>(bytes.data()),
                                    bytes.size()) == JXL_DEC_SUCCESS);
    if (is_all) jxl.JxlDecoderCloseInput(decoder.get());
    return decoder;
  }

  // Reads size and profile from the first bytes of the file. Returns false if they do not suffice.
  //   is_all  `bytes` are the whole file
  Result<bool> ReadHead(std::string_view bytes, bool is_all) {
    const JxlDecoderOwner decoder =
        NewDecoder(bytes, is_all, JXL_DEC_BASIC_INFO | JXL_DEC_COLOR_ENCODING);
    while (true) {
      const JxlDecoderStatus status = Jxl().JxlDecoderProcessInput(decoder.get());
      if (status == JXL_DEC_NEED_MORE_INPUT && !is_all) return false;
      if (status == JXL_DEC_BASIC_INFO) {
        LF_RETURN_IF_ERROR(ReadInfo(decoder.get()));
      } else if (status == JXL_DEC_COLOR_ENCODING) {
        PreferSrgb(decoder.get());
        ReadProfile(decoder.get());
        return true;
      } else {
        return Damaged();
      }
    }
  }

  Result<void> ReadInfo(JxlDecoder* decoder) {
    JxlBasicInfo basic;
    if (Jxl().JxlDecoderGetBasicInfo(decoder, &basic) != JXL_DEC_SUCCESS) return Damaged();
    if (basic.have_animation == JXL_TRUE)
      return InputError(fmt::format(
          "{}: is an animated JPEG XL file: expected a single picture; extract one", file_.name));
    const bool has_alpha = basic.alpha_bits > 0;
    info_.is_float = basic.exponent_bits_per_sample > 0;
    if (!info_.is_float && basic.bits_per_sample > 16)
      return InputError(fmt::format(
          "{}: is a JPEG XL file of {} bits: expected integers of up to 16 bits, or floats",
          file_.name, basic.bits_per_sample));
    for (uint32_t i = 0; i < basic.num_extra_channels; ++i) {
      JxlExtraChannelInfo extra;
      if (Jxl().JxlDecoderGetExtraChannelInfo(decoder, i, &extra) != JXL_DEC_SUCCESS)
        return Damaged();
      if (extra.type == JXL_CHANNEL_BLACK)
        return InputError(fmt::format(
            "{}: is a JPEG XL file of CMYK colours, which is not read: convert it to RGB",
            file_.name));
    }
    const int64_t channels = int64_t{basic.num_color_channels} + (has_alpha ? 1 : 0);
    LF_RETURN_IF_ERROR(CheckPictureSize(basic.xsize, basic.ysize, channels, file_.name));
    info_.width = static_cast<int>(basic.xsize);
    info_.height = static_cast<int>(basic.ysize);
    info_.channels = static_cast<int>(channels);
    info_.bits = info_.is_float ? 32 : basic.bits_per_sample <= 8 ? 8 : 16;
    info_.orientation = static_cast<int>(basic.orientation);
    info_.channel_names = basic.num_color_channels == 1 ? std::vector<std::string>{"Y"}
                                                        : std::vector<std::string>{"R", "G", "B"};
    if (has_alpha) info_.channel_names.emplace_back("A");
    is_encoded_in_profile_ = basic.uses_original_profile == JXL_TRUE;
    return {};
  }

  // Makes libjxl return sRGB values of a lossy picture whose profile is not one of those that it
  // can convert to. It would return linear values, which are too coarse at 8 bits.
  void PreferSrgb(JxlDecoder* decoder) const {
    JxlColorEncoding encoding = {};
    if (is_encoded_in_profile_ || info_.is_float ||
        Jxl().JxlDecoderGetColorAsEncodedProfile(
            decoder, nullptr, JXL_COLOR_PROFILE_TARGET_ORIGINAL, &encoding) == JXL_DEC_SUCCESS)
      return;
    encoding.color_space = info_.channels < 3 ? JXL_COLOR_SPACE_GRAY : JXL_COLOR_SPACE_RGB;
    encoding.white_point = JXL_WHITE_POINT_D65;
    encoding.primaries = JXL_PRIMARIES_SRGB;
    encoding.transfer_function = JXL_TRANSFER_FUNCTION_SRGB;
    encoding.rendering_intent = JXL_RENDERING_INTENT_RELATIVE;
    Jxl().JxlDecoderSetPreferredColorProfile(decoder, &encoding);
  }

  void ReadProfile(JxlDecoder* decoder) {
    size_t size = 0;
    if (Jxl().JxlDecoderGetICCProfileSize(decoder, nullptr, JXL_COLOR_PROFILE_TARGET_DATA, &size) !=
        JXL_DEC_SUCCESS)
      return;
    icc_.resize(size);
    if (Jxl().JxlDecoderGetColorAsICCProfile(decoder, nullptr, JXL_COLOR_PROFILE_TARGET_DATA,
                                             reinterpret_cast<uint8_t*>(icc_.data()),
                                             size) != JXL_DEC_SUCCESS)
      icc_.clear();
  }

  template <class T>
  Result<void> SetBuffer(JxlDecoder* decoder, JxlDataType type, StoredImage* image) const {
    Image<T>& pixels = Resized<T>(info_.width, info_.height, info_.channels, image);
    const JxlPixelFormat format = {static_cast<uint32_t>(info_.channels), type, JXL_NATIVE_ENDIAN,
                                   0};
    if (Jxl().JxlDecoderSetImageOutBuffer(decoder, &format, pixels.row(0), pixels.size_bytes()) !=
        JXL_DEC_SUCCESS)
      return Damaged();
    return {};
  }

  Result<void> SetOutput(JxlDecoder* decoder, StoredImage* image) const {
    if (info_.is_float) return SetBuffer<float>(decoder, JXL_TYPE_FLOAT, image);
    if (info_.bits == 16) return SetBuffer<uint16_t>(decoder, JXL_TYPE_UINT16, image);
    return SetBuffer<uint8_t>(decoder, JXL_TYPE_UINT8, image);
  }

  const FileBytes& file_;
  ImageFileInfo info_;
  bool is_encoded_in_profile_ = true;  // false: lossy, in the colour space of JPEG XL
  std::string icc_;
};

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenJpegXl(const FileBytes& file) {
  if (!Jxl().library.has_all())
    return MissingAtRunTime(file.name, "JPEG XL", LF_JXL_LIBRARY_NAME, "libjxl0.7");
  return Opened<JpegXlDecoder>(file);
}

}  // namespace lf

#else

namespace lf {
Result<std::unique_ptr<PictureDecoder>> OpenJpegXl(const FileBytes& file) {
  return MissingLibrary(file.name, "JPEG XL", "libjxl");
}
}  // namespace lf

#endif
