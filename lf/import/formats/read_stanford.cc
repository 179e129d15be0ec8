// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_stanford.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "lf/core/log.h"
#include "lf/core/natural_order.h"
#include "lf/core/shell_word.h"
#include "lf/import/exports/import_limits.h"
#include "lf/import/formats/stanford_name.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/light_field/model/image_files.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kNameForm = "NAME_ROW_COL_Y_X_FOCALMM_SENSORMM.ext";
constexpr const char* kGridNameForm = "NAME_ROW_COL.ext";
constexpr double kLargestPrincipal_px = 1e7;  // limit of principal points in transforms.json

struct StanfordImage {
  std::string file_name;
  StanfordName name;
};

// The images of a folder that form the light field, sorted by row and column, and the names of all
// other files. If some names state positions, an image whose name states none (such as
// sheet_01_02.png) belongs to the other files.
struct Listing {
  std::vector<StanfordImage> images;
  std::vector<std::string> others;
};

// Moves images that are numbered row by row from the other files to the images, if they fill a
// square grid.
void TakeNumberedGrid(Listing* listing) {
  std::vector<StanfordImage> images;
  std::vector<std::string> others;
  for (std::string& file_name : listing->others) {
    if (const std::optional<int> number = NumberOfHciName(file_name))
      images.push_back({file_name, {*number, 0, std::nullopt, std::nullopt}});
    else
      others.push_back(file_name);
  }
  const auto side = static_cast<int>(std::lround(std::sqrt(images.size())));
  const auto is_outside = [&](const StanfordImage& image) { return image.name.row >= side * side; };
  if (images.empty() || static_cast<size_t>(side) * static_cast<size_t>(side) != images.size() ||
      std::any_of(images.begin(), images.end(), is_outside))
    return;
  for (StanfordImage& image : images) {
    image.name.column = image.name.row % side;
    image.name.row /= side;
  }
  listing->images = std::move(images);
  listing->others = std::move(others);
}

// Lists all images of a folder in the order of their names, as those of a grid.
Result<Listing> ListGrid(const fs::path& folder, const StanfordOptions& options) {
  LF_ASSIGN_OR_RETURN(std::vector<std::string> names, SortedImageNames(folder));
  std::stable_sort(names.begin(), names.end(), NaturallyLess);
  const auto [columns, rows] = *options.grid;
  const size_t expected = static_cast<size_t>(columns) * static_cast<size_t>(rows);
  if (names.size() != expected)
    return InputError(fmt::format(
        "{}: holds {} images{}, but {{lfimport grid}} is {} x {}, which are {}: move other images "
        "away, or correct columns and rows",
        folder.string(), names.size(), names.empty() ? "" : ", the first of which is " + names[0],
        columns, rows, expected));
  Listing listing;
  for (size_t i = 0; i < names.size(); ++i) {
    const int row = static_cast<int>(i) / columns, along = static_cast<int>(i) % columns;
    const bool is_backward = options.is_serpentine && row % 2 == 1;
    listing.images.push_back(
        {names[i], {row, is_backward ? columns - 1 - along : along, std::nullopt, std::nullopt}});
  }
  return listing;
}

// Lists the views of a picture by the rows and columns of their cameras.
Result<Listing> ListPicture(const fs::path& folder, const StanfordOptions& options) {
  const PictureGrid& grid = options.picture_grid;
  LF_ASSIGN_OR_RETURN(std::vector<ViewOfPicture> views,
                      ViewsOfPicture(folder / options.picture, grid));
  Listing listing;
  for (ViewOfPicture& view : views) {
    const bool is_backward = options.is_serpentine && view.row % 2 == 1;
    const int column = is_backward ? grid.grid[0] - 1 - view.column : view.column;
    listing.images.push_back(
        {std::move(view.name), {view.row, column, std::nullopt, std::nullopt}});
  }
  std::sort(listing.images.begin(), listing.images.end(),
            [](const StanfordImage& a, const StanfordImage& b) {
              return std::tie(a.name.row, a.name.column) < std::tie(b.name.row, b.name.column);
            });
  return listing;
}

