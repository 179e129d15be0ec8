// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/files_nearby.h"
#include "lf/core/log.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/rotation.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostNameBytes = 4096;  // length of the longest path on Linux
constexpr double kMostSize_px = 65536;
constexpr double kMostPixelCount = 1 << 30;  // the limit of pixels/files/image_file.h
constexpr double kMostFocal_px = 1e7;
constexpr double kLeastFocal_px = 1e-3;
constexpr double kMostOffset_px = 1e7;

using Size = std::array<int, 2>;

bool HasSize(const Intrinsics& k) { return k.width_px != 0 || k.height_px != 0; }

// Returns "FILE: image 3 (NAME)", which begins the messages about an image.
std::string PlaceOf(const ExportedImage& image, size_t index, const fs::path& file) {
  constexpr size_t kMostShown = 200;
  return fmt::format("{}: image {} ({})", file.string(), index + 1,
                     image.name.substr(0, kMostShown));
}

Result<void> CheckName(const std::string& name) {
  if (name.empty()) return InputError("has no name: expected the name of an image file");
  if (name.size() > kMostNameBytes)
    return InputError(
        fmt::format("has a name of {} bytes: expected at most {}", name.size(), kMostNameBytes));
  if (name.find('\0') != std::string::npos)
    return InputError("has a NUL character in its name: expected the name of an image file");
  return {};
}

Result<void> CheckIntrinsics(const Intrinsics& k) {
  const auto is_focal = [](double x) { return x >= kLeastFocal_px && x <= kMostFocal_px; };
  if (!is_focal(k.fx_px) || !is_focal(k.fy_px))
    return InputError(
        fmt::format("has the focal lengths {:g} and {:g} pixels: expected {:g} to {:g} pixels",
                    k.fx_px, k.fy_px, kLeastFocal_px, kMostFocal_px));
  for (const double x : {k.cx_px, k.cy_px, k.skew_px})
    if (!(std::abs(x) <= kMostOffset_px))
      return InputError(
          fmt::format("has the principal point ({:g}, {:g}) and the skew {:g}: expected pixels "
                      "within +-{:g}",
                      k.cx_px, k.cy_px, k.skew_px, kMostOffset_px));
  const DistortionParameters& distortion = k.distortion.parameters;
  if (!std::all_of(distortion.begin(), distortion.end(),
                   [](double x) { return std::abs(x) <= 1e9; }) ||
      !IsDistortion(k.distortion))
    return InputError("has a lens distortion whose numbers are too large or not valid");
  return {};
}

Result<void> CheckSize(const Intrinsics& k) {
  const auto is_side = [](int size) { return size >= 1 && size <= kMostSize_px; };
  if (is_side(k.width_px) && is_side(k.height_px) &&
      static_cast<double>(k.width_px) * k.height_px <= kMostPixelCount)
    return {};
  return InputError(
      fmt::format("has {} x {} pixels: expected 1 to {:g} on each side, and at most 2^30 in total",
                  k.width_px, k.height_px, kMostSize_px));
}

Result<void> CheckPose(const RigidTransform& cam_from_world) {
  const Vec3 centre = cam_from_world.Inverse().translation;
  if (centre.allFinite() && centre.cwiseAbs().maxCoeff() <= kLargest_w) return {};
  return InputError(
      fmt::format("has its camera at ({:g}, {:g}, {:g}): expected coordinates within +-{:g}",
                  centre.x(), centre.y(), centre.z(), kLargest_w));
}

Result<void> CheckImage(const ExportedImage& image) {
  LF_RETURN_IF_ERROR(CheckName(image.name));
  LF_RETURN_IF_ERROR(CheckIntrinsics(image.intrinsics));
  if (HasSize(image.intrinsics)) LF_RETURN_IF_ERROR(CheckSize(image.intrinsics));
  return CheckPose(image.cam_from_world);
}

