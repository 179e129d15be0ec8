// SPDX-License-Identifier: Apache-2.0
// Decodes bands, compiled for every instruction set; the program chooses one at run time (Highway).
//
// A band is decoded row by row. While a row is decoded, the coefficients of a column of all strips
// are neighbours in memory: a cell holds a byte for each of 32 strips. Bands of 8 strips use every
// fourth byte. One vector of states belongs to every fourth strip.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "lf/pixels/codec/coefficient_coder.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE \
  "lf/pixels/codec/band_decoder_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE

template <class T>
bool DecodeBandOf(const CoefficientBand<T>& band, const Strips& strips, const BandScales& scales,
                  Coders* coders, PlainBits* plain) {
  return DecodeBandReference(band, strips, scales, coders, plain);
}

#else

using D128 = hn::FixedTag<uint8_t, 16>;
constexpr size_t kCell = kMostStrips;  // bytes of a cell
// Bytes that may be read or written beyond the cells or the row of parents.
constexpr size_t kRoom = 16 * kCell;
constexpr int kTurns = 4;  // vectors of states, one for each byte of 32 bits

// Byte shuffles for vectors of eight words of 16 bits, one for each set of lanes. A shuffle moves
// the first words into these lanes, in order. The other lanes get a word that is not used.
struct WordShuffles {
  HWY_ALIGN uint8_t bytes[256][16];

  WordShuffles() {
    for (size_t set = 0; set < 256; ++set) {
      size_t next = 0;
      for (size_t lane = 0; lane < 8; ++lane) {
        const size_t from = (set >> lane & 1) != 0 ? next++ : 0;
        bytes[set][2 * lane] = static_cast<uint8_t>(2 * from);
        bytes[set][2 * lane + 1] = static_cast<uint8_t>(2 * from + 1);
      }
    }
  }
};

// Memory that each thread keeps.
struct BandScratch {
  std::vector<uint8_t> above, above_two, here;  // activities of rows, with a cell before and behind
  std::vector<uint8_t> idle, sums, parents, symbols, scales;
  std::vector<uint8_t> parent_row;

  static BandScratch& OfThread() {
    static thread_local BandScratch scratch;
    return scratch;
  }
  void Prepare(size_t columns, int width) {
    const size_t size = (columns + 2) * kCell + kRoom;
    for (auto* const cells : {&above, &above_two, &here, &idle, &sums, &parents, &symbols, &scales})
      cells->assign(size, 0);
    parent_row.assign(static_cast<size_t>(width) + kRoom, 0);
  }
};

// Transposes 16 rows of 16 bytes.
HWY_INLINE void Transpose(const hn::Vec<D128> (&rows)[16], hn::Vec<D128> (&columns)[16]) {
  // Each step interleaves row i with row i + 8.
  hn::Vec<D128> other[16];
  const auto interleave = [](const hn::Vec<D128>(&from)[16], hn::Vec<D128>(&to)[16]) HWY_ATTR {
    for (int i = 0; i < 8; ++i) {
      to[2 * i] = hn::InterleaveLower(D128(), from[i], from[i + 8]);
      to[2 * i + 1] = hn::InterleaveUpper(D128(), from[i], from[i + 8]);
    }
  };
  interleave(rows, other);
  interleave(other, columns);
  interleave(columns, other);
  interleave(other, columns);
}

constexpr uint8_t kIdleSum = 255;  // stands for coders that have no column here

struct Escape {
  size_t cell;  // index of the byte in the cells of the row
  int32_t value;
};

