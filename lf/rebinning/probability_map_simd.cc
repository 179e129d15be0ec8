// SPDX-License-Identifier: Apache-2.0
// Computes probability maps; compiled for every instruction set, of which the program chooses one
// at run time (Highway).
#include <algorithm>
#include <cstring>

#include "lf/core/large_vector.h"
#include "lf/rebinning/probability_steps.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/rebinning/probability_map_simd.cc"  // NOLINT: Highway reads it
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<uint32_t>;
using D16 = hn::Rebind<uint16_t, D>;

// Number of additional values at both ends of a row, which whole vectors may read or write.
constexpr size_t kMargin = 64;
constexpr int kBandRows = 32;  // rows of the result whose intermediate rows fit the L2 cache

class Rows {
 public:
  Rows(int count, int width)
      : stride_(static_cast<size_t>(width) + 2 * kMargin), values_(stride_ * count) {}
  uint32_t* row(int i) { return values_.data() + stride_ * i + kMargin; }

 private:
  size_t stride_;
  LargeVector<uint32_t> values_;
};

void Across(const SmoothingTaps& taps, const uint16_t* HWY_RESTRICT padded, int width,
            uint32_t* HWY_RESTRICT out) {
  const D d;
  const D16 d16;
  const int lanes = static_cast<int>(hn::Lanes(d)), radius = taps.radius();
  const auto load = [&](int x) { return hn::PromoteTo(d, hn::LoadU(d16, padded + x)); };
  const auto middle = hn::Set(d, taps.values[0]), half = hn::Set(d, 128u);
  for (int x = 0; x < width; x += lanes) {
    auto sum = hn::Add(hn::Mul(load(x), middle), half);
    for (int k = 1; k <= radius; ++k)
      sum = hn::Add(sum, hn::Mul(hn::Add(load(x - k), load(x + k)), hn::Set(d, taps.values[k])));
    hn::StoreU(hn::ShiftRight<8>(sum), d, out + x);
  }
}

// Computes one row of the vertical smoothing, and writes its outermost values once more beyond both
// ends.
//   rows(k)  returns the input row that is k rows below the row of the result; k is -radius to
//            radius
template <class RowAt>
void Down(const SmoothingTaps& taps, const RowAt& rows, int width, uint32_t* HWY_RESTRICT out) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d)), radius = taps.radius();
  const auto middle = hn::Set(d, taps.values[0]), half = hn::Set(d, 2048u);
  const uint32_t* const here = rows(0);
  for (int x = 0; x < width; x += lanes) {
    auto sum = hn::Add(hn::Mul(hn::LoadU(d, here + x), middle), half);
    for (int k = 1; k <= radius; ++k)
      sum = hn::Add(sum, hn::Mul(hn::Add(hn::LoadU(d, rows(-k) + x), hn::LoadU(d, rows(k) + x)),
                                 hn::Set(d, taps.values[k])));
    hn::StoreU(hn::ShiftRight<12>(sum), d, out + x);
  }
  out[-1] = out[0];
  out[width] = out[width - 1];
}

void Probabilities(const ProbabilityParameters& parameters, const uint32_t* above,
                   const uint32_t* here, const uint32_t* below, int width,
                   uint16_t* HWY_RESTRICT out) {
  const D d;
  const D16 d16;
  const hn::RebindToSigned<D> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto most = hn::Set(d, 65535u), beta = hn::Set(d, parameters.beta),
             xi = hn::Set(d, parameters.xi);
  const auto alpha = hn::Set(d, parameters.alpha);
  for (int x = 0; x < width; x += lanes) {
    const auto around = hn::Add(hn::Add(hn::LoadU(d, above + x), hn::LoadU(d, below + x)),
                                hn::Add(hn::LoadU(d, here + x - 1), hn::LoadU(d, here + x + 1)));
    const auto laplacian = hn::Sub(around, hn::ShiftLeft<2>(hn::LoadU(d, here + x)));
    const auto size = hn::BitCast(d, hn::Abs(hn::BitCast(di, laplacian)));
    const auto change = hn::Min(hn::ShiftRight<4>(size), most);
    const auto p = hn::Min(hn::Add(hn::ShiftRight<8>(hn::Mul(change, alpha)), xi), most);
    // `change` and `beta` are small enough to be compared as signed numbers.
    const auto is_below = hn::Lt(hn::BitCast(di, change), hn::BitCast(di, beta));
    const auto kept = hn::IfThenZeroElse(is_below, hn::BitCast(di, p));
    hn::StoreU(hn::DemoteTo(d16, kept), d16, out + x);
  }
}

