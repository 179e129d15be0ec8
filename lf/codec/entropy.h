// The lossless coder behind the transforms: zstd. The only file of the folder that knows it.
// Internal to codec.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lf {

// Chosen by measurement (doc/codec.md).
inline constexpr int kEntropyLevel = 1;

// Appends bytes of its own length to `code`.
void AppendCompressed(std::span<const uint8_t> bytes, std::string* code);

// Whether `code` gives exactly as many bytes as there is place for.
[[nodiscard]] bool Decompress(std::string_view code, std::span<uint8_t> bytes);

// Whole numbers in as few bytes as they need: seven bits each, the lowest first; the highest bit
// says that more follow.
void AppendNumber(uint64_t number, std::string* code);
// Takes one from the front of `code`. False: the code ends, or it is above `limit`.
[[nodiscard]] bool TakeNumber(std::string_view* code, uint64_t limit, uint64_t* number);
// The next `count` bytes, taken.
[[nodiscard]] bool TakeBytes(std::string_view* code, size_t count, std::string_view* bytes);

}  // namespace lf