Result<Listing> ListFolder(const fs::path& folder) {
  Listing listing;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string file_name = it->path().filename().string();
    if (file_name.starts_with('.') || it->is_directory(error)) continue;
    const std::optional<StanfordName> name = ParseStanfordName(file_name);
    if (name)
      listing.images.push_back({std::move(file_name), *name});
    else
      listing.others.push_back(std::move(file_name));
  }
  if (error)
    return InputError(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  if (listing.images.empty()) TakeNumberedGrid(&listing);
  const auto has_position = [](const StanfordImage& image) { return !!image.name.position; };
  const auto others = std::partition(listing.images.begin(), listing.images.end(), has_position);
  if (others != listing.images.begin()) {
    for (auto it = others; it != listing.images.end(); ++it)
      listing.others.push_back(std::move(it->file_name));
    listing.images.erase(others, listing.images.end());
  }
  std::sort(listing.others.begin(), listing.others.end());
  std::sort(listing.images.begin(), listing.images.end(),
            [](const StanfordImage& a, const StanfordImage& b) {
              return std::tie(a.name.row, a.name.column, a.file_name) <
                     std::tie(b.name.row, b.name.column, b.file_name);
            });
  return listing;
}

void WarnOfOthers(const fs::path& folder, const Listing& listing) {
  constexpr size_t kShown = 3;
  const auto& others = listing.others;
  if (others.empty()) return;
  const bool has_positions = !listing.images.empty() && listing.images[0].name.position;
  const char* const form = has_positions ? kNameForm : kGridNameForm;
  LogWarning("{}: {} of {} files are left out, because their names are not of the form {}: {}{}",
             folder.string(), others.size(), others.size() + listing.images.size(), form,
             fmt::join(others.begin(), others.begin() + std::min(kShown, others.size()), ", "),
             others.size() > kShown ? ", ..." : "");
}

// Returns the distance between two neighbouring cameras, in world units.
double SpacingOf(const std::vector<StanfordImage>& images, const StanfordOptions& options) {
  if (options.pitch_w) return options.pitch_w->x();
  if (images.size() < 2 || !images[0].name.position) return 1;
  const StanfordName::Position &a = *images[0].name.position, &b = *images[1].name.position;
  const double spacing_w = std::hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm) / 1000;
  return spacing_w > 0 ? spacing_w : 1;
}

// Returns the lfimport command that adds the values that the names lack. Its numbers are examples,
// with which a film shows the same as with the true ones: a plane without parallax 100 cameras away
// keeps everything before the cameras, even if the images were not rectified.
std::string ImportCommand(const fs::path& folder, const std::vector<StanfordImage>& images,
                          const StanfordOptions& options, bool needs_pitch, int width_px) {
  std::vector<std::string> missing;
  if (options.grid && !options.import_again)
    missing = {"--grid", fmt::format("{}x{}", (*options.grid)[0], (*options.grid)[1])};
  if (options.is_serpentine && !options.import_again) missing.push_back("--serpentine");
  if (options.is_guess)
    missing = {"--grid",
               fmt::format("{}x{}", options.picture_grid.grid[0], options.picture_grid.grid[1])};
  if (!options.picture.empty() && options.picture_grid.layout != PictureLayout::kArray &&
      (options.is_guess || !options.import_again))
    missing.insert(missing.end(), {"--layout", NameOf(options.picture_grid.layout)});
  if (needs_pitch && !(options.pitch_w && options.import_again)) {
    const Vec2 pitch_w = options.pitch_w.value_or(Vec2(1, 1));
    missing.insert(missing.end(), {"--pitch", fmt::format("{},{}", pitch_w.x(), pitch_w.y())});
    if (pitch_w.x() == pitch_w.y()) missing.back() = fmt::format("{}", pitch_w.x());
  }
  if (!options.focal_px || !options.import_again)
    missing.insert(missing.end(),
                   {"--focal-px", fmt::format("{}", options.focal_px.value_or(width_px))});
  if (!options.plane_distance_w)
    missing.insert(missing.end(),
                   {"--plane-distance", fmt::format("{:.3g}", 100 * SpacingOf(images, options))});
  if (options.import_again) return options.import_again(missing);
  const fs::path asked_for = options.asked_for.empty() ? folder : options.asked_for;
  // The folder for the calibration of a picture has its name.
  const fs::path output = options.picture.empty() || asked_for.filename() != options.picture
                              ? asked_for
                              : fs::path(asked_for).replace_extension();
  std::vector<std::string> words = {"lfimport", FileArgument(asked_for), "-o",
                                    FileArgument(output)};
  words.insert(words.end(), missing.begin(), missing.end());
  return ShellCommand(words);
}

Result<void> CheckPlaces(const fs::path& folder, const std::vector<StanfordImage>& images) {
  if (images.empty())
    return InputError(fmt::format("{}: holds no image whose name has the form {} or {}",
                                  folder.string(), kNameForm, kGridNameForm));
  for (size_t i = 0; i + 1 < images.size(); ++i)
    if (images[i].name.row == images[i + 1].name.row &&
        images[i].name.column == images[i + 1].name.column)
      return InputError(
          fmt::format("{}: two images have the row {} and column {} in their names, {} and {}: "
                      "keep one image per camera",
                      folder.string(), images[i].name.row, images[i].name.column,
                      images[i].file_name, images[i + 1].file_name));
  return {};
}

