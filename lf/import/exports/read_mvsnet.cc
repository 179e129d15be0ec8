// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_mvsnet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/import/exports/export_files.h"
#include "lf/import/exports/export_words.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostMvsnetNumber = 1e9;
constexpr std::string_view kMvsnetEnding = "_cam.txt";

Result<void> ExpectMvsnetWord(ExportWords* words, std::string_view expected) {
  LF_ASSIGN_OR_RETURN(const std::string word, words->Word("extrinsic and intrinsic"));
  if (word == expected) return {};
  constexpr size_t kMostShown = 40;
  return words->Fault(
      fmt::format("\"{}\": expected the word {}", word.substr(0, kMostShown), expected));
}

Result<RigidTransform> MvsnetPose(ExportWords* words) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> m,
                      words->Numbers("the matrix of 4 x 4 numbers", 16, kLargest_w));
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    return words->Fault(fmt::format("{:g} {:g} {:g} {:g}: expected the last row 0 0 0 1", m[12],
                                    m[13], m[14], m[15]));
  const Result<Mat3> rotation =
      RotationOfRows({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]});
  if (!rotation) return words->Fault("the rotation above " + rotation.error().message);
  return RigidTransform{*rotation, {m[3], m[7], m[11]}};
}

Result<Intrinsics> MvsnetIntrinsics(ExportWords* words) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> m,
                      words->Numbers("the matrix of 3 x 3 numbers", 9, kMostMvsnetNumber));
  const std::optional<Intrinsics> k = IntrinsicsOfRows(m);
  if (!k) return words->Fault("the matrix above is no K: expected fx skew cx, 0 fy cy, 0 0 1");
  return *k;
}

// Multiplies intrinsics that were stated for images of a quarter of the width and height.
void EnlargeIntrinsics(const fs::path& folder, LightField* light_field) {
  constexpr double kFactor = 4, kLeast = 3, kMost = 5;
  const auto is_quarter = [](const Intrinsics& k) {
    const double x = 0.5 * k.width_px / k.cx_px, y = 0.5 * k.height_px / k.cy_px;
    return x > kLeast && x < kMost && y > kLeast && y < kMost;
  };
  if (!std::all_of(light_field->intrinsics.begin(), light_field->intrinsics.end(), is_quarter))
    return;
  const Intrinsics before = light_field->intrinsics[0];
  for (Intrinsics& k : light_field->intrinsics)
    for (double* const number : {&k.fx_px, &k.fy_px, &k.cx_px, &k.cy_px, &k.skew_px})
      *number *= kFactor;
  LogWarning(
      "{}: the principal point ({:g}, {:g}) is a quarter of what images of {} x {} pixels call "
      "for, "
      "as in data for training: all intrinsics are multiplied by 4",
      folder.string(), before.cx_px, before.cy_px, before.width_px, before.height_px);
}

}  // namespace

Result<MvsnetCamera> ParseMvsnetCamera(std::string_view text, const fs::path& file) {
  MvsnetCamera camera;
  std::string name = file.filename().string();
  if (name.ends_with(kMvsnetEnding)) name.resize(name.size() - kMvsnetEnding.size());
  camera.image.name = name + ".jpg";
  ExportWords words(text, file);
  LF_RETURN_IF_ERROR(ExpectMvsnetWord(&words, "extrinsic"));
  LF_ASSIGN_OR_RETURN(camera.image.cam_from_world, MvsnetPose(&words));
  LF_RETURN_IF_ERROR(ExpectMvsnetWord(&words, "intrinsic"));
  LF_ASSIGN_OR_RETURN(camera.image.intrinsics, MvsnetIntrinsics(&words));
  std::vector<double> depths;
  while (depths.size() < 4 && words.Advance()) {
    LF_ASSIGN_OR_RETURN(const double number, words.Number("the depths", kMostMvsnetNumber));
    depths.push_back(number);
  }
  if (depths.size() < 3) return camera;
  const double far_w = depths.size() == 4 ? depths[3] : depths[0] + depths[1] * (depths[2] - 1);
  if (depths[0] > 0 && depths[0] < far_w) camera.depth_range = DepthRange{depths[0], far_w};
  return camera;
}

Result<LightField> ReadMvsnet(const fs::path& file, const ExportOptions& options) {
  const fs::path folder = FolderAbove(fs::absolute(file)), root = FolderAbove(folder);
  LF_ASSIGN_OR_RETURN(const std::vector<fs::path> files, SortedFilesIn(folder, kMvsnetEnding));
  ExportedCameras exported;
  bool has_depths = true;
  for (const fs::path& one : files) {
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(one, kMostExportBytes));
    LF_ASSIGN_OR_RETURN(MvsnetCamera camera, ParseMvsnetCamera(text, one));
    exported.images.push_back(std::move(camera.image));
    has_depths = has_depths && camera.depth_range.has_value();
    if (!has_depths) continue;
    if (!exported.depth_range) exported.depth_range = camera.depth_range;
    exported.depth_range->near_w =
        std::min(exported.depth_range->near_w, camera.depth_range->near_w);
    exported.depth_range->far_w = std::max(exported.depth_range->far_w, camera.depth_range->far_w);
  }
  if (!has_depths) exported.depth_range.reset();
  exported.folder = FolderWithImages(
      exported.images, {root / kImagesName, root / "blended_images", folder / kImagesName, folder},
      root);
  LF_ASSIGN_OR_RETURN(LightField light_field, FinishExport(std::move(exported), folder, options));
  EnlargeIntrinsics(folder, &light_field);
  return light_field;
}

}  // namespace lf
