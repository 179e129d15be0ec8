// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/open_light_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "lf/core/log.h"
#include "lf/core/shell_word.h"
#include "lf/import/exports/export_cameras.h"
#include "lf/import/exports/export_forms.h"
#include "lf/import/exports/import_limits.h"
#include "lf/import/formats/complete_light_field.h"
#include "lf/import/formats/open_video.h"
#include "lf/import/formats/picture_grid.h"
#include "lf/import/formats/read_aos.h"
#include "lf/import/formats/read_hci.h"
#include "lf/import/formats/read_llff.h"
#include "lf/import/formats/read_middlebury.h"
#include "lf/import/formats/read_splits.h"
#include "lf/import/formats/read_stanford.h"
#include "lf/light_field/colmap/points_seen.h"
#include "lf/light_field/colmap/read_colmap.h"
#include "lf/light_field/model/brackets.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/time_slices.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/view_array.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCalibrationName = "transforms.json";
constexpr const char* kAosName = "poses.json";

// Returns the first option in `options` that only folders with Stanford names accept, as messages
// name it; "" if there is none.
std::string_view StanfordOptionOf(const OpenOptions& options) {
  if (options.focal_px) return "{focal_px}";
  if (options.pitch_w) return "{pitch}";
  if (options.grid) return "{grid}";
  if (options.layout) return "{layout}";
  if (options.plane_distance_w) return "{plane_distance}";
  if (options.flip_x) return "{flip_x}";
  if (options.flip_y) return "{flip_y}";
  return "";
}

// Returns kUsage if an option is given that only folders with Stanford names accept.
Result<void> CheckNoStanfordOptions(const fs::path& path, const OpenOptions& options) {
  const std::string_view option = StanfordOptionOf(options);
  if (option.empty()) return {};
  return UsageError(fmt::format(
      "{} is only for folders of images with Stanford names, which lack a part of the "
      "calibration, but {} is a complete calibration: leave the option out, or give the "
      "folder of the images",
      option, path.string()));
}

Result<void> CheckNoFov(const fs::path& path, const OpenOptions& options) {
  if (!options.fov_deg) return {};
  return UsageError(
      fmt::format("{{fov_deg}} is only for poses of Airborne Optical Sectioning, which lack the "
                  "field of view; {} is of another kind: leave the option out",
                  path.string()));
}

Result<void> CheckNoImagesFolder(const fs::path& path, const OpenOptions& options) {
  if (!options.images_folder) return {};
  return UsageError(fmt::format(
      "{{images}} cannot be used with {}, which contains its own images: leave the option out",
      path.string()));
}

Result<LightField> OpenAos(const fs::path& path, const OpenOptions& options) {
  LF_RETURN_IF_ERROR(CheckNoStanfordOptions(path, options));
  LogDebug("{}: opened as poses of Airborne Optical Sectioning", path.string());
  return ReadAos(path, {.fov_deg = options.fov_deg, .images_folder = options.images_folder});
}

// Opens a packed store. Most options are refused, because a store contains its calibration and
// states everything about its pixels.
Result<LightField> OpenPackedStore(const fs::path& path, const OpenOptions& options) {
  LF_RETURN_IF_ERROR(CheckNoStanfordOptions(path, options));
  LF_RETURN_IF_ERROR(CheckNoFov(path, options));
  LF_RETURN_IF_ERROR(CheckNoImagesFolder(path, options));
  if (options.masks_folder)
    return UsageError(
        fmt::format("{{masks}} cannot be used with the packed store {}, which contains its masks: "
                    "leave the option out",
                    path.string()));
  if (options.bayer)
    return UsageError(
        fmt::format("{{bayer}} cannot be used with the packed store {}, whose pixels are already "
                    "encoded: import "
                    "its image files with {{lfimport bayer}}, and compress them again",
                    path.string()));
  if (options.image_scale.kind != ImageScale::Kind::kAuto)
    return UsageError(
        fmt::format("{{image_scale}} cannot be used with the packed store {}, whose LF images have "
                    "the calibrated size: leave the option out",
                    path.string()));
  LogDebug("{}: opened as a packed store", path.string());
  LF_ASSIGN_OR_RETURN(PackedStoreFacts facts, ReadPackedStore(path));
  if (facts.LacksCameras())
    LogWarning(
        "{}: an older program made this store from packages, and kept {} of {} LF cameras: a film "
        "that is rendered without these packages has another order of LF images and other lens "
        "weights than that of the whole light field; make the store again with lfcompressor",
        path.string(), facts.light_field.size(), facts.whole.image_count);
  return std::move(facts.light_field);
}