Result<void> CheckOptions(const StanfordOptions& options) {
  const auto is_length = [](double length_w) { return length_w > 0 && length_w <= 1e9; };
  const Vec2 pitch_w = options.pitch_w.value_or(Vec2(1, 1));
  if (!is_length(pitch_w.x()) || !is_length(pitch_w.y()))
    return UsageError(
        fmt::format("the pitch ({{pitch}}) is {}, {} world units: expected above 0 and at most 1e9",
                    pitch_w.x(), pitch_w.y()));
  if (options.grid && std::min((*options.grid)[0], (*options.grid)[1]) < 1)
    return UsageError(
        fmt::format("the grid ({{grid}}) has {} columns and {} rows: expected at least 1 of each",
                    (*options.grid)[0], (*options.grid)[1]));
  if (!is_length(options.plane_distance_w.value_or(1)))
    return UsageError(
        fmt::format("the plane distance ({{plane_distance}}) is {} world units: expected above 0 "
                    "and at most 1e9",
                    *options.plane_distance_w));
  return {};
}

// Returns kInput unless the names and the options together state all positions and focal lengths.
Result<void> CheckComplete(const fs::path& folder, const std::vector<StanfordImage>& images,
                           const StanfordOptions& options, int width_px) {
  if (options.is_guess)
    return InputError(fmt::format(
        "{}: is one image file: if it is a picture of many views, state them by {{lfimport grid}} "
        "COLUMNSxROWS and {{lfimport layout}} mosaic|quilt|lenslets, for instance, as its name or "
        "its pixels tell, by: {}",
        (folder / options.picture).string(),
        ImportCommand(folder, images, options, true, width_px)));
  if (!options.picture.empty() && (!options.pitch_w || !options.focal_px))
    return InputError(fmt::format(
        "{}: has rows and columns of views, but states no {}: state it, and {{plane_distance}} if "
        "the views may be rectified to one plane, for instance by: {}",
        (folder / options.picture).string(),
        options.pitch_w    ? "focal length in pixels"
        : options.focal_px ? "distance from one camera to the next"
                           : "distance from one camera to the next and no focal length",
        ImportCommand(folder, images, options, true, width_px)));
  if (!options.pitch_w && !images[0].name.position)
    return InputError(fmt::format(
        "{}: the names {}, but neither positions nor the focal length ({}): "
        "state the pitch and the focal length, and {{plane_distance}} if the images may be "
        "rectified "
        "to one plane, for instance by: {}",
        folder.string(), options.grid ? "follow the order of the grid" : "contain row and column",
        images[0].file_name, ImportCommand(folder, images, options, true, width_px)));
  if (options.focal_px) return {};
  const auto lacks_lens = [](const StanfordImage& image) { return !image.name.lens; };
  const auto without = std::find_if(images.begin(), images.end(), lacks_lens);
  const auto with = std::find_if_not(images.begin(), images.end(), lacks_lens);
  if (without == images.end()) return {};
  if (with != images.end())
    return InputError(
        fmt::format("{}: the name {} contains focal length and sensor width, {} does not: rename "
                    "all files to the form {}",
                    folder.string(), with->file_name, without->file_name, kNameForm));
  return InputError(fmt::format(
      "{}: the names lack the focal length: {} has no _FOCALMM_SENSORMM at its end; "
      "give it in pixels ({{focal_px}}), or state it once, and {{plane_distance}} if the "
      "images may be rectified to one plane, for instance by: {}",
      folder.string(), without->file_name,
      ImportCommand(folder, images, options, !images[0].name.position, width_px)));
}

// Returns the positions of the cameras in their common plane, in world units.
std::vector<Vec2> Positions(const std::vector<StanfordImage>& images,
                            const StanfordOptions& options) {
  std::vector<Vec2> positions;
  for (const StanfordImage& image : images) {
    const StanfordName& name = image.name;
    positions.push_back(
        options.pitch_w ? Vec2(options.pitch_w->x() * name.column, options.pitch_w->y() * name.row)
                        : Vec2(name.position->x_mm, name.position->y_mm) / 1000);
    if (options.flip_x) positions.back().x() *= -1;
    if (options.flip_y) positions.back().y() *= -1;
  }
  return positions;
}

Vec2 MiddleOf(const std::vector<Vec2>& positions) {
  Eigen::AlignedBox2d box;
  for (const Vec2& position : positions) box.extend(position);
  return box.center();
}

