// SPDX-License-Identifier: Apache-2.0
// The entropy coder: turns the quantised coefficients of a packet into bytes and back
// (doc/formats/lf_image.md, "Packets coded by contexts"). Internal to this folder.
//
// A range coder by asymmetric numeral systems (rANS; Duda 2013) codes each coefficient by the
// distribution that its neighbours predict (band_contexts.h). Up to 32 coders take turns, one for
// each strip of a band, so that vectors can decode them at once. They share one stream of 16-bit
// words. What the distributions do not hold follows as plain bits: the lowest bits of large
// coefficients, and magnitudes beyond the escape.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "lf/pixels/codec/band_contexts.h"
#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// A band of quantised coefficients.
template <class T>
struct CoefficientBand {
  T* values = nullptr;  // [height][width]
  int width = 0;
  int height = 0;
  BandKind kind = BandKind::kEven;
  // Band of the same kind at the next coarser level; null if there is none.
  const std::remove_const_t<T>* parent = nullptr;  // [parent_height][parent_width]
  int parent_width = 0;
  int parent_height = 0;
};

// Encodes the bands of a packet.
class PacketWriter {
 public:
  //   strip_count  StripCount() of the widest band
  PacketWriter(int strip_count, Rounding rounding)
      : strip_count_(strip_count), rounding_(rounding) {}

  // Appends the bands of the next component: one or three.
  void Append(std::span<const CoefficientBand<const int32_t>> bands);
  // Returns the bytes of the packet. Must be the last call.
  std::string Packet();

 private:
  struct Coded {
    uint16_t first, count;
    uint8_t turn;
  };

  void AppendBand(const CoefficientBand<const int32_t>& band);
  // Returns the symbol of the value.
  int AppendValue(int32_t value, const ScaleTable& table, int shift, int turn);
  void AppendBits(uint32_t bits, int count);

  const int strip_count_;
  const Rounding rounding_;
  std::string flags_;         // a byte for each component; its bit i is set if band i is not 0
  std::vector<Coded> coded_;  // in the order of decoding
  std::string plain_;         // plain bits, the lowest first
  uint64_t pending_ = 0;      // plain bits that do not fill a byte
  int pending_count_ = 0;
};

// Plain bits, the lowest of a byte first.
class PlainBits {
 public:
  explicit PlainBits(std::string_view bytes = {}) : bytes_(bytes) {}
  // Reads up to 32 bits. Returns false if there are fewer.
  [[nodiscard]] bool Take(int count, uint32_t* bits) {
    if (next_bit_ + count > 8 * bytes_.size()) return false;
    *bits = static_cast<uint32_t>(Window() & ((uint64_t{1} << count) - 1));
    next_bit_ += count;
    return true;
  }
  // Reads a number above 0 in Elias's gamma code: n zeros and a one, then its n lowest bits.
  [[nodiscard]] bool TakeGamma(uint32_t* number) {
    const int count = std::countr_zero(Window());
    if (count > 31) return false;
    next_bit_ += count + 1;
    if (!Take(count, number)) return false;
    *number |= 1U << count;
    return true;
  }
  bool is_at_end() const { return (next_bit_ + 7) / 8 == bytes_.size(); }

 private:
  // Returns the next bits, of which at least 57 are those of the bytes; zeros follow the last one.
  uint64_t Window() const {
    const size_t first = next_bit_ / 8;
    uint64_t window = 0;
    if (first >= bytes_.size()) return 0;
    std::memcpy(&window, bytes_.data() + first, std::min<size_t>(8, bytes_.size() - first));
    return window >> (next_bit_ % 8);
  }

  std::string_view bytes_;
  uint64_t next_bit_ = 0;
};

// The coders of a packet.
struct Coders {
  std::array<uint32_t, kMostStrips> states{};  // index: turn (StripInTurn())
  // Words of two bytes, the lower first. At least kWordRoom bytes that may be read follow.
  std::string_view words;
};
// Most bytes of words that the coefficients of a row need, and of a vector that is read.
inline constexpr size_t kWordRoom = 2 * 4096 + 64;

// The numbers that a band begins with.
struct BandScales {
  Rounding rounding = Rounding::kNearest;
  int quiet = 0;                            // as ActivityOf() explains
  std::array<uint8_t, kLevels> of_level{};  // scale of each level
};

// Decodes the bands of a packet in the order in which they were appended.
class PacketReader {
 public:
  PacketReader() = default;

  // Reads the head. Returns false if the packet is damaged.
  //   component_count  number of calls of Take() that follow
  [[nodiscard]] bool Begin(Transform transform, std::string_view packet, int component_count,
                           int strip_count, Rounding rounding);
  // Reads the bands of the next component. `values` need room for kSlack more elements behind the
  // last band (wavelet53.h), and each band must follow the one before it in memory. Returns false
  // if the packet is damaged.
  template <class T>
  [[nodiscard]] bool Take(std::span<const CoefficientBand<T>> bands);
  // Returns true if the packet ends here, as it must after all components.
  [[nodiscard]] bool IsAtEnd() const;

 private:
  [[nodiscard]] bool TakeScales(BandScales* scales);

  Transform transform_ = Transform::kSimd;
  int strip_count_ = 1;
  Rounding rounding_ = Rounding::kNearest;
  std::string_view flags_;
  Coders coders_;
  std::string words_;  // a copy, with room behind
  PlainBits plain_;
};

// The two implementations that decode a band. Return false if the words or plain bits end early.
template <class T>
[[nodiscard]] bool DecodeBandReference(const CoefficientBand<T>& band, const Strips& strips,
                                       const BandScales& scales, Coders* coders, PlainBits* plain);
template <class T>
[[nodiscard]] bool DecodeBandSimd(const CoefficientBand<T>& band, const Strips& strips,
                                  const BandScales& scales, Coders* coders, PlainBits* plain);

// Decodes the next symbol of a coder. Returns false if the words end early.
//   slot  receives the slot of the symbol (coefficient_scales.h)
[[nodiscard]] inline bool TakeSymbol(const ScaleTable& table, int turn, Coders* coders,
                                     uint32_t* slot) {
  uint32_t& state = coders->states[turn];
  *slot = table.slots[state & (kSlots - 1)];
  state = CountOf(*slot) * (state >> kSlotBits) + PlaceOf(*slot);
  if (state >= kLeastState) return true;
  if (coders->words.size() < 2) return false;
  state = state << 16 | static_cast<uint8_t>(coders->words[1]) << 8 |
          static_cast<uint8_t>(coders->words[0]);
  coders->words.remove_prefix(2);
  return true;
}

// Completes a coefficient with its plain bits. Returns false if these end early.
[[nodiscard]] inline bool TakeRest(uint32_t slot, int scale, PlainBits* plain, int32_t* value) {
  const int symbol = SymbolOf(slot), shift = ShiftOf(scale);
  auto magnitude = static_cast<uint32_t>(symbol < 0 ? -symbol : symbol);
  if (IsEscape(slot)) {
    uint32_t beyond = 0;
    if (!plain->TakeGamma(&beyond)) return false;
    magnitude += beyond - 1;
  }
  uint32_t bits = symbol < 0 ? 0U - magnitude : magnitude;
  if (shift > 0) {
    uint32_t lowest = 0;
    if (!plain->Take(shift, &lowest)) return false;
    bits = (bits << shift) + lowest - (1U << (shift - 1));
  }
  *value = static_cast<int32_t>(bits);
  return true;
}

}  // namespace lf
