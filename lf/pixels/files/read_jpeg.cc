// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/read_jpeg.h"

#include <fmt/format.h>
// libjpeg's header needs FILE and size_t, but does not include them.
#include <jpeglib.h>

#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
// Must come after jpeglib.h.
#include <jerror.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "lf/pixels/files/exif_orientation.h"

namespace lf {
namespace {

constexpr size_t kBufferBytes = size_t{1} << 16;

// Margin around the wanted part, in pixels. At the edge of a decoded part, the neighbours that
// chroma is interpolated from are missing; two blocks further inside, all pixels equal the pixels
// of the whole picture.
constexpr int kMargin_px = 32;

// Decoding a part is faster than decoding all if the part is below this share of the picture.
constexpr double kPartPays = 0.85;

// The bytes that libjpeg reads. libjpeg knows no end of a file: it asks for bytes until the picture
// is complete.
struct Source : jpeg_source_mgr {
  const ByteSource* bytes = nullptr;
  uint64_t offset = 0;  // position in the file of the first byte behind those in the buffer
  std::vector<uint8_t> buffer = std::vector<uint8_t>(kBufferBytes);
};

Source& SourceOf(j_decompress_ptr decompress) { return *static_cast<Source*>(decompress->src); }

boolean FillBuffer(j_decompress_ptr decompress) {
  Source& source = SourceOf(decompress);
  const size_t count = (*source.bytes)(source.offset, source.buffer);
  if (count == 0) ERREXIT(decompress, JERR_INPUT_EOF);
  source.offset += count;
  source.next_input_byte = source.buffer.data();
  source.bytes_in_buffer = count;
  return TRUE;
}

void SkipBytes(j_decompress_ptr decompress, long count) {
  if (count <= 0) return;
  Source& source = SourceOf(decompress);
  const size_t in_buffer = std::min(source.bytes_in_buffer, static_cast<size_t>(count));
  source.next_input_byte += in_buffer;
  source.bytes_in_buffer -= in_buffer;
  source.offset += static_cast<size_t>(count) - in_buffer;
}

PixelRect WithMargin(const PixelRect& rect, const PixelRect& whole) {
  return Intersection({rect.x_begin - kMargin_px, rect.y_begin - kMargin_px,
                       rect.x_end + kMargin_px, rect.y_end + kMargin_px},
                      whole);
}

}  // namespace

struct JpegReader::State {
  State(const ByteSource& bytes, const std::string& file_name) : name(file_name) {
    decompress.err = jpeg_std_error(&errors);
    decompress.client_data = this;
    errors.error_exit = [](j_common_ptr common) { Of(common).JumpOut(); };
    errors.emit_message = [](j_common_ptr common, int level) {
      // After a warning, libjpeg continues with guessed pixels, so warnings are errors. The only
      // harmless warnings are about fill bytes between segments, which some cameras write, and
      // about parts of a colour profile.
      const int code = common->err->msg_code;
      if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_BOGUS_ICC) Of(common).JumpOut();
    };
    source.bytes = &bytes;
    source.init_source = [](j_decompress_ptr) {};
    source.fill_input_buffer = FillBuffer;
    source.skip_input_data = SkipBytes;
    source.resync_to_restart = jpeg_resync_to_restart;
    source.term_source = [](j_decompress_ptr) {};
    progress.progress_monitor = [](j_common_ptr common) {
      auto* const d = reinterpret_cast<j_decompress_ptr>(common);
      if (d->input_scan_number <= kMaxScans) return;
      std::snprintf(Of(common).message, sizeof Of(common).message, "more than %d scans", kMaxScans);
      std::longjmp(Of(common).jump, 1);
    };
  }
  ~State() { jpeg_destroy_decompress(&decompress); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  static State& Of(j_common_ptr common) { return *static_cast<State*>(common->client_data); }

  // Keeps libjpeg's message and leaves libjpeg by longjmp. No object that was created since setjmp
  // may need its destructor.
  [[noreturn]] void JumpOut() {
    errors.format_message(reinterpret_cast<j_common_ptr>(&decompress), message);
    std::longjmp(jump, 1);
  }

  // Calls `calls`, which calls libjpeg. kInput if libjpeg reported an error.
  template <class Calls>
  Result<void> Run(const Calls& calls) {
    if (setjmp(jump) != 0)
      return InputError(fmt::format("{}: truncated or damaged: {}", name, message));
    calls();
    return {};
  }

  const std::string name;
  char message[JMSG_LENGTH_MAX] = {};
  ImageFileInfo info;
  jpeg_decompress_struct decompress{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  Source source{};
  std::jmp_buf jump;
};

JpegReader::JpegReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
JpegReader::JpegReader(JpegReader&&) noexcept = default;
JpegReader::~JpegReader() = default;
const ImageFileInfo& JpegReader::info() const { return state_->info; }

std::string JpegReader::IccProfile() {
  JOCTET* bytes = nullptr;
  unsigned int size = 0;
  boolean is_there = FALSE;
  const auto read = [&] { is_there = jpeg_read_icc_profile(&state_->decompress, &bytes, &size); };
  if (!state_->Run(read) || is_there == FALSE) return "";
  const std::unique_ptr<JOCTET, decltype(&std::free)> owner(bytes, std::free);
  return {reinterpret_cast<const char*>(bytes), size};
}

Result<JpegReader> JpegReader::Open(const ByteSource& source, const std::string& name) {
  auto state = std::make_unique<State>(source, name);
  jpeg_decompress_struct& decompress = state->decompress;
  LF_RETURN_IF_ERROR(state->Run([&] {
    jpeg_create_decompress(&decompress);
    decompress.src = &state->source;
    decompress.progress = &state->progress;
    jpeg_save_markers(&decompress, JPEG_APP0 + 1, 0xffff);
    jpeg_save_markers(&decompress, JPEG_APP0 + 2, 0xffff);  // parts of a colour profile
    jpeg_read_header(&decompress, TRUE);
  }));
  const int channels = decompress.num_components;
  if (channels != 1 && channels != 3)
    return InputError(fmt::format(
        "{}: is a JPEG of {} components{}: expected 1 or 3; convert it to colour (RGB) or grey",
        name, channels, channels == 4 ? " (CMYK)" : ""));
  decompress.out_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  // Smoothing would invent the details that are missing if a progressive file lacks its last scans.
  decompress.do_block_smoothing = FALSE;
  state->info.width = static_cast<int>(decompress.image_width);
  state->info.height = static_cast<int>(decompress.image_height);
  state->info.channels = channels;
  state->info.bits = 8;
  state->info.channel_names =
      channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  for (const jpeg_marker_struct* m = decompress.marker_list; m != nullptr; m = m->next) {
    state->info.orientation = OrientationOfExif({m->data, m->data_length});
    if (state->info.orientation != 1) break;
  }
  return JpegReader(std::move(state));
}

// Calls libjpeg, and may therefore be left by longjmp.
void JpegReader::ReadRows(const PixelRect& part, Image<uint8_t>* image) {
  jpeg_decompress_struct& decompress = state_->decompress;
  constexpr JDIMENSION kMostRows = 16;
  JSAMPROW rows[kMostRows];
  while (decompress.output_scanline < static_cast<JDIMENSION>(part.y_end)) {
    const JDIMENSION y = decompress.output_scanline;
    const JDIMENSION count = std::min(kMostRows, static_cast<JDIMENSION>(part.y_end) - y);
    for (JDIMENSION i = 0; i < count; ++i)
      rows[i] = image->row(static_cast<int>(y + i) - part.y_begin);
    jpeg_read_scanlines(&decompress, rows, count);
  }
}

Result<void> JpegReader::ReadReduced(int reduction, Image<uint8_t>* image) {
  LF_CHECK(reduction == 2 || reduction == 4 || reduction == 8);
  State& state = *state_;
  jpeg_decompress_struct& decompress = state.decompress;
  LF_RETURN_IF_ERROR(state.Run([&] {
    decompress.scale_num = 1;
    decompress.scale_denom = static_cast<unsigned>(reduction);
    jpeg_start_decompress(&decompress);
  }));
  const PixelRect whole = {0, 0, static_cast<int>(decompress.output_width),
                           static_cast<int>(decompress.output_height)};
  image->Resize(whole.width(), whole.height(), state.info.channels);
  return state.Run([&] {
    ReadRows(whole, image);
    jpeg_finish_decompress(&decompress);
  });
}

Result<PixelRect> JpegReader::Read(const PixelRect& wanted, Image<uint8_t>* image) {
  State& state = *state_;
  jpeg_decompress_struct& decompress = state.decompress;
  const PixelRect whole = {0, 0, state.info.width, state.info.height};
  PixelRect part = WithMargin(Intersection(wanted, whole), whole);
  LF_CHECK(!Intersection(wanted, whole).empty());
  if (static_cast<double>(part.pixel_count()) >
      kPartPays * static_cast<double>(whole.pixel_count()))
    part = whole;

  JDIMENSION x_begin = static_cast<JDIMENSION>(part.x_begin);
  JDIMENSION width = static_cast<JDIMENSION>(part.width());
  LF_RETURN_IF_ERROR(state.Run([&] {
    jpeg_start_decompress(&decompress);
    // The crop begins at the start of a block, so it may be wider than `part`.
    if (part.width() < whole.width()) jpeg_crop_scanline(&decompress, &x_begin, &width);
  }));
  part.x_begin = static_cast<int>(x_begin);
  part.x_end = static_cast<int>(x_begin + width);
  image->Resize(part.width(), part.height(), state.info.channels);

  std::vector<uint8_t> last_row(static_cast<size_t>(whole.width()) * state.info.channels);
  LF_RETURN_IF_ERROR(state.Run([&] {
    if (part.y_begin > 0) jpeg_skip_scanlines(&decompress, static_cast<JDIMENSION>(part.y_begin));
    ReadRows(part, image);
    // Skipping to the very end would not detect damage there, so the last row is decoded.
    if (decompress.output_scanline + 1 < decompress.output_height)
      jpeg_skip_scanlines(&decompress, decompress.output_height - 1 - decompress.output_scanline);
    JSAMPROW last = last_row.data();
    if (decompress.output_scanline < decompress.output_height)
      jpeg_read_scanlines(&decompress, &last, 1);
    jpeg_finish_decompress(&decompress);
  }));
  return part;
}

}  // namespace lf