Result<void> CheckImages(const ExportedCameras& cameras, const fs::path& file) {
  if (cameras.images.empty())
    return InputError(fmt::format(
        "{}: holds no image with a pose: export the cameras again, after they were aligned",
        file.string()));
  if (cameras.images.size() > kMaxImageCount)
    return InputError(fmt::format("{}: holds {} images: expected at most {}", file.string(),
                                  cameras.images.size(), kMaxImageCount));
  std::unordered_set<std::string_view> names;
  for (size_t i = 0; i < cameras.images.size(); ++i) {
    const ExportedImage& image = cameras.images[i];
    if (const Result<void> checked = CheckImage(image); !checked)
      return InputError(fmt::format("{}: {}", PlaceOf(image, i, file), checked.error().message));
    if (!names.insert(image.name).second)
      return InputError(fmt::format("{}: has the name of an earlier image: remove one of the two",
                                    PlaceOf(image, i, file)));
  }
  return {};
}

void SetSize(const Size& size, const ExportedCameras& cameras, Intrinsics* k) {
  k->width_px = size[0];
  k->height_px = size[1];
  if (cameras.in_larger_sides)
    for (double* const length : {&k->fx_px, &k->fy_px, &k->cx_px, &k->cy_px, &k->skew_px})
      *length *= std::max(size[0], size[1]);
  if (!cameras.counts_from_middle) return;
  k->cx_px += 0.5 * size[0];
  k->cy_px += 0.5 * size[1];
}

// Returns true if an image file must be looked at to know all about an image.
bool NeedsFile(const ExportedImage& image) {
  return !HasSize(image.intrinsics) || !IsImageName(image.name);
}

// Finds the image files, and completes the images without a size.
Result<void> FindFiles(const ExportOptions& options, const fs::path& file,
                       ExportedCameras* cameras) {
  LightField names;  // only what FindImageFiles() changes
  names.folder = cameras->folder;
  names.cameras.resize(cameras->images.size());
  for (const ExportedImage& image : cameras->images) names.image_names.push_back(image.name);
  LF_RETURN_IF_ERROR(FindImageFiles(options.images_folder, &names));
  std::optional<Size> first;
  std::vector<Intrinsics*> without_file;
  for (size_t i = 0; i < cameras->images.size(); ++i) {
    ExportedImage& image = cameras->images[i];
    image.name = names.image_names[i];
    if (HasSize(image.intrinsics)) continue;
    Result<Size> size = first && cameras->sizes_from == SizesFrom::kFirstImage
                            ? Result<Size>(*first)
                            : options.image_size(names.folder / image.name);
    if (!size && size.error().kind != ErrorKind::kInput) return size.error();
    if (!size) {
      without_file.push_back(&image.intrinsics);
      continue;
    }
    if (!first) first = *size;
    SetSize(*size, *cameras, &image.intrinsics);
    if (const Result<void> checked = CheckImage(image); !checked)
      return InputError(fmt::format("{}: {}", PlaceOf(image, i, file), checked.error().message));
  }
  cameras->folder = names.folder;
  if (!first && !without_file.empty()) {
    const fs::path path = names.folder / names.image_names[0];
    return InputError(
        fmt::format("{}: does not state the sizes of the images, and none of their files was "
                    "found, such as {}{}: give their folder ({{images}})",
                    file.string(), path.string(), FilesNearby(path)));
  }
  for (Intrinsics* const k : without_file) SetSize(*first, *cameras, k);
  return {};
}

}  // namespace