//   kStrips  kMostStrips or 8
template <class T, int kStrips>
class BandDecoder {
 public:
  BandDecoder(const CoefficientBand<T>& band, const Strips& strips, const BandScales& scales,
              Coders* coders, PlainBits* plain)
      : band_(band),
        columns_(strips.columns),
        used_((band.width + strips.columns - 1) / strips.columns),
        weights_(WeightsOf(band.kind)),
        scales_(scales),
        tables_(TablesFor(scales.rounding)),
        coders_(*coders),
        plain_(*plain),
        scratch_(BandScratch::OfThread()) {
    scratch_.Prepare(columns_, band.width);
    // Strips and columns outside of the band are idle.
    for (int j = 0; j < columns_; ++j)
      for (size_t byte = 0; byte < kCell; ++byte) {
        const auto x = static_cast<int64_t>(byte / kBetween) * columns_ + j;
        if (byte % kBetween != 0 || x >= band.width) scratch_.idle[j * kCell + byte] = kIdleSum;
      }
    for (int level = 0; level < kLevels; ++level) {
      const int scale = scales.of_level[level];
      is_shifted_ |= ShiftOf(scale) > 0;
      const int begin = kLevelBegins[level];
      const int end = level + 1 < kLevels ? kLevelBegins[level + 1] : 128;
      for (int sum = begin; sum < std::min(end, 16); ++sum)
        low_scales_[sum] = static_cast<uint8_t>(scale);
      for (int sum = std::max(begin, 16); sum < end; sum += 8)
        high_scales_[sum / 8] = static_cast<uint8_t>(scale);
    }
    for (int i = 0; i < 16; ++i) {
      low_tables_[i] = static_cast<uint8_t>(TableOf(low_scales_[i]));
      high_tables_[i] = static_cast<uint8_t>(TableOf(high_scales_[i]));
      low_shifts_[i] = static_cast<uint8_t>(ShiftOf(low_scales_[i]));
      high_shifts_[i] = static_cast<uint8_t>(ShiftOf(high_scales_[i]));
    }
  }

  bool Decode() {
    for (int y = 0; y < band_.height; ++y) {
      if (y % 2 == 0) SetParents(y);
      SetSums();
      escapes_.clear();
      const bool is_whole = is_shifted_ ? DecodeRow<true>() : DecodeRow<false>();
      if (!is_whole) return false;
      T* const row = band_.values + static_cast<size_t>(y) * band_.width;
      if (is_shifted_) {
        if (!StoreShifted(row)) return false;
      } else {
        Store(row);
      }
      std::swap(scratch_.above_two, scratch_.above);
      std::swap(scratch_.above, scratch_.here);
    }
    return true;
  }

 private:
  using D8 = hn::CappedTag<uint8_t, kCell>;
  using D32 = hn::Repartition<uint32_t, D8>;
  static constexpr D8 d8{};
  static constexpr D32 d32{};
  static constexpr size_t kBytes = hn::MaxLanes(D8());
  static constexpr size_t kLanes = hn::MaxLanes(D32());
  static constexpr size_t kBlocks = kCell / kBytes;                   // vectors of a cell
  static constexpr size_t kBetween = kStrips == kMostStrips ? 1 : 4;  // bytes from strip to strip
  static constexpr int kUsedTurns = kStrips == kMostStrips ? kTurns : 1;

  static size_t ByteOf(int strip) { return static_cast<size_t>(strip) * kBetween; }

  // Makes cells of a row: cells[column * kCell + ByteOf(strip)] = row[strip * columns + column].
  void ToCells(const uint8_t* row, uint8_t* cells) const {
    hn::Vec<D128> rows[16], columns[16];
    for (int begin = 0; begin < columns_; begin += 16)
      for (size_t byte = 0; byte < kCell; byte += 16) {
        for (size_t i = 0; i < 16; ++i)
          rows[i] = i % kBetween == 0
                        ? hn::LoadU(D128(), row + (byte + i) / kBetween * columns_ + begin)
                        : hn::Zero(D128());
        Transpose(rows, columns);
        for (size_t i = 0; i < 16; ++i)
          hn::StoreU(columns[i], D128(), cells + (begin + i) * kCell + byte);
      }
  }