// Returns the intrinsics of the camera at the offset `offset_w` (x right, y down) from the middle
// of the grid. The message of kInput does not name the image; the caller adds it.
Result<Intrinsics> IntrinsicsOf(const StanfordName& name, const ImageFileInfo& info,
                                const StanfordOptions& options, const Vec2& offset_w) {
  Intrinsics k;
  k.width_px = info.width;
  k.height_px = info.height;
  k.fx_px = options.focal_px ? *options.focal_px
                             : name.lens->focal_mm / name.lens->sensor_width_mm * info.width;
  if (!(k.fx_px >= 0.001 && k.fx_px <= 1e7))
    return InputError(
        fmt::format("the computed focal length is {} px: expected 0.001 to 1e7 px: correct "
                    "{{focal_px}}, or the focal length and sensor width in the file name",
                    k.fx_px));
  k.fy_px =
      k.fx_px *
      (options.picture.empty() ? 1 : PixelAspect(options.picture_grid, info.width, info.height));
  const Vec2 shift_px =
      options.plane_distance_w
          ? Vec2(offset_w.cwiseProduct(Vec2(k.fx_px, k.fy_px)) / *options.plane_distance_w)
          : Vec2(0, 0);
  k.cx_px = info.width / 2.0 + shift_px.x();
  k.cy_px = info.height / 2.0 + shift_px.y();
  if (!(shift_px.cwiseAbs().maxCoeff() <= kLargestPrincipal_px / 2))
    return InputError(fmt::format(
        "the computed principal point is ({}, {}) px from the middle of the image: expected within "
        "+-{} px; is the plane distance {} in the units of the positions?",
        shift_px.x(), shift_px.y(), kLargestPrincipal_px / 2, *options.plane_distance_w));
  return k;
}

}  // namespace

StanfordNames FindStanfordNames(const fs::path& folder) {
  const Result<Listing> listing = ListFolder(folder);
  if (!listing || listing->images.empty()) return StanfordNames::kNone;
  const std::vector<StanfordImage>& images = listing->images;
  if (images[0].name.position) return StanfordNames::kGrid;
  std::set<int> rows, columns;
  for (const StanfordImage& image : images) {
    rows.insert(image.name.row);
    columns.insert(image.name.column);
  }
  const auto is_counted = [](const std::set<int>& numbers) {
    return numbers.size() > 1 || *numbers.begin() <= 1;
  };
  return is_counted(rows) && is_counted(columns) && 2 * images.size() > rows.size() * columns.size()
             ? StanfordNames::kGrid
             : StanfordNames::kSeries;
}

Result<LightField> ReadStanfordFolder(const fs::path& folder, const StanfordOptions& options) {
  LF_RETURN_IF_ERROR(CheckOptions(options));
  LF_ASSIGN_OR_RETURN(const Listing listing, !options.picture.empty() ? ListPicture(folder, options)
                                             : options.grid           ? ListGrid(folder, options)
                                                                      : ListFolder(folder));
  LF_RETURN_IF_ERROR(CheckPlaces(folder, listing.images));
  LF_ASSIGN_OR_RETURN(const ImageFileInfo info,
                      ReadImageInfo(folder / listing.images[0].file_name));
  LF_RETURN_IF_ERROR(CheckComplete(folder, listing.images, options, info.width));
  WarnOfOthers(folder, listing);

  LightField light_field;
  light_field.folder = folder;
  const std::vector<Vec2> positions = Positions(listing.images, options);
  const Vec2 middle = MiddleOf(positions);
  const Vec2 origin = options.pitch_w ? middle : Vec2(0, 0);
  DistinctIntrinsics distinct;
  for (size_t i = 0; i < positions.size(); ++i) {
    const StanfordImage& image = listing.images[i];
    const Result<Intrinsics> k = IntrinsicsOf(image.name, info, options, positions[i] - middle);
    if (!k) return InputError((folder / image.file_name).string() + ": " + k.error().message);
    const Vec2 centre = positions[i] - origin;
    if (!(centre.cwiseAbs().maxCoeff() <= kLargest_w))
      return InputError(
          fmt::format("{}: its camera is at ({}, {}): expected positions within +-1e12 world "
                      "units: correct {{pitch}}, or the position in the file name",
                      (folder / image.file_name).string(), centre.x(), centre.y()));
    LfCamera camera;
    camera.intrinsics_index = distinct.IndexOf(*k);
    camera.cam_from_world.translation = Vec3::Zero() - Vec3(centre.x(), centre.y(), 0);
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(image.file_name);
  }
  light_field.intrinsics = distinct.Take();
  // Arrays of floats have no name that tells them from those of integers.
  light_field.encoding.max_radiance =
      info.is_float ? kFloatMaxRadiance : DefaultMaxRadiance(light_field.image_names);
  return light_field;
}

}  // namespace lf