// Returns kUsage if an option is given that the export of another program does not need.
Result<void> CheckExportOptions(const ExportForm& form, const fs::path& path, OpenOptions options) {
  if (form.takes_focal) options.focal_px.reset();
  LF_RETURN_IF_ERROR(CheckNoStanfordOptions(path, options));
  return CheckNoFov(path, options);
}

ExportOptions ExportOptionsOf(const OpenOptions& options) {
  return {.images_folder = options.images_folder, .focal_px = options.focal_px};
}

// Opens an export of another program. Returns nullopt if the file is none.
std::optional<Result<LightField>> OpenExport(const fs::path& path, const OpenOptions& options) {
  const ExportForm* const form = ExportFormOf(path);
  if (form == nullptr) return std::nullopt;
  if (Result<void> result = CheckExportOptions(*form, path, options); !result)
    return result.error();
  return OpenExportFile(path, ExportOptionsOf(options));
}

// Opens the first export in a folder, which must hold one.
Result<LightField> OpenFirstExport(const fs::path& folder, const OpenOptions& options) {
  const std::vector<FoundExport> found = ExportsIn(folder, /*reads=*/true);
  LF_CHECK(!found.empty());
  LF_RETURN_IF_ERROR(CheckExportOptions(*found[0].form, folder, options));
  std::optional<Result<LightField>> opened = OpenExportIn(folder, ExportOptionsOf(options));
  LF_CHECK(opened.has_value());
  return *std::move(opened);
}

// Opens a calibration file or packed store. Returns nullopt if its name is of no known kind.
std::optional<Result<LightField>> OpenFile(const fs::path& path, const OpenOptions& options) {
  const bool is_json = path.extension() == ".json";
  if (is_json && IsAosFile(path)) return OpenAos(path, options);
  // An export is told from a transforms.json by the words in it.
  if (is_json && !path.filename().string().starts_with("transforms"))
    if (std::optional<Result<LightField>> opened = OpenExport(path, options)) return opened;
  if (path.extension() == kStoreExtension) return OpenPackedStore(path, options);
  const std::optional<fs::path>& images = options.images_folder;
  const struct {
    bool fits;
    const char* name;
    std::function<Result<LightField>()> read;
  } kinds[] = {
      {is_json, "transforms.json", [&] { return ReadTransformsJson(path, images); }},
      {path.extension() == ".npy", "LLFF poses", [&] { return ReadLlff(path, images); }},
      {path.extension() == ".cfg", "parameters of the 4D Light Field Benchmark",
       [&] { return ReadHci(path); }},
      {IsMiddleburyName(path.filename().string()), "Middlebury parameters",
       [&] { return ReadMiddlebury(path, images); }},
  };
  for (const auto& kind : kinds) {
    if (!kind.fits) continue;
    if (Result<void> result = CheckNoStanfordOptions(path, options); !result) return result.error();
    if (Result<void> result = CheckNoFov(path, options); !result) return result.error();
    LogDebug("{}: opened as {}", path.string(), kind.name);
    return kind.read();
  }
  return OpenExport(path, options);
}

Result<LightField> OpenSplits(const std::vector<fs::path>& files, const OpenOptions& options) {
  LF_RETURN_IF_ERROR(CheckNoStanfordOptions(files[0], options));
  LF_RETURN_IF_ERROR(CheckNoFov(files[0], options));
  LogDebug("{}: opened as the parts of a split data set", files[0].parent_path().string());
  return ReadSplits(files, options.images_folder);
}

