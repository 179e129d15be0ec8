// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_nsvf.h"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/exports/export_files.h"
#include "lf/import/exports/export_words.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/model/image_files.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostNsvfNumber = 1e9;
constexpr double kNsvfCentre_px = 0.5;  // pixel centres of the file are at whole numbers

// Reads all numbers of the text, of which there are at most 16.
Result<std::vector<double>> NsvfNumbers(ExportWords* words, double most) {
  std::vector<double> numbers;
  while (words->Advance()) {
    if (numbers.size() == 16) return words->Fault("has more than 16 numbers");
    LF_ASSIGN_OR_RETURN(const double number, words->Number("a number of the matrix", most));
    numbers.push_back(number);
  }
  return numbers;
}

// Reads the numbers of the first line with any, of which there are at most 16.
Result<std::vector<double>> NsvfFirstLine(ExportWords* words) {
  std::vector<double> numbers;
  if (!words->Advance()) return numbers;
  while (!words->line().AtLineEnd() && numbers.size() < 17) {
    LF_ASSIGN_OR_RETURN(const double number, words->line().Number("a number"));
    numbers.push_back(number);
  }
  return numbers;
}

// Returns the names of the images of the data set, one for each pose.
Result<std::vector<std::string>> NsvfNames(const fs::path& rgb,
                                           const std::vector<fs::path>& poses) {
  std::vector<std::string> names;
  std::error_code error;
  if (!fs::is_directory(rgb, error)) {
    for (const fs::path& pose : poses) names.push_back(pose.stem().string() + ".png");
    return names;
  }
  LF_ASSIGN_OR_RETURN(names, SortedImageNames(rgb));
  if (names.size() != poses.size())
    return InputError(fmt::format(
        "{}: holds {} images, but {} has {} poses: expected as many, because they "
        "belong together in the order of their names",
        rgb.string(), names.size(), poses.front().parent_path().string(), poses.size()));
  return names;
}

// Returns the depth range of near_and_far.txt; none if it is not there or states none.
Result<std::optional<DepthRange>> NsvfDepths(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::optional<DepthRange>();
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostExportBytes));
  ExportWords words(text, file);
  LF_ASSIGN_OR_RETURN(const std::vector<double> depths,
                      words.Numbers("the nearest and the farthest depth", 2, kMostNsvfNumber));
  if (!(depths[0] > 0 && depths[0] < depths[1])) return std::optional<DepthRange>();
  return std::optional(DepthRange{depths[0], depths[1]});
}

}  // namespace

Result<RigidTransform> ParseNsvfPose(std::string_view text, const fs::path& file) {
  ExportWords words(text, file);
  LF_ASSIGN_OR_RETURN(const std::vector<double> m, NsvfNumbers(&words, kLargest_w));
  if (m.size() != 16 || m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    return words.Fault(
        fmt::format("has {} numbers: expected a matrix of 4 x 4 numbers whose last "
                    "row is 0 0 0 1",
                    m.size()));
  const Result<Mat3> world_from_cam =
      RotationOfRows({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]});
  if (!world_from_cam) return words.Fault("the rotation " + world_from_cam.error().message);
  return PoseAt(world_from_cam->transpose(), {m[3], m[7], m[11]});
}

Result<Intrinsics> ParseNsvfIntrinsics(std::string_view text, const fs::path& file) {
  ExportWords first_words(text, file);
  LF_ASSIGN_OR_RETURN(const std::vector<double> first, NsvfFirstLine(&first_words));
  ExportWords words(text, file);
  Intrinsics k;
  // The first line of a matrix is "f 0 cx 0" or "f 0 cx"; that of the other form, "f cx cy 0".
  if (first.size() == 4 && first[1] != 0) {
    k.fx_px = k.fy_px = first[0];
    k.cx_px = first[1] + kNsvfCentre_px;
    k.cy_px = first[2] + kNsvfCentre_px;
    return k;
  }
  LF_ASSIGN_OR_RETURN(const std::vector<double> m, NsvfNumbers(&words, kMostNsvfNumber));
  const size_t columns = m.size() == 16 ? 4 : 3;
  if (m.size() != columns * columns)
    return words.Fault(fmt::format(
        "has {} numbers: expected a matrix of 4 x 4 or 3 x 3 numbers, or the line f cx cy 0",
        m.size()));
  if (m[columns] != 0 || m[2 * columns] != 0 || m[2 * columns + 1] != 0 || m[2 * columns + 2] != 1)
    return words.Fault("the matrix is no K: expected f 0 cx, 0 f cy, 0 0 1 in its first columns");
  k.fx_px = m[0];
  k.skew_px = m[1];
  k.cx_px = m[2] + kNsvfCentre_px;
  k.fy_px = m[columns + 1];
  k.cy_px = m[columns + 2] + kNsvfCentre_px;
  return k;
}

Result<LightField> ReadNsvf(const fs::path& file, const ExportOptions& options) {
  const fs::path folder = FolderAbove(fs::absolute(file)), root = FolderAbove(folder);
  const fs::path intrinsics_file = root / "intrinsics.txt";
  LF_ASSIGN_OR_RETURN(const std::string intrinsics_text,
                      ReadFile(intrinsics_file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const Intrinsics intrinsics,
                      ParseNsvfIntrinsics(intrinsics_text, intrinsics_file));
  LF_ASSIGN_OR_RETURN(const std::vector<fs::path> poses, SortedFilesIn(folder, ".txt"));
  LF_ASSIGN_OR_RETURN(std::vector<std::string> names, NsvfNames(root / "rgb", poses));
  ExportedCameras exported;
  for (size_t i = 0; i < poses.size(); ++i) {
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(poses[i], kMostExportBytes));
    LF_ASSIGN_OR_RETURN(const RigidTransform pose, ParseNsvfPose(text, poses[i]));
    exported.images.push_back({std::move(names[i]), intrinsics, pose});
  }
  LF_ASSIGN_OR_RETURN(exported.depth_range, NsvfDepths(root / "near_and_far.txt"));
  exported.folder = FolderWithImages(exported.images, {root / "rgb"}, root);
  return FinishExport(std::move(exported), folder, options);
}

}  // namespace lf
