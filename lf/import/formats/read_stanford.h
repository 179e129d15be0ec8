// SPDX-License-Identifier: Apache-2.0
// Reads folders whose file names state where the cameras stood, as in the Stanford Light Field
// Archive (doc/formats/stanford.md):
//
//   [NAME_]ROW_COL_Y_X[_FOCALMM_SENSORMM].ext    positions in millimetres
//   [NAME_]ROW_COL.ext                           a grid, placed by StanfordOptions::pitch_w; other
//                                                ways to write it: stanford_name.h
//   input_CamNNN.ext                             the same: the cameras of a square grid, numbered
//                                                row by row
//   any names                                    the images of StanfordOptions::grid, row by row
//
// The cameras look straight ahead (their rotation is the identity) in a world with x right, y down
// and z into the scene. The camera centres are (X, Y, 0) / 1000 world units, which are then metres.
// If pitch_w is given, they are (pitch_w.x COL, pitch_w.y ROW, 0) instead, with the middle of the
// grid as origin.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/core/shell_word.h"
#include "lf/import/formats/picture_grid.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// How the names of the images in a folder may be read.
enum class StanfordNames {
  kNone,    // no name states a place
  kSeries,  // the names look like rows and columns, but make no grid: they are those of photographs
            // of one day or burst, such as IMG_4831_0.jpg
  kGrid,    // the names state positions, or rows and columns of a grid
};

// Looks at the names of a folder. Rows and columns without positions make a grid if images are at
// more than half of its places; the number of a single row or column must be 0 or 1.
StanfordNames FindStanfordNames(const std::filesystem::path& folder);

// Values that the file names may lack. Only lfimport offers all of them as options.
// ReadStanfordFolder() returns kUsage if a pitch or plane_distance_w is outside (0, 1e9], or if a
// side of the grid is below 1.
struct StanfordOptions {
  // Columns and rows of the cameras whose images the folder holds, in the order of their names
  // (numbers by their value), from the upper left camera on, row by row. The names are not read
  // otherwise.
  std::optional<std::array<int, 2>> grid = {};
  // One picture in the folder, which holds the views of a grid of cameras side by side or
  // interleaved; its columns and rows replace those of `grid`.
  std::string picture = {};  // the name of its file; empty: each LF image has a file of its own
  PictureGrid picture_grid = {};
  // picture_grid was guessed: the picture is not read, but kInput names the command that reads it.
  bool is_guess = false;
  bool is_serpentine = false;  // every second row of `grid` was recorded from right to left
  std::optional<double> focal_px = {};  // focal length of all cameras; overrides the file names
  // Distance from one column (x), and from one row (y), to the next; overrides positions in the
  // names.
  std::optional<Vec2> pitch_w = {};
  // Depth Z0 of the plane without disparity, for rectified images. A camera of focal length F at
  // the offset (x, y) from the middle of the grid has its principal point at
  //   (w/2 + F x / Z0,  h/2 + F y / Z0)
  // of an image of w x h pixels. Unset: the principal point is the image centre.
  std::optional<double> plane_distance_w = {};
  // True negates the x (flip_x) or y (flip_y) of all positions, for light fields whose columns or
  // rows are counted in the opposite direction.
  bool flip_x = false;
  bool flip_y = false;
  // LIGHTFIELD as the user typed it, for the command in messages; empty: the folder.
  std::filesystem::path asked_for = {};
  // Repeats the call of lfimport in messages. Unset: their command reads `asked_for` and writes
  // into it.
  CallAgain import_again = {};
};

// Reads the views of a picture if StanfordOptions::picture is given, and all images of the folder
// if StanfordOptions::grid is. Otherwise reads those whose names ParseStanfordName() accepts or, if
// there are none, those that NumberOfHciName() accepts, sorted by row and column. All images get
// the size that the header of the first one states; the focal length is FOCALMM / SENSORMM * width
// pixels. Other files, and images whose names state no position if others state one, are left out
// with a warning that states their number and the names of the first three. kInput: no such name;
// another number of images than the grid has; two images with the same row and column; names that
// lack the position or the focal length (the message contains the lfimport command that adds it); a
// focal length in only some of the names, or out of range; a position beyond 1e12 world units; an
// unreadable first image; a picture whose grid was guessed.
Result<LightField> ReadStanfordFolder(const std::filesystem::path& folder,
                                      const StanfordOptions& options = {});

}  // namespace lf
