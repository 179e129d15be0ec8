// The points of a COLMAP model that one of its images shows: where the scene is, without its
// pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/colmap/read_colmap.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

inline constexpr size_t kMostPointsSeen = 2048;

// Collects the points while a points3D file is read. Internal to colmap.
class ColmapPointsSeen {
 public:
  //   image_id  the number that the model gives the image of this camera
  ColmapPointsSeen(uint32_t image_id, const PinholeCamera& camera);

  // A point of the file; its observations follow.
  Result<void> AddPoint(uint64_t point_id, const Vec3& point_world, bool has_track);
  Result<void> AddObservation(uint64_t point_id, const Vec3& point_world, uint32_t image_id);

  // Returns the points whose tracks name the image. If no point of the file has a track, these are
  // all points that project into the image. Empty afterwards.
  std::vector<Vec3> Take();

 private:
  // At most kMostPointsSeen points, those whose hash is small, the same in any order.
  struct Sample {
    void Add(uint64_t point_id, const Vec3& point_world);

    uint64_t hash_limit = UINT64_MAX;
    std::vector<std::pair<uint64_t, Vec3>> points;  // with their hashes
  };

  bool ProjectsIntoImage(const Vec3& point_world) const;

  uint32_t image_id_;
  RayThrough rays_;
  Vec3 forward_world_;
  bool has_tracks_ = false;
  Sample tracked_, untracked_;
};

// Returns points in world coordinates, at most kMostPointsSeen, evenly chosen; none if the model
// has no points3D file. Cameras, images and points are read once more, a block at a time.
//   position  of the image among all of the model, sorted by name: its LfImageId
//   camera    that took it, with the size of the images that are there
// kInput: errors of ReadColmapModel(); an image beyond the number of images.
Result<std::vector<Vec3>> ReadColmapPointsSeen(const std::filesystem::path& model_folder,
                                               uint32_t position, const PinholeCamera& camera);
// Reads the same from streams.
Result<std::vector<Vec3>> ParseColmapPointsSeen(ColmapStreams streams, uint32_t position,
                                                const PinholeCamera& camera);

}  // namespace lf
