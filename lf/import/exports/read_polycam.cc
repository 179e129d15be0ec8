// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_polycam.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/import/exports/export_files.h"
#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostPolycamNumber = 1e9;

Result<Intrinsics> PolycamIntrinsics(const JsonValue& camera) {
  constexpr int kMostSide_px = 65536;
  Intrinsics k;
  LF_ASSIGN_OR_RETURN(k.fx_px, camera.NumberAt("fx", 1e-6, kMostPolycamNumber));
  LF_ASSIGN_OR_RETURN(k.fy_px, camera.NumberAt("fy", 1e-6, kMostPolycamNumber));
  LF_ASSIGN_OR_RETURN(k.cx_px, camera.NumberAt("cx", -kMostPolycamNumber, kMostPolycamNumber));
  LF_ASSIGN_OR_RETURN(k.cy_px, camera.NumberAt("cy", -kMostPolycamNumber, kMostPolycamNumber));
  LF_ASSIGN_OR_RETURN(k.width_px, camera.WholeAt("width", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.height_px, camera.WholeAt("height", 1, kMostSide_px));
  return k;
}

}  // namespace

Result<ExportedImage> ParsePolycamCamera(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree, ParseExportJson(text, file));
  const JsonValue camera(tree, file);
  ExportedImage image;
  image.name = file.stem().string() + ".jpg";
  LF_ASSIGN_OR_RETURN(image.intrinsics, PolycamIntrinsics(camera));
  std::vector<double> rows;
  Vec3 centre;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      LF_ASSIGN_OR_RETURN(const double number, camera.NumberAt(fmt::format("t_{}{}", row, column),
                                                               -kLargest_w, kLargest_w));
      if (column < 3)
        rows.push_back(number);
      else
        centre[row] = number;
    }
  const Result<Mat3> world_from_opengl = RotationOfRows(rows);
  if (!world_from_opengl) return camera.Fault("t_00 to t_22 " + world_from_opengl.error().message);
  image.cam_from_world = PoseAt(CameraFromOpenGl() * world_from_opengl->transpose(), centre);
  return image;
}

Result<LightField> ReadPolycam(const fs::path& file, const ExportOptions& options) {
  const fs::path folder = FolderAbove(fs::absolute(file)), root = FolderAbove(folder);
  const bool is_corrected = folder.filename().string().starts_with("corrected");
  LF_ASSIGN_OR_RETURN(const std::vector<fs::path> files, SortedFilesIn(folder, ".json"));
  ExportedCameras cameras;
  for (const fs::path& one : files) {
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(one, kMostExportBytes));
    LF_ASSIGN_OR_RETURN(ExportedImage image, ParsePolycamCamera(text, one));
    cameras.images.push_back(std::move(image));
  }
  if (!is_corrected)
    LogWarning(
        "{}: holds the cameras as the phone recorded them: Polycam neither optimised their poses "
        "nor removed the distortion of their lenses, because the scan was too large or Loop "
        "Closure "
        "was off",
        folder.string());
  cameras.folder = FolderWithImages(cameras.images,
                                    {root / (is_corrected ? "corrected_images" : "images")}, root);
  return FinishExport(std::move(cameras), folder, options);
}

}  // namespace lf
