// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>

#include "lf/analysis/depth/sweep_sums.h"

namespace lf {

void RowSums::Clear() {
  std::fill(roots_.begin(), roots_.end(), 0);
  std::fill(squares_.begin(), squares_.end(), 0);
}

void AddViewReference(const ViewOfPlane& plane, int x_begin, int y, RowSums* sums) {
  const LensView& view = *plane.view;
  // From the centre of the first loaded pixel.
  const double first_x = view.rect.x_begin + 0.5, first_y = view.rect.y_begin + 0.5;
  const double most_x = view.light.width() - 1, most_y = view.light.height() - 1;
  uint32_t* roots = sums->RootsOf(static_cast<size_t>(view.Quarter()));
  uint64_t* squares = sums->SquaresOf(static_cast<size_t>(view.Quarter()));
  for (int i = 0; i < sums->element_count(); ++i, roots += 4, squares += 2) {
    const Vec3 at = plane.positions.At(x_begin + i + 0.5, y + 0.5);
    const double inverse = 1 / at.z();
    const double across = at.x() * inverse - first_x, down = at.y() * inverse - first_y;
    if (!(across >= 0 && across < most_x && down >= 0 && down < most_y)) continue;
    const int column = static_cast<int>(across), row = static_cast<int>(down);
    const auto right = static_cast<uint32_t>((across - column) * 256);
    const auto below = static_cast<uint32_t>((down - row) * 256);
    const uint16_t* const p = &view.light.at(column, row);
    const uint16_t* const q = &view.light.at(column, row + 1);
    if (view.any_masked && (p[3] & p[7] & q[3] & q[7]) == 0) continue;
    const uint32_t weights[4] = {(256 - right) * (256 - below), right * (256 - below),
                                 (256 - right) * below, right * below};
    ++roots[3];
    ++squares[1];
    for (size_t c = 0; c < 3; ++c) {
      const uint64_t root =
          (uint64_t{p[c]} * weights[0] + uint64_t{p[4 + c]} * weights[1] +
           uint64_t{q[c]} * weights[2] + uint64_t{q[4 + c]} * weights[3] + 32768) >>
          16;
      roots[c] += static_cast<uint32_t>(root);
      squares[c / 2] += root * root;
    }
  }
}

}  // namespace lf
