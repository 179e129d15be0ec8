// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/coefficient_scales.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"

namespace lf {
namespace {

// exp(-1 / (36 scale)) in 1 / 2^32 for each table. The tables follow from these numbers in integer
// arithmetic, so that they are the same on every machine.
constexpr std::array<uint64_t, kTables> kRoots = {
    2290807968, 2531741600, 2753848799, 2955631108, 3136709312, 3297536562, 3439140958, 3562911583,
    3670431025, 3763351125, 3843305601, 3911852340, 3970438416, 4020381823, 4062864982, 4098936187,
    4129516091, 4155407134, 4177304421, 4195807058, 4211429278, 4224610957, 4235727313, 4245097655,
    4252993183, 4259643870, 4265244458, 4269959671, 4273928712, 4277269119, 4280080076, 4282445229,
    4284435090, 4286109073, 4287517225, 4288701693, 4289697961, 4290535898, 4291240643, 4291833351};

uint64_t Product(uint64_t a, uint64_t b) { return a * b >> 32; }

uint64_t Power(uint64_t base, int exponent) {
  uint64_t power = base;
  for (int i = 1; i < exponent; ++i) power = Product(power, base);
  return power;
}

// The share of coefficients of at least a magnitude: 19 parts of a Laplacian distribution, and one
// part of another one whose scale is three times as large. In 1 / 2^32.
class Tail {
 public:
  Tail(uint64_t root, Rounding rounding)
      : narrow_ratio_(Power(root, 36)), wide_ratio_(Power(root, 12)) {
    // Magnitudes from 1/2 or 2/3 on do not become 0.
    narrow_.front() = Power(root, rounding == Rounding::kNearest ? 18 : 24);
    wide_.front() = Power(root, rounding == Rounding::kNearest ? 6 : 8);
    for (size_t m = 1; m < narrow_.size(); ++m) {
      narrow_[m] = Product(narrow_[m - 1], narrow_ratio_);
      wide_[m] = Product(wide_[m - 1], wide_ratio_);
    }
  }
  uint64_t From(int magnitude) const {
    return (19 * narrow_[magnitude - 1] + wide_[magnitude - 1]) / 20;
  }

 private:
  const uint64_t narrow_ratio_, wide_ratio_;
  std::array<uint64_t, kMostSymbol + 1> narrow_{}, wide_{};
};

void SetSlots(int symbol, int first, int count, bool is_escape, uint32_t* slots) {
  for (int i = 0; i < count; ++i)
    slots[first + i] = static_cast<uint32_t>(count) | static_cast<uint32_t>(i) << 12 |
                       static_cast<uint32_t>(is_escape) << 23 |
                       static_cast<uint32_t>(static_cast<uint8_t>(symbol)) << 24;
}

ScaleTable MadeTable(const Tail& tail, uint32_t* slots) {
  ScaleTable table;
  table.slots = slots;
  table.most = 1;
  // A magnitude with less than 3/4 of a slot for each sign belongs to the escape.
  constexpr uint64_t kLeastShare = (uint64_t{3} << 32) / (2 * kSlots);
  while (table.most < kMostSymbol &&
         tail.From(table.most) - tail.From(table.most + 1) >= kLeastShare)
    ++table.most;
  int left = kSlots;
  for (int m = 1; m <= table.most; ++m) {
    const uint64_t share = tail.From(m) - (m < table.most ? tail.From(m + 1) : 0);
    // Half of the share for each sign, to the nearest slot.
    table.count[m] =
        static_cast<uint16_t>(std::max<uint64_t>(1, (share * (kSlots / 2) + (1ULL << 31)) >> 32));
    left -= 2 * table.count[m];
  }
  LF_CHECK(left > 0);
  table.count[0] = static_cast<uint16_t>(left);
  int first = 0;
  for (int m = 0; m <= table.most; ++m) {
    table.first[m] = static_cast<uint16_t>(first);
    table.cost[m] =
        static_cast<uint16_t>(std::lround(256 * std::log2(double{kSlots} / table.count[m])));
    SetSlots(m, first, table.count[m], m == table.most, slots);
    if (m > 0) SetSlots(-m, first + table.count[m], table.count[m], m == table.most, slots);
    first += (m > 0 ? 2 : 1) * table.count[m];
  }
  return table;
}

const ScaleTables* MadeTables(Rounding rounding) {
  auto* const all = new ScaleTables;
  for (int i = 0; i <= kTables; ++i) {
    uint32_t* const slots = all->slots.data() + static_cast<size_t>(i) * kSlots;
    if (i < kTables) {
      all->tables[i] = MadeTable(Tail(kRoots[i], rounding), slots);
    } else {
      all->tables[i].slots = slots;
      SetSlots(0, 0, kSlots, false, slots);
    }
  }
  return all;
}

}  // namespace

const ScaleTables& TablesFor(Rounding rounding) {
  if (rounding == Rounding::kNearest) {
    static const ScaleTables* const kTablesForNearest = MadeTables(Rounding::kNearest);
    return *kTablesForNearest;
  }
  static const ScaleTables* const kTablesForDeadZone = MadeTables(Rounding::kDeadZone);
  return *kTablesForDeadZone;
}

}  // namespace lf