  // Sets the activities of the parents of two rows.
  void SetParents(int y) {
    if (band_.parent == nullptr || band_.parent_width == 0 || band_.parent_height == 0) return;
    const T* const parents =
        band_.parent +
        static_cast<size_t>(std::min(y / 2, band_.parent_height - 1)) * band_.parent_width;
    uint8_t* const row = scratch_.parent_row.data();
    const int whole = std::min(band_.width / 2, band_.parent_width);
    int i = 0;
    const hn::FixedTag<T, 16 / sizeof(T)> dt;
    const hn::RebindToUnsigned<decltype(dt)> du;
    const hn::Rebind<uint16_t, decltype(dt)> d_pair;
    if (scales_.quiet < static_cast<int>(8 * sizeof(T)))
      for (; i + static_cast<int>(hn::MaxLanes(dt)) <= whole; i += hn::MaxLanes(dt)) {
        const auto magnitude = hn::BitCast(du, hn::Abs(hn::LoadU(dt, parents + i)));
        const auto activity = hn::Min(hn::ShiftRightSame(magnitude, scales_.quiet),
                                      hn::Set(du, hn::TFromD<decltype(du)>{kMostActivity}));
        const auto twice = hn::Or(activity, hn::ShiftLeft<8>(activity));
        if constexpr (sizeof(T) == 2)
          hn::StoreU(twice, du, reinterpret_cast<uint16_t*>(row + 2 * i));
        else
          hn::StoreU(hn::DemoteTo(d_pair, hn::BitCast(dt, twice)), d_pair,
                     reinterpret_cast<uint16_t*>(row + 2 * i));
      }
    const auto activity = [&](T value) {
      const auto bits = static_cast<uint32_t>(int32_t{value});
      return static_cast<uint8_t>(ActivityOf(value < 0 ? 0U - bits : bits, scales_.quiet));
    };
    for (; i < whole; ++i) row[2 * i] = row[2 * i + 1] = activity(parents[i]);
    for (int x = 2 * whole; x < band_.width; ++x)
      row[x] = activity(parents[std::min(x / 2, band_.parent_width - 1)]);
    ToCells(row, scratch_.parents.data());
  }

  // Sets the parts of the sums that are known before a row is decoded: all but the left neighbours.
  void SetSums() {
    SetBorders(&scratch_.above);
    const uint8_t* const above = scratch_.above.data() + kCell;
    const uint8_t* const above_two = scratch_.above_two.data() + kCell;
    const uint8_t* const parents = scratch_.parents.data();
    const uint8_t* const idle = scratch_.idle.data();
    uint8_t* const sums = scratch_.sums.data();
    const size_t size = columns_ * kCell;
    for (size_t i = 0; i < size; i += kBytes) {
      const auto two = hn::LoadU(d8, above_two + i);
      auto sum = hn::Add(hn::LoadU(d8, parents + i), two);
      if (weights_.above_two == 2) sum = hn::Add(sum, two);
      sum =
          hn::Add(sum, hn::Add(hn::LoadU(d8, above + i - kCell), hn::LoadU(d8, above + i + kCell)));
      sum = hn::Add(sum, Times(weights_.above, hn::LoadU(d8, above + i)));
      hn::StoreU(hn::Or(sum, hn::LoadU(d8, idle + i)), d8, sums + i);
    }
  }

  // Sets the cells before and behind a row: the left neighbour of the first column of a strip is
  // the last column of the strip before it.
  void SetBorders(std::vector<uint8_t>* cells) const {
    uint8_t* const before = cells->data();
    uint8_t* const last = before + columns_ * kCell;
    uint8_t* const behind = last + kCell;
    const uint8_t* const first = before + kCell;
    std::fill_n(before, kCell, uint8_t{0});
    std::fill_n(behind, kCell, uint8_t{0});
    std::copy_n(last, kCell - kBetween, before + kBetween);
    std::copy_n(first + kBetween, kCell - kBetween, behind);
  }

  static HWY_INLINE hn::Vec<D8> Times(int weight, hn::Vec<D8> v) {
    return weight == 1 ? v : weight == 2 ? hn::Add(v, v) : hn::Add(v, hn::Add(v, v));
  }

