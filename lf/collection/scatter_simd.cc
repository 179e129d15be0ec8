// The inner loop of ray collection, for every instruction set from one source (Highway): addresses
// by cubics, a vector at a time, then one integer addition per ray; no fused multiply-add, so that
// every target gives the same bits.
#include <algorithm>
#include <bit>
#include <cmath>

#include "lf/collection/scatter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/collection/scatter_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using LaneF = hn::CappedTag<float, 16>;
using LaneI = hn::RebindToSigned<LaneF>;
#if HWY_HAVE_SCALABLE
#error "vectors of unknown length need loops over Lanes()"
#endif
constexpr int kLanes = static_cast<int>(hn::MaxLanes(LaneF()));

// Where the words of an element are, counted from the first of the tile:
// y_stride * row + x_stride * column, both in the tile.
struct TileLayout {
  PixelRect rect;
  int plate_width;
  int plate_height;
  int x_stride;
  int y_stride;
};

// An RGB scanline adds to sums. Returns the number of rays: none from a masked pixel.
struct RgbPixels {
  static constexpr int kLanesPerPixel = LfPixels::kRgbLanes;
  const uint16_t* row;        // [width][4]
  const uint16_t* row_ahead;  // that of a scanline to come
  TileSums::Element* elements;
  bool may_be_masked;

  int channel(int /*column*/) const { return 0; }
  HWY_ATTR uint32_t Add(int column, int32_t element) const {
    const uint16_t* v = row + static_cast<ptrdiff_t>(column) * LfPixels::kRgbLanes;
    uint32_t* sums = elements[element].rgb_rays;
#if HWY_TARGET == HWY_SCALAR
    for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) sums[lane] += v[lane];
#else
    const hn::Full128<uint32_t> d32;
    const hn::Full64<uint16_t> d16;
    hn::Store(hn::Add(hn::Load(d32, sums), hn::PromoteTo(d32, hn::LoadU(d16, v))), d32, sums);
#endif
    return may_be_masked ? v[LfPixels::kRayLane] : 1;
  }
  HWY_ATTR uint32_t AddAll(int column, int count, const int32_t* words) const {
    uint32_t rays = 0;
    for (int i = 0; i < count; ++i) rays += Add(column + i, words[i]);
    return rays;
  }
};

// A scanline of a mosaic adds to the plate's words.
struct MosaicPixels {
  static constexpr int kLanesPerPixel = 1;
  const uint16_t* row;        // [width]
  const uint16_t* row_ahead;  // that of a scanline to come
  uint64_t* words;
  const uint8_t* mask;  // [width], or none
  int channels[2];      // of even and odd columns

  int channel(int column) const { return channels[column & 1]; }
  uint32_t Add(int column, int32_t word) const {
    if (mask != nullptr && mask[column] == 0) return 0;
    words[word] += SensorPlate::kOneRay | row[column];
    return 1;
  }
  uint32_t AddAll(int column, int count, const int32_t* hit_words) const {
    if (mask != nullptr) {
      uint32_t rays = 0;
      for (int i = 0; i < count; ++i) rays += Add(column + i, hit_words[i]);
      return rays;
    }
    const uint16_t* v = row + column;
    for (int i = 0; i < count; ++i) words[hit_words[i]] += SensorPlate::kOneRay | v[i];
    return static_cast<uint32_t>(count);
  }
};

struct IndexRange {
  int begin;
  int end;
  bool empty() const { return begin >= end; }
};

float At(const float (&c)[4], float t) { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; }

// Cuts from `outer` what the cubic `c` sends outside of [low, high), leaving some pixels too many,
// and from `inner` all that it might send there, by the chord: the cubic strays from it by w^2 / 8
// times its second derivative at most.
void Narrow(const float (&c)[4], float t_begin, int count, float low, float high, IndexRange* outer,
            IndexRange* inner) {
  const float w = static_cast<float>(count - 1);
  const float first = At(c, t_begin), rise = At(c, t_begin + w) - first;
  const float t_most = std::max(std::abs(t_begin), std::abs(t_begin + w));
  const float stray = w * w * 0.125F * (2 * std::abs(c[2]) + 6 * std::abs(c[3]) * t_most) + 0.01F;
  if (!(std::abs(rise) > 4 * stray)) {
    if (std::min(first, first + rise) - stray < low ||
        std::max(first, first + rise) + stray >= high)
      *inner = {0, 0};
    return;
  }
  const float per_element = w / rise;
  const float slack = stray * std::abs(per_element) + 1;
  float enter = (low - first) * per_element, leave = (high - first) * per_element;
  if (rise < 0) std::swap(enter, leave);
  const auto index = [w](float i) { return static_cast<int>(std::clamp(i, 0.0F, w + 1)); };
  outer->begin = std::max(outer->begin, index(enter - slack));
  outer->end = std::min(outer->end, index(leave + slack + 1));
  inner->begin = std::max(inner->begin, index(enter + slack + 1));
  inner->end = std::min(inner->end, index(leave - slack));
}

