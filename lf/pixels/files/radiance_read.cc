// SPDX-License-Identifier: Apache-2.0
// Reads pictures of Radiance (.hdr, .pic): a common exponent for R, G and B. The format is that of
// https://radsite.lbl.gov/radiance/refer/filefmts.pdf, "Picture File Format". A value is
// m 2^(e - 136), as rgbe.c of Bruce Walter and OpenCV compute it.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/text_head.h"

namespace lf {
namespace {

using Rgbe = std::array<uint8_t, 4>;

struct RadianceHead {
  int64_t width = 0, height = 0;
  bool is_upside_down = false, is_mirrored = false;
  size_t pixels_begin = 0;
};

class RadianceDecoder : public PictureDecoder {
 public:
  RadianceDecoder(const FileBytes& file, const RadianceHead& head) : file_(file), head_(head) {
    info_.width = static_cast<int>(head.width);
    info_.height = static_cast<int>(head.height);
    info_.channels = 3;
    info_.bits = 32;
    info_.is_float = true;
    info_.channel_names = {"R", "G", "B"};
  }

  const ImageFileInfo& info() const override { return info_; }

  Result<void> Read(StoredImage* image) override {
    std::string storage;
    std::string_view rest = ContentOf(file_, &storage).substr(head_.pixels_begin);
    Image<float>& pixels = Resized<float>(info_.width, info_.height, 3, image);
    std::vector<Rgbe> row(static_cast<size_t>(info_.width));
    for (int i = 0; i < info_.height; ++i) {
      if (!ReadRow(&rest, &row))
        return InputError(
            fmt::format("{}: truncated or damaged: row {} of {} of the Radiance "
                        "picture is not whole",
                        file_.name, i + 1, info_.height));
      float* const out = pixels.row(head_.is_upside_down ? info_.height - 1 - i : i);
      for (int x = 0; x < info_.width; ++x) {
        const Rgbe& rgbe = row[static_cast<size_t>(head_.is_mirrored ? info_.width - 1 - x : x)];
        const float unit = rgbe[3] == 0 ? 0 : std::ldexp(1.0F, rgbe[3] - 136);
        for (int c = 0; c < 3; ++c)
          out[3 * x + c] = static_cast<float>(rgbe[static_cast<size_t>(c)]) * unit;
      }
    }
    return {};
  }

 private:
  // Reads a row and moves `rest` behind it. Returns false if the file is damaged.
  static bool ReadRow(std::string_view* rest, std::vector<Rgbe>* row) {
    const auto byte = [rest](size_t i) { return static_cast<uint8_t>((*rest)[i]); };
    if (rest->size() < 4) return false;
    const size_t width = row->size();
    const bool is_by_channels = width >= 8 && width < 32768 && byte(0) == 2 && byte(1) == 2 &&
                                static_cast<size_t>(byte(2) << 8 | byte(3)) == width;
    if (!is_by_channels) return ReadPixels(rest, row);
    rest->remove_prefix(4);
    for (size_t c = 0; c < 4; ++c)
      for (size_t x = 0; x < width;) {
        if (rest->size() < 2) return false;
        // Up to 128: so many bytes follow as they are; above: one byte, 128 fewer times.
        const size_t count = byte(0) > 128 ? byte(0) - 128U : byte(0);
        const bool is_run = byte(0) > 128;
        if (count == 0 || count > width - x || (!is_run && rest->size() < 1 + count)) return false;
        for (size_t i = 0; i < count; ++i) (*row)[x++][c] = byte(is_run ? 1 : 1 + i);
        rest->remove_prefix(is_run ? 2 : 1 + count);
      }
    return true;
  }

  // Reads pixels one after the other. A pixel (1, 1, 1, n) repeats the one before it n times;
  // several of these make a number of more digits to the base 256.
  static bool ReadPixels(std::string_view* rest, std::vector<Rgbe>* row) {
    int shift = 0;
    for (size_t x = 0; x < row->size();) {
      if (rest->size() < 4) return false;
      Rgbe rgbe;
      for (size_t c = 0; c < 4; ++c) rgbe[c] = static_cast<uint8_t>((*rest)[c]);
      rest->remove_prefix(4);
      if (rgbe[0] != 1 || rgbe[1] != 1 || rgbe[2] != 1) {
        (*row)[x++] = rgbe;
        shift = 0;
        continue;
      }
      const size_t count = size_t{rgbe[3]} << shift;
      if (x == 0 || shift > 16 || count > row->size() - x) return false;
      for (size_t i = 0; i < count; ++i, ++x) (*row)[x] = (*row)[x - 1];
      shift += 8;
    }
    return true;
  }

  const FileBytes& file_;
  const RadianceHead head_;
  ImageFileInfo info_;
};

// Returns the numbers of the line "-Y height +X width". Signs: "+Y" begins below, "-X" at the
// right. Pictures that are stored by columns (X first) are not read.
std::optional<RadianceHead> ParseResolution(std::string_view line) {
  constexpr int64_t kMostRadianceSide = int64_t{1} << 31;
  TextHead words(line);
  RadianceHead head;
  const std::string_view y = words.Word();
  const std::optional<int64_t> height = words.Integer(kMostRadianceSide);
  const std::string_view x = words.Word();
  const std::optional<int64_t> width = words.Integer(kMostRadianceSide);
  if ((y != "-Y" && y != "+Y") || (x != "-X" && x != "+X") || !width || !height)
    return std::nullopt;
  head.width = *width;
  head.height = *height;
  head.is_upside_down = y == "+Y";
  head.is_mirrored = x == "-X";
  return head;
}

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenRadiance(const FileBytes& file) {
  constexpr size_t kMostRadianceHeadBytes = 65536;
  const std::string start = StartOf(file, kMostRadianceHeadBytes);
  TextHead lines(start);
  std::string_view line = lines.Line();
  bool states_rgbe = true;
  while (lines.position() < start.size() && !(line = lines.Line()).empty())
    if (line.starts_with("FORMAT=")) states_rgbe = line == "FORMAT=32-bit_rle_rgbe";
  if (!states_rgbe)
    return InputError(
        fmt::format("{}: is a Radiance picture of another kind than RGB (FORMAT=32-bit_rle_rgbe): "
                    "convert it to "
                    "EXR",
                    file.name));
  std::optional<RadianceHead> head = ParseResolution(lines.Line());
  if (!head)
    return InputError(
        fmt::format("{}: the head of the Radiance picture is damaged: expected an empty line and a "
                    "line such as \"-Y 480 +X 640\"",
                    file.name));
  head->pixels_begin = lines.position();
  LF_RETURN_IF_ERROR(CheckPictureSize(head->width, head->height, 3, file.name));
  // Runs of at most 127 values, as programs write them, take a byte for at most 16 pixels. Runs of
  // whole pixels, which old files have, may be longer.
  const auto pixels = static_cast<uint64_t>(head->width * head->height);
  if (head->width >= 8 && head->width < 32768 && pixels / 64 > file.size_bytes * 4)
    return InputError(fmt::format(
        "{}: claims {} x {} pixels, for which the file is too short: truncated or damaged",
        file.name, head->width, head->height));
  return std::unique_ptr<PictureDecoder>(std::make_unique<RadianceDecoder>(file, *head));
}

}  // namespace lf
