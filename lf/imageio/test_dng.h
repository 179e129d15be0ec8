// Writes DNG files for tests: one strip of 16-bit pixels, uncompressed, and the tags a test names.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/image.h"

namespace lf {

// A classic TIFF file, little-endian, of one directory. Tags may be changed and taken away.
class TestDng {
 public:
  // pattern: four letters, as lf_bayer
  TestDng(const Image<uint16_t>& mosaic, const std::string& pattern) {
    for (const uint16_t value : mosaic.pixels()) Append(value, 2, &pixels_);
    const auto width = static_cast<uint32_t>(mosaic.width());
    const auto height = static_cast<uint32_t>(mosaic.height());
    Long(254, {0}).Long(256, {width}).Long(257, {height}).Short(258, {16}).Short(259, {1});
    Short(262, {32803}).Text(271, "lf").Text(272, "test").Long(273, {0}).Short(277, {1});
    Long(278, {height}).Long(279, {static_cast<uint32_t>(pixels_.size())}).Short(33421, {2, 2});
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
  // type: 5 unsigned, 10 signed
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
      if (tag == 273) {
        Append(pixels_at, 4, &directory);
      } else if (entry.bytes.size() > 4) {
        Append(values_at + values.size(), 4, &directory);
        values += entry.bytes;
        values.resize(values.size() + values.size() % 2);
      } else {
        directory += entry.bytes + std::string(4 - entry.bytes.size(), '\0');
      }
    }
    return std::string("II*\0\x08\0\0\0", 8) + directory + std::string(4, '\0') + values + pixels_;
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

  std::map<int, Entry> entries_;
  std::string pixels_;
};

}  // namespace lf
