// SPDX-License-Identifier: Apache-2.0
// The distributions by which the entropy coder (coefficient_coder.h) codes coefficients. Internal
// to this folder.
//
// Coefficients with similar neighbours have nearly a Laplacian distribution: a magnitude m occurs
// about as often as exp(-m / scale), with a few more large magnitudes. Therefore a distribution is
// one of a family, given by its scale alone, and no frequencies are stored (doc/codec.md compares
// this with stored frequencies). Scales are a quarter of an octave apart.
//
// A distribution divides kSlots slots among the symbols -most, ..., -1, 0, 1, ..., most. The two
// outermost symbols are escapes: they stand for all magnitudes from `most` on. Coefficients whose
// scale is larger than those of the tables lose their lowest bits first (ShiftOf()).
#pragma once

#include <array>
#include <cstdint>

namespace lf {

inline constexpr int kSlotBits = 11;
inline constexpr int kSlots = 1 << kSlotBits;
// Largest magnitude of a symbol.
inline constexpr int kMostSymbol = 120;

// Scale i has the mean magnitude 2^(i / 4 - 4.5). Scales below kTables have a table of their own.
// The others share the four widest of these tables, for coefficients without their lowest bits.
inline constexpr int kTables = 40;
inline constexpr int kScales = kTables + 4 * 15;
inline constexpr int TableOf(int scale) {
  return scale < kTables ? scale : kTables - 4 + (scale - kTables) % 4;
}
// Returns the number of lowest bits that coefficients of a scale lose.
inline constexpr int ShiftOf(int scale) { return scale < kTables ? 0 : 1 + (scale - kTables) / 4; }

// How values have become coefficients: by rounding to the nearest, or with a dead zone, so that a
// coefficient is 0 below two thirds of a step.
enum class Rounding : uint8_t { kNearest = 0, kDeadZone = 1 };

// A slot, in the bits of one number so that vectors can load it at once: bits 0 to 11: number of
// slots of its symbol; 12 to 22: number of earlier slots of the same symbol; 23: set for an escape;
// 24 to 31: the symbol.
inline constexpr uint32_t CountOf(uint32_t slot) { return slot & 0xfff; }
inline constexpr uint32_t PlaceOf(uint32_t slot) { return slot >> 12 & 0x7ff; }
inline constexpr bool IsEscape(uint32_t slot) { return (slot >> 23 & 1) != 0; }
inline constexpr int SymbolOf(uint32_t slot) { return static_cast<int8_t>(slot >> 24); }

struct ScaleTable {
  const uint32_t* slots = nullptr;  // [kSlots]
  int most = 0;                     // largest symbol: the escape
  // Index: magnitude of a symbol. Each of the symbols m and -m has `count[m]` slots, those of m
  // from first[m] on, followed by those of -m.
  std::array<uint16_t, kMostSymbol + 1> count{}, first{};
  // Bits that a symbol of this magnitude costs, in 1/256 bit.
  std::array<uint16_t, kMostSymbol + 1> cost{};
};

// The tables of all scales, and one more, kIdle: its symbol is always 0 and costs nothing.
inline constexpr int kIdle = kTables;
struct ScaleTables {
  std::array<uint32_t, (kTables + 1) * kSlots> slots;
  std::array<ScaleTable, kTables + 1> tables;

  const ScaleTable& of(int scale) const { return tables[TableOf(scale)]; }
};
const ScaleTables& TablesFor(Rounding rounding);

}  // namespace lf
