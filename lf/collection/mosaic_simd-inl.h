// SPDX-License-Identifier: Apache-2.0
// Adds rays, interpolated between four or sixteen pixels with the shares of mosaic_filter.h, to
// their elements. Internal to collection. Highway includes this file once for each instruction set.
#if defined(LF_COLLECTION_MOSAIC_SIMD_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // NOLINT: Highway's guard
#ifdef LF_COLLECTION_MOSAIC_SIMD_INL_H_
#undef LF_COLLECTION_MOSAIC_SIMD_INL_H_
#else
#define LF_COLLECTION_MOSAIC_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <cstdint>

#include "lf/collection/bilinear_simd-inl.h"
#include "lf/collection/cubic_simd-inl.h"
#include "lf/collection/cubic_weights.h"
#include "lf/collection/gather_places_simd-inl.h"
#include "lf/collection/mosaic_filter.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/light_field/model/lf_pixels.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Tables for one Bayer pattern, with the weights d and the shares s of mosaic_filter.h, indexed by
// the phase (Places::phase) of the upper left one of the inner four pixels. In the last lane, which
// counts rays, every pixel has the share of a recorded one.
struct MosaicTable {
  // Weights for rays of sixteen pixels. Columns 0 and 2 of the pixels have index 0, columns 1 and 3
  // have index 1.
  struct Columns {
    // [column % 2][row / 2]: products d s for two successive rows, interleaved for each lane.
    HWY_ALIGN int16_t weights[2][2][8];
    HWY_ALIGN int32_t counts[2][4];  // [column % 2][lane]: sum of the products d s of four rows
  };
  Columns columns[4][kCubicSteps + 1];  // [phase][down]
  // Weights for rays of four pixels, [phase][row]: twice the shares s of the left and the right
  // pixel, interleaved for each lane.
  HWY_ALIGN uint16_t rows[4][2][8];
  HWY_ALIGN int32_t mean_shares[LfPixels::kRgbLanes];  // for images that were filtered by shares

  explicit MosaicTable(BayerPattern recorded) {
    const auto share = [recorded](int x, int y, int lane) {
      const bool is_colour = lane != LfPixels::kRayLane;
      return is_colour ? RecordedShareOf(recorded, x, y, lane) : kRecordedShare;
    };
    for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
      mean_shares[lane] = static_cast<int32_t>(
          lane == LfPixels::kRayLane ? kRecordedShare : MeanShareOf(recorded, lane));
    for (int phase = 0; phase < 4; ++phase) {
      const int x = phase % 2, y = phase / 2;
      for (int row = 0; row < 2; ++row)
        for (int i = 0; i < 8; ++i)
          rows[phase][row][i] = static_cast<uint16_t>(2 * share(x + i % 2, y + row, i / 2));
      for (int down = 0; down <= kCubicSteps; ++down) {
        const CubicTaps taps = CubicTapsAt(down, kMosaicTapBits);
        Columns& of_step = columns[phase][down];
        for (int column = 0; column < 2; ++column)
          for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
            of_step.counts[column][lane] = 0;
            for (int row = 0; row < 4; ++row) {
              // The sixteen pixels begin one column to the left of the inner four and one row above
              // them. At their first pixel, x and y are therefore odd if they are even at the first
              // of the four.
              const int32_t weight =
                  taps[row] * static_cast<int32_t>(share(x + 1 + column, y + 1 + row, lane));
              of_step.weights[column][row / 2][2 * lane + row % 2] = static_cast<int16_t>(weight);
              of_step.counts[column][lane] += weight;
            }
          }
      }
    }
  }
};

inline const MosaicTable& TableOfMosaic(BayerPattern recorded) {
  static const MosaicTable tables[] = {
      MosaicTable(BayerPattern::kNone), MosaicTable(BayerPattern::kRggb),
      MosaicTable(BayerPattern::kBggr), MosaicTable(BayerPattern::kGrbg),
      MosaicTable(BayerPattern::kGbrg)};
  return tables[static_cast<int>(recorded)];
}

