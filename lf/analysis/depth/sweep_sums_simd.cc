// SPDX-License-Identifier: Apache-2.0
// Highway compiles these loops for several instruction sets, and the program chooses one of these
// versions at run time. All compute the same bits as AddViewReference().
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "lf/analysis/depth/sweep_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/analysis/depth/sweep_sums_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#ifndef LF_ANALYSIS_DEPTH_ROW_OF_VIEW_
#define LF_ANALYSIS_DEPTH_ROW_OF_VIEW_
namespace lf {

// A row of elements in a view: the arguments of the kernel.
struct RowOfView {
  const uint16_t* light;  // [row][column][4]
  ptrdiff_t row_values;   // number of values from one row of pixels to the next
  bool any_masked;
  // Position of the element x: (by_x x + by_row) + start, divided by its third number; then minus
  // `first`. It is in the image if it is at least 0 and below `most`.
  double by_x[3], by_row[3], start[3];
  double first[2], most[2];
  double x;  // of the first element
  int count;
  uint32_t* roots;    // RowSums::RootsOf()
  uint64_t* squares;  // RowSums::SquaresOf()
};

}  // namespace lf
#endif

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Places = hn::CappedTag<double, 8>;
constexpr int kAtOnce = static_cast<int>(hn::MaxLanes(Places()));
static_assert(kAtOnce <= static_cast<int>(RowSums::kMostAtOnce));

constexpr int kChunk = 128;  // elements whose samples are found, and then added

// For each element of a chunk: the upper left one of the four pixels around its position, as an
// index into the loaded pixels; the weights of the pixels, in 1/256; and -1 if it is in the image,
// otherwise 0.
struct Samples {
  HWY_ALIGN int32_t pixel[kChunk];
  HWY_ALIGN uint32_t left_right[kChunk];  // weights of the left (low 16 bits) and the right pixels
  HWY_ALIGN uint32_t lower[kChunk];       // weights of the two lower pixels
  HWY_ALIGN int32_t is_inside[kChunk];
};

// Sets samples [at, at + kAtOnce) of a chunk that begins at element `begin` of the row. Returns
// false if all of them are beyond the image.
HWY_ATTR HWY_INLINE bool FindSamples(const RowOfView& row, int begin, int at, Samples* samples) {
  const Places d;
  const hn::Rebind<int32_t, Places> di;
  const hn::RebindToUnsigned<decltype(di)> du;
  const auto x = hn::Iota(d, row.x + (begin + at));
  const auto number = [&](int k) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, row.by_x[k]), x), hn::Set(d, row.by_row[k])),
                   hn::Set(d, row.start[k]));
  };
  const auto inverse = hn::Div(hn::Set(d, 1.0), number(2));
  const auto across = hn::Sub(hn::Mul(number(0), inverse), hn::Set(d, row.first[0]));
  const auto down = hn::Sub(hn::Mul(number(1), inverse), hn::Set(d, row.first[1]));
  const auto zero = hn::Zero(d);
  const auto is_inside =
      hn::And(hn::And(hn::Ge(across, zero), hn::Lt(across, hn::Set(d, row.most[0]))),
              hn::And(hn::Ge(down, zero), hn::Lt(down, hn::Set(d, row.most[1]))));
  const auto column_position = hn::IfThenElseZero(is_inside, across);
  const auto row_position = hn::IfThenElseZero(is_inside, down);
  const auto column = hn::DemoteTo(di, column_position), line = hn::DemoteTo(di, row_position);
  const auto weight = [&](hn::Vec<Places> position, hn::Vec<decltype(di)> whole) HWY_ATTR {
    const auto rest = hn::Sub(position, hn::PromoteTo(d, whole));
    return hn::BitCast(du, hn::DemoteTo(di, hn::Mul(rest, hn::Set(d, 256.0))));
  };
  const auto right = weight(column_position, column);
  const auto width = hn::Set(di, static_cast<int32_t>(row.row_values / 4));
  hn::Store(hn::Add(hn::Mul(line, width), column), di, samples->pixel + at);
  hn::Store(hn::Or(hn::Sub(hn::Set(du, 256), right), hn::ShiftLeft<16>(right)), du,
            samples->left_right + at);
  hn::Store(weight(row_position, line), du, samples->lower + at);
  hn::Store(hn::DemoteTo(di, hn::IfThenElseZero(is_inside, hn::Set(d, -1.0))), di,
            samples->is_inside + at);
  if (row.any_masked)
    for (int k = 0; k < kAtOnce; ++k) {
      const uint16_t* const p = row.light + static_cast<ptrdiff_t>(samples->pixel[at + k]) * 4;
      const uint16_t* const q = p + row.row_values;
      if ((p[3] & p[7] & q[3] & q[7]) == 0) samples->is_inside[at + k] = 0;
    }
  return !hn::AllFalse(d, is_inside);
}