// Returns the calibration file in a folder: NAME_par.txt, or the poses_bounds.npy, parameters.cfg
// or poses.json; nullopt if there is none of these.
Result<std::optional<fs::path>> OtherCalibrationIn(const fs::path& folder) {
  std::error_code error;
  const std::vector<fs::path> middlebury = MiddleburyFiles(folder);
  if (middlebury.size() > 1)
    return InputError(fmt::format(
        "{}: holds several calibrations, such as {} and {}: give the path of one of these files",
        folder.string(), middlebury[0].filename().string(), middlebury[1].filename().string()));
  if (!middlebury.empty()) return std::optional(middlebury[0]);
  if (fs::exists(folder / kLlffName, error)) return std::optional(folder / kLlffName);
  if (IsHciFile(folder / kHciName)) return std::optional(folder / kHciName);
  if (IsAosFile(folder / kAosName)) return std::optional(folder / kAosName);
  return std::optional<fs::path>();
}

Result<std::optional<fs::path>> CalibrationIn(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / kCalibrationName, error)) return std::optional(folder / kCalibrationName);
  return OtherCalibrationIn(folder);
}

Result<LightField> OpenColmap(const fs::path& model_folder, const OpenOptions& options) {
  LF_RETURN_IF_ERROR(CheckNoStanfordOptions(model_folder, options));
  LF_RETURN_IF_ERROR(CheckNoFov(model_folder, options));
  LogDebug("{}: opened as a COLMAP model", model_folder.string());
  return ReadColmapModel(model_folder, options.images_folder);
}

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

Result<LightField> OpenStanford(const fs::path& folder, const OpenOptions& options,
                                const fs::path& asked_for) {
  LF_RETURN_IF_ERROR(CheckNoFov(folder, options));
  LF_RETURN_IF_ERROR(CheckNoImagesFolder(folder, options));
  LogDebug("{}: opened as images with Stanford names", folder.string());
  return ReadStanfordFolder(folder, StanfordOptionsOf(options, asked_for));
}

// Returns a hint for a folder that holds photographs but no calibration; "" for other folders.
std::string PhotographsIn(const fs::path& path) {
  constexpr size_t kMostEntries = 4096;
  for (const fs::path& folder : {path, path / kImagesName}) {
    size_t count = 0, entry_count = 0;
    std::string first;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (++entry_count > kMostEntries) break;
      const std::string name = it->path().filename().string();
      if (!IsImageName(name)) continue;
      ++count;
      if (first.empty() || name < first) first = name;
    }
    if (count > 1)
      return fmt::format(
          "; {} holds {}{} images, such as {}, but no file with the poses of the cameras: "
          "reconstruct the poses first, for instance with COLMAP (colmap automatic_reconstructor), "
          "which writes sparse/0; or, if a regular grid of cameras recorded them in the order of "
          "their names, give its columns and rows ({{lfimport grid}})",
          folder.string(), entry_count > kMostEntries ? "at least " : "", count, first);
  }
  return "";
}

// Returns a hint that names up to five subfolders that hold a light field, and ends with the
// command for the first of them; "" if there are none.
std::string LightFieldsBelow(const fs::path& folder) {
  constexpr size_t kMostNames = 5;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (names.size() < kMostNames && it->is_directory(ignored) && HoldsLightField(it->path()))
      names.push_back(it->path().filename().string());
  }
  if (names.empty()) return "";
  std::sort(names.begin(), names.end());
  return fmt::format("; but there is a light field in {}/: {}", fmt::join(names, "/, "),
                     ShellCommand({"lfimport", FileArgument(folder / names[0])}));
}

// Opens a picture that holds the views of a grid of cameras.
//   asked_for  the picture, or its folder, as the user typed it
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

// Opens an array of views, which states its rows and columns.
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

bool HoldsImages(const fs::path& folder) {
  const Result<std::vector<std::string>> names = SortedImageNames(folder);
  return names && !names->empty();
}

bool HoldsGrid(const fs::path& folder) {
  return FindStanfordNames(folder) == StanfordNames::kGrid ||
         FindStanfordNames(folder / kImagesName) == StanfordNames::kGrid;
}