// The t of mosaic_filter.h, a_x a_y s / 2^9 for bilinear weights a_x, a_y and the share s, is the
// upper half of the 32-bit product of 2^kSideShift a_x and 2 a_y s.
constexpr int kSideShift = 16 - kShareShift - 1;

// AddMosaicRays() adds rays [i, i + kRaysAtOnce) of `places` to the elements with the same indices
// in `sums`, AddMosaicRay() and AddCubicMosaicRay() add ray i alone. AddMeanShareRays(),
// AddMeanShareRay() and AddCubicMeanShareRay() do so for LF images that were filtered by shares.
//   values  the first pixel of the LF image's loaded rectangle
#if HWY_TARGET == HWY_SCALAR

template <class Weights>
HWY_INLINE void AddMosaicRays(const MosaicTable& table, const Places& places, int i,
                              const uint16_t* values, ptrdiff_t row_values, const Weights& weights,
                              TileSums::CountedElement* sums) {
  const uint16_t* const upper =
      values + static_cast<ptrdiff_t>(places.pixel[i]) * LfPixels::kRgbLanes;
  const uint32_t sides[] = {(places.left_right[i] & 0xFFFF) << kSideShift,
                            (places.left_right[i] >> 16) << kSideShift};
  const uint32_t row_weights[] = {kOne - places.lower[i], places.lower[i]};
  const auto& rows = table.rows[places.phase[i]];
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
    uint32_t sum = 0, count = 0;
    for (int row = 0; row < 2; ++row)
      for (int side = 0; side < 2; ++side) {
        const uint32_t t = (sides[side] * (row_weights[row] * rows[row][2 * lane + side])) >> 16;
        sum += t * upper[row * row_values + side * LfPixels::kRgbLanes + lane];
        count += t;
      }
    const uint32_t rays = ((count + (1 << (kShareBits - 1))) >> kShareBits) * weights.At(i);
    sums[i].rgb[lane] += SharedMean(sum, count) * rays;
    sums[i].counts[lane] += rays;
  }
}
template <class Weights>
constexpr auto AddMosaicRay = AddMosaicRays<Weights>;

template <class Weights>
HWY_INLINE void AddMeanShareRays(const MosaicTable& table, const Places& places, int i,
                                 const uint16_t* values, ptrdiff_t row_values,
                                 const Weights& weights, TileSums::CountedElement* sums) {
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
    const uint32_t rays = static_cast<uint32_t>(table.mean_shares[lane]) * weights.At(i);
    sums[i].rgb[lane] += MixedLane(places, i, values, row_values, lane) * rays;
    sums[i].counts[lane] += rays;
  }
}
template <class Weights>
constexpr auto AddMeanShareRay = AddMeanShareRays<Weights>;

//   first  the upper left one of the sixteen pixels of ray i
template <class Weights>
HWY_INLINE void AddCubicMeanShareRay(const CubicTables& cubics, const MosaicTable& table,
                                     const Places& places, int i, const uint16_t* first,
                                     ptrdiff_t row_values, const Weights& weights,
                                     TileSums::CountedElement* sums) {
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
    const uint32_t rays = static_cast<uint32_t>(table.mean_shares[lane]) * weights.At(i);
    sums[i].rgb[lane] +=
        CubicLane(cubics, places.left_right[i] >> 16, places.lower[i], first, row_values, lane) *
        rays;
    sums[i].counts[lane] += rays;
  }
}

