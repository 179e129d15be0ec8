// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/open_views.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <system_error>

#include "lf/core/log.h"
#include "lf/import/formats/guess_grid.h"
#include "lf/import/formats/hci_archive.h"
#include "lf/import/formats/option_checks.h"
#include "lf/import/formats/picture_grid.h"
#include "lf/import/formats/read_stanford.h"
#include "lf/pixels/files/hdf5_array.h"
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

// Returns how the views lie in a picture: what the options state, or its name, or a guess.
//   is_guess  set to true if neither options nor name state it
Result<PictureGrid> GridOf(const fs::path& path, const OpenOptions& options, bool* is_guess) {
  const std::optional<PictureGrid> named = PictureGridOfName(path.filename().string());
  const bool is_other = named && options.layout && *options.layout != named->layout;
  if (options.grid) {
    PictureGrid grid = named && !is_other ? *named : PictureGrid();
    grid.grid = *options.grid;
    grid.layout = options.layout.value_or(grid.layout);
    return grid;
  }
  // Names of pictures of lenslets state no numbers, and some grids of cameras are called quilts.
  // Somebody who states the geometry knows them.
  const bool is_sure = named && !is_other && options.pitch_w && options.focal_px;
  const Result<bool> is_divisible = named ? CanBeDivided(path, *named) : Result<bool>(false);
  if (!is_divisible) return is_divisible.error();
  if (is_sure && *is_divisible) return *named;
  const std::optional<PictureGrid> guess = GuessPictureGrid(path);
  if (guess &&
      (!options.layout || *options.layout == guess->layout ||
       guess->layout == PictureLayout::kMosaic) &&
      !(named && guess->layout == named->layout && guess->grid == named->grid)) {
    *is_guess = true;
    PictureGrid grid = *guess;
    grid.layout = options.layout.value_or(grid.layout);
    return grid;
  }
  if (*is_divisible && !is_other) return *named;
  return InputError(fmt::format(
      "{}: is one image file: if it is a picture of many views, give their columns and "
      "rows ({{lfimport grid}}), and {{lfimport layout}} mosaic|quilt|lenslets if they do not lie "
      "side by side",
      path.string()));
}

// Adds what the attributes of an HDF5 file state, unless the options state it.
Result<void> AddAttributes(const fs::path& path, const ViewArray& array, StanfordOptions* views) {
  LF_ASSIGN_OR_RETURN(Hdf5Attributes attributes, ReadHdf5Attributes(path));
  if (views->pitch_w) {
    attributes["dH"] = views->pitch_w->x();
    attributes["dV"] = views->pitch_w->y();
  }
  if (views->focal_px) attributes["focalLength"] = *views->focal_px;
  if (views->plane_distance_w) attributes.erase("shift");
  LF_ASSIGN_OR_RETURN(const HciArchive archive, HciArchiveOf(attributes, array, path.string()));
  if (archive.unclear_focal_length && !views->focal_px)
    LogWarning(
        "{}: its attribute focalLength is {}, which cannot be pixels of views that are {} pixels "
        "wide, and its unit is not stated: the attribute is not used",
        path.string(), *archive.unclear_focal_length, array.info.width);
  if (!views->pitch_w) views->pitch_w = archive.pitch_w;
  if (!views->focal_px) views->focal_px = archive.focal_px;
  if (!views->plane_distance_w) views->plane_distance_w = archive.plane_distance_w;
  return {};
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
  LF_RETURN_IF_ERROR(CheckNoFov(path, options));
  LF_RETURN_IF_ERROR(CheckNoImagesFolder(path, options));
  StanfordOptions picture = StanfordOptionsOf(options, asked_for);
  LF_ASSIGN_OR_RETURN(picture.picture_grid, GridOf(path, options, &picture.is_guess));
  const auto [columns, rows] = picture.picture_grid.grid;
  LogDebug("{}: opened as a picture of {} x {} views ({})", path.string(), columns, rows,
           NameOf(picture.picture_grid.layout));
  picture.picture = path.filename().string();
  return ReadStanfordFolder(path.parent_path(), picture);
}

Result<LightField> OpenArray(const fs::path& path, const OpenOptions& options,
                             const fs::path& asked_for) {
  LF_RETURN_IF_ERROR(CheckNoFov(path, options));
  LF_RETURN_IF_ERROR(CheckNoImagesFolder(path, options));
  if (options.grid || options.layout)
    return UsageError(fmt::format(
        "{}: {} is an array, which states the rows and columns of its views: leave the option out",
        options.grid ? "{grid}" : "{layout}", path.string()));
  LF_ASSIGN_OR_RETURN(const ViewArray array, ReadViewArray(path));
  LogDebug("{}: opened as an array of {} x {} views", path.string(), array.columns, array.rows);
  StanfordOptions views = StanfordOptionsOf(options, asked_for);
  views.picture = path.filename().string();
  views.picture_grid = {.layout = PictureLayout::kArray, .grid = {array.columns, array.rows}};
  if (HasHdf5Name(path)) LF_RETURN_IF_ERROR(AddAttributes(path, array, &views));
  return ReadStanfordFolder(path.parent_path(), views);
}

std::optional<fs::path> ArrayIn(const fs::path& folder) {
  std::error_code error;
  if (const fs::path archive = folder / kHciArchiveName; fs::is_regular_file(archive, error))
    return archive;
  std::optional<fs::path> found;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& path = it->path();
    if (!HasHdf5Name(path) || path.filename().string().starts_with('.') ||
        !fs::is_regular_file(path, error))
      continue;
    if (found) return std::nullopt;
    found = path;
  }
  // Many programs keep other things in such files, such as the features of photographs.
  return found && ReadViewArray(*found) ? found : std::nullopt;
}

}  // namespace lf
