// SPDX-License-Identifier: Apache-2.0
// Finds the points of a COLMAP model that one of its images shows. These points describe the
// geometry of the scene; no pixels have to be read for them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/colmap/read_colmap.h"

namespace lf {

inline constexpr size_t kMostPointsSeen = 2048;  // largest number of points that are returned

// Collects the points that one image sees while a points3D file is read. Internal to this folder.
class ColmapPointsSeen {
 public:
  // image_id  the id of the image in the model
  ColmapPointsSeen(uint32_t image_id, const PinholeCamera& camera);

  // Adds a point of the file; its observations are added next.
  Result<void> AddPoint(uint64_t point_id, const Vec3& point_world, bool has_track);
  Result<void> AddObservation(uint64_t point_id, const Vec3& point_world, uint32_t image_id);

  // Returns the points whose tracks contain the image. If no point of the file has a track, returns
  // the points that project into the image. This object is empty afterwards.
  std::vector<Vec3> Take();

 private:
  // Keeps at most kMostPointsSeen points: the points whose hashes are at most a limit, which is
  // halved whenever there are more points. The order in which points are added has no influence.
  struct Sample {
    void Add(uint64_t point_id, const Vec3& point_world);

    uint64_t hash_limit = UINT64_MAX;
    std::vector<std::pair<uint64_t, Vec3>> points;  // hash and position of each kept point
  };

  bool ProjectsIntoImage(const Vec3& point_world) const;

  uint32_t image_id_;
  RayThrough rays_;
  Vec3 forward_world_;
  bool has_tracks_ = false;
  Sample tracked_, untracked_;
};

// Returns the points that one image shows, in world coordinates: at most kMostPointsSeen, a random
// sample if there are more; none if the model has no points3D file. Reads cameras, images and
// points again, block by block.
//   position  index of the image among all images of the model sorted by name; equals its LfImageId
//   camera    the camera of this image, with intrinsics for the size of the image file
// kInput: errors of OpenColmapStreams() and ParseColmapModel(); a position beyond the last image.
Result<std::vector<Vec3>> ReadColmapPointsSeen(const std::filesystem::path& model_folder,
                                               uint32_t position, const PinholeCamera& camera);
// Reads from streams as ReadColmapPointsSeen() does from files.
Result<std::vector<Vec3>> ParseColmapPointsSeen(ColmapStreams streams, uint32_t position,
                                                const PinholeCamera& camera);

}  // namespace lf