  // Decodes the cells of a row: symbols, activities and scales, and the escapes unless kShifted is
  // true. kShifted is true if coefficients of any level lose their lowest bits.
  template <bool kShifted>
  bool DecodeRow() {
    const auto* const slots = reinterpret_cast<const int32_t*>(tables_.slots.data());
    const uint8_t* words = reinterpret_cast<const uint8_t*>(coders_.words.data());
    const uint8_t* const end = words + coders_.words.size();
    const uint8_t* const sums = scratch_.sums.data();
    uint8_t* const activities = scratch_.here.data() + kCell;
    uint8_t* const symbols = scratch_.symbols.data();
    uint8_t* const used_scales = scratch_.scales.data();

    hn::Vec<D32> states[kUsedTurns][kBlocks];
    for (int turn = 0; turn < kUsedTurns; ++turn)
      for (size_t b = 0; b < kBlocks; ++b)
        states[turn][b] = hn::LoadU(d32, coders_.states.data() + 8 * turn + kLanes * b);
    hn::Vec<D8> left[kBlocks];  // weighted activities
    const uint8_t* const above = scratch_.above.data() + kCell;
    for (size_t b = 0; b < kBlocks; ++b)
      left[b] = Times(weights_.left, hn::LoadU(d8, above + b * kBytes));

    const auto low = hn::LoadDup128(d8, low_tables_.data());
    const auto high = hn::LoadDup128(d8, high_tables_.data());
    const auto low_scales = hn::LoadDup128(d8, low_scales_.data());
    const auto high_scales = hn::LoadDup128(d8, high_scales_.data());
    const auto low_shifts = hn::LoadDup128(d8, low_shifts_.data());
    const auto high_shifts = hn::LoadDup128(d8, high_shifts_.data());
    const auto slot_mask = hn::Set(d32, uint32_t{kSlots - 1});
    const auto quiet_mask = hn::Set(d8, static_cast<uint8_t>(0xff >> std::min(scales_.quiet, 7)));
    const int quiet = std::min(scales_.quiet, 7);

    for (int j = 0; j < columns_; ++j) {
      hn::Vec<D32> slot[kUsedTurns][kBlocks];
      auto any = hn::Zero(d32);  // bits that are set in any slot
      for (size_t b = 0; b < kBlocks; ++b) {
        // The tables of a cell.
        const size_t at = j * kCell + b * kBytes;
        const auto known = hn::LoadU(d8, sums + at);
        const auto sum = hn::Min(hn::Add(known, left[b]), hn::Set(d8, uint8_t{kMostSum}));
        const auto eighth = hn::And(hn::BitCast(d8, hn::ShiftRight<3>(hn::BitCast(d16, sum))),
                                    hn::Set(d8, uint8_t{15}));
        const auto is_low = hn::Lt(sum, hn::Set(d8, uint8_t{16}));
        const auto is_idle = hn::Eq(known, hn::Set(d8, kIdleSum));
        const auto lowest = hn::Min(sum, hn::Set(d8, uint8_t{15}));
        auto table = hn::IfThenElse(is_low, hn::TableLookupBytes(low, lowest),
                                    hn::TableLookupBytes(high, eighth));
        table = hn::IfThenElse(is_idle, hn::Set(d8, uint8_t{kIdle}), table);
        if (kShifted)
          hn::StoreU(hn::IfThenElse(is_low, hn::TableLookupBytes(low_scales, lowest),
                                    hn::TableLookupBytes(high_scales, eighth)),
                     d8, used_scales + at);
        else
          hn::StoreU(table, d8, used_scales + at);
        // The slots of the states in these tables.
        const auto of_table = hn::Set(d32, uint32_t{0xff << kSlotBits});
        const auto tables = hn::BitCast(d32, table);
        const auto look_up = [&](int turn, hn::Vec<D32> begin) HWY_ATTR {
          const auto index = hn::Or(begin, hn::And(states[turn][b], slot_mask));
          slot[turn][b] = hn::BitCast(d32, hn::GatherIndex(di32, slots, hn::BitCast(di32, index)));
          any = hn::Or(any, slot[turn][b]);
        };
        look_up(0, hn::And(hn::ShiftLeft<kSlotBits>(tables), of_table));
        if constexpr (kUsedTurns > 1) {
          look_up(1, hn::And(hn::ShiftLeft<kSlotBits - 8>(tables), of_table));
          look_up(2, hn::And(hn::ShiftRight<16 - kSlotBits>(tables), of_table));
          look_up(3, hn::And(hn::ShiftRight<24 - kSlotBits>(tables), of_table));
        }
        // The symbols as bytes, and their activities.
        auto packed = hn::ShiftRight<24>(slot[0][b]);
        if constexpr (kUsedTurns > 1) {
          packed = hn::Or(packed, hn::And(hn::ShiftRight<16>(slot[1][b]), hn::Set(d32, 0xff00u)));
          packed = hn::Or(packed, hn::And(hn::ShiftRight<8>(slot[2][b]), hn::Set(d32, 0xff0000u)));
          packed = hn::Or(packed, hn::And(slot[3][b], hn::Set(d32, 0xff000000u)));
        }
        const auto symbol = hn::BitCast(d8, packed);
        hn::StoreU(symbol, d8, symbols + at);
        auto magnitude = hn::BitCast(d8, hn::Abs(hn::BitCast(di8, symbol)));
        if (kShifted) {
          const auto shift = hn::IfThenElse(is_low, hn::TableLookupBytes(low_shifts, lowest),
                                            hn::TableLookupBytes(high_shifts, eighth));
          magnitude = ShiftedActivity(magnitude, shift);
        } else if (quiet > 0) {
          magnitude = hn::And(
              hn::BitCast(d8, hn::ShiftRightSame(hn::BitCast(d16, magnitude), quiet)), quiet_mask);
        }
        const auto activity = hn::Min(magnitude, hn::Set(d8, uint8_t{kMostActivity}));
        hn::StoreU(activity, d8, activities + at);
        left[b] = Times(weights_.left, activity);
      }
      for (int turn = 0; turn < kUsedTurns; ++turn)
        for (size_t b = 0; b < kBlocks; ++b)
          states[turn][b] = NextState(states[turn][b], slot[turn][b], &words);
      const auto escapes = hn::And(any, hn::Set(d32, 1u << 23));
      if (!kShifted && !hn::AllTrue(d32, hn::Eq(escapes, hn::Zero(d32))) && !TakeEscapes(j, slot))
        return false;
    }
    for (int turn = 0; turn < kUsedTurns; ++turn)
      for (size_t b = 0; b < kBlocks; ++b)
        hn::StoreU(states[turn][b], d32, coders_.states.data() + 8 * turn + kLanes * b);
    if (words > end) return false;
    coders_.words.remove_prefix(coders_.words.size() - (end - words));
    return true;
  }

