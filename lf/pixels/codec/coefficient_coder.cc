// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/coefficient_coder.h"

#include <algorithm>

#include "lf/pixels/codec/band_activities.h"
#include "lf/pixels/codec/entropy.h"

namespace lf {

bool PacketReader::Begin(Transform transform, std::string_view packet, int component_count,
                         int strip_count, Rounding rounding) {
  transform_ = transform;
  strip_count_ = strip_count;
  rounding_ = rounding;
  coders_ = {};
  plain_ = PlainBits();
  if (!TakeBytes(&packet, component_count, &flags_)) return false;
  if (std::all_of(flags_.begin(), flags_.end(), [](char flag) { return flag == 0; }))
    return packet.empty();
  uint64_t word_count = 0;
  if (!TakeNumber(&packet, packet.size() / 2, &word_count)) return false;
  std::string_view states;
  if (!TakeBytes(&packet, size_t{4} * strip_count, &states)) return false;
  for (int turn = 0; turn < strip_count; ++turn) {
    for (int i = 0; i < 4; ++i)
      coders_.states[turn] |= uint32_t{static_cast<uint8_t>(states[4 * turn + i])} << (8 * i);
    if (coders_.states[turn] < kLeastState || coders_.states[turn] >> 16 >= kLeastState)
      return false;
  }
  std::string_view words;
  if (!TakeBytes(&packet, 2 * word_count, &words)) return false;
  words_.reserve(words.size() + kWordRoom);
  words_.assign(words);
  words_.append(kWordRoom, '\0');
  coders_.words = std::string_view(words_).substr(0, words.size());
  plain_ = PlainBits(packet);
  return true;
}

bool PacketReader::TakeScales(BandScales* scales) {
  const ScaleTable& table = TablesFor(Rounding::kNearest).of(kScaleOfDifferences);
  const auto take = [&](int32_t* value) {
    uint32_t slot = 0;
    return TakeSymbol(table, 0, &coders_, &slot) &&
           TakeRest(slot, kScaleOfDifferences, &plain_, value);
  };
  *scales = {rounding_, 0, {}};
  int32_t difference = 0;
  if (!take(&scales->quiet) || scales->quiet < 0 || scales->quiet > kMostQuiet) return false;
  for (int level = 0; level < kLevels; ++level) {
    int32_t change = 0;
    if (!take(&change) || change < -kScales || change > kScales) return false;
    difference += change;
    const int scale = kUsualScales[level] + difference;
    if (scale < 0 || scale >= kScales) return false;
    scales->of_level[level] = static_cast<uint8_t>(scale);
  }
  return true;
}

template <class T>
bool PacketReader::Take(std::span<const CoefficientBand<T>> bands) {
  if (flags_.empty()) return false;
  const auto flag = static_cast<uint8_t>(flags_.front());
  flags_.remove_prefix(1);
  if (flag >> bands.size() != 0) return false;
  for (size_t i = 0; i < bands.size(); ++i) {
    const CoefficientBand<T>& band = bands[i];
    const size_t count = static_cast<size_t>(band.width) * band.height;
    if ((flag >> i & 1) == 0 || count == 0) {
      if ((flag >> i & 1) != 0) return false;
      std::fill_n(band.values, count, T{0});
      continue;
    }
    BandScales scales;
    if (!TakeScales(&scales)) return false;
    const Strips strips = StripsOf(strip_count_, band.width);
    const bool is_whole = transform_ == Transform::kReference || strip_count_ == 1
                              ? DecodeBandReference(band, strips, scales, &coders_, &plain_)
                              : DecodeBandSimd(band, strips, scales, &coders_, &plain_);
    if (!is_whole) return false;
  }
  return true;
}
template bool PacketReader::Take(std::span<const CoefficientBand<int16_t>>);
template bool PacketReader::Take(std::span<const CoefficientBand<int32_t>>);

bool PacketReader::IsAtEnd() const {
  return flags_.empty() && coders_.words.empty() && plain_.is_at_end() &&
         std::all_of(coders_.states.begin(), coders_.states.end(),
                     [](uint32_t state) { return state == 0 || state == kLeastState; });
}

template <class T>
bool DecodeBandReference(const CoefficientBand<T>& band, const Strips& strips,
                         const BandScales& scales, Coders* coders, PlainBits* plain) {
  const ScaleTables& tables = TablesFor(scales.rounding);
  BandActivities<T> activities(band, strips, scales.quiet);
  for (int y = 0; y < band.height; ++y) {
    activities.BeginRow(y);
    for (int column = 0; column < strips.columns; ++column)
      for (int turn = 0; turn < strips.count; ++turn) {
        const int x = StripInTurn(turn, strips.count) * strips.columns + column;
        if (x >= band.width) continue;
        const int scale = scales.of_level[activities.Level(x)];
        uint32_t slot = 0;
        int32_t value = 0;
        if (!TakeSymbol(tables.of(scale), turn, coders, &slot) ||
            !TakeRest(slot, scale, plain, &value))
          return false;
        activities.Set(x, MagnitudeOf(SymbolOf(slot), ShiftOf(scale)));
        band.values[static_cast<size_t>(y) * band.width + x] = static_cast<T>(value);
      }
  }
  return true;
}
template bool DecodeBandReference(const CoefficientBand<int16_t>&, const Strips&, const BandScales&,
                                  Coders*, PlainBits*);
template bool DecodeBandReference(const CoefficientBand<int32_t>&, const Strips&, const BandScales&,
                                  Coders*, PlainBits*);

}  // namespace lf
