// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/read_raw.h"

#include <fmt/format.h>
#include <libraw/libraw.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include "lf/pixels/files/raw_facts.h"
#include "lf/pixels/files/raw_stream.h"

namespace lf {
namespace {

constexpr const char* kAdvice =
    "convert it to DNG (with the mosaic as the sensor recorded it), or to 16-bit TIFF or PNG "
    "without demosaicking";

// LibRaw without threads of its own and without messages.
class QuietLibRaw final : public LibRaw {
 public:
  QuietLibRaw() {
    set_memerror_handler(nullptr, nullptr);
    set_dataerror_handler(nullptr, nullptr);  // LibRaw still counts errors
    imgdata.params.use_camera_wb = 1;         // makes LibRaw use the file's colour matrices
    imgdata.params.use_rawspeed = 0;
    imgdata.params.raw_processing_options |= LIBRAW_PROCESSING_DNG_PREFER_LARGEST_IMAGE;
    set_exifparser_handler(NoteTag, this);
  }

  bool is_staggered() const { return is_staggered_; }
  bool has_other_colours() const { return has_other_colours_; }
  const libraw_internal_data_t& internals() const { return libraw_internal_data; }
  bool IsDecodedBy(const char* name) {
    const char* decoder = unpack_function_name();
    return decoder && std::strcmp(decoder, name) == 0;
  }

  // Returns the rectangle of the sensor's pixels that are the image. LibRaw rounds margins to even
  // numbers, so the active area of a DNG is taken from the file.
  PixelRect VisibleArea() const {
    const libraw_image_sizes_t& sizes = imgdata.sizes;
    const tiff_ifd_t* ifd = imgdata.idata.dng_version != 0 ? IfdOfPixels() : nullptr;
    if (ifd && ifd->t_vwidth > 0 && ifd->t_vheight > 0)
      return {ifd->t_lm, ifd->t_tm, ifd->t_lm + ifd->t_vwidth, ifd->t_tm + ifd->t_vheight};
    return {sizes.left_margin, sizes.top_margin, sizes.left_margin + sizes.width,
            sizes.top_margin + sizes.height};
  }

  // Returns true if the rows of an uncompressed DNG are contiguous in the file, as LibRaw expects.
  bool LiesInOnePiece() const {
    const auto& unpacker = libraw_internal_data.unpacker_data;
    if (unpacker.tile_width < imgdata.sizes.raw_width ||
        unpacker.tile_length < imgdata.sizes.raw_height)
      return false;
    const tiff_ifd_t* ifd = IfdOfPixels();
    if (!ifd || !ifd->strip_offsets || !ifd->strip_byte_counts) return true;
    const int strips = std::min(ifd->strip_offsets_count, ifd->strip_byte_counts_count);
    for (int strip = 1; strip < strips; ++strip)
      if (int64_t{ifd->strip_offsets[strip]} !=
          int64_t{ifd->strip_offsets[strip - 1]} + ifd->strip_byte_counts[strip - 1])
        return false;
    return true;
  }

 protected:
  void fuji_decode_loop(const fuji_compressed_params* common, int count, INT64* offsets,
                        unsigned* sizes) override {
    for (int i = 0; i < count; ++i) fuji_decode_strip(common, i, offsets[i], sizes[i]);
  }
  void crxLoadDecodeLoop(void* image, int plane_count) override {
    for (int i = 0; i < plane_count; ++i)
      if (crxDecodePlane(image, static_cast<uint32_t>(i)) != 0) derror();
  }
  void crxLoadFinalizeLoopE3(void* image, int plane_height) override {
    for (int row = 0; row < plane_height; ++row) crxConvertPlaneLineDf(image, row);
  }

 private:
  // Returns the TIFF directory (IFD) whose data begin where the pixels begin; null if there is
  // none.
  const tiff_ifd_t* IfdOfPixels() const {
    const int count = static_cast<int>(libraw_internal_data.identify_data.tiff_nifds);
    for (int i = 0; i < std::min(count, LIBRAW_IFD_MAXCOUNT); ++i)
      if (tiff_ifd[i].offset == libraw_internal_data.unpacker_data.data_offset) return &tiff_ifd[i];
    return nullptr;
  }

