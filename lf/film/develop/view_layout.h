// SPDX-License-Identifier: Apache-2.0
// How the pictures of several views are arranged in one picture, and the names of the files.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

enum class ViewLayout {
  kQuilt,       // "quilt": tiles, view 1 at the lower left, then to the right, then upwards
  kSideBySide,  // "side-by-side": the left eye's view is on the left
  kOverUnder,   // "over-under": the left eye's view is above
  kAnaglyph,    // "anaglyph": red of the left eye's view, green and blue of the right eye's
  kLeftRight,   // "left-right": a picture for each eye
};
std::optional<ViewLayout> ParseViewLayout(std::string_view name);
const char* NameOf(ViewLayout layout);

// Numbers of views side by side and above each other.
struct TileCounts {
  int columns = 1;
  int rows = 1;
  int view_count() const { return columns * rows; }
};

// Width and height in pixels.
struct ViewSize {
  int width = 0;
  int height = 0;
  bool operator==(const ViewSize&) const = default;
};

// Returns the number of views of one moment: 2 unless the layout is a quilt of `grid`.
int ViewCountOf(ViewLayout layout, const TileCounts& grid);

// Returns the grid of the picture: `grid` for a quilt, 1 x 1 if views do not stand beside each
// other.
TileCounts GridOf(ViewLayout layout, const TileCounts& grid);

// Position of a view in GridOf(): its column from the left and its row from the top, from 0 on.
struct ViewTile {
  int column = 0;
  int row = 0;
};
//   view  index of the view, from 0: the leftmost of a quilt, or the left eye
ViewTile TileOf(ViewLayout layout, const TileCounts& grid, int view);

// The name of the file of a picture.
struct ViewFileName {
  ViewLayout layout = ViewLayout::kQuilt;
  TileCounts grid = {};       // of a quilt
  int width = 0, height = 0;  // of one view, in pixels
  std::optional<int> moment =
      {};       // number of the moment; none: the file is the only one, or a video
  int eye = 0;  // kLeftRight: 0 for left, 1 for right
};

// Returns the path of the file for the output `out`, FOLDER/NAME.EXT, by the layout:
//   kQuilt      NAME_qs8x6a0.75.EXT: columns, rows, and the width of a view divided by its height,
//               by which light field displays know how to show a quilt
//   kLeftRight  NAME_left.EXT and NAME_right.EXT
//   others      NAME.EXT
// The number of the moment, with at least four digits, stands behind NAME, left or right: a quilt's
// name must end with its description. kUsage: the layout is a quilt, and NAME ends with the
// description of another one. If it ends with the right one, this is not repeated.
Result<std::filesystem::path> PathOfViews(const std::filesystem::path& out,
                                          const ViewFileName& name);

}  // namespace lf
