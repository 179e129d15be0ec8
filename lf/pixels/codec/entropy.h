// SPDX-License-Identifier: Apache-2.0
// The lossless coder that compresses coefficients, zstd, and the numbers between the compressed
// bytes (doc/formats/lf_image.md, "Numbers"). No other file of the folder uses zstd. Internal to
// this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lf {

// Compression level of zstd, chosen by measurement (doc/codec.md).
inline constexpr int kEntropyLevel = 1;

// Compresses `bytes` and appends the result to `code`, without its length.
void AppendCompressed(std::span<const uint8_t> bytes, std::string* code);

// Decompresses `code` into `bytes`. Returns true if it gives exactly bytes.size() bytes.
[[nodiscard]] bool Decompress(std::string_view code, std::span<uint8_t> bytes);

// Appends a whole number in as few bytes as it needs: seven bits in each byte, the lowest first.
// The highest bit of a byte is set if more bytes follow.
void AppendNumber(uint64_t number, std::string* code);
// Reads a number that AppendNumber() wrote from the front of `code` and removes it there. Returns
// false if `code` ends within the number, the number has more than ten bytes, or it exceeds
// `limit`.
[[nodiscard]] bool TakeNumber(std::string_view* code, uint64_t limit, uint64_t* number);
// Appends a whole number whose sign is stored in the lowest bit.
void AppendSigned(int64_t number, std::string* code);
// Reads a number that AppendSigned() wrote, as TakeNumber() does.
[[nodiscard]] bool TakeSigned(std::string_view* code, int64_t* number);
// Removes the first `count` bytes from `code` and sets `bytes` to them. Returns false if `code` has
// fewer bytes.
[[nodiscard]] bool TakeBytes(std::string_view* code, size_t count, std::string_view* bytes);

}  // namespace lf
