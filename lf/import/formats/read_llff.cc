// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_llff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/parse_number.h"
#include "lf/import/exports/import_limits.h"
#include "lf/import/formats/npy.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/rotation.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kRowSize = 17;
constexpr double kLlffRotationTolerance = 1e-3;  // wide enough for files saved as 32-bit floats

// One row of the array in poses_bounds.npy: the values of one image.
class Row {
 public:
  explicit Row(const double* numbers) : matrix_(numbers), near_far_(numbers + 15) {}

  // The kInput messages of this class do not name the file and the row; the caller adds them.
  Result<RigidTransform> CamFromWorld() const {
    if (!matrix_.allFinite() || !(Centre().cwiseAbs().maxCoeff() <= kLargest_w))
      return InputError(
          fmt::format("the pose holds a number that is not finite, or a camera position beyond "
                      "+-{:g} world units",
                      kLargest_w));
    Mat3 axes;  // camera axes right, down and forward, as rows
    axes.row(0) = matrix_.col(1);
    axes.row(1) = matrix_.col(0);
    axes.row(2) = -matrix_.col(2);
    const Result<Mat3> rotation = NearestRotation(axes, kLlffRotationTolerance);
    if (!rotation)
      return InputError(
          fmt::format("the pose, whose columns are the axes down, right and backwards, {}",
                      rotation.error().message));
    return RigidTransform{*rotation, Vec3::Zero() - *rotation * Centre()};
  }

  Result<Intrinsics> CameraIntrinsics() const {
    const double height = matrix_(0, 4), width = matrix_(1, 4), focal = matrix_(2, 4);
    const auto is_size = [](double x) { return x >= 1 && x <= 65536 && x == std::floor(x); };
    if (!is_size(height) || !is_size(width))
      return InputError(fmt::format(
          "the height and width are {} and {}: expected whole numbers of pixels from 1 to 65536",
          height, width));
    if (!(focal >= 0.001 && focal <= 1e7))
      return InputError(
          fmt::format("the focal length is {} pixels: expected 0.001 to 1e7 pixels", focal));
    return Intrinsics{
        focal, focal, width / 2, height / 2, 0, static_cast<int>(width), static_cast<int>(height)};
  }

  Result<DepthRange> Depths() const {
    const DepthRange depths{near_far_[0], near_far_[1]};
    if (!(depths.near_w > 0 && depths.near_w < depths.far_w && depths.far_w <= kLargest_w))
      return InputError(fmt::format(
          "the near and far bounds are {} and {}: expected world units with 0 < near < far <= {:g}",
          depths.near_w, depths.far_w, kLargest_w));
    return depths;
  }

 private:
  Vec3 Centre() const { return matrix_.col(3); }

  Eigen::Map<const Eigen::Matrix<double, 3, 5, Eigen::RowMajor>> matrix_;
  const double* near_far_;
};

struct RowValues {
  RigidTransform cam_from_world;
  Intrinsics intrinsics;
  DepthRange depths;
};

Result<RowValues> ParseRow(const double* numbers) {
  const Row row(numbers);
  RowValues values;
  LF_ASSIGN_OR_RETURN(values.cam_from_world, row.CamFromWorld());
  LF_ASSIGN_OR_RETURN(values.intrinsics, row.CameraIntrinsics());
  LF_ASSIGN_OR_RETURN(values.depths, row.Depths());
  return values;
}

Result<void> CheckShape(const NpyArray& array, size_t image_count, const fs::path& images_folder,
                        const fs::path& path) {
  const std::vector<size_t>& shape = array.shape;
  if (shape.size() != 2 || shape[1] != kRowSize || shape[0] > kMaxImageCount)
    return InputError(
        fmt::format("{}: holds an array of the shape ({}): expected (N, {}), one row for each of "
                    "at most {} images",
                    path.string(), fmt::join(shape, ", "), kRowSize, kMaxImageCount));
  if (shape[0] != image_count)
    return InputError(fmt::format(
        "{}: holds {} poses, but {} holds {} image files: expected one image file for each pose, "
        "in the same order; remove or add images",
        path.string(), shape[0], (path.parent_path() / images_folder).string(), image_count));
  return {};
}