  // Records two facts from tags that LibRaw mostly ignores: that the mosaic is not in rows and
  // columns, and that its colours are not R, G, B.
  static void NoteTag(void* self, int tag, int type, int length, unsigned order, void* stream,
                      INT64) {
    constexpr int kCfaPlaneColor = 50710, kCfaLayout = 50711, kByte = 1, kShort = 3;
    auto* raw = static_cast<QuietLibRaw*>(self);
    auto* bytes = static_cast<LibRaw_abstract_datastream*>(stream);
    if ((tag & 0xffff) == kCfaLayout && type == kShort && length == 1) {
      const int first = bytes->get_char(), second = bytes->get_char();
      raw->is_staggered_ |= (order == 0x4949 ? first | second << 8 : first << 8 | second) != 1;
    }
    if ((tag & 0xffff) == kCfaPlaneColor && type == kByte)
      for (int i = 0; i < 3; ++i) raw->has_other_colours_ |= length != 3 || bytes->get_char() != i;
  }

  bool has_other_colours_ = false;
  bool is_staggered_ = false;
};

// Returns the reason why LibRaw refuses a file.
std::string ReasonOfRefusal(const QuietLibRaw& raw) {
  constexpr int kLeast_px = 22;
  const auto& sizes = raw.imgdata.sizes;
  const auto& unpacker = raw.internals().unpacker_data;
  const bool is_small = (sizes.width > 0 && sizes.width < kLeast_px) ||
                        (sizes.height > 0 && sizes.height < kLeast_px);
  if (is_small)
    return fmt::format(
        "its {} x {} pixels are fewer than {} x {}, the smallest size that LibRaw reads",
        sizes.width, sizes.height, kLeast_px, kLeast_px);
  if (unpacker.tiff_sampleformat == 3) return "its pixels are floating point numbers";
  if (unpacker.tiff_bps > 16)
    return fmt::format("its pixels have {} bits instead of 8 to 16", unpacker.tiff_bps);
  return "it is truncated or damaged, or does not state its mosaic, or LibRaw does not know its "
         "kind";
}

// kInput if the file has no pixels as a Bayer or monochrome sensor recorded them.
Result<void> CheckSensor(QuietLibRaw& raw, const std::string& name) {
  const auto refuse = [&](const std::string& what) {
    return InputError(fmt::format("{}: {}; {}", name, what, kAdvice));
  };
  const libraw_iparams_t& kind = raw.imgdata.idata;
  if (raw.is_floating_point() || raw.internals().unpacker_data.tiff_sampleformat == 3)
    return refuse("its pixels are floating point numbers, which are not read from raw files");
  if (kind.is_foveon)
    return refuse("its sensor (Foveon) records three colours in every pixel, which is not read");
  if (raw.is_fuji_rotated() || raw.is_staggered())
    return refuse("the pixels of its mosaic are staggered, not in rows and columns, and not read");
  if (kind.filters == 9)
    return refuse(
        "its colour filter (X-Trans) repeats every 6 x 6 pixels; only Bayer mosaics, "
        "which repeat every 2 x 2, are read");
  if (kind.filters == 0 && kind.colors != 1)
    return InputError(
        fmt::format("{}: is a linear DNG or a reduced raw file, whose {} colours are already "
                    "interpolated: expected a mosaic; convert the file to 16-bit TIFF",
                    name, kind.colors));
  if (raw.internals().unpacker_data.tiff_samples > 1 && kind.dng_version != 0)
    return refuse(fmt::format("its mosaic has {} channels; expected one",
                              raw.internals().unpacker_data.tiff_samples));
  if (kind.filters != 0 && (kind.filters < 1000 || !RepeatsEveryTwo(raw)))
    return refuse("its colour filter does not repeat every 2 x 2 pixels, as Bayer mosaics do");
  return {};
}

// Checks width and height against the file's length, because LibRaw allocates memory for them and
// makes up the pixels that a short file lacks.
Result<void> CheckSizes(QuietLibRaw& raw, uint64_t size_bytes, const std::string& name) {
  const libraw_image_sizes_t& sizes = raw.imgdata.sizes;
  const int width = sizes.raw_width, height = sizes.raw_height;
  LF_RETURN_IF_ERROR(
      CheckPixelCount(static_cast<uint64_t>(width), static_cast<uint64_t>(height), name));
  const PixelRect area = raw.VisibleArea();
  if (area.x_begin < 0 || area.y_begin < 0 || area.empty() || area.x_end > width ||
      area.y_end > height)
    return InputError(
        fmt::format("{}: its active area, {} to {} in x and {} to {} in y, does not lie within its "
                    "{} x {} pixels: truncated or damaged",
                    name, area.x_begin, area.x_end, area.y_begin, area.y_end, width, height));
  if (raw.imgdata.idata.dng_version != 0 && raw.internals().unpacker_data.data_offset <= 0)
    return InputError(
        fmt::format("{}: does not say where its pixels are: truncated or damaged", name));
  const bool is_packed = raw.IsDecodedBy("packed_dng_load_raw()");
  if (is_packed && !raw.LiesInOnePiece())
    return InputError(fmt::format(
        "{}: its mosaic is in uncompressed tiles, or in strips with gaps, which LibRaw does not "
        "read; write the DNG again with lossless compression or in strips without gaps",
        name));
  // The Huffman code of a pixel has at least one bit, but a run of equal pixels may share it. No
  // file is expected to hold more pixels per byte than this.
  constexpr double kMostPixelsPerByte = 512;
  const double pixel_count = static_cast<double>(width) * height;
  const double least_bytes = is_packed ? pixel_count * raw.internals().unpacker_data.tiff_bps / 8
                                       : pixel_count / kMostPixelsPerByte;
  if (static_cast<double>(size_bytes) < std::floor(least_bytes))
    return InputError(
        fmt::format("{}: claims {} x {} pixels, for which the file is too short: truncated or "
                    "damaged",
                    name, width, height));
  return {};
}

Result<void> DamageError(const std::string& name) {
  return InputError(fmt::format("{}: LibRaw cannot decode it: truncated or damaged", name));
}

// Marks at the last pixels of a picture, by which decoders that stop early are detected: such
// decoders leave the marks unchanged. A picture has these values by chance once in 2^64. All other
// pixels are cleared, because LibRaw does not clear them.
class DecodingMarks {
 public:
  void Set(libraw_data_t& raw, const PixelRect& area) const {
    if (!raw.rawdata.raw_image) return;
    std::fill_n(raw.rawdata.raw_image, size_t{raw.sizes.raw_width} * raw.sizes.raw_height,
                ushort{0});
    ForEach(raw, area, [](ushort* pixel, ushort mark) { *pixel = mark; });
  }
  bool AreThere(const libraw_data_t& raw, const PixelRect& area) const {
    bool all = true;
    ForEach(raw, area, [&](const ushort* pixel, ushort mark) { all &= *pixel == mark; });
    return all;
  }

