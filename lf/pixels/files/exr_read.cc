// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVersion.h>
#include <OpenEXR/openexr.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "lf/core/parse_number.h"
#include "lf/pixels/files/layers.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/stated_camera.h"

namespace lf {
namespace {

// Lets OpenEXR read the bytes of a FileBytes.
class InputStream : public Imf::IStream {
 public:
  explicit InputStream(const FileBytes& file) : IStream(file.name.c_str()), file_(file) {}

  // Reads `count` bytes, and throws if fewer are left. Returns false if the file ends behind them.
  bool read(char to[], int count) override {
    const std::span<uint8_t> bytes(reinterpret_cast<uint8_t*>(to), static_cast<size_t>(count));
    if (file_.read(offset_, bytes) != bytes.size())
      throw std::runtime_error("the file ends too early");
    offset_ += bytes.size();
    return offset_ < file_.size_bytes;
  }
  uint64_t tellg() override { return offset_; }
  void seekg(uint64_t offset) override { offset_ = offset; }

 private:
  const FileBytes& file_;
  uint64_t offset_ = 0;
};

// Checks the header by OpenEXR's C library. kInput: an attribute is damaged, or its length is not
// that of its value. The C++ library does not check this: it takes other bytes for the next
// attribute, and allocates as much memory as these claim.
Result<void> CheckHeader(const FileBytes& file) {
  struct Checked {
    const FileBytes& file;
    char fault[256] = {};
  } checked = {file};
  exr_context_initializer_t callbacks = EXR_DEFAULT_CONTEXT_INITIALIZER;
  callbacks.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
  callbacks.user_data = &checked;
  callbacks.size_fn = [](exr_const_context_t, void* of) {
    return static_cast<int64_t>(static_cast<Checked*>(of)->file.size_bytes);
  };
  callbacks.read_fn = [](exr_const_context_t, void* of, void* to, uint64_t count, uint64_t offset,
                         exr_stream_error_func_ptr_t) {
    return static_cast<int64_t>(
        static_cast<Checked*>(of)->file.read(offset, {static_cast<uint8_t*>(to), count}));
  };
  callbacks.error_handler_fn = [](exr_const_context_t context, exr_result_t, const char* message) {
    void* of = nullptr;
    if (exr_get_user_data(context, &of) == EXR_ERR_SUCCESS && of != nullptr)
      std::snprintf(static_cast<Checked*>(of)->fault, sizeof Checked::fault, "%s", message);
  };
  exr_context_t context = nullptr;
  const exr_result_t result = exr_start_read(&context, "EXR", &callbacks);
  exr_finish(&context);
  if (result == EXR_ERR_SUCCESS) return {};
  if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
  return InputError(
      fmt::format("{}: truncated or damaged: {}", file.name,
                  checked.fault[0] != 0 ? checked.fault : exr_get_default_error_message(result)));
}

// Calls `call`, and turns exceptions of OpenEXR into errors. OpenEXR reports a lack of memory in a
// text, which must not be taken for damage.
template <class Call>
Result<void> Run(const std::string& name, const Call& call) {
  try {
    call();
    return {};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    const std::string reason = error.what();
    if (reason.find(std::bad_alloc().what()) != std::string::npos) throw std::bad_alloc();
    return InputError(
        fmt::format("{}: truncated or damaged: {}", name, reason.substr(0, reason.find('\n'))));
  }
}

// Decodes the first part of a file, by OpenEXR, in the calling thread.
class ExrDecoder : public PictureDecoder {
 public:
  explicit ExrDecoder(const FileBytes& file) : name_(file.name), stream_(file) {}

  Result<void> Open(const FileBytes& file) {
    LF_RETURN_IF_ERROR(CheckHeader(file));
    constexpr int kNoThreads = 0;
    constexpr bool kReconstructs = false;  // without a table of offsets, a file is refused
    LF_RETURN_IF_ERROR(Run(name_, [&] { file_.emplace(stream_, kNoThreads, kReconstructs); }));
    const Imf::Header& header = file_->header(0);
    if (Imf::isNonImage(file_->version()) || (header.hasType() && Imf::isDeepData(header.type())))
      return InputError(fmt::format(
          "{}: holds deep data, which is not supported; convert the file to a flat picture",
          name_));
    const Imath::Box2i& window = header.dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t height = int64_t{window.max.y} - window.min.y + 1;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
      if (i.channel().xSampling != 1 || i.channel().ySampling != 1)
        return InputError(fmt::format(
            "{}: channel {} has fewer pixels than the picture, as in files of luminance "
            "and chroma, which are not supported: convert the file to RGB",
            name_, i.name()));
      names_.emplace_back(i.name());
    }
    LF_RETURN_IF_ERROR(CheckPictureSize(width, height, static_cast<int64_t>(names_.size()), name_));
    LF_ASSIGN_OR_RETURN(const std::vector<int> order, ColoursFirst(names_, name_));
    info_.width = static_cast<int>(width);
    info_.height = static_cast<int>(height);
    info_.channels = static_cast<int>(names_.size());
    info_.bits = 32;
    info_.is_float = true;
    for (const int channel : order) info_.channel_names.push_back(names_[channel]);
    return {};
  }