// Smooths the rows of a grey plane, a band at a time.
class Smoother {
 public:
  Smoother(const SmoothingTaps& taps, int width, int height, int band_rows)
      : taps_(taps),
        width_(width),
        height_(height),
        across_(band_rows + 2 * taps.radius(), width),
        smooth_(band_rows, width),
        padded_(width + 2 * kMargin) {}

  // Smooths the rows [begin, end).
  //   read(y, out)  writes row y of the plane to `out`
  template <class Read>
  void Run(int begin, int end, const Read& read) {
    first_ = begin;
    const int radius = taps_.radius();
    const int low = std::max(begin - radius, 0), high = std::min(end + radius, height_);
    uint16_t* const line = padded_.data() + kMargin;
    for (int y = low; y < high; ++y) {
      read(y, line);
      std::fill_n(line - kMargin, kMargin, line[0]);
      std::fill_n(line + width_, kMargin, line[width_ - 1]);
      Across(taps_, line, width_, across_.row(y - low));
    }
    for (int y = begin; y < end; ++y)
      Down(
          taps_, [&](int k) { return across_.row(std::clamp(y + k, 0, height_ - 1) - low); },
          width_, smooth_.row(y - begin));
  }
  // Returns smoothed row y of the last Run(), or the first or last row of the plane if y is beyond
  // it.
  const uint32_t* row(int y) { return smooth_.row(std::clamp(y, 0, height_ - 1) - first_); }

 private:
  const SmoothingTaps& taps_;
  int width_, height_;
  Rows across_, smooth_;
  std::vector<uint16_t> padded_;
  int first_ = 0;
};

void ProbabilityRows(const ProbabilityParameters& parameters, const GreyRows& grey,
                     ImageView<uint16_t> out) {
  const int width = grey.width(), height = grey.height();
  Smoother smoother(parameters.taps, width, height, kBandRows + 2);
  std::vector<uint16_t> line(width + kMargin);
  for (int begin = 0; begin < height; begin += kBandRows) {
    const int end = std::min(begin + kBandRows, height);
    smoother.Run(std::max(begin - 1, 0), std::min(end + 1, height),
                 [&](int y, uint16_t* row) { grey.Read(y, row); });
    for (int y = begin; y < end; ++y) {
      Probabilities(parameters, smoother.row(y - 1), smoother.row(y), smoother.row(y + 1), width,
                    line.data());
      std::memcpy(out.row(y), line.data(), sizeof(uint16_t) * width);
    }
  }
}

void SmoothedRows(const SmoothingTaps& taps, ImageView<const uint16_t> grey,
                  ImageView<uint16_t> out) {
  Smoother smoother(taps, grey.width, grey.height, kBandRows);
  for (int begin = 0; begin < grey.height; begin += kBandRows) {
    const int end = std::min(begin + kBandRows, grey.height);
    smoother.Run(begin, end, [&](int y, uint16_t* row) {
      std::memcpy(row, grey.row(y), sizeof(uint16_t) * grey.width);
    });
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < grey.width; ++x)
        out.at(x, y) = static_cast<uint16_t>((smoother.row(y)[x] + 8) >> 4);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(ProbabilityRows);
HWY_EXPORT(SmoothedRows);

void ProbabilityPlane(const ProbabilityParameters& parameters, const GreyRows& grey,
                      Image<uint16_t>* p) {
  p->Resize(grey.width(), grey.height(), 1);
  HWY_DYNAMIC_DISPATCH(ProbabilityRows)(parameters, grey, p->view());
}

void SmoothedPlane(const SmoothingTaps& taps, const Image<uint16_t>& grey,
                   Image<uint16_t>* smooth) {
  smooth->Resize(grey.width(), grey.height(), 1);
  HWY_DYNAMIC_DISPATCH(SmoothedRows)(taps, grey.view(), smooth->view());
}

}  // namespace lf
#endif  // HWY_ONCE
