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
#include "lf/import/exports/export_cameras.h"
#include "lf/import/exports/export_forms.h"
#include "lf/import/exports/import_limits.h"
#include "lf/import/formats/complete_light_field.h"
#include "lf/import/formats/folder_hints.h"
#include "lf/import/formats/open_video.h"
#include "lf/import/formats/open_views.h"
#include "lf/import/formats/option_checks.h"
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
#include "lf/light_field/model/reduction.h"
#include "lf/light_field/model/time_slices.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/hdf5_array.h"
#include "lf/pixels/files/view_array.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/remote/store_cache.h"
#include "lf/storage/remote/store_url.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCalibrationName = "transforms.json";
constexpr const char* kAosName = "poses.json";

Result<LightField> OpenAos(const fs::path& path, const OpenOptions& options) {
  LF_RETURN_IF_ERROR(CheckNoStanfordOptions(path, options));
  LogDebug("{}: opened as poses of Airborne Optical Sectioning", path.string());
  return ReadAos(path, {.fov_deg = options.fov_deg, .images_folder = options.images_folder});
}

// Reduces the LF images of a packed store by resolution to the parts that are there. Warns if parts
// are missing or incomplete, unless the reduction that was asked for does not need them.
Result<void> ReduceToParts(const fs::path& path, int asked, PackedStoreFacts* facts) {
  const size_t missing = facts->part_count - facts->found_parts;
  // The first part of a mosaic has half the resolution of its recorded pixels.
  const size_t halvings = missing > 0 && facts->light_field.encoding.bayer != BayerPattern::kNone
                              ? missing + 1
                              : missing;
  const int divisor = std::min(1 << std::min(halvings, size_t{8}), kMostReduction);
  const fs::path last = FilesOf(path, *facts).back();
  if (facts->cut_count > 0 && asked <= divisor)
    LogWarning(
        "{}: has the bytes of {} of {} LF images, because it was not copied to its end: the others "
        "count as missing; copy the file again{}",
        last.string(), facts->light_field.size() - facts->left_out_count - facts->cut_count,
        facts->light_field.size() - facts->left_out_count,
        facts->found_parts > 1 && 2 * divisor <= kMostReduction
            ? fmt::format(", or load all LF images smaller ({{reduce {}}})", 2 * divisor)
            : "");
  if (divisor > asked)
    LogWarning(
        "{}: {} of the store's {} files of LF images are missing: LF images are loaded at 1/{} of "
        "their width and height; add these files to the store for more",
        path.string(), missing, facts->part_count, divisor);
  return ReduceLightField(divisor, &facts->light_field);
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
  LF_RETURN_IF_ERROR(ReduceToParts(path, options.reduce, &facts));
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
  if (const std::optional<fs::path> array = ArrayIn(path)) return OpenArray(*array, options, path);
  return std::nullopt;
}

// Returns the only image in a folder or its images/; nullopt if there are several, or none.
std::optional<fs::path> OnlyPictureIn(const fs::path& path) {
  for (const fs::path& folder : {path, path / kImagesName})
    if (std::optional<fs::path> picture = PictureOfViewsIn(folder, /*is_any=*/true)) return picture;
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
      return InputError(
          fmt::format("{}: holds no light field{}{}", path.string(), advice.text, advice.command));
    hint = PhotographsIn(path) + series;
    if (hint.empty() && advice.text.empty())
      if (const std::optional<fs::path> picture = OnlyPictureIn(path))
        return OpenPicture(*picture, options, path);
    // A command must end the message.
    hint = advice.text + (hint.empty() ? advice.command : hint);
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
  if (HasHdf5Name(path) || (path.extension() == ".npy" && HoldsViewArray(path)))
    return OpenArray(path, options, path);
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
         ArrayIn(folder) || !PackedStoresIn(folder).empty() ||
         !ExportsIn(folder, /*reads=*/true).empty();
}

bool HoldsOwnAndItsSource(const fs::path& folder, bool has_grid) {
  std::error_code error;
  if (!fs::exists(folder / kCalibrationName, error)) return false;
  const Result<bool> is_own = IsAsWritten(folder / kCalibrationName, kImportProgram);
  if (!is_own || !*is_own) return false;
  const Result<std::optional<fs::path>> model = FindColmapModel(folder);
  if (model && *model) return true;
  if (has_grid && (HoldsImages(folder) || HoldsImages(folder / kImagesName))) return true;
  if (PictureOfViewsIn(folder, false) || ArrayIn(folder)) return true;
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
  fs::path local = path;
  if (IsUrl(path.string())) {
    LF_ASSIGN_OR_RETURN(local, OpenRemoteStore(path.string(), {.folder = options.store_cache}));
  }
  LF_ASSIGN_OR_RETURN(LightField light_field, OpenCalibration(local, options));
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
  LF_RETURN_IF_ERROR(ReduceLightField(options.reduce, &light_field));
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
