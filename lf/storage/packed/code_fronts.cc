// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/code_fronts.h"

#include "lf/core/check.h"
#include "lf/core/hash.h"

namespace lf {
namespace {

constexpr size_t kNumberBytes = sizeof(uint64_t);

void AppendLittleEndian(uint64_t number, std::string* bytes) {
  for (size_t i = 0; i < kNumberBytes; ++i)
    bytes->push_back(static_cast<char>(number >> (8 * i) & 0xFF));
}

uint64_t LittleEndianAt(std::string_view bytes, size_t begin) {
  uint64_t number = 0;
  for (size_t i = kNumberBytes; i-- > 0;)
    number = number << 8 | static_cast<unsigned char>(bytes[begin + i]);
  return number;
}

}  // namespace

std::string CodeOfFronts(std::string_view code, std::span<const uint64_t> ends) {
  std::string fronts;
  for (const uint64_t end : ends) {
    LF_CHECK(end <= code.size());
    AppendLittleEndian(end, &fronts);
    AppendLittleEndian(HashBytes(code.substr(0, end)), &fronts);
  }
  return fronts;
}

std::optional<std::vector<CodeFront>> FrontsOfCode(std::string_view fronts, uint64_t most_bytes) {
  if (fronts.size() % (2 * kNumberBytes) != 0) return std::nullopt;
  std::vector<CodeFront> all;
  for (size_t begin = 0; begin < fronts.size(); begin += 2 * kNumberBytes) {
    const CodeFront front = {LittleEndianAt(fronts, begin),
                             LittleEndianAt(fronts, begin + kNumberBytes)};
    if (front.bytes > most_bytes || (!all.empty() && front.bytes < all.back().bytes))
      return std::nullopt;
    all.push_back(front);
  }
  return all;
}

}  // namespace lf
