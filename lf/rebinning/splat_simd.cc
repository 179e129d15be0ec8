// SPDX-License-Identifier: Apache-2.0
// Computes splats; compiled for every instruction set, of which the program chooses one at run time
// (Highway).
//
// Products and sums are never fused, and lanes are added up in a fixed order, so results are
// bit-identical on every instruction set.
#include <algorithm>
#include <cmath>

#include "lf/core/check.h"
#include "lf/rebinning/splat_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/rebinning/splat_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, LensPointGroup::kPoints>;
using V = hn::Vec<D>;
constexpr int kPoints = LensPointGroup::kPoints;
constexpr int kChannels = SplatSums::kChannels;
constexpr float kReach2 = static_cast<float>(kReach_sigmas * kReach_sigmas);
// Largest number of columns or rows of a splat, plus one vector beyond its end.
constexpr int kMostAcross = 2 * static_cast<int>(kReach_sigmas * kMostSigmaUv_px) + 2 + kPoints;

// Returns exp(-q / 2) for q in [0, 9], accurate to 4e-6: the eighth power of exp(-q / 16), which is
// computed by its series.
HWY_INLINE V Gaussian(V q) {
  const D d;
  const V x = hn::Mul(q, hn::Set(d, -1.0F / 16));
  V series = hn::Add(hn::Set(d, 1.0F / 24), hn::Mul(x, hn::Set(d, 1.0F / 120)));
  series = hn::Add(hn::Set(d, 1.0F / 6), hn::Mul(x, series));
  series = hn::Add(hn::Set(d, 0.5F), hn::Mul(x, series));
  series = hn::Add(hn::Set(d, 1.0F), hn::Mul(x, series));
  series = hn::Add(hn::Set(d, 1.0F), hn::Mul(x, series));
  const V squared = hn::Mul(series, series);
  const V fourth = hn::Mul(squared, squared);
  return hn::Mul(fourth, fourth);
}

// The columns or rows of a SplatGrid that a ray reaches, [begin, end), with q = (distance /
// sigma)^2 and exp(-q / 2) of each.
struct Along {
  int begin;
  int end;
  HWY_ALIGN float q[kMostAcross];
  HWY_ALIGN float gaussian[kMostAcross];

  //   place  position of the ray, in elements of the grid, from the centre of the first element
  //   scale  k / sigma: distance between elements of the grid, in sigmas
  //   count  number of columns or rows of the grid
  HWY_INLINE void Find(float place, float scale, int count) {
    const float reach = static_cast<float>(kReach_sigmas) / scale;
    begin = std::max(0, static_cast<int>(std::ceil(place - reach)));
    end = std::min(count, static_cast<int>(std::floor(place + reach)) + 1);
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V steps = hn::Iota(d, 0.0F), scales = hn::Set(d, scale);
    for (int i = begin; i < end; i += lanes) {
      const V distance = hn::Add(steps, hn::Set(d, static_cast<float>(i) - place));
      const V scaled = hn::Mul(distance, scales);
      const V squared = hn::Mul(scaled, scaled);
      hn::Store(squared, d, q + (i - begin));
      hn::Store(Gaussian(squared), d, gaussian + (i - begin));
    }
  }
};

