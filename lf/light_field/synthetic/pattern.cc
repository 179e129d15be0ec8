// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/pattern.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

double LatticeValue(int64_t x, int64_t y, uint64_t seed) {
  const uint64_t place = static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                         static_cast<uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL;
  return static_cast<double>(MixBits(place ^ seed) >> 40) * 0x1.0p-24;
}

// The baseline instruction set has no floor(), and calls of it would take half of a texture's time.
double Floor(double t) {
  const auto cut = static_cast<double>(static_cast<int64_t>(t));
  return cut > t ? cut - 1 : cut;
}

// Returns a sine-like wave of period 1 between -1 and 1, made of two parabolas.
double Wave(double t) {
  const double phase = t - Floor(t) - 0.5;
  return 16 * phase * (std::abs(phase) - 0.5);
}

double SmoothStep(double t) { return t * t * (3 - 2 * t); }

// Returns the contrast that a wave of period 1 keeps when averaged over `width`: 1 for width 0, 0
// for widths of one period and more.
double Contrast(double width) {
  const double rest = std::max(0.0, 1 - width * width);
  return rest * rest;
}

// Returns the square wave that is +1 on [0, 1/2) and -1 on [1/2, 1), averaged over `width`. The
// mean is the difference of the wave's integral (a triangle wave) at both ends of the interval,
// divided by `width`.
double SquareWave(double x, double width) {
  const auto integral = [](double t) { return 0.5 - std::abs(t - Floor(t) - 0.5); };
  constexpr double kNarrow = 1e-6;  // for smaller widths the difference is rounding noise
  if (width < kNarrow) return x - Floor(x) < 0.5 ? 1 : -1;
  return std::clamp((integral(x + width / 2) - integral(x - width / 2)) / width, -1.0, 1.0);
}

double Checker(const Pattern& pattern, const Vec2& place_w, double width_w) {
  const double period_w = 2 * pattern.scale_w;
  return 0.5 + 0.5 * SquareWave(place_w.x() / period_w, width_w / period_w) *
                   SquareWave(place_w.y() / period_w, width_w / period_w);
}

// The row at height v of a table of letters or bars. A row is 1.5 times as high as its letters, and
// 4/5 as high as the row above. The top edge is v = 0; v increases upwards, so that rows have
// negative v.
struct ShrinkingRow {
  int index = 0;
  double letter_w = 0;  // height of the row's letters
  double down = 0;      // 0 at the top of a letter, 1 at its bottom; below 0 or above 1 in a gap
};
constexpr int kRowCount = 12;

ShrinkingRow RowAt(double v_w, double letter_w) {
  double top_w = 0;
  ShrinkingRow row{0, letter_w, -1};
  for (; row.index < kRowCount; ++row.index, row.letter_w *= 0.8) {
    const double down = (top_w - v_w) / row.letter_w;
    if (down < 0) return row;
    row.down = down;
    if (down < 1.5) return row;
    top_w -= 1.5 * row.letter_w;
  }
  row.down = -1;
  return row;
}

double Bars(const Pattern& pattern, const Vec2& place_w, double width_w) {
  const ShrinkingRow row = RowAt(place_w.y(), 5 * pattern.scale_w);
  if (row.down < 0 || row.down > 1) return 0;
  const double period_w = 2 * row.letter_w / 5;
  return 0.5 + 0.5 * SquareWave(place_w.x() / period_w, width_w / period_w);
}

// The 3 x 5 dots of each digit as bits: rows from the top, in each row the left dot first.
constexpr std::array<uint16_t, 10> kDigits = {
    0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111,
    0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'010'010'010,
    0b111'101'111'101'111, 0b111'101'111'001'111};

double Letters(const Pattern& pattern, const Vec2& place_w) {
  const ShrinkingRow row = RowAt(place_w.y(), pattern.scale_w);
  if (row.down < 0 || row.down >= 1) return 0;
  const double across = place_w.x() / row.letter_w * 5;  // in dots; a digit is 3 wide, a gap 1
  const double cell = Floor(across / 4);
  const int dot_x = static_cast<int>(across - 4 * cell);
  if (dot_x >= 3) return 0;
  const int dot_y = std::min(4, static_cast<int>(row.down * 5));
  const uint64_t digit = RandomBits(pattern.seed, static_cast<uint64_t>(row.index),
                                    static_cast<uint64_t>(static_cast<int64_t>(cell))) %
                         kDigits.size();
  return (kDigits[digit] >> (14 - 3 * dot_y - dot_x)) & 1;
}