Result<LightField> FinishExport(ExportedCameras cameras, const fs::path& file,
                                const ExportOptions& options) {
  LF_RETURN_IF_ERROR(CheckImages(cameras, file));
  if (cameras.folder.empty()) cameras.folder = ".";
  if (std::any_of(cameras.images.begin(), cameras.images.end(), NeedsFile))
    LF_RETURN_IF_ERROR(FindFiles(options, file, &cameras));
  LightField light_field;
  light_field.folder = cameras.folder;
  light_field.depth_range = cameras.depth_range;
  light_field.unit_m = cameras.unit_m;
  DistinctIntrinsics distinct;
  for (ExportedImage& image : cameras.images) {
    LfCamera camera;
    camera.cam_from_world = image.cam_from_world;
    camera.intrinsics_index = distinct.IndexOf(image.intrinsics);
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(std::move(image.name));
  }
  light_field.intrinsics = distinct.Take();
  light_field.encoding.max_radiance = DefaultMaxRadiance(light_field.image_names);
  return light_field;
}

Result<LightField> ReadExport(const fs::path& file, const ExportOptions& options,
                              ParseExport parse) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(ExportedCameras cameras, parse(text, file));
  return FinishExport(std::move(cameras), file, options);
}

fs::path FolderWithImages(const std::vector<ExportedImage>& images,
                          const std::vector<fs::path>& folders, const fs::path& otherwise) {
  LightField names;
  names.cameras.resize(images.size());
  for (const ExportedImage& image : images) names.image_names.push_back(image.name);
  for (const fs::path& folder : folders) {
    names.folder = folder.lexically_normal();
    if (HasSomeImageFiles(names)) return names.folder;
  }
  return otherwise;
}

fs::path FolderAbove(const fs::path& path) {
  const fs::path above = path.parent_path();
  return above.empty() ? fs::path(".") : above;
}

void LogPosedCount(const fs::path& file, size_t posed_count, size_t image_count) {
  if (posed_count == image_count) return;
  LogInfo("{}: {} of {} images have a pose; the others are left out", file.string(), posed_count,
          image_count);
}

Distortion DistortionOf(DistortionModel model, const DistortionParameters& parameters) {
  const bool is_zero = std::all_of(parameters.begin(), parameters.end(),
                                   [](double parameter) { return parameter == 0; });
  if (model == DistortionModel::kRadialTangential && is_zero) return {};
  return {model, parameters};
}

Result<Mat3> RotationOfQuaternion(double w, double x, double y, double z) {
  const Eigen::Quaterniond quaternion(w, x, y, z);
  const double norm = quaternion.norm();
  if (!(std::abs(norm - 1) <= 0.01))
    return InputError(fmt::format(
        "({:g}, {:g}, {:g}, {:g}) has the length {:g}: expected a quaternion of length 1", w, x, y,
        z, norm));
  return NearestRotation(quaternion.normalized().toRotationMatrix(), kExportRotationTolerance);
}

Result<Mat3> RotationOfAxisAngle(const Vec3& axis_angle) {
  constexpr double kMostTurn_rad = 1e3;
  const double angle_rad = axis_angle.norm();
  if (!(angle_rad <= kMostTurn_rad))
    return InputError(
        fmt::format("({:g}, {:g}, {:g}) is no rotation: expected an axis whose length is "
                    "the angle in radians, at most {:g}",
                    axis_angle.x(), axis_angle.y(), axis_angle.z(), kMostTurn_rad));
  if (angle_rad == 0) return Mat3(Mat3::Identity());
  return NearestRotation(Eigen::AngleAxisd(angle_rad, axis_angle / angle_rad).toRotationMatrix(),
                         kExportRotationTolerance);
}

std::optional<Intrinsics> IntrinsicsOfRows(const std::vector<double>& numbers) {
  const std::vector<double>& m = numbers;
  LF_CHECK(m.size() == 9);
  if (m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1) return std::nullopt;
  Intrinsics k;
  k.fx_px = m[0];
  k.skew_px = m[1];
  k.cx_px = m[2];
  k.fy_px = m[4];
  k.cy_px = m[5];
  return k;
}

Result<Mat3> RotationOfRows(const std::vector<double>& numbers) {
  LF_CHECK(numbers.size() == 9);
  return NearestRotation(Mat3(Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(numbers.data())),
                         kExportRotationTolerance);
}

}  // namespace lf