// Returns kInput if the image has neither the size that the file states nor that of a copy that was
// made smaller by a whole factor. Of such copies, the caller of the reader scales the intrinsics.
Result<void> CheckSize(const Intrinsics& k, const std::array<int, 2>& size, const fs::path& image,
                       const fs::path& path) {
  if (IsWholeFraction(k, size)) return {};
  return InputError(
      fmt::format("{}: is for images of {} x {} pixels, but {} has {} x {}: put the images of the "
                  "stated size into {}, or scale height, width and focal length (columns 4, 9 and "
                  "14 of each row, counted from 0)",
                  path.string(), k.width_px, k.height_px, image.string(), size[0], size[1],
                  image.parent_path().string()));
}

// Returns the folders in and including `root` that may hold the images, relative to it, in the
// order in which ReadLlff() tries them.
std::vector<fs::path> FoldersOfPhotographs(const fs::path& root) {
  const std::string copies = fmt::format("{}_", kImagesName);
  std::vector<std::pair<uint32_t, fs::path>> numbered;  // the copies, with their factors
  std::vector<fs::path> others;
  std::error_code error;
  for (fs::directory_iterator it(root, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    const std::string name = it->path().filename().string();
    if (!it->is_directory(ignored) || name.starts_with('.') || name == kImagesName) continue;
    const auto factor = name.starts_with(copies)
                            ? ParseWhole<uint32_t>(std::string_view(name).substr(copies.size()))
                            : std::nullopt;
    if (factor)
      numbered.emplace_back(*factor, name);
    else if (!NamesSomethingElse(name))
      others.emplace_back(name);
  }
  std::sort(numbered.begin(), numbered.end());
  std::sort(others.begin(), others.end());
  std::vector<fs::path> folders = {kImagesName};
  for (auto& [factor, name] : numbered) folders.push_back(std::move(name));
  folders.insert(folders.end(), others.begin(), others.end());
  folders.emplace_back(".");
  return folders;
}

}  // namespace

Result<LightField> ParseLlff(std::string_view bytes, const fs::path& path,
                             std::span<const std::string> image_names,
                             const ImageSizeSource& image_size, const fs::path& images_folder) {
  const Result<NpyArray> array = ParseNpy(bytes);
  if (!array) return InputError(fmt::format("{}: {}", path.string(), array.error().message));
  LF_RETURN_IF_ERROR(CheckShape(*array, image_names.size(), images_folder, path));

  LightField light_field;
  light_field.folder = path.parent_path();
  DistinctIntrinsics distinct;
  for (size_t i = 0; i < image_names.size(); ++i) {
    const Result<RowValues> row = ParseRow(array->values.data() + i * kRowSize);
    if (!row)
      return InputError(fmt::format("{}: row {} ({}): {}", path.string(), i, image_names[i],
                                    row.error().message));
    light_field.cameras.push_back({row->cam_from_world, distinct.IndexOf(row->intrinsics), 1});
    light_field.image_names.push_back((images_folder / image_names[i]).lexically_normal().string());
    DepthRange& range = light_field.depth_range ? *light_field.depth_range
                                                : light_field.depth_range.emplace(row->depths);
    range = {std::min(range.near_w, row->depths.near_w), std::max(range.far_w, row->depths.far_w)};
    if (i > 0) continue;
    const fs::path image = light_field.ImagePath({0});
    const auto size = image_size(image);
    if (!size) return size.error();
    LF_RETURN_IF_ERROR(CheckSize(row->intrinsics, *size, image, path));
  }
  light_field.intrinsics = distinct.Take();
  light_field.encoding.max_radiance = DefaultMaxRadiance(light_field.image_names);
  return light_field;
}

Result<LightField> ReadLlff(const fs::path& path, const std::optional<fs::path>& images_folder) {
  constexpr size_t kLimit = kMaxImageCount * kRowSize * sizeof(double) + (size_t{1} << 17);
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(path, kLimit));
  const fs::path beside = path.parent_path();
  const fs::path root = images_folder ? fs::absolute(*images_folder) : fs::path();
  fs::path folder = images_folder ? "." : kImagesName;
  if (const Result<NpyArray> array = ParseNpy(bytes); array && !array->shape.empty()) {
    std::vector<fs::path> folders = FoldersOfPhotographs(beside / root);
    if (images_folder) folders.insert(folders.begin(), ".");
    const auto fits = [&](const fs::path& candidate) {
      const auto names = SortedImageNames(beside / root / candidate);
      return names && names->size() == array->shape[0];
    };
    const auto found = std::find_if(folders.begin(), folders.end(), fits);
    if (found != folders.end()) folder = *found;
  }
  LF_ASSIGN_OR_RETURN(const std::vector<std::string> names,
                      SortedImageNames(beside / root / folder));
  return ParseLlff(bytes, path, names, ImageSizeInHeader, root / folder);
}

}  // namespace lf