double Star(const Pattern& pattern, const Vec2& place_w, double width_w) {
  constexpr double kPeriods = 36;
  const double radius_w = place_w.norm();
  if (radius_w > pattern.scale_w) return 0;
  const double angle = std::atan2(place_w.y(), place_w.x());
  const double periods_in_width = width_w * kPeriods / (2 * kPi * std::max(radius_w, 1e-9));
  return 0.5 + 0.5 * Contrast(periods_in_width) * std::sin(kPeriods * angle);
}

double Wood(const Pattern& pattern, const Vec2& place_w, double width_w) {
  const double across = place_w.x() / pattern.scale_w;
  const double plank = Floor(across);
  const double in_plank = across - plank;
  const uint64_t seed =
      RandomBits(pattern.seed, 1, static_cast<uint64_t>(static_cast<int64_t>(plank)));
  const double tone = static_cast<double>(seed >> 40) * 0x1.0p-24;
  const double x = place_w.x() / pattern.scale_w;
  const double y = place_w.y() / pattern.scale_w + 8 * tone;
  const double width = width_w / pattern.scale_w;

  // The wood has year rings, bent by noise of low frequency, fibres, and pores, which are short
  // dark strokes along the grain.
  const double bend = ValueNoise(2.2 * x, 0.55 * y, seed);
  const double rings = Wave(2.6 * x + 3.2 * bend);
  const double fibre = ValueNoise(26 * x, 1.6 * y, seed + 1) - 0.5;
  const double pores = ValueNoise(60 * x, 5 * y, seed + 2);
  double value = 0.42 + 0.3 * (tone - 0.5) + 0.14 * Contrast(4 * width) * rings +
                 0.45 * Contrast(20 * width) * fibre +
                 0.35 * Contrast(40 * width) * std::max(0.0, pores - 0.72) / 0.28;
  // The seam between planks is a line of the second colour. Half of it is 1/70 of a plank wide; a
  // wider footprint makes it wider and fainter in proportion.
  const double seam_width = std::max(1.0 / 70, width);
  const double from_seam = std::min(in_plank, 1 - in_plank) / seam_width;
  if (from_seam < 1) value += (1 - value) * (1 - SmoothStep(from_seam)) / (70 * seam_width);
  return std::clamp(value, 0.0, 1.0);
}

double Swirl(const Pattern& pattern, const Vec2& place_w, double width_w) {
  const double x = place_w.x() / pattern.scale_w;
  const double y = place_w.y() / pattern.scale_w;
  const double bend = ValueNoise(0.8 * x, 0.8 * y, pattern.seed);
  const double wave = Wave(0.5 * x + 0.3 * y + 1.8 * bend);
  return 0.5 + 0.5 * Contrast(1.5 * width_w / pattern.scale_w) * wave * std::abs(wave);
}

}  // namespace

double ValueNoise(double x, double y, uint64_t seed) {
  const double floor_x = Floor(x), floor_y = Floor(y);
  const auto ix = static_cast<int64_t>(floor_x), iy = static_cast<int64_t>(floor_y);
  const double tx = SmoothStep(x - floor_x), ty = SmoothStep(y - floor_y);
  const double top = (1 - tx) * LatticeValue(ix, iy, seed) + tx * LatticeValue(ix + 1, iy, seed);
  const double bottom =
      (1 - tx) * LatticeValue(ix, iy + 1, seed) + tx * LatticeValue(ix + 1, iy + 1, seed);
  return (1 - ty) * top + ty * bottom;
}

double PatternAt(const Pattern& pattern, const Vec2& place_w, double width_w) {
  switch (pattern.kind) {
    case PatternKind::kPlain:
      return 0;
    case PatternKind::kChecker:
      return Checker(pattern, place_w, width_w);
    case PatternKind::kBars:
      return Bars(pattern, place_w, width_w);
    case PatternKind::kLetters:
      return Letters(pattern, place_w);
    case PatternKind::kStar:
      return Star(pattern, place_w, width_w);
    case PatternKind::kWood:
      return Wood(pattern, place_w, width_w);
    case PatternKind::kSwirl:
      return Swirl(pattern, place_w, width_w);
  }
  return 0;
}

}  // namespace lf
