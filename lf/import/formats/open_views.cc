// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/open_views.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "lf/core/log.h"
#include "lf/import/formats/option_checks.h"
#include "lf/import/formats/picture_grid.h"
#include "lf/import/formats/read_stanford.h"
#include "lf/pixels/files/view_array.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns the options of a folder with Stanford names.
//   asked_for  LIGHTFIELD as the user typed it
StanfordOptions StanfordOptionsOf(const OpenOptions& options, const fs::path& asked_for) {
  return {.grid = options.grid,
          .is_serpentine = options.is_serpentine,
          .focal_px = options.focal_px,
          .pitch_w = options.pitch_w,
          .plane_distance_w = options.plane_distance_w,
          .flip_x = options.flip_x,
          .flip_y = options.flip_y,
          .asked_for = asked_for,
          .import_again = options.import_again};
}

}  // namespace

Result<LightField> OpenStanford(const fs::path& folder, const OpenOptions& options,
                                const fs::path& asked_for) {
  LF_RETURN_IF_ERROR(CheckNoFov(folder, options));
  LF_RETURN_IF_ERROR(CheckNoImagesFolder(folder, options));
  LogDebug("{}: opened as images with Stanford names", folder.string());
  return ReadStanfordFolder(folder, StanfordOptionsOf(options, asked_for));
}

Result<LightField> OpenPicture(const fs::path& path, const OpenOptions& options,
                               const fs::path& asked_for) {
  std::optional<PictureGrid> grid = PictureGridOfName(path.filename().string());
  if (options.layout && (!grid || grid->layout != *options.layout))
    grid = PictureGrid{.layout = *options.layout, .grid = {0, 0}};
  if (options.grid) {
    if (!grid) grid.emplace();
    grid->grid = *options.grid;
  }
  if (!grid || grid->grid[0] < 1 || grid->grid[1] < 1)
    return InputError(fmt::format(
        "{}: is a picture: if it holds the views of a grid of cameras, give their columns and rows "
        "({{lfimport grid}}), and {{lfimport layout}} if they do not lie side by side",
        path.string()));
  LF_RETURN_IF_ERROR(CheckNoFov(path, options));
  LF_RETURN_IF_ERROR(CheckNoImagesFolder(path, options));
  LogDebug("{}: opened as a picture of {} x {} views ({})", path.string(), grid->grid[0],
           grid->grid[1], NameOf(grid->layout));
  StanfordOptions picture = StanfordOptionsOf(options, asked_for);
  picture.picture = path.filename().string();
  picture.picture_grid = *grid;
  return ReadStanfordFolder(path.parent_path(), picture);
}

Result<LightField> OpenArray(const fs::path& path, const OpenOptions& options) {
  LF_RETURN_IF_ERROR(CheckNoFov(path, options));
  LF_RETURN_IF_ERROR(CheckNoImagesFolder(path, options));
  if (options.grid || options.layout)
    return UsageError(fmt::format(
        "{}: {} is an array, which states the rows and columns of its views: leave the option out",
        options.grid ? "{grid}" : "{layout}", path.string()));
  LF_ASSIGN_OR_RETURN(const ViewArray array, ReadViewArray(path));
  LogDebug("{}: opened as an array of {} x {} views", path.string(), array.columns, array.rows);
  StanfordOptions views = StanfordOptionsOf(options, path);
  views.picture = path.filename().string();
  views.picture_grid = {.layout = PictureLayout::kArray, .grid = {array.columns, array.rows}};
  return ReadStanfordFolder(path.parent_path(), views);
}

}  // namespace lf