// AddSamples() adds kBlocks elements from index `i` of `samples` on; `roots` and `squares` are the
// sums of the first of them.
#if HWY_TARGET == HWY_SCALAR

constexpr int kBlocks = 1;

HWY_INLINE void AddSamples(const RowOfView& row, const Samples& samples, int i, uint32_t* roots,
                           uint64_t* squares) {
  if (samples.is_inside[i] == 0) return;
  const uint16_t* const p = row.light + static_cast<ptrdiff_t>(samples.pixel[i]) * 4;
  const uint16_t* const q = p + row.row_values;
  const uint32_t left = samples.left_right[i] & 0xffff, right = samples.left_right[i] >> 16;
  const uint32_t lower = samples.lower[i], upper = 256 - lower;
  for (int c = 0; c < 3; ++c) {
    // The largest sum, 65535 * 65536 + 32768, just fits into 32 bits.
    const uint32_t sum =
        (p[c] * left + p[4 + c] * right) * upper + (q[c] * left + q[4 + c] * right) * lower;
    const uint32_t root = (sum + 32768) >> 16;
    roots[c] += root;
    squares[c / 2] += uint64_t{root} * root;
  }
  ++roots[3];
  ++squares[1];
}

#else

using Lanes = hn::CappedTag<uint32_t, 16>;
constexpr int kBlocks = static_cast<int>(hn::MaxLanes(Lanes())) / 4;

// Loads two adjacent pixels for each sample into a block of 128 bits.
HWY_ATTR HWY_INLINE hn::Vec<hn::Full128<uint16_t>> LoadPairs(hn::Full128<uint16_t> d,
                                                             const uint16_t* light,
                                                             const int32_t* pixel) {
  return hn::LoadU(d, light + static_cast<ptrdiff_t>(pixel[0]) * 4);
}
template <class D>
HWY_ATTR HWY_INLINE hn::Vec<D> LoadPairs(D d, const uint16_t* light, const int32_t* pixel) {
  const hn::Half<D> half;
  constexpr int kHalf = static_cast<int>(hn::MaxLanes(half)) / 8;
  return hn::Combine(d, LoadPairs(half, light, pixel + kHalf), LoadPairs(half, light, pixel));
}

// Returns numbers[k] in all lanes of block k.
HWY_ATTR HWY_INLINE hn::Vec<Lanes> InBlocks(const uint32_t* numbers) {
  const Lanes d;
  if constexpr (kBlocks == 1) {
    return hn::Set(d, *numbers);
  } else {
    HWY_ALIGN static constexpr uint8_t kBytes[64] = {
        0,  1,  2,  3,  0,  1,  2,  3,  0,  1,  2,  3,  0,  1,  2,  3,   //
        4,  5,  6,  7,  4,  5,  6,  7,  4,  5,  6,  7,  4,  5,  6,  7,   //
        8,  9,  10, 11, 8,  9,  10, 11, 8,  9,  10, 11, 8,  9,  10, 11,  //
        12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15};
    const hn::Repartition<uint8_t, Lanes> d8;
    return hn::BitCast(
        d, hn::TableLookupBytes(hn::BitCast(d8, hn::LoadDup128(d, numbers)), hn::Load(d8, kBytes)));
  }
}

