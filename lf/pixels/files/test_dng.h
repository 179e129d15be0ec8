// SPDX-License-Identifier: Apache-2.0
// Writes DNG files for tests, with the tags that a test sets: one strip of uncompressed 16-bit
// pixels, unless the test asks for packed bits, tiles or lossless JPEG.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/image.h"
#include "lf/pixels/files/test_lossless_jpeg.h"

namespace lf {

// A classic TIFF file, little-endian, with one directory. Tags may be changed and removed.
class TestDng {
 public:
  // pattern: colours of the pixels (0, 0), (1, 0), (0, 1), (1, 1), such as "RGGB"
  TestDng(const Image<uint16_t>& mosaic, const std::string& pattern) : mosaic_(mosaic) {
    parts_.emplace_back();
    for (const uint16_t value : mosaic.pixels()) Append(value, 2, &parts_[0]);
    const auto width = static_cast<uint32_t>(mosaic.width());
    const auto height = static_cast<uint32_t>(mosaic.height());
    Long(254, {0}).Long(256, {width}).Long(257, {height}).Short(258, {16}).Short(259, {1});
    Short(262, {32803}).Text(271, "lf").Text(272, "test").Long(273, {0}).Short(277, {1});
    Long(278, {height}).Long(279, {static_cast<uint32_t>(parts_[0].size())}).Short(33421, {2, 2});
    std::string colours;
    for (const char letter : pattern) colours += static_cast<char>(std::string("RGB").find(letter));
    Bytes(33422, colours).Bytes(50706, std::string("\1\4\0\0", 4)).Text(50708, "lf test");
  }

  TestDng& Bytes(int tag, const std::string& values) { return Set(tag, 1, values.size(), values); }
  TestDng& Text(int tag, const std::string& text) {
    return Set(tag, 2, text.size() + 1, text + '\0');
  }
  TestDng& Short(int tag, const std::vector<uint32_t>& values) { return Set(tag, 3, 2, values); }
  TestDng& Long(int tag, const std::vector<uint32_t>& values) { return Set(tag, 4, 4, values); }
  // type: 5 for unsigned, 10 for signed fractions
  TestDng& Fractions(int tag, int type, const std::vector<std::pair<int, int>>& values) {
    std::string bytes;
    for (const auto& [over, under] : values) {
      Append(static_cast<uint32_t>(over), 4, &bytes);
      Append(static_cast<uint32_t>(under), 4, &bytes);
    }
    return Set(tag, type, values.size(), bytes);
  }
  TestDng& Without(int tag) {
    entries_.erase(tag);
    return *this;
  }
  // Packs the values, which must be below 2^bits, without gaps; every row begins with a new byte.
  TestDng& Packed(int bits) {
    parts_.assign(1, "");
    for (int y = 0; y < mosaic_.height(); ++y) {
      uint64_t rest = 0;
      int rest_bits = 0;
      for (int x = 0; x < mosaic_.width(); ++x) {
        rest = rest << bits | mosaic_.at(x, y);
        for (rest_bits += bits; rest_bits >= 8; rest_bits -= 8)
          parts_[0] += static_cast<char>(rest >> (rest_bits - 8));
      }
      if (rest_bits > 0) parts_[0] += static_cast<char>(rest << (8 - rest_bits));
    }
    return Short(258, {static_cast<uint32_t>(bits)}).SetParts(278, 273, 279);
  }
  // Puts the pixels into tiles of an even width, as lossless JPEG or uncompressed.
  TestDng& Tiled(int width, int height, bool is_lossless_jpeg) {
    parts_.clear();
    for (int top = 0; top < mosaic_.height(); top += height)
      for (int left = 0; left < mosaic_.width(); left += width) {
        Image<uint16_t> tile(width, height, 1);
        for (int y = 0; y < std::min(height, mosaic_.height() - top); ++y)
          for (int x = 0; x < std::min(width, mosaic_.width() - left); ++x)
            tile.at(x, y) = mosaic_.at(left + x, top + y);
        parts_.emplace_back();
        if (is_lossless_jpeg)
          parts_.back() = LosslessJpeg(tile);
        else
          for (const uint16_t value : tile.pixels()) Append(value, 2, &parts_.back());
      }
    Without(273).Without(278).Without(279).Short(259, {is_lossless_jpeg ? 7u : 1u});
    Long(322, {static_cast<uint32_t>(width)}).Long(323, {static_cast<uint32_t>(height)});
    return SetParts(0, 324, 325);
  }

  std::string File() const {
    std::string directory, values;
    const size_t values_at = 8 + 2 + 12 * entries_.size() + 4;
    size_t pixels_at = values_at;
    for (const auto& [tag, entry] : entries_)
      if (entry.bytes.size() > 4) pixels_at += entry.bytes.size() + entry.bytes.size() % 2;
    Append(entries_.size(), 2, &directory);
    for (const auto& [tag, entry] : entries_) {
      Append(static_cast<uint64_t>(tag), 2, &directory);
      Append(static_cast<uint64_t>(entry.type), 2, &directory);
      Append(entry.count, 4, &directory);
      const std::string bytes = tag == 273 || tag == 324 ? Offsets(pixels_at) : entry.bytes;
      if (bytes.size() > 4) {
        Append(values_at + values.size(), 4, &directory);
        values += bytes;
        values.resize(values.size() + values.size() % 2);
      } else {
        directory += bytes + std::string(4 - bytes.size(), '\0');
      }
    }
    std::string file =
        std::string("II*\0\x08\0\0\0", 8) + directory + std::string(4, '\0') + values;
    for (const std::string& part : parts_) file += part;
    return file;
  }

 private:
  struct Entry {
    int type = 0;
    size_t count = 0;
    std::string bytes;
  };
  static void Append(uint64_t value, int count, std::string* bytes) {
    for (int i = 0; i < count; ++i) *bytes += static_cast<char>(value >> 8 * i);
  }
  TestDng& Set(int tag, int type, size_t count, const std::string& bytes) {
    entries_[tag] = {type, count, bytes};
    return *this;
  }
  TestDng& Set(int tag, int type, int size, const std::vector<uint32_t>& values) {
    std::string bytes;
    for (const uint32_t value : values) Append(value, size, &bytes);
    return Set(tag, type, values.size(), bytes);
  }

  // Sets the tags of the parts (strips or tiles): rows of each part (rows_tag 0: no such tag),
  // offsets and sizes.
  TestDng& SetParts(int rows_tag, int offsets_tag, int sizes_tag) {
    std::vector<uint32_t> sizes;
    for (const std::string& part : parts_) sizes.push_back(static_cast<uint32_t>(part.size()));
    if (rows_tag != 0) Long(rows_tag, {static_cast<uint32_t>(mosaic_.height())});
    return Long(offsets_tag, std::vector<uint32_t>(sizes.size())).Long(sizes_tag, sizes);
  }
  std::string Offsets(size_t pixels_at) const {
    std::string offsets;
    for (const std::string& part : parts_) {
      Append(pixels_at, 4, &offsets);
      pixels_at += part.size();
    }
    return offsets;
  }

  Image<uint16_t> mosaic_;
  std::map<int, Entry> entries_;
  std::vector<std::string> parts_;  // strips or tiles
};

}  // namespace lf