// Of rays that all land in the tile and need no clamping.
template <class Pixels>
HWY_ATTR uint32_t ScatterInside(const RaySegment& s, IndexRange range, const Pixels& pixels,
                                const TileLayout& tile, int column_begin) {
  const LaneF df;
  const LaneI di;
  const auto x0 = hn::Set(df, s.x_cubic[0]), x1 = hn::Set(df, s.x_cubic[1]);
  const auto x2 = hn::Set(df, s.x_cubic[2]), x3 = hn::Set(df, s.x_cubic[3]);
  const auto y0 = hn::Set(df, s.y_cubic[0]), y1 = hn::Set(df, s.y_cubic[1]);
  const auto y2 = hn::Set(df, s.y_cubic[2]), y3 = hn::Set(df, s.y_cubic[3]);
  // Integers below 2^23 are exact in single precision; added to 2^23 they are its last bits.
  constexpr float kTwoTo23 = 8388608;
  const auto x_stride = hn::Set(df, static_cast<float>(tile.x_stride));
  const auto y_stride = hn::Set(df, static_cast<float>(tile.y_stride));
  const int first = (s.base_y - tile.rect.y_begin) * tile.y_stride +
                    (s.base_x - tile.rect.x_begin) * tile.x_stride;
  const auto base = hn::Set(df, static_cast<float>(first) + kTwoTo23);
  // Colours alternate along a scanline.
  HWY_ALIGN int32_t pattern[kLanes + 1];
  for (int i = 0; i <= kLanes; ++i)
    pattern[i] = pixels.channel(column_begin + range.begin + i) - std::bit_cast<int32_t>(kTwoTo23);
  const auto channel = hn::Load(di, pattern);
  // Scanlines are too far apart for the processor to foresee.
  constexpr int kLinePixels = 64 / (Pixels::kLanesPerPixel * static_cast<int>(sizeof(uint16_t)));
  for (int i = range.begin; i < range.end; i += kLinePixels)
    hwy::Prefetch(pixels.row_ahead + (column_begin + i) * Pixels::kLanesPerPixel);
  // All addresses first: reading them back one by one is cheaper than taking a vector apart.
  HWY_ALIGN int32_t words[CubicSegment::kMaxCount];
  const int count = range.end - range.begin;
  for (int i = 0; i < count; i += kLanes) {
    const auto t = hn::Iota(df, s.t_begin + static_cast<float>(range.begin + i));
    const auto x =
        hn::Floor(hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(x3, t), x2), t), x1), t), x0));
    const auto y =
        hn::Floor(hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(y3, t), y2), t), y1), t), y0));
    const auto word = hn::Add(hn::Add(hn::Mul(y, y_stride), hn::Mul(x, x_stride)), base);
    const bool is_odd = kLanes == 1 && (i & 1) != 0;
    hn::Store(hn::Add(hn::BitCast(di, word), is_odd ? hn::LoadU(di, pattern + 1) : channel), di,
              words + i);
  }
  return pixels.AddAll(column_begin + range.begin, count, words);
}

// Of any rays: only those that land in the tile are added.
template <class Pixels>
HWY_ATTR uint32_t ScatterTested(const RaySegment& s, IndexRange range, const Pixels& pixels,
                                const TileLayout& tile, int column_begin) {
  const PixelRect& rect = tile.rect;
  const LaneF df;
  const LaneI di;
  const auto position = [&](const float(&c)[4], const auto& t) HWY_ATTR {
    return hn::ConvertTo(
        di,
        hn::Floor(hn::Add(
            hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Set(df, c[3]), t), hn::Set(df, c[2])), t),
                            hn::Set(df, c[1])),
                    t),
            hn::Set(df, c[0]))));
  };
  HWY_ALIGN int32_t words[kLanes];
  uint32_t rays = 0;
  for (int i = range.begin; i < range.end; i += kLanes) {
    const auto t = hn::Iota(df, s.t_begin + static_cast<float>(i));
    const auto zero = hn::Zero(di), minus_one = hn::Set(di, -1);
    const auto x =
        hn::Sub(hn::Min(hn::Max(hn::Add(position(s.x_cubic, t), hn::Set(di, s.base_x)), zero),
                        hn::Set(di, tile.plate_width - 1)),
                hn::Set(di, rect.x_begin));
    const auto y =
        hn::Sub(hn::Min(hn::Max(hn::Add(position(s.y_cubic, t), hn::Set(di, s.base_y)), zero),
                        hn::Set(di, tile.plate_height - 1)),
                hn::Set(di, rect.y_begin));
    const auto in_tile =
        hn::And(hn::And(hn::Gt(x, minus_one), hn::Lt(x, hn::Set(di, rect.width()))),
                hn::And(hn::Gt(y, minus_one), hn::Lt(y, hn::Set(di, rect.height()))));
    hn::Store(
        hn::Add(hn::Mul(y, hn::Set(di, tile.y_stride)), hn::Mul(x, hn::Set(di, tile.x_stride))), di,
        words);
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(di, in_tile, bytes);
    uint32_t bits = bytes[0] | (uint32_t{bytes[1]} << 8);
    const int count = std::min(kLanes, range.end - i);
    bits &= (uint32_t{1} << count) - 1;
    for (; bits != 0; bits &= bits - 1) {
      const int k = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
      const int column = column_begin + i + k;
      rays += pixels.Add(column, words[k] + pixels.channel(column));
    }
  }
  return rays;
}