//   first  the upper left one of the sixteen pixels of ray i
template <class Weights>
HWY_INLINE void AddCubicMosaicRay(const CubicTables& cubics, const MosaicTable& table,
                                  const Places& places, int i, const uint16_t* first,
                                  ptrdiff_t row_values, const Weights& weights,
                                  TileSums::CountedElement* sums) {
  const MosaicTable::Columns& columns = table.columns[places.phase[i]][places.lower[i]];
  const int32_t* const right = cubics.right[places.left_right[i] >> 16];
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
    int32_t sum = 0, count = 0;
    for (int k = 0; k < 4; ++k) {
      int32_t column = 1 << (kMosaicColumnShift - 1);
      for (int row = 0; row < 4; ++row)
        column += columns.weights[k % 2][row / 2][2 * lane + row % 2] *
                  (first[row * row_values + k * LfPixels::kRgbLanes + lane] - kMiddle);
      const int32_t across = right[CubicTables::kPlaces[k]];
      sum += across * (column >> kMosaicColumnShift);
      count += across * columns.counts[k % 2][lane];
    }
    const auto rays =
        static_cast<uint32_t>((count + (1 << (kMosaicCountBits - 1))) >> kMosaicCountBits) *
        weights.At(i);
    sums[i].rgb[lane] += CubicMosaicValue(sum, count) * rays;
    sums[i].counts[lane] += rays;
  }
}

#else

// Rounds each lane down to an integer. The numbers must be from 0 to 2^22.
template <class VF>
HWY_ATTR HWY_INLINE hn::Vec<hn::RebindToSigned<hn::DFromV<VF>>> RoundedDown(VF v) {
  const hn::DFromV<VF> df;
  const hn::RebindToSigned<decltype(df)> di;
  const auto whole = hn::Add(hn::Floor(v), hn::Set(df, kWhole));
  return hn::Sub(hn::BitCast(di, whole), hn::Set(di, std::bit_cast<int32_t>(kWhole)));
}

// Adds `rgb` and `counts`, a block of 128 bits for each element, to the elements sums[0],
// sums[1]...
HWY_ATTR HWY_INLINE void AddToElements(hn::Full128<uint32_t> d, hn::Vec<hn::Full128<uint32_t>> rgb,
                                       hn::Vec<hn::Full128<uint32_t>> counts,
                                       TileSums::CountedElement* sums) {
  hn::Store(hn::Add(hn::Load(d, sums->rgb), rgb), d, sums->rgb);
  hn::Store(hn::Add(hn::Load(d, sums->counts), counts), d, sums->counts);
}
template <class D>
HWY_ATTR HWY_INLINE void AddToElements(D d, hn::Vec<D> rgb, hn::Vec<D> counts,
                                       TileSums::CountedElement* sums) {
  if constexpr (hn::MaxLanes(d) == 8) {
    // An element is as long as a vector.
    const auto add = [&](hn::Vec<D> added, TileSums::CountedElement* element) HWY_ATTR {
      hn::StoreU(hn::Add(hn::LoadU(d, element->rgb), added), d, element->rgb);
    };
    add(hn::ConcatLowerLower(d, counts, rgb), sums);
    add(hn::ConcatUpperUpper(d, counts, rgb), sums + 1);
  } else {
    const hn::Half<D> half;
    AddToElements(half, hn::LowerHalf(half, rgb), hn::LowerHalf(half, counts), sums);
    AddToElements(half, hn::UpperHalf(half, rgb), hn::UpperHalf(half, counts),
                  sums + hn::MaxLanes(half) / 4);
  }
}

// Adds rays to elements i, i + 1 ... of `sums`. `value` holds the rays' colours, integers of 16
// bits, and `rays` the rays' counts in each colour; a block of 128 bits is a ray.
template <class VI, class Weights>
HWY_ATTR HWY_INLINE void AddCounted(VI value, VI rays, const Weights& weights, int i,
                                    TileSums::CountedElement* sums) {
  const hn::RebindToUnsigned<hn::DFromV<VI>> du;
  auto counted = hn::BitCast(du, rays);
  if constexpr (!Weights::kIsOne) counted = hn::Mul(counted, weights.OfPixels(du, i));
  AddToElements(du, hn::Mul(hn::BitCast(du, value), counted), counted, sums + i);
}

