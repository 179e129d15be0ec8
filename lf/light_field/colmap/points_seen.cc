// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/points_seen.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/core/random.h"
#include "lf/light_field/colmap/colmap_binary.h"
#include "lf/light_field/colmap/colmap_scene.h"
#include "lf/light_field/colmap/colmap_text.h"

namespace lf {

ColmapPointsSeen::ColmapPointsSeen(uint32_t image_id, const PinholeCamera& camera)
    : image_id_(image_id),
      rays_(camera, camera.ForwardWorld()),
      forward_world_(camera.ForwardWorld()) {}

void ColmapPointsSeen::Sample::Add(uint64_t point_id, const Vec3& point_world) {
  constexpr uint64_t kHashSeed = 1;
  const uint64_t hash = RandomBits(kHashSeed, point_id, 0);
  if (hash > hash_limit) return;
  points.emplace_back(hash, point_world);
  while (points.size() > kMostPointsSeen && hash_limit > 0) {
    hash_limit /= 2;
    std::erase_if(points, [this](const auto& entry) { return entry.first > hash_limit; });
  }
}

bool ColmapPointsSeen::ProjectsIntoImage(const Vec3& point_world) const {
  const Vec3 direction = point_world - rays_.centre_world();
  if (!(forward_world_.dot(direction) > 0)) return false;
  const std::optional<Vec2> at = rays_.RecordedAt(direction);
  const Intrinsics& k = rays_.intrinsics();
  return at && at->x() >= 0 && at->y() >= 0 && at->x() <= k.width_px && at->y() <= k.height_px;
}

Result<void> ColmapPointsSeen::AddPoint(uint64_t point_id, const Vec3& point_world,
                                        bool has_track) {
  has_tracks_ = has_tracks_ || has_track;
  if (!has_tracks_ && ProjectsIntoImage(point_world)) untracked_.Add(point_id, point_world);
  return {};
}

Result<void> ColmapPointsSeen::AddObservation(uint64_t point_id, const Vec3& point_world,
                                              uint32_t image_id) {
  if (image_id == image_id_) tracked_.Add(point_id, point_world);
  return {};
}

std::vector<Vec3> ColmapPointsSeen::Take() {
  std::vector<Vec3> points;
  for (const auto& [hash, point] : (has_tracks_ ? tracked_ : untracked_).points)
    points.push_back(point);
  tracked_ = untracked_ = {};
  return points;
}

Result<std::vector<Vec3>> ParseColmapPointsSeen(ColmapStreams streams, uint32_t position,
                                                const PinholeCamera& camera) {
  if (!streams.points) return std::vector<Vec3>();
  LF_ASSIGN_OR_RETURN(const ColmapScene scene, ReadColmapScene(&streams));
  const std::optional<uint32_t> image_id = scene.ImageIdAt(position);
  if (!image_id)
    return InputError(
        fmt::format("{}: has {} images, but image {} is needed: the file was replaced "
                    "while the program ran; start again",
                    streams.images.path().string(), scene.image_count(), position + 1));
  ColmapPointsSeen seen(*image_id, camera);
  LF_RETURN_IF_ERROR(streams.is_binary ? ReadColmapPointsBinary(&*streams.points, &seen)
                                       : ReadColmapPointsText(&*streams.points, &seen));
  return seen.Take();
}

Result<std::vector<Vec3>> ReadColmapPointsSeen(const std::filesystem::path& model_folder,
                                               uint32_t position, const PinholeCamera& camera) {
  LF_ASSIGN_OR_RETURN(ColmapStreams streams, OpenColmapStreams(model_folder));
  return ParseColmapPointsSeen(std::move(streams), position, camera);
}

}  // namespace lf