// Tells if a folder also holds an export of another program, besides a calibration that was read
// and was not made from it.
void LogUnreadExport(const fs::path& path) {
  const std::vector<FoundExport> exports = ExportsIn(path, /*reads=*/true);
  if (exports.empty() || HoldsOwnAndItsSource(path)) return;
  LogInfo("{} is {}, too, and is not read: give its path to read it instead",
          exports[0].files[0].string(), exports[0].form->name);
}

// Opens the calibration of a folder, unless it holds none but exports of other programs.
//   series  gets a hint about the names of the images, if they are numbered
std::optional<Result<LightField>> OpenOwnForm(const fs::path& path, const OpenOptions& options,
                                              std::string* series) {
  std::error_code error;
  const auto has_export = [&] { return !ExportsIn(path, /*reads=*/true).empty(); };
  // Options that only names need ask for the names.
  const bool passes_over = (options.passes_over_own || !StanfordOptionOf(options).empty()) &&
                           HoldsOwnAndItsSource(path, options.grid.has_value());
  if (passes_over)
    LogInfo("{}: was written by lfimport: the calibration from which it was made is read instead",
            (path / kCalibrationName).string());
  std::optional<Error> broken_model;
  // COLMAP comes before poses_bounds.npy, which is made from such a model and drops the distortion.
  if (passes_over || !fs::exists(path / kCalibrationName, error)) {
    const Result<std::optional<fs::path>> model = FindColmapModel(path);
    if (model && *model) return OpenColmap(**model, options);
    if (!model) broken_model = model.error();
  }
  const Result<std::optional<fs::path>> calibration =
      passes_over ? OtherCalibrationIn(path) : CalibrationIn(path);
  if (!calibration) return calibration.error();
  if (broken_model && !*calibration && !has_export()) return *broken_model;
  if (broken_model)
    LogWarning("{}; {} is read instead", broken_model->message,
               *calibration ? (*calibration)->string() : "an export of another program");
  if (*calibration) return *OpenFile(**calibration, options);
  if (broken_model) return std::nullopt;
  if (const std::vector<fs::path> splits = SplitsIn(path); !splits.empty())
    return OpenSplits(splits, options);
  for (const fs::path& folder : {path, path / kImagesName}) {
    const bool is_any = options.layout || (options.grid && *options.grid != std::array{1, 1});
    if (const std::optional<fs::path> picture = PictureOfViewsIn(folder, is_any))
      return OpenPicture(*picture, options, path);
    const StanfordNames names = FindStanfordNames(folder);
    if (names == StanfordNames::kGrid || (names == StanfordNames::kSeries && options.pitch_w) ||
        (options.grid && HoldsImages(folder))) {
      Result<LightField> opened = OpenStanford(folder, options, path);
      if (opened || !StanfordOptionOf(options).empty() || !has_export()) return opened;
      LogInfo("{}: the names of the images do not state the whole calibration", folder.string());
      return std::nullopt;
    }
    if (names == StanfordNames::kSeries)
      *series = fmt::format(
          "; the names in {} end in two numbers, but not in those of a grid of cameras: if they "
          "are rows and columns, give their distance to lfimport ({{pitch}})",
          folder.string());
  }
  const std::vector<fs::path> stores = PackedStoresIn(path);
  if (stores.size() == 1) return OpenPackedStore(stores[0], options);
  if (stores.size() > 1)
    return InputError(fmt::format(
        "{}: holds several packed stores, such as {} and {}: give the path of one of them",
        path.string(), stores[0].filename().string(), stores[1].filename().string()));
  return std::nullopt;
}