 private:
  template <class Use>
  static void ForEach(const libraw_data_t& raw, const PixelRect& area, const Use& use) {
    for (int i = 0; i < 4; ++i) {
      const auto row = static_cast<size_t>(std::max(area.y_end - 1 - i / 2, 0));
      const auto column = static_cast<size_t>(std::max(area.x_end - 1 - i % 2, 0));
      use(raw.rawdata.raw_image + row * raw.sizes.raw_width + column,
          static_cast<ushort>((i + 1) * 40503));
    }
  }
};

// Calls `call` and returns its error number; LIBRAW_DATA_ERROR if LibRaw throws an exception.
template <class Call>
int WithoutThrowing(const Call& call) {
  try {
    return call();
  } catch (const LibRaw_exceptions&) {
    return LIBRAW_DATA_ERROR;
  }
}

}  // namespace

struct RawReader::State {
  State(const ByteSource& source, uint64_t size_bytes, std::string file_name)
      : name(std::move(file_name)), stream(source, size_bytes) {}
  std::string name;
  RawStream stream;  // must outlive `raw`, which reads from it
  QuietLibRaw raw;
  PixelRect area;  // the image's rectangle on the sensor
  ImageFileInfo info;
};

RawReader::RawReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
RawReader::RawReader(RawReader&&) noexcept = default;
RawReader::~RawReader() = default;

Result<RawReader> RawReader::Open(const ByteSource& source, uint64_t size_bytes,
                                  const std::string& name) {
  auto state = std::make_unique<State>(source, size_bytes, name);
  QuietLibRaw& raw = state->raw;
  const int code = WithoutThrowing([&] { return raw.open_datastream(&state->stream); });
  if (code != LIBRAW_SUCCESS)
    return InputError(
        fmt::format("{}: LibRaw cannot read this camera raw file: {}", name, ReasonOfRefusal(raw)));
  LF_RETURN_IF_ERROR(CheckSensor(raw, name));
  LF_RETURN_IF_ERROR(CheckSizes(raw, size_bytes, name));
  state->area = raw.VisibleArea();
  RawFacts facts = FactsOf(raw.imgdata, false);
  facts.is_monochrome = raw.imgdata.idata.filters == 0;
  if (facts.is_monochrome) {
    facts.white_balance.reset();
    facts.linear_srgb_from_camera.reset();
  } else if (!raw.has_other_colours()) {
    facts.bayer = PatternAt(raw, state->area.x_begin, state->area.y_begin);
  }
  state->info = {state->area.width(),
                 state->area.height(),
                 1,
                 16,
                 false,
                 {"Y"},
                 OrientationOf(raw.imgdata.sizes.flip),
                 facts};
  return RawReader(std::move(state));
}

const ImageFileInfo& RawReader::info() const { return state_->info; }

ExposureFacts RawReader::exposure() const {
  const auto stated = [](float value) {
    return value > 0 && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
  };
  const libraw_imgother_t& other = state_->raw.imgdata.other;
  return {stated(other.shutter), stated(other.aperture), stated(other.iso_speed)};
}

Result<void> RawReader::Read(Image<uint16_t>* image) {
  QuietLibRaw& raw = state_->raw;
  RawStream& stream = state_->stream;
  const PixelRect& area = state_->area;
  // LibRaw seeks the pixels after it has allocated their memory, so the marks are set at this seek.
  const DecodingMarks marks;
  stream.OnNextSeek([&] { marks.Set(raw.imgdata, area); });
  stream.ForgetReadBeyondEnd();
  const int code = WithoutThrowing([&] { return raw.unpack(); });
  if (code == LIBRAW_UNSUFFICIENT_MEMORY) throw std::bad_alloc();
  const ushort* pixels = raw.imgdata.rawdata.raw_image;
  const libraw_image_sizes_t& sizes = raw.imgdata.sizes;
  if (code != LIBRAW_SUCCESS || !pixels || raw.error_count() > 0 || stream.ReadBeyondEnd() ||
      area.x_end > sizes.raw_width || area.y_end > sizes.raw_height ||
      sizes.raw_pitch != sizes.raw_width * sizeof(ushort) || marks.AreThere(raw.imgdata, area))
    return DamageError(state_->name);
  ImageFileInfo& info = state_->info;
  const RawFacts facts = FactsOf(raw.imgdata, true);
  info.raw->black_level = facts.black_level;
  info.raw->white_level = facts.white_level;
  image->Resize(info.width, info.height, 1);
  for (int y = 0; y < info.height; ++y)
    std::copy_n(pixels + static_cast<size_t>(area.y_begin + y) * sizes.raw_width + area.x_begin,
                info.width, image->row(y));
  return {};
}

}  // namespace lf
