// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_bundler.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "lf/core/file.h"
#include "lf/import/exports/export_words.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/model/image_files.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostBundleNumber = 1e9;
constexpr std::string_view kBundleHeader = "# Bundle file v0.3";

// Returns the name in a line of a list: the whole line if it ends like an image, so that names may
// contain blanks, and otherwise its first word, behind which a focal length may follow.
std::string NameInListLine(const std::string& line) {
  return IsImageName(line) ? line : line.substr(0, line.find_first_of(" \t"));
}

Result<std::vector<std::string>> NamesOfBundlerList(std::string_view list,
                                                    const fs::path& list_file) {
  constexpr size_t kLongest = 4096;
  std::vector<std::string> names;
  ByteStream stream(list, list_file);
  TextWords words(&stream);
  while (words.NextEntry()) {
    const std::string line = words.Rest(kLongest);
    if (line.size() > kLongest) return words.Fault("is longer than 4096 bytes");
    names.push_back(NameInListLine(line));
    if (names.size() > kMaxImageCount)
      return words.Fault(fmt::format("names more than {} images", kMaxImageCount));
  }
  return names;
}

struct BundleCamera {
  double focal_px = 0, k1 = 0, k2 = 0;
  RigidTransform cam_from_world;
};

// Returns the next camera; one with a focal length of 0 has no pose.
Result<BundleCamera> NextBundleCamera(ExportWords* words) {
  BundleCamera camera;
  LF_ASSIGN_OR_RETURN(const std::vector<double> lens,
                      words->Numbers("focal length, k1 and k2", 3, kMostBundleNumber));
  LF_ASSIGN_OR_RETURN(const std::vector<double> rows, words->Numbers("the rotation", 9, 2));
  LF_ASSIGN_OR_RETURN(const std::vector<double> translation,
                      words->Numbers("the translation", 3, kLargest_w));
  camera.focal_px = lens[0];
  camera.k1 = lens[1];
  camera.k2 = lens[2];
  if (camera.focal_px == 0) return camera;
  const Result<Mat3> rotation = RotationOfRows(rows);
  if (!rotation) return words->Fault("the rotation above " + rotation.error().message);
  camera.cam_from_world = {CameraFromOpenGl() * *rotation,
                           CameraFromOpenGl() * Vec3(translation.data())};
  return camera;
}

// Returns the list that belongs to a bundle file.
std::optional<fs::path> BundlerListOf(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::error_code error;
  for (const fs::path& folder : {file.parent_path(), file.parent_path() / ".."})
    for (const std::string& name :
         {stem + ".list.txt", stem + "_list.txt", file.filename().string() + ".list.txt",
          std::string("list.txt"), std::string("image_list.txt"), std::string("images.txt")})
      if (fs::is_regular_file(folder / name, error)) return (folder / name).lexically_normal();
  return std::nullopt;
}

}  // namespace

Result<ExportedCameras> ParseBundler(std::string_view text, const fs::path& file,
                                     std::string_view list, const fs::path& list_file) {
  if (!text.starts_with(kBundleHeader))
    return InputError(
        fmt::format("{}: is no bundle file of version 0.3: expected the first line "
                    "\"{}\"",
                    file.string(), kBundleHeader));
  LF_ASSIGN_OR_RETURN(std::vector<std::string> names, NamesOfBundlerList(list, list_file));
  ExportWords words(text, file);
  LF_ASSIGN_OR_RETURN(const std::vector<double> counts,
                      words.Numbers("the numbers of cameras and points", 2, kMostBundleNumber));
  if (counts[0] != std::floor(counts[0]) || counts[0] < 1 || counts[0] > kMaxImageCount)
    return words.Fault(
        fmt::format("the number of cameras is {:g}: expected 1 to {}", counts[0], kMaxImageCount));
  const auto count = static_cast<size_t>(counts[0]);
  if (names.size() < count)
    return InputError(
        fmt::format("{}: names {} images, but {} has {} cameras: give the list that belongs to it",
                    list_file.string(), names.size(), file.string(), count));
  ExportedCameras exported;
  exported.folder = list_file.parent_path();
  exported.sizes_from = SizesFrom::kEachImage;
  exported.counts_from_middle = true;
  for (size_t i = 0; i < count; ++i) {
    LF_ASSIGN_OR_RETURN(const BundleCamera camera, NextBundleCamera(&words));
    if (camera.focal_px == 0) continue;
    ExportedImage image;
    image.name = std::move(names[i]);
    image.cam_from_world = camera.cam_from_world;
    Intrinsics& k = image.intrinsics;
    k.fx_px = k.fy_px = camera.focal_px;
    k.distortion = DistortionOf(DistortionModel::kRadialTangential, {camera.k1, camera.k2});
    exported.images.push_back(std::move(image));
  }
  LogPosedCount(file, exported.images.size(), count);
  return exported;
}

Result<LightField> ReadBundler(const fs::path& file, const ExportOptions& options) {
  const std::optional<fs::path> list_file = BundlerListOf(file);
  if (!list_file)
    return InputError(fmt::format(
        "{}: the list of its images is missing: expected {} or list.txt beside it, with "
        "the name of an image on each line",
        file.string(), file.stem().string() + ".list.txt"));
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const std::string list, ReadFile(*list_file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(ExportedCameras exported, ParseBundler(text, file, list, *list_file));
  return FinishExport(std::move(exported), file, options);
}

}  // namespace lf
