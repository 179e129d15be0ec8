// SPDX-License-Identifier: Apache-2.0
// Writes small TIFF files with tags of GeoTIFF, for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lf {

// The tags of a small little-endian TIFF file of one float, in the order in which they are added.
class GeoTiffText {
 public:
  GeoTiffText() {
    Add(256, 3, 1, Numbers({1}));
    Add(257, 3, 1, Numbers({1}));
    Add(258, 3, 1, Numbers({32}));
    Add(259, 3, 1, Numbers({1}));
    Add(262, 3, 1, Numbers({1}));
    Add(273, 4, 1, std::string("\x08\0\0\0", 4));
    Add(277, 3, 1, Numbers({1}));
    Add(278, 3, 1, Numbers({1}));
    Add(279, 4, 1, std::string("\x04\0\0\0", 4));
    Add(339, 3, 1, Numbers({3}));
  }
  GeoTiffText& Doubles(int tag, const std::vector<double>& values) {
    return Add(tag, 12, values.size(),
               {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
  }
  GeoTiffText& Keys(const std::vector<uint16_t>& values) {
    return Add(34735, 3, values.size(), Numbers(values));
  }
  GeoTiffText& Nodata(const std::string& text) {
    return Add(42113, 2, text.size() + 1, text + '\0');
  }

  // Places of values behind the pixel; the directory comes last.
  std::string Bytes() const {
    std::string bytes("II*\0\0\0\0\0\0\0\x80\x3f", 12), directory;
    AddNumber(tags_.size(), 2, &directory);
    for (const Tag& tag : tags_) {
      AddNumber(static_cast<uint64_t>(tag.number), 2, &directory);
      AddNumber(static_cast<uint64_t>(tag.type), 2, &directory);
      AddNumber(tag.count, 4, &directory);
      if (tag.values.size() <= 4) {
        directory += tag.values + std::string(4 - tag.values.size(), '\0');
        continue;
      }
      AddNumber(bytes.size(), 4, &directory);
      bytes += tag.values;
      if (bytes.size() % 2 != 0) bytes += '\0';
    }
    std::string begin;
    AddNumber(bytes.size(), 4, &begin);
    bytes.replace(4, 4, begin);
    return bytes + directory + std::string(4, '\0');
  }

 private:
  struct Tag {
    int number, type;
    size_t count;
    std::string values;
  };
  static void AddNumber(uint64_t value, int size, std::string* bytes) {
    for (int i = 0; i < size; ++i) *bytes += static_cast<char>(value >> (8 * i));
  }
  static std::string Numbers(const std::vector<uint16_t>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * 2};
  }
  GeoTiffText& Add(int number, int type, size_t count, const std::string& values) {
    tags_.push_back({number, type, count, values});
    return *this;
  }

  std::vector<Tag> tags_;
};

}  // namespace lf
