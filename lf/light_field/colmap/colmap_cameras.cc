// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lf {
namespace {

constexpr uint64_t kMaxSize_px = 65536;
constexpr uint64_t kMaxPixelCount = 1 << 30;  // the limit of pixels/files/image_file.h
constexpr double kMinFocal_px = 0.001;
constexpr double kMaxFocal_px = 1e7;
constexpr double kMaxPrincipal_px = 1e7;
// kMaxDistortion and kMaxOmega equal the limits for transforms.json.
constexpr double kMaxDistortion = 1e6;
constexpr double kMaxOmega = 3.1415;  // largest field of view of the FOV model, in radians
// The FOV model with an omega below this limit bends no ray by more than a rounding error.
constexpr double kMinOmega = 1e-7;

constexpr ColmapCameraModel kModels[] = {
    {"SIMPLE_PINHOLE", 0, 3},
    {"PINHOLE", 1, 4},
    {"SIMPLE_RADIAL", 2, 4},
    {"RADIAL", 3, 5},
    {"OPENCV", 4, 8},
    {"OPENCV_FISHEYE", 5, 8},
    {"FULL_OPENCV", 6, 12},
    {"FOV", 7, 5},
    {"SIMPLE_RADIAL_FISHEYE", 8, 4},
    {"RADIAL_FISHEYE", 9, 5},
    {"THIN_PRISM_FISHEYE", 10, 12},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 11, 16},
    {"SIMPLE_DIVISION", 12, 4},
    {"DIVISION", 13, 5},
    {"SIMPLE_FISHEYE", 14, 3},
    {"FISHEYE", 15, 4},
    {"EUCM", 16, 6},
    {"EQUIRECTANGULAR", 17, 0},
};

Error Unsupported(std::string_view what) {
  return InputError(
      fmt::format("has the camera model {}, which is not supported: undistort the images first "
                  "(colmap image_undistorter), or reconstruct with another model (e.g. OPENCV, "
                  "OPENCV_FISHEYE)",
                  what));
}

Error Panorama(std::string_view model) {
  return InputError(
      fmt::format("has the camera model {}, which is a panorama of the whole sphere: LF images are "
                  "perspective or fish-eye; cut perspective images out of the panoramas and "
                  "reconstruct with these (COLMAP's python/examples/panorama_sfm.py does both)",
                  model));
}

template <class IsIt>
Result<ColmapCameraModel> Find(const IsIt& is_it, const std::string& unknown) {
  const auto* found = std::find_if(std::begin(kModels), std::end(kModels), is_it);
  if (found == std::end(kModels)) return Unsupported(unknown);
  if (!found->is_supported()) return Panorama(found->name);
  return *found;
}

bool HasOneFocalLength(std::string_view model) {
  return model.starts_with("SIMPLE_") || model.starts_with("RADIAL");
}

DistortionModel DistortionModelOf(std::string_view model) {
  if (model.ends_with("PINHOLE")) return DistortionModel::kNone;
  if (model == "FOV") return DistortionModel::kFov;
  if (model == "EUCM") return DistortionModel::kUnified;
  if (model == "THIN_PRISM_FISHEYE") return DistortionModel::kThinPrism;
  if (model == "RAD_TAN_THIN_PRISM_FISHEYE") return DistortionModel::kRadialTangentialThinPrism;
  if (model.ends_with("DIVISION")) return DistortionModel::kDivision;
  if (model.ends_with("FISHEYE")) return DistortionModel::kFisheye;
  return DistortionModel::kRadialTangential;
}

// Converts the parameters that follow the principal point. Their order is the same in COLMAP and in
// Distortion.
Result<Distortion> DistortionOf(std::string_view model, std::span<const double> coefficients) {
  Distortion distortion;
  distortion.model = DistortionModelOf(model);
  for (const double k : coefficients)
    if (!(std::abs(k) <= kMaxDistortion))
      return InputError(fmt::format(
          "has the distortion parameter {}: expected a number within +-{:g}", k, kMaxDistortion));
  std::copy(coefficients.begin(), coefficients.end(), distortion.parameters.begin());
  if (distortion.model == DistortionModel::kFov) {
    // Both signs of omega give the same distortion; COLMAP's optimizer may find either.
    double& omega = distortion.parameters[0];
    omega = std::abs(omega);
    if (!(omega < kMaxOmega))
      return InputError(
          fmt::format("has the distortion parameter omega {}: expected radians below pi", omega));
    if (omega < kMinOmega) return Distortion{};
  }
  if (!IsDistortion(distortion))
    return InputError(
        fmt::format("has the distortion parameters alpha {} and beta {}: expected alpha from 0 to "
                    "1 and beta above 0",
                    distortion.parameters[0], distortion.parameters[1]));
  if (distortion.model == DistortionModel::kUnified && distortion.parameters[0] == 0)
    return Distortion{};
  const bool is_of_pinhole = distortion.model == DistortionModel::kRadialTangential ||
                             distortion.model == DistortionModel::kDivision;
  if (is_of_pinhole &&
      std::all_of(coefficients.begin(), coefficients.end(), [](double k) { return k == 0; }))
    return Distortion{};
  return distortion;
}

}  // namespace

Result<ColmapCameraModel> FindColmapCameraModel(int32_t number) {
  return Find([&](const ColmapCameraModel& model) { return model.number == number; },
              fmt::format("number {}", number));
}

Result<ColmapCameraModel> FindColmapCameraModel(std::string_view name) {
  return Find([&](const ColmapCameraModel& model) { return model.name == name; },
              fmt::format("\"{}\"", name));
}

Result<Intrinsics> IntrinsicsOfColmap(const ColmapCameraModel& model, uint64_t width,
                                      uint64_t height, std::span<const double> parameters) {
  LF_CHECK(model.is_supported() && parameters.size() == static_cast<size_t>(model.parameter_count));
  if (width < 1 || height < 1 || width > kMaxSize_px || height > kMaxSize_px)
    return InputError(
        fmt::format("has images of {} x {} pixels: expected a width and a height from 1 to {}",
                    width, height, kMaxSize_px));
  if (width * height > kMaxPixelCount)
    return InputError(fmt::format(
        "has images of {} x {} pixels: expected at most 2^30 pixels in total", width, height));
  for (const double parameter : parameters)
    if (!std::isfinite(parameter))
      return InputError(
          fmt::format("has the parameters {} of the camera model {}: expected finite numbers",
                      fmt::join(parameters, " "), model.name));

  Intrinsics k;
  k.width_px = static_cast<int>(width);
  k.height_px = static_cast<int>(height);
  const size_t focal_count = HasOneFocalLength(model.name) ? 1 : 2;
  k.fx_px = parameters[0];
  k.fy_px = parameters[focal_count - 1];
  k.cx_px = parameters[focal_count];
  k.cy_px = parameters[focal_count + 1];
  for (const double focal_px : {k.fx_px, k.fy_px})
    if (!(focal_px >= kMinFocal_px && focal_px <= kMaxFocal_px))
      return InputError(fmt::format("has a focal length of {} px: expected {} to {:g} px", focal_px,
                                    kMinFocal_px, kMaxFocal_px));
  for (const double principal_px : {k.cx_px, k.cy_px})
    if (!(std::abs(principal_px) <= kMaxPrincipal_px))
      return InputError(
          fmt::format("has a coordinate of the principal point at {} px: expected within +-{:g} px",
                      principal_px, kMaxPrincipal_px));
  LF_ASSIGN_OR_RETURN(k.distortion, DistortionOf(model.name, parameters.subspan(focal_count + 2)));
  return k;
}

}  // namespace lf