// Loads a block of 128 bits for each ray: rows[phase[k]][row] for ray k.
HWY_ATTR HWY_INLINE hn::Vec<hn::Full128<uint16_t>> LoadShares(hn::Full128<uint16_t> d,
                                                              const uint16_t (*rows)[2][8],
                                                              const int32_t* phase, int row) {
  return hn::Load(d, rows[*phase][row]);
}
template <class D>
HWY_ATTR HWY_INLINE hn::Vec<D> LoadShares(D d, const uint16_t (*rows)[2][8], const int32_t* phase,
                                          int row) {
  const hn::Half<D> half;
  constexpr int kBlocks = static_cast<int>(hn::MaxLanes(half)) * 2 / 16;
  return hn::Combine(d, LoadShares(half, rows, phase + kBlocks, row),
                     LoadShares(half, rows, phase, row));
}

// Adds rays from `i` on: one for each block of 128 bits in a vector of `D`.
template <class D, class Weights>
HWY_ATTR HWY_INLINE void AddMosaicRaysOf(D d, const MosaicTable& table, const Places& places, int i,
                                         const uint16_t* values, ptrdiff_t row_values,
                                         const Weights& weights, TileSums::CountedElement* sums) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToFloat<D> df;
  const hn::Repartition<uint16_t, D> d16;
  const hn::RebindToSigned<decltype(d16)> di16;
  const auto middle = hn::Set(d16, kMiddle);
  const auto one = hn::Set(di16, 1);
  const auto sides =
      hn::ShiftLeft<kSideShift>(hn::BitCast(d16, LoadWeights(d, places.left_right + i)));
  const auto lower = LoadWeights(d, places.lower + i);
  const auto lower_weight = hn::BitCast(d16, hn::Or(lower, hn::ShiftLeft<16>(lower)));
  auto sum = hn::Zero(di), sum_odd = hn::Zero(di), count = hn::Zero(di), count_odd = hn::Zero(di);
  const auto add = [&](hn::Vec<decltype(d16)> weight, int row) HWY_ATTR {
    const auto share = LoadShares(d16, table.rows, places.phase + i, row);
    const auto t = hn::BitCast(di16, hn::MulHigh(sides, hn::Mul(weight, share)));
    const auto pairs = SideBySide(d16, LoadPairs(d16, values + row * row_values, places.pixel + i));
    sum = hn::ReorderWidenMulAccumulate(di, hn::BitCast(di16, hn::Xor(pairs, middle)), t, sum,
                                        sum_odd);
    count = hn::ReorderWidenMulAccumulate(di, one, t, count, count_odd);
  };
  add(hn::Sub(hn::Set(d16, kOne), lower_weight), 0);
  add(lower_weight, 1);
  const auto all_t = hn::RearrangeToOddPlusEven(count, count_odd);
  const auto all_values =
      hn::Add(hn::RearrangeToOddPlusEven(sum, sum_odd), hn::ShiftLeft<15>(all_t));
  const auto quotient = hn::Div(hn::ConvertTo(df, all_values), hn::ConvertTo(df, all_t));
  const auto half = hn::Set(di, 1 << (kShareBits - 1));
  const auto rays = hn::ShiftRight<kShareBits>(hn::Add(all_t, half));
  AddCounted(RoundedDown(hn::Add(quotient, hn::Set(df, 0.5F))), rays, weights, i, sums);
}

template <class Weights>
HWY_ATTR HWY_INLINE void AddMosaicRays(const MosaicTable& table, const Places& places, int i,
                                       const uint16_t* values, ptrdiff_t row_values,
                                       const Weights& weights, TileSums::CountedElement* sums) {
  AddMosaicRaysOf(AllLanes(), table, places, i, values, row_values, weights, sums);
}
template <class Weights>
HWY_ATTR HWY_INLINE void AddMosaicRay(const MosaicTable& table, const Places& places, int i,
                                      const uint16_t* values, ptrdiff_t row_values,
                                      const Weights& weights, TileSums::CountedElement* sums) {
  AddMosaicRaysOf(LanesOfOne(), table, places, i, values, row_values, weights, sums);
}