  // Returns the states after a symbol, which take the next words if they have become too small.
  static HWY_INLINE hn::Vec<D32> NextState(hn::Vec<D32> state, hn::Vec<D32> slot,
                                           const uint8_t** words) {
    static const WordShuffles kShuffles;
    const auto count = hn::And(slot, hn::Set(d32, 0xfffu));
    const auto place = hn::And(hn::ShiftRight<12>(slot), hn::Set(d32, 0x7ffu));
    const auto moved = hn::Add(hn::Mul(count, hn::ShiftRight<kSlotBits>(state)), place);
    const auto is_small =
        hn::Lt(hn::BitCast(di32, moved), hn::Set(di32, static_cast<int32_t>(kLeastState)));
    uint8_t set[8] = {};
    hn::StoreMaskBits(di32, is_small, set);
    const hn::FixedTag<uint16_t, 8> d_words;
    const auto shuffled =
        hn::TableLookupBytes(hn::LoadU(D128(), *words), hn::Load(D128(), kShuffles.bytes[set[0]]));
    *words += 2 * std::popcount(set[0]);
    const auto next = WidenWords(hn::BitCast(d_words, shuffled));
    return hn::IfThenElse(hn::RebindMask(d32, is_small), hn::Or(hn::ShiftLeft<16>(moved), next),
                          moved);
  }

