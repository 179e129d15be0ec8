// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/npy_head.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <system_error>

namespace lf {
namespace {

constexpr size_t kMaxHeaderSize = 65535;
constexpr size_t kMaxValues = size_t{1} << 32;

uint64_t NpyNumber(std::string_view bytes) {
  uint64_t value = 0;
  for (size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<uint8_t>(bytes[i]);
  return value;
}

struct NpyFields {
  std::optional<std::string_view> descr;
  std::optional<bool> fortran_order;
  std::optional<std::vector<size_t>> shape;
};

// Parses the header, a Python literal: {'descr': '<f8', 'fortran_order': False, 'shape': (20, 17),
// }
class NpyHeadReader {
 public:
  explicit NpyHeadReader(std::string_view text) : all_(text), text_(text) {}

  Result<NpyFields> Read() {
    NpyFields header;
    if (!Take("{")) return Fault();
    while (!Take("}")) {
      const std::optional<std::string_view> key = TakeString();
      if (!key || !Take(":") || !TakeValue(*key, &header)) return Fault();
      if (!Take(",")) {
        if (!Take("}")) return Fault();
        break;
      }
    }
    SkipBlanks();
    if (!text_.empty() || !header.descr || !header.fortran_order || !header.shape) return Fault();
    return header;
  }

 private:
  Error Fault() const {
    return InputError(
        fmt::format("has the .npy header \"{}\": expected {{'descr': ..., 'fortran_order': ..., "
                    "'shape': ...}}, as numpy.save writes it for an array of floats",
                    ShownNpyText(all_)));
  }
  void SkipBlanks() {
    text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
  }
  bool Take(std::string_view word) {
    SkipBlanks();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  std::optional<std::string_view> TakeString() {
    for (const char* quote : {"'", "\""}) {
      if (!Take(quote)) continue;
      const size_t end = text_.find(*quote);
      if (end == std::string_view::npos) return std::nullopt;
      const std::string_view string = text_.substr(0, end);
      text_.remove_prefix(end + 1);
      return string;
    }
    return std::nullopt;
  }
  std::optional<size_t> TakeSize() {
    SkipBlanks();
    size_t value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) return std::nullopt;
    text_.remove_prefix(end - text_.data());
    return value;
  }
  std::optional<std::vector<size_t>> TakeShape() {
    std::vector<size_t> shape;
    if (!Take("(")) return std::nullopt;
    while (!Take(")")) {
      const std::optional<size_t> size = TakeSize();
      if (!size || shape.size() == kMostNpyDimensions) return std::nullopt;
      shape.push_back(*size);
      if (Take(",")) continue;
      if (!Take(")")) return std::nullopt;
      break;
    }
    return shape;
  }
  bool TakeValue(std::string_view key, NpyFields* header) {
    if (key == "descr" && !header->descr) {
      header->descr = TakeString();
      return header->descr.has_value();
    }
    if (key == "shape" && !header->shape) {
      header->shape = TakeShape();
      return header->shape.has_value();
    }
    if (key != "fortran_order" || header->fortran_order) return false;
    header->fortran_order = Take("True");
    return *header->fortran_order || Take("False");
  }

  std::string_view all_, text_;
};

// The text of a file's header, and the bytes of the numbers behind it.
struct NpyParts {
  std::string_view header, values;
};

Result<NpyParts> CutNpy(std::string_view bytes) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  constexpr size_t kVersionEnd = kMagic.size() + 2;
  if (!bytes.starts_with(kMagic) || bytes.size() < kVersionEnd)
    return InputError(
        "is no .npy file: expected \\x93NUMPY as its first bytes, as numpy.save writes them");
  const int version = static_cast<uint8_t>(bytes[kMagic.size()]);
  if (version != 1 && version != 2)
    return InputError(
        fmt::format("is a .npy file of format version {}: expected 1 or 2, as numpy.save writes "
                    "them for arrays of numbers",
                    version));
  const size_t length_size = version == 1 ? 2 : 4;
  const size_t begin = kVersionEnd + length_size;
  if (bytes.size() < begin)
    return InputError("is truncated: it ends within its .npy header; copy or save it again");
  const uint64_t length = NpyNumber(bytes.substr(kVersionEnd, length_size));
  if (length > kMaxHeaderSize)
    return InputError(fmt::format(
        "has a .npy header of {} bytes: expected at most {}; save the array again with numpy.save",
        length, kMaxHeaderSize));
  if (length > bytes.size() - begin)
    return InputError("is truncated: it ends within its .npy header; copy or save it again");
  return NpyParts{bytes.substr(begin, length), bytes.substr(begin + length)};
}

}  // namespace

std::string ShownNpyText(std::string_view text) {
  std::string shown(text.substr(0, 80));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

Result<size_t> NpyValueCount(const std::vector<size_t>& shape) {
  size_t count = 1;
  for (const size_t size : shape) {
    if (size == 0 || size > kMaxValues / count)
      return InputError(
          fmt::format("holds an array of the shape ({}): expected 1 to 2^32 numbers in total",
                      fmt::join(shape, ", ")));
    count *= size;
  }
  return count;
}

Result<NpyHead> ParseNpyHead(std::string_view bytes) {
  LF_ASSIGN_OR_RETURN(const NpyParts parts, CutNpy(bytes));
  LF_ASSIGN_OR_RETURN(const NpyFields fields, NpyHeadReader(parts.header).Read());
  return NpyHead{std::string(*fields.descr), *fields.fortran_order, *fields.shape,
                 static_cast<size_t>(parts.values.data() - bytes.data())};
}

}  // namespace lf
