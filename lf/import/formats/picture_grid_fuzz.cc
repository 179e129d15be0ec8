// SPDX-License-Identifier: Apache-2.0
// Any file name must give no grid, or one of at least one view; a path that names a view must name
// the same view when it is written again.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/formats/picture_grid.h"
#include "lf/pixels/files/picture_view.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view name(reinterpret_cast<const char*>(bytes), size_bytes);
  if (const auto grid = lf::PictureGridOfName(name))
    LF_CHECK(grid->grid[0] >= 1 && grid->grid[1] >= 1 && grid->aspect.value_or(1) > 0);
  const auto view = lf::PictureViewOf(name);
  if (!view) return 0;
  const auto again = lf::PictureViewOf(lf::PathOfView(*view));
  LF_CHECK(again && again->file == view->file && again->x == view->x && again->y == view->y);
  LF_CHECK(again->step_x == view->step_x && again->width == view->width);
  return 0;
}