  template <class Words>
  static HWY_INLINE hn::Vec<D32> WidenWords(Words words) {
    if constexpr (hn::MaxLanes(hn::Repartition<uint32_t, hn::DFromV<Words>>()) < kLanes)
      return hn::PromoteTo(d32, words);
    else
      return hn::PromoteTo(d32, hn::LowerHalf(words));
  }

  // Returns the activities of coefficients that have lost `shift` lowest bits.
  HWY_INLINE hn::Vec<D8> ShiftedActivity(hn::Vec<D8> magnitude, hn::Vec<D8> shift) const {
    const auto byte = hn::Set(d32, 0xffu);
    const auto magnitudes = hn::BitCast(d32, magnitude), shifts = hn::BitCast(d32, shift);
    const auto of_turn = [&](hn::Vec<D32> m, hn::Vec<D32> s) HWY_ATTR {
      return hn::Min(hn::ShiftRightSame(hn::Shl(hn::And(m, byte), hn::And(s, byte)), scales_.quiet),
                     hn::Set(d32, uint32_t{kMostActivity}));
    };
    auto packed = of_turn(magnitudes, shifts);
    if constexpr (kUsedTurns > 1) {
      packed = hn::Or(packed, hn::ShiftLeft<8>(of_turn(hn::ShiftRight<8>(magnitudes),
                                                       hn::ShiftRight<8>(shifts))));
      packed = hn::Or(packed, hn::ShiftLeft<16>(of_turn(hn::ShiftRight<16>(magnitudes),
                                                        hn::ShiftRight<16>(shifts))));
      packed = hn::Or(packed, hn::ShiftLeft<24>(of_turn(hn::ShiftRight<24>(magnitudes),
                                                        hn::ShiftRight<24>(shifts))));
    }
    return hn::BitCast(d8, packed);
  }

  // Reads the plain bits of the escapes in a cell.
  bool TakeEscapes(int j, const hn::Vec<D32> (&slot)[kUsedTurns][kBlocks]) {
    HWY_ALIGN uint32_t lanes[kMostStrips];
    for (int turn = 0; turn < kUsedTurns; ++turn)
      for (size_t b = 0; b < kBlocks; ++b)
        hn::StoreU(slot[turn][b], d32, lanes + 8 * turn + kLanes * b);
    for (int turn = 0; turn < kStrips; ++turn) {
      if (!IsEscape(lanes[turn])) continue;
      const size_t cell = j * kCell + ByteOf(StripInTurn(turn, kStrips));
      int32_t value = 0;
      if (!TakeRest(lanes[turn], scratch_.scales[cell], &plain_, &value)) return false;
      escapes_.push_back({cell, value});
    }
    return true;
  }

  // Moves the symbols of a row into the band. Writes up to 15 values more behind each strip. They
  // are overwritten later: by the following strips, of which the first columns are written last, by
  // the next row, or by the next band.
  void Store(T* row) const {
    const uint8_t* const symbols = scratch_.symbols.data();
    hn::Vec<D128> cells[16], strips[16];
    for (int begin = (columns_ - 1) / 16 * 16; begin >= 0; begin -= 16)
      for (size_t byte = 0; byte < kCell; byte += 16) {
        for (size_t i = 0; i < 16; ++i)
          cells[i] = hn::LoadU(D128(), symbols + (begin + i) * kCell + byte);
        Transpose(cells, strips);
        for (size_t i = 0; i < 16; i += kBetween) {
          const auto strip = static_cast<int>((byte + i) / kBetween);
          if (strip < used_) StoreWide(strips[i], row + strip * columns_ + begin);
        }
      }
    for (const Escape& escape : escapes_) row[PlaceOf(escape.cell)] = static_cast<T>(escape.value);
  }
  static HWY_INLINE void StoreWide(hn::Vec<D128> bytes, T* out) {
    const hn::CappedTag<T, 16> d;
    const hn::Rebind<int8_t, decltype(d)> d_bytes;
    HWY_ALIGN int8_t symbols[16];
    hn::Store(bytes, D128(), reinterpret_cast<uint8_t*>(symbols));
    for (size_t i = 0; i < 16; i += hn::MaxLanes(d))
      hn::StoreU(hn::PromoteTo(d, hn::LoadU(d_bytes, symbols + i)), d, out + i);
  }
  size_t PlaceOf(size_t cell) const { return cell % kCell / kBetween * columns_ + cell / kCell; }