template <class Pixels>
HWY_ATTR uint32_t ScatterSegment(const RaySegment& s, const Pixels& pixels, const TileLayout& tile,
                                 int column_begin) {
  const PixelRect& e = s.elements;
  const PixelRect& t = tile.rect;
  IndexRange outer{0, s.count}, inner = outer;
  const bool inside = e.x_begin >= t.x_begin && e.x_end <= t.x_end && e.y_begin >= t.y_begin &&
                      e.y_end <= t.y_end && e.x_begin > 0 && e.y_begin > 0 &&
                      e.x_end < tile.plate_width && e.y_end < tile.plate_height;
  if (inside) return ScatterInside(s, inner, pixels, tile, column_begin);
  Narrow(s.x_cubic, s.t_begin, s.count, static_cast<float>(t.x_begin - s.base_x),
         static_cast<float>(t.x_end - s.base_x), &outer, &inner);
  Narrow(s.y_cubic, s.t_begin, s.count, static_cast<float>(t.y_begin - s.base_y),
         static_cast<float>(t.y_end - s.base_y), &outer, &inner);
  if (outer.empty()) return 0;
  if (inner.empty()) return ScatterTested(s, outer, pixels, tile, column_begin);
  return ScatterTested(s, {outer.begin, inner.begin}, pixels, tile, column_begin) +
         ScatterInside(s, inner, pixels, tile, column_begin) +
         ScatterTested(s, {inner.end, outer.end}, pixels, tile, column_begin);
}

bool Meet(const PixelRect& a, const PixelRect& b) {
  return a.x_begin < b.x_end && b.x_begin < a.x_end && a.y_begin < b.y_end && b.y_begin < a.y_end;
}

HWY_ATTR uint64_t ScatterTile(const ScatterPlan& plan, const LfPixels& pixels, TileSums* sums) {
  PlateTile& plate_tile = sums->tile();
  const PixelRect& rect = plate_tile.rect();
  const bool is_rgb = pixels.bayer == BayerPattern::kNone;
  TileLayout tile{rect, plan.plate_width, plan.plate_height, 1, sums->stride()};
  if (!is_rgb) tile.x_stride = SensorPlate::kChannels;
  if (!is_rgb) tile.y_stride = plan.plate_width * SensorPlate::kChannels;
  uint64_t* const words =
      plate_tile.row(rect.y_begin) + static_cast<size_t>(rect.x_begin) * SensorPlate::kChannels;
  uint64_t rays = 0;
  for (size_t block = 0; block < plan.block_elements.size(); ++block) {
    if (!Meet(plan.block_elements[block], rect)) continue;
    const size_t begin = block * ScatterPlan::kBlock;
    const size_t end = std::min(plan.segments.size(), begin + ScatterPlan::kBlock);
    for (size_t i = begin; i < end; ++i) {
      const RaySegment& s = plan.segments[i];
      if (!Meet(s.elements, rect)) continue;
      const int row = s.y - pixels.rect.y_begin;
      constexpr int kRowsAhead = 2;
      const uint16_t* const row_ahead =
          pixels.radiance.row(std::min(row + kRowsAhead, pixels.rect.height() - 1));
      const int column = s.x_begin - pixels.rect.x_begin;
      if (is_rgb) {
        sums->Reserve(s.crowd);
        rays += ScatterSegment(
            s, RgbPixels{pixels.radiance.row(row), row_ahead, sums->elements(), pixels.any_masked},
            tile, column);
        continue;
      }
      plate_tile.Reserve(s.crowd);
      const MosaicPixels mosaic{pixels.radiance.row(row),
                                row_ahead,
                                words,
                                pixels.mosaic_mask.empty() ? nullptr : pixels.mosaic_mask.row(row),
                                {BayerChannel(pixels.bayer, pixels.rect.x_begin, s.y),
                                 BayerChannel(pixels.bayer, pixels.rect.x_begin + 1, s.y)}};
      rays += ScatterSegment(s, mosaic, tile, column);
    }
  }
  return rays;
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(ScatterTile);

uint64_t ScatterTile(const ScatterPlan& plan, const LfPixels& pixels, TileSums* sums) {
  const PixelRect& rect = sums->tile().rect();
  LF_CHECK(sums->tile().plate_width() == plan.plate_width &&
           sums->tile().plate_height() == plan.plate_height);
  // Addresses within a tile are exact in single precision.
  LF_CHECK(static_cast<int64_t>(rect.height()) * plan.plate_width * SensorPlate::kChannels <
           (int64_t{1} << 24));
  if (rect.empty()) return 0;
  return HWY_DYNAMIC_DISPATCH(ScatterTile)(plan, pixels, sums);
}

}  // namespace lf
#endif
