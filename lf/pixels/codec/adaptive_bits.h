// SPDX-License-Identifier: Apache-2.0
// Writes and reads single bits in about as many bytes as their probabilities ask for, by adaptive
// binary range coding (Martin 1979, with the carry of Schindler 1998). Meant for a few thousand
// symbols, such as the depths of blocks, for which zstd's tables would be too long. Internal to
// this folder.
//
// A bit has a context, which holds the probability that it is 0 and adapts to each bit:
// 1 / 4096 units, 2048 at first; after a 0 it grows by (4096 - p) >> 4, after a 1 it falls by p
// >> 4. The range is 32 bits wide. A 0 takes the lower part, (range >> 12) p, and a 1 the rest.
// While the range is below 2^24, it is multiplied by 256, and the highest byte of the low end is
// written.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace lf {

inline constexpr int kProbabilityBits = 12;
inline constexpr int kAdaptation = 4;

struct BitContext {
  uint16_t zero = 1 << (kProbabilityBits - 1);

  void Adapt(bool bit) {
    if (bit)
      zero = static_cast<uint16_t>(zero - (zero >> kAdaptation));
    else
      zero = static_cast<uint16_t>(zero + (((1 << kProbabilityBits) - zero) >> kAdaptation));
  }
};

class BitWriter {
 public:
  void Put(bool bit, BitContext* context) {
    const uint32_t of_zero = (range_ >> kProbabilityBits) * context->zero;
    if (bit) {
      low_ += of_zero;
      range_ -= of_zero;
    } else {
      range_ = of_zero;
    }
    context->Adapt(bit);
    for (; range_ < 1U << 24; range_ <<= 8) ShiftByte();
  }

  // Returns the bytes. Nothing must be put afterwards.
  std::string Finished() && {
    for (int i = 0; i < 5; ++i) ShiftByte();
    return std::move(bytes_);
  }

 private:
  // Moves the highest byte of `low_` out. It waits in `first_waiting_`, with the bytes of 255 that
  // follow it, until no later carry can change it.
  void ShiftByte() {
    if (low_ < 0xFF000000U || low_ > UINT32_MAX) {
      const auto carry = static_cast<uint8_t>(low_ >> 32);
      if (has_first_) bytes_.push_back(static_cast<char>(first_waiting_ + carry));
      for (; waiting_ > 0; --waiting_) bytes_.push_back(static_cast<char>(0xFF + carry));
      first_waiting_ = static_cast<uint8_t>(low_ >> 24);
      has_first_ = true;
    } else {
      ++waiting_;
    }
    low_ = (low_ & 0x00FFFFFFU) << 8;
  }

  uint64_t low_ = 0;  // at most 33 bits: bit 32 is a carry
  uint32_t range_ = UINT32_MAX;
  uint8_t first_waiting_ = 0;
  bool has_first_ = false;
  size_t waiting_ = 0;
  std::string bytes_;
};

// Reads what BitWriter wrote, with contexts that begin and adapt in the same way. Any bytes give
// some bits: those beyond the end are 0.
class BitReader {
 public:
  explicit BitReader(std::string_view bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | Next();
  }

  bool Take(BitContext* context) {
    const uint32_t of_zero = (range_ >> kProbabilityBits) * context->zero;
    const bool bit = code_ >= of_zero;
    if (bit) {
      code_ -= of_zero;
      range_ -= of_zero;
    } else {
      range_ = of_zero;
    }
    context->Adapt(bit);
    for (; range_ < 1U << 24; range_ <<= 8) code_ = code_ << 8 | Next();
    return bit;
  }

  // Returns true if the bytes hold as many bits as were read.
  bool IsAtEnd() const { return next_ == bytes_.size(); }

 private:
  uint32_t Next() {
    const size_t at = next_++;
    return at < bytes_.size() ? static_cast<uint8_t>(bytes_[at]) : 0;
  }

  std::string_view bytes_;
  size_t next_ = 0;
  uint32_t code_ = 0;
  uint32_t range_ = UINT32_MAX;
};

// A number of `kBits` bits, written from the highest bit on. Each bit has a context for each value
// of the bits above it.
template <int kBits>
struct NumberContexts {
  std::array<BitContext, size_t{1} << kBits> nodes;

  void Put(uint32_t number, BitWriter* writer) {
    uint32_t node = 1;
    for (int i = kBits - 1; i >= 0; --i) {
      const bool bit = (number >> i & 1) != 0;
      writer->Put(bit, &nodes[node]);
      node = 2 * node + (bit ? 1 : 0);
    }
  }
  uint32_t Take(BitReader* reader) {
    uint32_t node = 1;
    for (int i = 0; i < kBits; ++i) node = 2 * node + (reader->Take(&nodes[node]) ? 1 : 0);
    return node - (1U << kBits);
  }
};

}  // namespace lf