template <class D, class Weights>
HWY_ATTR HWY_INLINE void AddMeanShareRaysOf(D d, const MosaicTable& table, const Places& places,
                                            int i, const uint16_t* values, ptrdiff_t row_values,
                                            const Weights& weights,
                                            TileSums::CountedElement* sums) {
  const hn::RebindToSigned<D> di;
  const auto value = hn::BitCast(di, MixedRays(d, places, i, values, row_values));
  AddCounted(value, hn::LoadDup128(di, table.mean_shares), weights, i, sums);
}
template <class Weights>
HWY_ATTR HWY_INLINE void AddMeanShareRays(const MosaicTable& table, const Places& places, int i,
                                          const uint16_t* values, ptrdiff_t row_values,
                                          const Weights& weights, TileSums::CountedElement* sums) {
  AddMeanShareRaysOf(AllLanes(), table, places, i, values, row_values, weights, sums);
}
template <class Weights>
HWY_ATTR HWY_INLINE void AddMeanShareRay(const MosaicTable& table, const Places& places, int i,
                                         const uint16_t* values, ptrdiff_t row_values,
                                         const Weights& weights, TileSums::CountedElement* sums) {
  AddMeanShareRaysOf(LanesOfOne(), table, places, i, values, row_values, weights, sums);
}

//   first  the upper left one of the sixteen pixels of ray i
template <class Weights>
HWY_ATTR HWY_INLINE void AddCubicMeanShareRay(const CubicTables& cubics, const MosaicTable& table,
                                              const Places& places, int i, const uint16_t* first,
                                              ptrdiff_t row_values, const Weights& weights,
                                              TileSums::CountedElement* sums) {
  const auto value =
      CubicRay(cubics, places.left_right[i] >> 16, places.lower[i], first, row_values);
  AddCounted(value, hn::Load(hn::Full128<int32_t>(), table.mean_shares), weights, i, sums);
}

//   first  the upper left one of the sixteen pixels of ray i
template <class Weights>
HWY_ATTR HWY_INLINE void AddCubicMosaicRay(const CubicTables& cubics, const MosaicTable& table,
                                           const Places& places, int i, const uint16_t* first,
                                           ptrdiff_t row_values, const Weights& weights,
                                           TileSums::CountedElement* sums) {
  const hn::Full128<int32_t> di;
  const hn::Full128<float> df;
  const hn::Repartition<int16_t, SixteenTag> d16;
  const MosaicTable::Columns& columns = table.columns[places.phase[i]][places.lower[i]];
  const int32_t* const right = cubics.right[places.left_right[i] >> 16];
  ColumnWeights<hn::Vec<decltype(d16)>> down;
  for (int pair = 0; pair < 2; ++pair) {
    down.low[pair] = hn::LoadDup128(d16, columns.weights[0][pair]);
    down.high[pair] = hn::LoadDup128(d16, columns.weights[1][pair]);
  }
  const auto sum = MixSixteen<kMosaicColumnShift>(SixteenTag(), down, right, first, row_values);
  const auto counts = [&](int column) HWY_ATTR {
    const int32_t* const other = right + CubicTables::kPlaces[column + 2];
    const auto across =
        hn::Add(hn::Load(di, right + CubicTables::kPlaces[column]), hn::Load(di, other));
    return hn::Mul(across, hn::Load(di, columns.counts[column]));
  };
  const auto count = hn::Add(counts(0), counts(1));
  const auto quotient = hn::Div(hn::ConvertTo(df, sum), hn::ConvertTo(df, count));
  const auto value =
      hn::Add(hn::Mul(quotient, hn::Set(df, 1 << kMosaicColumnShift)), hn::Set(df, 32768.5F));
  const auto clipped = hn::Min(hn::Max(value, hn::Zero(df)), hn::Set(df, 65535.0F));
  const auto half = hn::Set(di, 1 << (kMosaicCountBits - 1));
  AddCounted(RoundedDown(clipped), hn::ShiftRight<kMosaicCountBits>(hn::Add(count, half)), weights,
             i, sums);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
