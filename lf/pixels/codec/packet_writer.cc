// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "lf/pixels/codec/band_activities.h"
#include "lf/pixels/codec/coefficient_coder.h"
#include "lf/pixels/codec/entropy.h"

namespace lf {
namespace {

using ValueBand = CoefficientBand<const int32_t>;

uint32_t Magnitude(int32_t value) {
  return value < 0 ? 0U - static_cast<uint32_t>(value) : static_cast<uint32_t>(value);
}

// Counts of the magnitudes of the coefficients of a level: each magnitude up to kExact, and classes
// of larger ones that are half an octave wide.
class Magnitudes {
 public:
  void Add(uint32_t magnitude) {
    ++counts_[magnitude < kExact ? magnitude : ClassOf(magnitude)];
    sum_ += magnitude;
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  double Mean() const { return static_cast<double>(sum_) / static_cast<double>(count_); }

  // Returns the number of 1/256 bits that the coefficients cost with a scale.
  uint64_t Cost(int scale, const ScaleTable& table) const {
    const int shift = ShiftOf(scale);
    uint64_t cost = count_ * 256 * shift;
    for (int bin = 0; bin < kBins; ++bin) {
      if (counts_[bin] == 0) continue;
      const uint64_t magnitude = bin < kExact ? bin : MiddleOf(bin);
      const uint64_t symbol = (magnitude + (uint64_t{1} << shift >> 1)) >> shift;
      const uint64_t most = table.most;
      uint64_t of_one = table.cost[std::min(symbol, most)];
      if (symbol >= most) of_one += 256 * (2 * std::bit_width(symbol - most + 1) - 1);
      cost += counts_[bin] * of_one;
    }
    return cost;
  }

 private:
  static constexpr int kExactBits = 7, kExact = 1 << kExactBits;
  static constexpr int kBins = kExact + 2 * (33 - kExactBits);
  static int ClassOf(uint32_t magnitude) {
    const int octave = std::bit_width(magnitude) - 1;
    return kExact + 2 * (octave - kExactBits) + static_cast<int>(magnitude >> (octave - 1) & 1);
  }
  static uint64_t MiddleOf(int bin) {
    const int octave = (bin - kExact) / 2 + kExactBits;
    return (uint64_t{5} + 2 * ((bin - kExact) % 2)) << octave >> 2;
  }

  std::array<uint32_t, kBins> counts_{};
  uint64_t sum_ = 0, count_ = 0;
};

// Returns the largest BandScales::quiet with which most activities are not 0.
int MostQuietOf(const ValueBand& band) {
  constexpr uint64_t kUsualMagnitude = 5;
  const size_t count = static_cast<size_t>(band.width) * band.height;
  uint64_t sum = 0;
  for (size_t i = 0; i < count; ++i) sum += Magnitude(band.values[i]);
  return std::min<int>(kMostQuiet, std::bit_width(sum / count / kUsualMagnitude));
}

using MagnitudesOfLevels = std::array<Magnitudes, kLevels>;

MagnitudesOfLevels CountedMagnitudes(const ValueBand& band, const Strips& strips, int quiet) {
  MagnitudesOfLevels magnitudes;
  BandActivities<const int32_t> activities(band, strips, quiet);
  for (int y = 0; y < band.height; ++y) {
    activities.BeginRow(y);
    const int32_t* const row = band.values + static_cast<size_t>(y) * band.width;
    for (int x = 0; x < band.width; ++x) {
      const uint32_t magnitude = Magnitude(row[x]);
      magnitudes[activities.Level(x)].Add(magnitude);
      activities.Set(x, magnitude);
    }
  }
  return magnitudes;
}

struct ScaleChoice {
  BandScales scales;
  uint64_t cost = 0;  // in 1/256 bit
};

// Chooses the scale of each level so that its coefficients, and the scale itself, cost the fewest
// bits.
ScaleChoice ChosenScales(const MagnitudesOfLevels& magnitudes, Rounding rounding, int quiet) {
  const ScaleTables& tables = TablesFor(rounding);
  const ScaleTable& of_differences = TablesFor(Rounding::kNearest).of(kScaleOfDifferences);
  ScaleChoice choice{{rounding, quiet, {}}, 0};
  int difference = 0;
  for (int level = 0; level < kLevels; ++level) {
    int best = std::clamp(kUsualScales[level] + difference, 0, kScales - 1);
    if (!magnitudes[level].empty()) {
      // The best scale is near the mean magnitude.
      constexpr int kReach = 6;
      const double octaves = std::log2(std::max(magnitudes[level].Mean(), 1e-3));
      const int middle =
          std::clamp(static_cast<int>(std::lround(4 * (octaves + 4.5))), 0, kScales - 1);
      uint64_t least = UINT64_MAX;
      for (int scale = std::max(0, middle - kReach);
           scale <= std::min(kScales - 1, middle + kReach); ++scale) {
        const int change = std::abs(scale - kUsualScales[level] - difference);
        const uint64_t cost = magnitudes[level].Cost(scale, tables.of(scale)) +
                              of_differences.cost[std::min(change, of_differences.most)] +
                              256 * (change / 8);
        if (cost < least) {
          least = cost;
          best = scale;
        }
      }
      choice.cost += least;
    }
    difference = best - kUsualScales[level];
    choice.scales.of_level[level] = static_cast<uint8_t>(best);
  }
  return choice;
}

BandScales ScalesOf(const ValueBand& band, const Strips& strips, Rounding rounding) {
  ScaleChoice best{{}, UINT64_MAX};
  for (int quiet = MostQuietOf(band); quiet >= 0; --quiet) {
    const ScaleChoice choice =
        ChosenScales(CountedMagnitudes(band, strips, quiet), rounding, quiet);
    // Activities that are finer by more than two bits than the best ones are hardly ever better.
    if (choice.cost < best.cost)
      best = choice;
    else if (quiet + 2 < best.scales.quiet)
      break;
  }
  return best.scales;
}

}  // namespace

void PacketWriter::AppendBits(uint32_t bits, int count) {
  pending_ |= uint64_t{bits} << pending_count_;
  pending_count_ += count;
  for (; pending_count_ >= 8; pending_count_ -= 8, pending_ >>= 8)
    plain_.push_back(static_cast<char>(pending_));
}

int PacketWriter::AppendValue(int32_t value, const ScaleTable& table, int shift, int turn) {
  const int64_t moved = int64_t{value} + (int64_t{1} << shift >> 1);
  const int64_t whole = moved >> shift;
  const auto magnitude = static_cast<uint32_t>(std::abs(whole));
  const auto coded = static_cast<int>(std::min<uint32_t>(magnitude, table.most));
  const bool is_negative = whole < 0;
  coded_.push_back(
      {static_cast<uint16_t>(table.first[coded] + (is_negative ? table.count[coded] : 0)),
       table.count[coded], static_cast<uint8_t>(turn)});
  if (coded == table.most) {
    const uint32_t beyond = magnitude - table.most + 1;
    const int length = static_cast<int>(std::bit_width(beyond)) - 1;
    AppendBits(0, length);
    AppendBits(1, 1);
    AppendBits(beyond & ((1U << length) - 1), length);
  }
  if (shift > 0) AppendBits(static_cast<uint32_t>(moved & ((int64_t{1} << shift) - 1)), shift);
  return is_negative ? -coded : coded;
}

void PacketWriter::AppendBand(const ValueBand& band) {
  const Strips strips = StripsOf(strip_count_, band.width);
  const BandScales scales = ScalesOf(band, strips, rounding_);
  const ScaleTable& of_differences = TablesFor(Rounding::kNearest).of(kScaleOfDifferences);
  AppendValue(scales.quiet, of_differences, 0, 0);
  for (int level = 0, before = 0; level < kLevels; ++level) {
    const int difference = scales.of_level[level] - kUsualScales[level];
    AppendValue(difference - before, of_differences, 0, 0);
    before = difference;
  }
  const ScaleTables& tables = TablesFor(rounding_);
  std::array<int, kMostStrips> begins{};  // first column of the strip of each turn
  for (int turn = 0; turn < strips.count; ++turn)
    begins[turn] = StripInTurn(turn, strips.count) * strips.columns;
  BandActivities<const int32_t> activities(band, strips, scales.quiet);
  for (int y = 0; y < band.height; ++y) {
    activities.BeginRow(y);
    const int32_t* const row = band.values + static_cast<size_t>(y) * band.width;
    for (int column = 0; column < strips.columns; ++column)
      for (int turn = 0; turn < strips.count; ++turn) {
        const int x = begins[turn] + column;
        if (x >= band.width) continue;
        const int scale = scales.of_level[activities.Level(x)], shift = ShiftOf(scale);
        const int symbol = AppendValue(row[x], tables.of(scale), shift, turn);
        activities.Set(x, MagnitudeOf(symbol, shift));
      }
  }
}

void PacketWriter::Append(std::span<const ValueBand> bands) {
  uint8_t flags = 0;
  for (size_t i = 0; i < bands.size(); ++i) {
    const int32_t* const values = bands[i].values;
    const size_t count = static_cast<size_t>(bands[i].width) * bands[i].height;
    if (std::all_of(values, values + count, [](int32_t value) { return value == 0; })) continue;
    flags |= static_cast<uint8_t>(1U << i);
    AppendBand(bands[i]);
  }
  flags_.push_back(static_cast<char>(flags));
}

std::string PacketWriter::Packet() {
  if (coded_.empty()) return flags_;
  // The coder works backwards: the decoder finds the last word first.
  std::array<uint32_t, kMostStrips> states;
  states.fill(kLeastState);
  std::string words;  // from the last to the first, the higher byte of each first
  for (size_t i = coded_.size(); i-- > 0;) {
    const Coded& coded = coded_[i];
    uint32_t& state = states[coded.turn];
    if (state >= uint64_t{coded.count} << (31 - kSlotBits)) {
      words.push_back(static_cast<char>(state >> 8));
      words.push_back(static_cast<char>(state));
      state >>= 16;
    }
    state = (state / coded.count << kSlotBits) + state % coded.count + coded.first;
  }
  std::reverse(words.begin(), words.end());
  if (pending_count_ > 0) AppendBits(0, 8 - pending_count_);
  std::string packet = flags_;
  AppendNumber(words.size() / 2, &packet);
  for (int turn = 0; turn < strip_count_; ++turn)
    for (int i = 0; i < 4; ++i) packet.push_back(static_cast<char>(states[turn] >> (8 * i)));
  return packet + words + plain_;
}

}  // namespace lf
