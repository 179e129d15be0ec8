// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lf/light_field/model/distinct_intrinsics.h"

namespace lf {
namespace {

constexpr double kLargest_w = 1e12;  // largest absolute value in a translation
// Largest deviation of a quaternion's length from 1. Rounding to a few digits causes less.
constexpr double kNormTolerance = 1e-3;

Result<RigidTransform> PoseOf(const ColmapImage& image) {
  const auto& [w, x, y, z] = image.quaternion;
  const Eigen::Quaterniond quaternion(w, x, y, z);
  if (!(std::abs(quaternion.norm() - 1) <= kNormTolerance))
    return InputError(
        fmt::format("has the quaternion {} {} {} {} (w x y z) of norm {:g}: expected a rotation, "
                    "of norm 1 +- {:g}",
                    w, x, y, z, quaternion.norm(), kNormTolerance));
  RigidTransform cam_from_world;
  cam_from_world.rotation = quaternion.normalized().toRotationMatrix();
  cam_from_world.translation = Vec3(image.translation.data());
  if (!(cam_from_world.translation.cwiseAbs().maxCoeff() <= kLargest_w) ||
      !cam_from_world.translation.allFinite())
    return InputError(fmt::format("has the translation {}: expected finite numbers within +-{:g}",
                                  fmt::join(image.translation, " "), kLargest_w));
  return cam_from_world;
}

Result<void> CheckName(const std::string& name) {
  if (name.empty()) return InputError("has no name: expected the name of its image file");
  if (name.size() > kMaxColmapNameSize)
    return InputError(fmt::format(
        "has a name of more than {} bytes: copy the file again, because it is probably damaged",
        kMaxColmapNameSize));
  if (std::any_of(name.begin(), name.end(),
                  [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    return InputError(
        "has a name with control characters: copy the file again, because it is probably damaged");
  return {};
}

// Moves values[order[i]] to values[i] for all i, in place.
template <class T>
void Permute(std::vector<uint32_t> order, std::vector<T>* values) {
  for (uint32_t start = 0; start < order.size(); ++start) {
    T first = std::move((*values)[start]);
    uint32_t at = start;
    while (order[at] != start) {
      const uint32_t from = order[at];
      (*values)[at] = std::move((*values)[from]);
      order[at] = at;
      at = from;
    }
    (*values)[at] = std::move(first);
    order[at] = at;
  }
}

}  // namespace

std::optional<uint32_t> ColmapIds::Sort() {
  if (!std::is_sorted(positions_.begin(), positions_.end()))
    std::sort(positions_.begin(), positions_.end());
  const auto twice =
      std::adjacent_find(positions_.begin(), positions_.end(),
                         [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice == positions_.end()) return std::nullopt;
  return twice->first;
}

std::optional<uint32_t> ColmapIds::Find(uint32_t id) const {
  if (positions_.empty() || id < positions_.front().first) return std::nullopt;
  // If the ids have no gaps, as in most models, the entry with `id` is at this index.
  const size_t guess = id - positions_.front().first;
  if (guess < positions_.size() && positions_[guess].first == id) return positions_[guess].second;
  const auto found = std::lower_bound(positions_.begin(), positions_.end(), std::pair(id, 0u));
  if (found == positions_.end() || found->first != id) return std::nullopt;
  return found->second;
}

std::optional<uint32_t> ColmapIds::IdOf(uint32_t position) const {
  const auto found = std::find_if(positions_.begin(), positions_.end(),
                                  [position](const auto& one) { return one.second == position; });
  return found == positions_.end() ? std::nullopt : std::optional(found->first);
}

void ColmapScene::ReserveImages(size_t count) {
  light_field_.cameras.reserve(count);
  light_field_.image_names.reserve(count);
  image_ids_.reserve(count);
}

Result<void> ColmapScene::AddCamera(uint32_t id, const ColmapCameraModel& model, uint64_t width,
                                    uint64_t height, std::span<const double> parameters) {
  if (cameras_.size() == kMaxColmapEntryCount)
    return InputError(
        fmt::format("is one camera too many: expected at most {} cameras", kMaxColmapEntryCount));
  LF_ASSIGN_OR_RETURN(const Intrinsics intrinsics,
                      IntrinsicsOfColmap(model, width, height, parameters));
  camera_ids_.Add(id, static_cast<uint32_t>(cameras_.size()));
  cameras_.push_back(intrinsics);
  return {};
}

Result<void> ColmapScene::EndCameras() {
  if (const std::optional<uint32_t> twice = camera_ids_.Sort())
    return InputError(
        fmt::format("two cameras have the ID {}: expected a different ID for each camera; export "
                    "the model from COLMAP again",
                    *twice));
  return {};
}

Result<void> ColmapScene::AddImage(ColmapImage&& image) {
  if (image_count() == kMaxColmapEntryCount)
    return InputError(
        fmt::format("is one image too many: expected at most {} images", kMaxColmapEntryCount));
  LF_RETURN_IF_ERROR(CheckName(image.name));
  LfCamera camera;
  LF_ASSIGN_OR_RETURN(camera.cam_from_world, PoseOf(image));
  const std::optional<uint32_t> camera_position = camera_ids_.Find(image.camera_id);
  if (!camera_position)
    return InputError(
        fmt::format("has the camera ID {}, which none of the {} cameras in the cameras file has: "
                    "copy both files from the same model",
                    image.camera_id, cameras_.size()));
  camera.intrinsics_index = *camera_position;
  light_field_.cameras.push_back(camera);
  light_field_.image_names.push_back(std::move(image.name));
  image_ids_.push_back(image.id);
  return {};
}

void ColmapScene::SortImages() {
  const std::vector<std::string>& names = light_field_.image_names;
  if (std::is_sorted(names.begin(), names.end())) return;
  std::vector<uint32_t> order(image_count());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return names[a] < names[b]; });
  Permute(order, &light_field_.cameras);
  Permute(order, &light_field_.image_names);
  Permute(std::move(order), &image_ids_);
}

Result<void> ColmapScene::EndImages() {
  if (image_count() == 0)
    return InputError("holds no images: expected at least one registered image");
  SortImages();
  image_positions_.Reserve(image_count());
  for (uint32_t i = 0; i < image_count(); ++i) image_positions_.Add(image_ids_[i], i);
  if (const std::optional<uint32_t> twice = image_positions_.Sort())
    return InputError(
        fmt::format("two images have the ID {}: expected a different ID for each image; export the "
                    "model from COLMAP again",
                    *twice));
  const std::vector<std::string>& names = light_field_.image_names;
  if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end()) {
    const auto [first, second] =
        std::minmax(image_ids_[twice - names.begin()], image_ids_[twice - names.begin() + 1]);
    return InputError(
        fmt::format("the images with the IDs {} and {} have the same name {}: expected a different "
                    "file name for each image",
                    first, second, *twice));
  }
  image_ids_ = {};
  return {};
}

Result<void> ColmapScene::AddObservation(uint64_t point_id, const Vec3& point_world,
                                         uint32_t image_id) {
  const std::optional<uint32_t> position = image_positions_.Find(image_id);
  if (!position)
    return InputError(
        fmt::format("is seen by the image with ID {}, which the images file does not contain: copy "
                    "both files from the same model, or remove the points file to read the model "
                    "without a range of depths",
                    image_id));
  if (!depths_.MayKeep(point_id, image_id))
    return {};  // saves reading the pose, which is slow: poses are scattered in memory
  const RigidTransform& pose = light_field_.cameras[*position].cam_from_world;
  depths_.Add(point_id, image_id, pose.rotation.row(2).dot(point_world) + pose.translation.z());
  return {};
}

LightField ColmapScene::Take() {
  constexpr uint32_t kNotYet = UINT32_MAX;
  std::vector<uint32_t> resolved(cameras_.size(), kNotYet);
  DistinctIntrinsics distinct;
  for (LfCamera& camera : light_field_.cameras) {
    uint32_t& index = resolved[camera.intrinsics_index];
    if (index == kNotYet) index = distinct.IndexOf(cameras_[camera.intrinsics_index]);
    camera.intrinsics_index = index;
  }
  light_field_.intrinsics = distinct.Take();
  light_field_.depth_range = depths_.Range();
  light_field_.encoding.max_radiance = DefaultMaxRadiance(light_field_.image_names);
  return std::exchange(light_field_, {});
}

}  // namespace lf