  // Stores coefficients that have lost their lowest bits, and reads these. Returns false if the
  // plain bits end early.
  bool StoreShifted(T* row) {
    for (int j = 0; j < columns_; ++j)
      for (int turn = 0; turn < kStrips; ++turn) {
        const int strip = StripInTurn(turn, kStrips), x = strip * columns_ + j;
        if (x >= band_.width) continue;
        const size_t cell = j * kCell + ByteOf(strip);
        const int scale = scratch_.scales[cell];
        const int symbol = static_cast<int8_t>(scratch_.symbols[cell]);
        const bool is_escape = std::abs(symbol) == tables_.of(scale).most;
        const uint32_t slot = static_cast<uint32_t>(static_cast<uint8_t>(symbol)) << 24 |
                              static_cast<uint32_t>(is_escape) << 23;
        int32_t value = 0;
        if (!TakeRest(slot, scale, &plain_, &value)) return false;
        row[x] = static_cast<T>(value);
      }
    return true;
  }

  static constexpr hn::RebindToSigned<D8> di8{};
  static constexpr hn::RebindToSigned<D32> di32{};
  static constexpr hn::Repartition<uint16_t, D8> d16{};

  const CoefficientBand<T>& band_;
  const int columns_;
  const int used_;  // number of strips that have columns
  const NeighbourWeights weights_;
  const BandScales& scales_;
  const ScaleTables& tables_;
  Coders& coders_;
  PlainBits& plain_;
  BandScratch& scratch_;
  bool is_shifted_ = false;
  // Scales and tables of sums: below 16, and from 16 on, of an eighth of the sum.
  alignas(16) std::array<uint8_t, 16> low_scales_{}, high_scales_{}, low_tables_{}, high_tables_{},
      low_shifts_{}, high_shifts_{};
  std::vector<Escape> escapes_;
};

template <class T>
bool DecodeBandOf(const CoefficientBand<T>& band, const Strips& strips, const BandScales& scales,
                  Coders* coders, PlainBits* plain) {
  return strips.count == kMostStrips
             ? BandDecoder<T, kMostStrips>(band, strips, scales, coders, plain).Decode()
             : BandDecoder<T, 8>(band, strips, scales, coders, plain).Decode();
}

#endif

bool DecodeBand16(const CoefficientBand<int16_t>& band, const Strips& strips,
                  const BandScales& scales, Coders* coders, PlainBits* plain) {
  return DecodeBandOf(band, strips, scales, coders, plain);
}
bool DecodeBand32(const CoefficientBand<int32_t>& band, const Strips& strips,
                  const BandScales& scales, Coders* coders, PlainBits* plain) {
  return DecodeBandOf(band, strips, scales, coders, plain);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(DecodeBand16);
HWY_EXPORT(DecodeBand32);

template <>
bool DecodeBandSimd(const CoefficientBand<int16_t>& band, const Strips& strips,
                    const BandScales& scales, Coders* coders, PlainBits* plain) {
  return HWY_DYNAMIC_DISPATCH(DecodeBand16)(band, strips, scales, coders, plain);
}
template <>
bool DecodeBandSimd(const CoefficientBand<int32_t>& band, const Strips& strips,
                    const BandScales& scales, Coders* coders, PlainBits* plain) {
  return HWY_DYNAMIC_DISPATCH(DecodeBand32)(band, strips, scales, coders, plain);
}

}  // namespace lf
#endif  // HWY_ONCE
