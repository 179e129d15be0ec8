// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_nvm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "lf/import/exports/export_words.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostNvmNumber = 1e9;

// The calibration that all cameras share, if the first line states it.
struct FixedNvmCamera {
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
};

// Reads the rest of the first line: nothing, or FixedK fx cx fy cy r.
Result<std::optional<FixedNvmCamera>> ReadFixedCamera(ExportWords* words) {
  if (words->line().AtLineEnd()) return std::optional<FixedNvmCamera>();
  const std::string word(words->line().Word());
  if (word != "FixedK")
    return words->Fault(
        fmt::format("\"{}\": expected FixedK or the end of the line", word.substr(0, 40)));
  LF_ASSIGN_OR_RETURN(const std::vector<double> k,
                      words->Numbers("fx cx fy cy r of FixedK", 5, kMostNvmNumber));
  return std::optional(FixedNvmCamera{k[0], k[2], k[1], k[3]});
}

Result<RigidTransform> NvmPose(bool has_matrix, ExportWords* words) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> turn,
                      words->Numbers("the rotation", has_matrix ? 9 : 4, 2));
  LF_ASSIGN_OR_RETURN(const std::vector<double> place,
                      words->Numbers("the position", 3, kLargest_w));
  const Result<Mat3> rotation =
      has_matrix ? RotationOfRows(turn) : RotationOfQuaternion(turn[0], turn[1], turn[2], turn[3]);
  if (!rotation) return words->Fault("the rotation " + rotation.error().message);
  if (has_matrix) return RigidTransform{*rotation, Vec3(place.data())};
  return PoseAt(*rotation, Vec3(place.data()));
}

// Reads NAME f ROTATION POSITION r 0.
Result<ExportedImage> NvmImage(bool has_matrix, const std::optional<FixedNvmCamera>& fixed,
                               ExportWords* words) {
  ExportedImage image;
  LF_ASSIGN_OR_RETURN(image.name, words->Word("the name of an image"));
  // VisualSFM writes quotation marks in place of blanks.
  std::replace(image.name.begin(), image.name.end(), '"', ' ');
  LF_ASSIGN_OR_RETURN(const double focal_px, words->Number("the focal length", kMostNvmNumber));
  LF_ASSIGN_OR_RETURN(image.cam_from_world, NvmPose(has_matrix, words));
  LF_ASSIGN_OR_RETURN(const double radial, words->Number("the radial distortion", kMostNvmNumber));
  LF_RETURN_IF_ERROR(words->Number("the 0 behind the radial distortion", kMostNvmNumber));
  Intrinsics& k = image.intrinsics;
  k.fx_px = fixed ? fixed->fx_px : focal_px;
  k.fy_px = fixed ? fixed->fy_px : focal_px;
  if (fixed) {
    k.cx_px = fixed->cx_px;
    k.cy_px = fixed->cy_px;
  }
  if (radial != 0) k.distortion = InverseOfNvmRadial(radial);
  return image;
}

// Returns how far, in pixels, the distortion of `k` is from undoing r at the farthest corner of the
// image; infinity if r has no inverse there.
double CornerError(const Intrinsics& k, double r) {
  const double x = std::max(k.cx_px, k.width_px - k.cx_px) / k.fx_px;
  const double y = std::max(k.cy_px, k.height_px - k.cy_px) / k.fy_px;
  const double distorted = std::hypot(x, y);
  const double undistorted = distorted * (1 + r * distorted * distorted);
  if (!(1 + 3 * r * distorted * distorted > 0)) return INFINITY;
  const std::optional<Vec2> found = DistortionMap(k.distortion).Distort({undistorted, 0, 1});
  if (!found) return INFINITY;
  return std::abs(found->x() - distorted) * std::max(k.fx_px, k.fy_px);
}

}  // namespace

Distortion InverseOfNvmRadial(double r) {
  // f with distorted = undistorted f solves f + u f^3 = 1 for u = r undistorted^2. Its power series
  // 1 - u + 3 u^2 - 12 u^3 + 55 u^4 ... has this Pade approximant of the order [3/3].
  const double a1 = 113. / 13, a2 = 243. / 13, a3 = 85. / 13;
  const double b1 = 126. / 13, b2 = 330. / 13, b3 = 193. / 13;
  return {DistortionModel::kRadialTangential,
          {a1 * r, a2 * r * r, 0, 0, a3 * r * r * r, b1 * r, b2 * r * r, b3 * r * r * r}};
}

Result<ExportedCameras> ParseNvm(std::string_view text, const fs::path& file) {
  ExportWords words(text, file);
  LF_ASSIGN_OR_RETURN(const std::string header, words.Word("NVM_V3"));
  const bool has_matrix = header == "NVM_V3_R9T";
  if (!has_matrix && header != "NVM_V3")
    return words.Fault(
        fmt::format("\"{}\": expected the first word NVM_V3 or NVM_V3_R9T", header.substr(0, 40)));
  LF_ASSIGN_OR_RETURN(const std::optional<FixedNvmCamera> fixed, ReadFixedCamera(&words));
  LF_ASSIGN_OR_RETURN(const double stated, words.Number("the number of cameras", kMostNvmNumber));
  if (stated != std::floor(stated) || stated < 1 || stated > kMaxImageCount)
    return words.Fault(
        fmt::format("the number of cameras is {:g}: expected 1 to {}", stated, kMaxImageCount));
  ExportedCameras exported;
  exported.folder = file.parent_path();
  exported.sizes_from = SizesFrom::kEachImage;
  exported.counts_from_middle = !fixed;
  for (auto count = static_cast<size_t>(stated); count > 0; --count) {
    LF_ASSIGN_OR_RETURN(ExportedImage image, NvmImage(has_matrix, fixed, &words));
    exported.images.push_back(std::move(image));
  }
  return exported;
}

Result<LightField> ReadNvm(const fs::path& file, const ExportOptions& options) {
  constexpr double kMostError_px = 1e-3;
  LF_ASSIGN_OR_RETURN(LightField light_field, ReadExport(file, options, ParseNvm));
  for (const Intrinsics& k : light_field.intrinsics) {
    if (!k.has_distortion()) continue;
    // r is recovered from k4, which is b1 r.
    const double r = k.distortion.parameters[5] * 13 / 126;
    if (const double error_px = CornerError(k, r); error_px > kMostError_px)
      return InputError(fmt::format(
          "{}: the radial distortion {:g} of VisualSFM is too large for images of {} x "
          "{} pixels and the focal length {:g}: its inverse is {:.2g} pixels wrong in a "
          "corner, expected at most {:g}: let VisualSFM undistort the images (SfM > More "
          "Functions > Run CMVS/PMVS), and open its bundle file",
          file.string(), r, k.width_px, k.height_px, k.fx_px, error_px, kMostError_px));
  }
  return light_field;
}

}  // namespace lf