  const ImageFileInfo& info() const override { return info_; }

  ColourFacts colours() const override {
    const Imf::Header& header = file_->header(0);
    ColourFacts facts = {PixelType::kHalf};
    const bool has_alpha = info_.channels > 3 && info_.channel_names[3].ends_with('A');
    for (int i = 0; i < std::min(info_.channels, has_alpha ? 4 : 3); ++i)
      if (header.channels()[info_.channel_names[i].c_str()].type != Imf::HALF)
        facts.type = PixelType::kFloat;
    if (Imf::hasChromaticities(header)) {
      const Imf::Chromaticities& c = Imf::chromaticities(header);
      facts.chromaticities = {c.red.x,  c.red.y,  c.green.x, c.green.y,
                              c.blue.x, c.blue.y, c.white.x, c.white.y};
    }
    if (Imf::hasFramesPerSecond(header)) {
      const double rate = Imf::framesPerSecond(header);
      if (rate > 0 && std::isfinite(rate)) facts.frames_per_second = rate;
    }
    facts.camera = StatedCameraOf([this](const char* key) { return Text(key); });
    facts.first_frame = ParseFrameNumber(Text(kFirstFrameText));
    return facts;
  }

  std::string Text(const char* key) const override {
    const auto* const text = file_->header(0).findTypedAttribute<Imf::StringAttribute>(key);
    return text == nullptr ? std::string() : text->value();
  }

  StatedProjection projection() const override {
    const Imf::Header& header = file_->header(0);
    StatedProjection facts;
    if (Imf::hasWorldToNDC(header)) {
      const Imath::M44f& matrix = Imf::worldToNDC(header);
      facts.world_to_ndc.emplace();
      for (size_t i = 0; i < 16; ++i)
        (*facts.world_to_ndc)[i] = matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)];
    }
    if (const auto* unit = header.findTypedAttribute<Imf::DoubleAttribute>("lf:unit_m"))
      facts.unit_m = unit->value();
    // In double precision, because a damaged header may state any windows.
    const Imath::Box2i &display = header.displayWindow(), &data = header.dataWindow();
    facts.display_width = static_cast<double>(display.max.x) - display.min.x + 1;
    facts.display_height = static_cast<double>(display.max.y) - display.min.y + 1;
    facts.left = static_cast<double>(data.min.x) - display.min.x;
    facts.top = static_cast<double>(data.min.y) - display.min.y;
    return facts;
  }

  int picture_count() const override {
    int count = 0;  // parts with the channels R, G and B
    for (int part = 0; part < file_->parts(); ++part) {
      const Imf::ChannelList& channels = file_->header(part).channels();
      count += channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    }
    return count;
  }

  // OpenEXR converts halves and integers (exactly up to 2^24) to floats.
  Result<void> Read(StoredImage* image) override {
    Image<float>& floats = Resized<float>(info_.width, info_.height, info_.channels, image);
    const Imath::Box2i& window = file_->header(0).dataWindow();
    const size_t pixel_bytes = sizeof(float) * static_cast<size_t>(info_.channels);
    Imf::FrameBuffer buffer;
    for (int channel = 0; channel < info_.channels; ++channel)
      buffer.insert(info_.channel_names[channel],
                    Imf::Slice::Make(Imf::FLOAT, floats.pixels().data() + channel, window.min,
                                     info_.width, info_.height, pixel_bytes,
                                     pixel_bytes * static_cast<size_t>(info_.width)));
    return Run(name_, [&] {
      Imf::InputPart part(*file_, 0);
      part.setFrameBuffer(buffer);
      part.readPixels(window.min.y, window.max.y);
    });
  }

 private:
  const std::string name_;
  InputStream stream_;
  std::optional<Imf::MultiPartInputFile> file_;
  std::vector<std::string> names_;  // channel names, in the order of the file
  ImageFileInfo info_;
};

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenExr(const FileBytes& file) {
  auto decoder = std::make_unique<ExrDecoder>(file);
  LF_RETURN_IF_ERROR(decoder->Open(file));
  return std::unique_ptr<PictureDecoder>(std::move(decoder));
}

}  // namespace lf