// Opens the light field video of a folder. Returns nullopt if there is none, or if another light
// field in the folder is opened, because no time is given.
std::optional<Result<LightField>> OpenVideo(const fs::path& folder, const OpenOptions& options,
                                            const fs::path& asked_for) {
  std::error_code error;
  if (fs::exists(folder / kCalibrationName, error) && !options.passes_over_own) return std::nullopt;
  const std::optional<VideoFolder> found = FindVideoFolder(folder);
  if (!found) return std::nullopt;
  if (!options.time && options.path_times.empty()) {
    if (options.images_folder) return std::nullopt;
    const Result<std::optional<fs::path>> model = FindColmapModel(folder, /*warns=*/false);
    if (found->holds_stills || (model && *model)) {
      LogInfo("{}: videos of its cameras are there, too, and are not read: give a time ({{time}})",
              asked_for.string());
      return std::nullopt;
    }
  }
  if (Result<void> result = CheckNoStanfordOptions(folder, options); !result) return result.error();
  if (Result<void> result = CheckNoFov(folder, options); !result) return result.error();
  if (Result<void> result = CheckNoImagesFolder(folder, options); !result) return result.error();
  LogDebug("{}: opened as a light field video of {} cameras", folder.string(),
           found->cameras.size());
  return OpenVideoFolder(*found, options, asked_for);
}

Result<LightField> OpenFolder(const fs::path& path, const OpenOptions& options) {
  if (std::optional<Result<LightField>> video = OpenVideo(path, options, path))
    return *std::move(video);
  std::string series;
  if (std::optional<Result<LightField>> own = OpenOwnForm(path, options, &series)) {
    if (*own) LogUnreadExport(path);
    return *std::move(own);
  }
  if (!ExportsIn(path, /*reads=*/true).empty()) return OpenFirstExport(path, options);
  std::string hint = LightFieldsBelow(path);
  if (hint.empty()) {
    const ExportAdvice advice = AdviceOnExportsIn(path);
    // Nobody is told to reconstruct poses that are there, or of all the forms that are not there.
    if (advice.has_poses)
      return InputError(fmt::format("{}: holds no light field{}", path.string(), advice.text));
    hint = advice.text + PhotographsIn(path) + series;
  }
  return InputError(fmt::format(
      "{}: holds no light field: looked for {}, a COLMAP model in it or in sparse/0, NAME_par.txt, "
      "{}, {}, {} (AOS), one packed store NAME.lfs, for images named "
      "NAME_ROW_COL_Y_X_FOCALMM_SENSORMM.ext or NAME_ROW_COL.ext in it and in {}/, and for exports "
      "of other programs ({}){}{}",
      path.string(), kCalibrationName, kLlffName, kHciName, kAosName, kImagesName,
      ListOfExportForms(), OtherCalibrations(path), hint));
}

Result<LightField> OpenCalibration(const fs::path& path, const OpenOptions& options) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::none)
    return InputError(fmt::format("{}: cannot be read: {}", path.string(), error.message()));
  if (!fs::exists(status))
    return InputError(fmt::format("{}: no such file or folder", path.string()));
  if (fs::is_directory(status)) return OpenFolder(path, options);
  if (path.extension() == ".npy" && HoldsViewArray(path)) return OpenArray(path, options);
  if (path.filename() == kLlffName || path.filename() == "models.json")
    if (std::optional<Result<LightField>> video = OpenVideo(FolderAbove(path), options, path))
      return *std::move(video);
  if (std::optional<Result<LightField>> opened = OpenFile(path, options)) return *opened;
  if (IsImageName(path.filename().string())) return OpenPicture(path, options, path);
  return InputError(
      fmt::format("{}: is not a light field: expected a transforms.json, a NAME_par.txt "
                  "(Middlebury), a poses_bounds.npy (LLFF), a parameters.cfg (4D Light Field "
                  "Benchmark), a poses.json (AOS), a packed store "
                  "(STORE.lfs) or the folder of one, the folder of a COLMAP model, a folder "
                  "of images, a picture of many views, or an export of another program ({})",
                  path.string(), ListOfExportForms()));
}

// Warns if none of the image files is there, and the folder also holds a COLMAP model or another
// calibration, which may be the one that belongs to the images.
void WarnOfOtherCalibration(const fs::path& path, const LightField& light_field) {
  std::error_code error;
  if (HasSomeImageFiles(light_field) || !fs::is_directory(path, error) ||
      !fs::exists(path / kCalibrationName, error))
    return;
  const Result<std::optional<fs::path>> model = FindColmapModel(path, /*warns=*/false);
  const Result<std::optional<fs::path>> other = OtherCalibrationIn(path);
  Result<std::optional<fs::path>> found = model && *model ? model : other;
  if (const std::vector<FoundExport> exports = ExportsIn(path, /*reads=*/true);
      found && !*found && !exports.empty())
    found = std::optional(exports[0].files[0]);
  if (!found || !*found) return;
  LogWarning(
      "{}: none of the image files that it names is there, such as {}; {} may belong to the images "
      "instead: give its path to read it",
      (path / kCalibrationName).string(), light_field.ImagePath({0}).string(), (*found)->string());
}

}  // namespace