// Mixes the two pixels of each block. 32768 is subtracted from their values first, because the
// instruction that multiplies pairs of numbers and adds the products needs signed ones.
HWY_ATTR HWY_INLINE hn::Vec<Lanes> MixPairs(const uint16_t* light, const int32_t* pixel,
                                            hn::Vec<hn::Repartition<int16_t, Lanes>> weights) {
  const hn::Repartition<uint16_t, Lanes> d16;
  const hn::RebindToSigned<decltype(d16)> di16;
  const hn::Repartition<uint8_t, Lanes> d8;
  const hn::RebindToSigned<Lanes> di;
  HWY_ALIGN static constexpr uint8_t kBytes[16] = {0, 1, 8,  9,  2, 3, 10, 11,
                                                   4, 5, 12, 13, 6, 7, 14, 15};
  const auto pairs = hn::BitCast(d8, LoadPairs(d16, light, pixel));
  const auto side_by_side = hn::TableLookupBytes(pairs, hn::LoadDup128(d8, kBytes));
  const auto about_0 =
      hn::BitCast(di16, hn::Xor(hn::BitCast(d16, side_by_side), hn::Set(d16, 0x8000)));
  auto odd = hn::Zero(di);
  const auto even = hn::ReorderWidenMulAccumulate(di, about_0, weights, hn::Zero(di), odd);
  return hn::BitCast(Lanes(), hn::RearrangeToOddPlusEven(even, odd));
}

HWY_ATTR HWY_INLINE void AddSamples(const RowOfView& row, const Samples& samples, int i,
                                    uint32_t* roots, uint64_t* squares) {
  const Lanes d;
  const hn::Repartition<uint64_t, Lanes> d64;
  const hn::Repartition<int16_t, Lanes> di16;
  const auto left_right = hn::BitCast(di16, InBlocks(samples.left_right + i));
  const auto lower = InBlocks(samples.lower + i);
  const auto inside = InBlocks(reinterpret_cast<const uint32_t*>(samples.is_inside) + i);
  const auto above = MixPairs(row.light, samples.pixel + i, left_right);
  const auto below = MixPairs(row.light + row.row_values, samples.pixel + i, left_right);
  // above * (256 - lower) + below * lower, modulo 2^32
  const auto sum = hn::Add(hn::ShiftLeft<8>(above), hn::Mul(hn::Sub(below, above), lower));
  // Adds back 32768, which was subtracted from each pixel, times the sum of all weights (65536);
  // and half of that sum, to round. The largest result, 65535 * 65536 + 32768, just fits.
  constexpr uint32_t kBack = 32768u * 65536u + 32768u;
  const auto root = hn::And(hn::ShiftRight<16>(hn::Add(sum, hn::Set(d, kBack))), inside);
  hn::StoreU(hn::Add(hn::LoadU(d, roots), root), d, roots);
  const auto odd = hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(d64, root)));
  const auto pairs = hn::Add(hn::MulEven(root, root), hn::MulEven(odd, odd));
  hn::StoreU(hn::Add(hn::LoadU(d64, squares), pairs), d64, squares);
}

#endif

HWY_ATTR void AddRowOfView(const RowOfView& row) {
  Samples samples;
  for (int begin = 0; begin < row.count; begin += kChunk) {
    const int count = std::min(kChunk, row.count - begin);
    int first = count, last = 0;  // elements before and after them are beyond the image
    for (int i = 0; i < count; i += kAtOnce)
      if (FindSamples(row, begin, i, &samples)) {
        first = std::min(first, i);
        last = i + kAtOnce;
      }
    for (int i = first; i < last; i += kBlocks)
      AddSamples(row, samples, i, row.roots + 4 * (begin + i), row.squares + 2 * (begin + i));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(AddRowOfView);

void AddView(const ViewOfPlane& plane, int x_begin, int y, RowSums* sums) {
  const LensView& view = *plane.view;
  const auto quarter = static_cast<size_t>(view.Quarter());
  RowOfView row;
  row.light = &view.light.at(0, 0);
  row.row_values = static_cast<ptrdiff_t>(view.light.width()) * 4;
  row.any_masked = view.any_masked;
  const PlanePositions& positions = plane.positions;
  const Vec3 by_row = positions.by_y * (y + 0.5);
  for (int k = 0; k < 3; ++k) {
    row.by_x[k] = positions.by_x[k];
    row.by_row[k] = by_row[k];
    row.start[k] = positions.start[k];
  }
  row.first[0] = view.rect.x_begin + 0.5;
  row.first[1] = view.rect.y_begin + 0.5;
  row.most[0] = view.light.width() - 1;
  row.most[1] = view.light.height() - 1;
  row.x = x_begin + 0.5;
  row.count = sums->element_count();
  row.roots = sums->RootsOf(quarter);
  row.squares = sums->SquaresOf(quarter);
  HWY_DYNAMIC_DISPATCH(AddRowOfView)(row);
}

}  // namespace lf
#endif  // HWY_ONCE