void AddRaysOf(std::span<const FrameRay> rays, const LensPointGroup& points,
               const QueryKernel& kernel, const SplatGrid& grid, SplatSums* sums) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float per_k = 1 / static_cast<float>(grid.k);
  const float scale = static_cast<float>(grid.k / kernel.sigma_uv_px);
  const float left = static_cast<float>(grid.x0) + 0.5F, top = static_cast<float>(grid.y0) + 0.5F;
  const V reach2 = hn::Set(d, kReach2);
  HWY_ALIGN float q_st[kPoints];
  HWY_ALIGN float gaussian_st[kPoints];
  Along across, down;
  for (const FrameRay& ray : rays) {
    bool is_near = false;
    for (int i = 0; i < kPoints; i += lanes) {
      const V dx = hn::Sub(hn::Set(d, ray.lens_x_w), hn::LoadU(d, points.x.data() + i));
      const V dy = hn::Sub(hn::Set(d, ray.lens_y_w), hn::LoadU(d, points.y.data() + i));
      const V q = hn::Mul(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)),
                          hn::LoadU(d, points.per_st2.data() + i));
      is_near = is_near || !hn::AllFalse(d, hn::Le(q, reach2));
      hn::Store(q, d, q_st + i);
      hn::Store(Gaussian(hn::Min(q, reach2)), d, gaussian_st + i);
    }
    if (!is_near) continue;
    across.Find((ray.x_px - left) * per_k, scale, grid.columns);
    down.Find((ray.y_px - top) * per_k, scale, grid.rows);
    const V red = hn::Set(d, ray.rgb[0]), green = hn::Set(d, ray.rgb[1]);
    const V blue = hn::Set(d, ray.rgb[2]);
    for (int row = down.begin; row < down.end; ++row) {
      const float of_row = kReach2 - down.q[row - down.begin];
      const float weight_of_row = down.gaussian[row - down.begin];
      float* at = sums->weighted.data() +
                  (static_cast<size_t>(row) * grid.columns + across.begin) * SplatSums::kElement;
      for (int column = across.begin; column < across.end; ++column, at += SplatSums::kElement) {
        const V left_over = hn::Set(d, of_row - across.q[column - across.begin]);
        const V weight_uv = hn::Set(d, weight_of_row * across.gaussian[column - across.begin]);
        for (int i = 0; i < kPoints; i += lanes) {
          const V weight = hn::IfThenElseZero(hn::Le(hn::Load(d, q_st + i), left_over),
                                              hn::Mul(hn::Load(d, gaussian_st + i), weight_uv));
          float* const to = at + i;
          hn::Store(hn::Add(hn::Load(d, to), hn::Mul(weight, red)), d, to);
          hn::Store(hn::Add(hn::Load(d, to + kPoints), hn::Mul(weight, green)), d, to + kPoints);
          hn::Store(hn::Add(hn::Load(d, to + 2 * kPoints), hn::Mul(weight, blue)), d,
                    to + 2 * kPoints);
          hn::Store(hn::Add(hn::Load(d, to + 3 * kPoints), weight), d, to + 3 * kPoints);
        }
      }
    }
  }
}

void AddMeansOf(const SplatGrid& grid, SplatSums* sums) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const size_t elements = static_cast<size_t>(grid.columns) * grid.rows;
  HWY_ALIGN float means[kChannels][kPoints];
  for (size_t element = 0; element < elements; ++element) {
    float* const weighted = sums->weighted.data() + element * SplatSums::kElement;
    const float* const shares =
        sums->shares.empty() ? nullptr : sums->shares.data() + element * kPoints;
    for (int i = 0; i < kPoints; i += lanes) {
      const V share = shares == nullptr ? one : hn::Load(d, shares + i);
      const V weight = hn::Load(d, weighted + 3 * kPoints + i);
      const auto has_rays = hn::Gt(weight, zero);
      const V per_weight = hn::Div(share, hn::IfThenElse(has_rays, weight, one));
      for (int c = 0; c < 3; ++c) {
        hn::Store(hn::Mul(hn::Load(d, weighted + c * kPoints + i), per_weight), d, means[c] + i);
        hn::Store(zero, d, weighted + c * kPoints + i);
      }
      hn::Store(hn::IfThenElseZero(has_rays, share), d, means[3] + i);
      hn::Store(zero, d, weighted + 3 * kPoints + i);
    }
    float* const total = sums->means.data() + element * kChannels;
    for (int c = 0; c < kChannels; ++c)
      for (int i = 0; i < kPoints; ++i) total[c] += means[c][i];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(AddRaysOf);
HWY_EXPORT(AddMeansOf);

void AddRays(std::span<const FrameRay> rays, const LensPointGroup& points,
             const QueryKernel& kernel, const SplatGrid& grid, SplatSums* sums) {
  LF_CHECK(kernel.sigma_uv_px <= kMostSigmaUv_px);
  HWY_DYNAMIC_DISPATCH(AddRaysOf)(rays, points, kernel, grid, sums);
}
void AddMeans(const SplatGrid& grid, SplatSums* sums) {
  HWY_DYNAMIC_DISPATCH(AddMeansOf)(grid, sums);
}

}  // namespace lf
#endif  // HWY_ONCE
