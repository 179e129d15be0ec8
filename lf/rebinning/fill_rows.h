// SPDX-License-Identifier: Apache-2.0
// The inner loop of FillPixels() (fill_pixels.h).
#pragma once

namespace lf {

// Gives each unknown pixel of a row the mean of its four neighbours. Known pixels stay.
//   above, below, weight  [width]; the weight is 1 for known pixels and 0 for the others
//   row                   [width + 2], a copy of the row between its left and its right neighbour
//   to                    [width], the row
// The result has the same bits on every instruction set.
void RelaxRow(const float* above, const float* below, const float* row, const float* weight,
              int width, float* to);

}  // namespace lf
