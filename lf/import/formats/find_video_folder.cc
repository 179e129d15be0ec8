// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/find_video_folder.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "lf/core/file.h"
#include "lf/import/exports/read_google_models.h"
#include "lf/import/formats/npy.h"
#include "lf/import/formats/read_llff.h"
#include "lf/import/video/video_facts.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/image_files.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kModelsName = "models.json";

size_t ImageCountIn(const fs::path& folder) {
  const Result<std::vector<std::string>> names = SortedImageNames(folder);
  return names ? names->size() : 0;
}

std::vector<FilmingCamera> VideosIn(const fs::path& folder) {
  std::vector<FilmingCamera> cameras;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (IsRecordedVideoName(it->path().filename().string()) && it->is_regular_file(ignored))
      cameras.push_back({it->path().stem().string(), it->path(), {}});
  }
  std::sort(cameras.begin(), cameras.end(), [](const FilmingCamera& a, const FilmingCamera& b) {
    return a.video.filename() < b.video.filename();
  });
  return cameras;
}

std::vector<FilmingCamera> FrameFoldersIn(const fs::path& folder) {
  std::vector<FilmingCamera> cameras;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    const std::string name = it->path().filename().string();
    if (!it->is_directory(ignored) || name.starts_with('.') || name.starts_with(kImagesName) ||
        NamesSomethingElse(name))
      continue;
    for (const fs::path& place : {fs::path(name), fs::path(name) / kImagesName}) {
      const Result<std::vector<std::string>> images = SortedImageNames(folder / place);
      if (!images || images->empty()) continue;
      FilmingCamera& camera = cameras.emplace_back();
      camera.name = name;
      for (const std::string& image : *images) camera.frames.push_back((place / image).string());
      break;
    }
  }
  std::sort(cameras.begin(), cameras.end(),
            [](const FilmingCamera& a, const FilmingCamera& b) { return a.name < b.name; });
  return cameras;
}

// Returns true if images beside a poses_bounds.npy are as many as its rows.
bool HoldsImagesOfRows(const fs::path& folder, size_t row_count) {
  if (ImageCountIn(folder) == row_count) return true;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with(kImagesName) &&
        ImageCountIn(it->path()) == row_count)
      return true;
  return false;
}

std::optional<ExportedCameras> ModelsIn(const fs::path& file) {
  const Result<std::string> text = ReadFile(file, kMostExportBytes);
  if (!text) return std::nullopt;
  Result<ExportedCameras> cameras = ParseGoogleModels(*text, file);
  if (!cameras) return std::nullopt;
  return *std::move(cameras);
}

// Returns true if the file of a camera of a models.json is there, with any ending of an image.
bool HoldsImagesOfModels(const fs::path& folder, const ExportedCameras& models) {
  std::set<std::string> stems;
  if (const Result<std::vector<std::string>> names = SortedImageNames(folder); names)
    for (const std::string& name : *names) stems.insert(fs::path(name).stem().string());
  return std::any_of(models.images.begin(), models.images.end(), [&](const ExportedImage& model) {
    std::error_code error;
    return stems.contains(model.name) || fs::is_regular_file(folder / model.name, error);
  });
}

}  // namespace

size_t PoseRowCount(const fs::path& file) {
  const Result<std::string> bytes = ReadFile(file, kMostPoseBytes);
  if (!bytes) return 0;
  const Result<NpyArray> array = ParseNpy(*bytes);
  return array && array->shape.size() == 2 ? array->shape[0] : 0;
}

std::string NameOfModel(const ExportedImage& model) { return fs::path(model.name).stem().string(); }

std::optional<VideoFolder> FindVideoFolder(const fs::path& folder) {
  std::error_code error;
  VideoFolder found;
  found.folder = folder;
  for (const char* const name : {kLlffName, kModelsName})
    if (found.calibration.empty() && fs::is_regular_file(folder / name, error))
      found.calibration = folder / name;
  if (found.calibration.empty()) return std::nullopt;
  found.cameras = VideosIn(folder);
  const bool has_videos = found.cameras.size() > 1;
  if (!has_videos) found.cameras = FrameFoldersIn(folder);
  if (found.cameras.size() < 2) return std::nullopt;
  if (found.calibration.filename() == kLlffName) {
    const size_t rows = PoseRowCount(found.calibration);
    found.holds_stills = HoldsImagesOfRows(folder, rows);
    const bool is_of_one_folder =
        !has_videos && rows != found.cameras.size() &&
        std::any_of(found.cameras.begin(), found.cameras.end(),
                    [&](const FilmingCamera& camera) { return camera.frames.size() == rows; });
    if (is_of_one_folder || rows == 0) return std::nullopt;
    return found;
  }
  const std::optional<ExportedCameras> models = ModelsIn(found.calibration);
  if (!models) return std::nullopt;
  std::set<std::string> names;
  for (const ExportedImage& model : models->images) names.insert(NameOfModel(model));
  std::erase_if(found.cameras,
                [&](const FilmingCamera& camera) { return !names.contains(camera.name); });
  if (found.cameras.size() < 2) return std::nullopt;
  found.holds_stills = HoldsImagesOfModels(folder, *models);
  return found;
}

}  // namespace lf
