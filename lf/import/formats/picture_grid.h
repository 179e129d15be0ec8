// SPDX-License-Identifier: Apache-2.0
// Pictures that hold the views of a grid of cameras (doc/formats/pictures_of_views.md):
//
//   mosaic    the views side by side, row by row from the upper left one on
//   quilt     the views of one row of cameras, from the lower left place on, row by row upwards, as
//             light field displays take them: NAME_qsCOLUMNSxROWS[aASPECT].ext
//   lenslets  the pixels of all views interleaved: under each lenslet lies one pixel of every view,
//             as in the ESLF pictures of the Stanford Lytro Light Field Archive: NAME_eslf.ext
//   array     a NumPy file of views (pixels/files/view_array.h)
//
// Their views become LF images that are read as parts of the picture (pixels/files/picture_view.h).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

enum class PictureLayout { kMosaic, kQuilt, kLenslets, kArray };

// Returns "mosaic", "quilt", "lenslets" or "array".
const char* NameOf(PictureLayout layout);
// Returns the layout of this name; nullopt for other words.
std::optional<PictureLayout> PictureLayoutOf(std::string_view name);

struct PictureGrid {
  PictureLayout layout = PictureLayout::kMosaic;
  // Columns and rows of the views in the picture: its tiles, or the pixels under a lenslet.
  std::array<int, 2> grid = {1, 1};
  // Width of a view divided by its height on the display, as the name of a quilt states it. Pixels
  // are not square if this is not the quotient of their numbers.
  std::optional<double> aspect = {};
};

// Returns what the name of a picture states: a quilt, or the 14 x 14 views of an ESLF picture;
// nullopt for other names.
std::optional<PictureGrid> PictureGridOfName(std::string_view file_name);

// Returns the only image in a folder, if its name states a grid or `is_any` is true; nullopt
// otherwise.
std::optional<std::filesystem::path> PictureOfViewsIn(const std::filesystem::path& folder,
                                                      bool is_any);

// Returns true if the width and height of a picture are multiples of the columns and rows. kInput:
// errors of ReadImageInfo().
Result<bool> CanBeDivided(const std::filesystem::path& picture, const PictureGrid& grid);

// The path of a view, relative to the folder of its picture, and the place of its camera.
struct ViewOfPicture {
  std::string name;
  int row = 0, column = 0;
};

// Lists the views of a picture by the rows and columns of their cameras. kInput: errors of
// ReadImageInfo(); the picture cannot be divided into so many views.
Result<std::vector<ViewOfPicture>> ViewsOfPicture(const std::filesystem::path& picture,
                                                  const PictureGrid& grid);

// Returns the width of a pixel divided by its height; 1 if they may be square.
//   width_px, height_px  size of a view
double PixelAspect(const PictureGrid& grid, int width_px, int height_px);

}  // namespace lf