bool HoldsLightField(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / kCalibrationName, error)) return true;
  const Result<std::optional<fs::path>> model = FindColmapModel(folder);
  if (model && *model) return true;
  const Result<std::optional<fs::path>> calibration = CalibrationIn(folder);
  return !calibration || *calibration || !SplitsIn(folder).empty() || HoldsGrid(folder) ||
         !PackedStoresIn(folder).empty() || !ExportsIn(folder, /*reads=*/true).empty();
}

bool HoldsOwnAndItsSource(const fs::path& folder, bool has_grid) {
  std::error_code error;
  if (!fs::exists(folder / kCalibrationName, error)) return false;
  const Result<bool> is_own = IsAsWritten(folder / kCalibrationName, kImportProgram);
  if (!is_own || !*is_own) return false;
  const Result<std::optional<fs::path>> model = FindColmapModel(folder);
  if (model && *model) return true;
  if (has_grid && (HoldsImages(folder) || HoldsImages(folder / kImagesName))) return true;
  if (PictureOfViewsIn(folder, false)) return true;
  const Result<std::optional<fs::path>> other = OtherCalibrationIn(folder);
  return (other && *other) || !SplitsIn(folder).empty() || HoldsGrid(folder) ||
         !ExportsIn(folder, /*reads=*/true).empty();
}

Result<std::vector<Vec3>> PointsSeenBy(const fs::path& path, const LightField& light_field,
                                       LfImageId id) {
  std::error_code error;
  if (!fs::is_directory(path, error) || fs::exists(path / kCalibrationName, error))
    return std::vector<Vec3>();
  const Result<std::optional<fs::path>> model = FindColmapModel(path, /*warns=*/false);
  if (!model || !*model) return std::vector<Vec3>();  // another calibration was read
  return ReadColmapPointsSeen(**model, id.value, light_field.Camera(id));
}

Result<LightField> OpenLightField(const fs::path& path, const OpenOptions& options) {
  LF_ASSIGN_OR_RETURN(LightField light_field, OpenCalibration(path, options));
  light_field.source = path;
  LF_RETURN_IF_ERROR(ChooseTimes(options, path, &light_field));
  if (!HoldsPackedStore(light_field)) {
    LF_RETURN_IF_ERROR(FindImages(options, path, &light_field));
    LF_RETURN_IF_ERROR(FindMasks(options, &light_field));
    WarnOfOtherCalibration(path, light_field);
    LF_RETURN_IF_ERROR(CompleteEncoding(options, path, &light_field));
  }
  LF_RETURN_IF_ERROR(CompleteAlpha(options, path, &light_field));
  // A packed store needs no ApplyBrackets(), because its encoded masks contain the clipped pixels.
  if (!HoldsPackedStore(light_field) && light_field.encoding.masks_clipped)
    ApplyBrackets(&light_field);
  if (light_field.video && light_field.slice_times.size() == 1)
    LogInfo("{}: shows the time {:.6g} of a light field video, {}", path.string(),
            light_field.slice_times[0], TextOfSpan(*light_field.video));
  const Intrinsics& first = light_field.Camera({0}).intrinsics;
  LogDebug("{}: {} LF images in {}, the first of {} x {} pixels{}, {} distinct intrinsics{}{}",
           path.string(), light_field.size(), light_field.folder.string(), first.width_px,
           first.height_px, first.has_distortion() ? " with lens distortion" : "",
           light_field.intrinsics.size(),
           light_field.encoding.bayer == BayerPattern::kNone ? "" : ", mosaics",
           light_field.mask_names.empty() ? "" : ", masks");
  return light_field;
}

}  // namespace lf
