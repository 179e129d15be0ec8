// Folders whose file names tell where the cameras stood, as in the Stanford Light Field Archive
// (doc/formats/stanford.md):
//
//   NAME_ROW_COL_Y_X[_FOCALMM_SENSORMM].ext      positions in millimetres
//   NAME_ROW_COL.ext                             a grid, placed by StanfordOptions::pitch_w
//
// The cameras look straight ahead, R = I, in a world with x right, y down and z into the scene:
// from (X, Y, 0) / 1000, with metres as units, or from the pitch times (COL, ROW, 0), with the
// middle of the grid as origin.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

// Whether an image file in the folder has such a name.
bool HoldsStanfordNames(const std::filesystem::path& folder);

// What the names do not tell. kUsage where a length is not above 0 and at most 1e9. Only lfimport
// offers all of it.
struct StanfordOptions {
  std::optional<double> focal_px = {};  // of all cameras; goes before the names
  // World units from one column, and one row, to the next; goes before positions in the names.
  std::optional<Vec2> pitch_w = {};
  // For rectified slabs, whose images show one plane Z0 without disparity: the depth of that plane.
  // A camera at the offset (x, y) from the middle of the grid then has its principal point at
  //   (w/2 + F x / Z0,  h/2 + F y / Z0)
  std::optional<double> plane_distance_w = {};
  // Where a data set counts the other way round: x, or y, is negated.
  bool flip_x = false;
  bool flip_y = false;
  // What the user called the light field, for the command in messages; empty: the folder.
  std::filesystem::path asked_for = {};
};

// All images with such names, by row and column. The first one's header tells the image size, for
// all; the principal point is the image's centre, the focal length FOCAL / SENSOR * width pixels.
// Other files, and names without a position beside some with one, are left out, with a warning
// that counts and names them.
// kInput: no such name, two images with one row and column, names that lack the position or the
// focal length (the message holds the call of lfimport that adds it), or some that state the focal
// length and some that do not, an unreadable first image.
Result<LightField> ReadStanfordFolder(const std::filesystem::path& folder,
                                      const StanfordOptions& options = {});

}  // namespace lf
