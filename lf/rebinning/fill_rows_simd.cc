// SPDX-License-Identifier: Apache-2.0
// RelaxRow(), compiled for every instruction set; the program chooses one at run time (Highway).
// Compilers make vectors of the loop by themselves.
#include "lf/rebinning/fill_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/rebinning/fill_rows_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {

// The two values are mixed by products, because compilers do not vectorize a choice between them.
void RelaxRowHere(const float* HWY_RESTRICT above, const float* HWY_RESTRICT below,
                  const float* HWY_RESTRICT row, const float* HWY_RESTRICT weight, int width,
                  float* HWY_RESTRICT to) {
  for (int x = 0; x < width; ++x) {
    const float mean = 0.25F * ((row[x] + row[x + 2]) + (above[x] + below[x]));
    to[x] = weight[x] * row[x + 1] + (1 - weight[x]) * mean;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(RelaxRowHere);

void RelaxRow(const float* above, const float* below, const float* row, const float* weight,
              int width, float* to) {
  HWY_DYNAMIC_DISPATCH(RelaxRowHere)(above, below, row, weight, width, to);
}

}  // namespace lf
#endif  // HWY_ONCE
