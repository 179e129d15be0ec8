// A COLMAP model while it is read, from either form, into a LightField. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/result.h"
#include "lf/light_field/colmap/colmap_cameras.h"
#include "lf/light_field/colmap/colmap_depths.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

inline constexpr size_t kMaxColmapEntryCount = size_t{1} << 24;  // cameras; images
inline constexpr size_t kMaxColmapNameSize = 4096;               // bytes

struct ColmapImage {
  uint32_t id = 0;
  std::array<double, 4> quaternion = {1, 0, 0, 0};  // w x y z, of cam_from_world
  std::array<double, 3> translation = {};
  uint32_t camera_id = 0;
  std::string name;
};

// Positions of cameras or images by their ids in COLMAP, 8 bytes each.
class ColmapIds {
 public:
  void Reserve(size_t count) { positions_.reserve(count); }
  void Add(uint32_t id, uint32_t position) { positions_.emplace_back(id, position); }
  // Must be called before the first Find(). Returns an id that was added twice, or nullopt.
  std::optional<uint32_t> Sort();
  std::optional<uint32_t> Find(uint32_t id) const;
  // Returns the id at a position. Takes linear time.
  std::optional<uint32_t> IdOf(uint32_t position) const;

 private:
  std::vector<std::pair<uint32_t, uint32_t>> positions_;
};

// Receives cameras, then images, then points. The errors are kInput without file and entry, which
// the caller adds.
class ColmapScene {
 public:
  // Reserves memory for `count` images.
  void ReserveImages(size_t count);

  Result<void> AddCamera(uint32_t id, const ColmapCameraModel& model, uint64_t width,
                         uint64_t height, std::span<const double> parameters);
  // Ends the cameras. Fails if an id occurred twice.
  Result<void> EndCameras();

  // Fails for an unknown camera, a quaternion whose length is not 1, a number that is not finite,
  // and a name that is empty or has control characters.
  Result<void> AddImage(ColmapImage&& image);
  // Sorts the images by name. Fails if there are none, or if an id or a name occurred twice.
  Result<void> EndImages();

  // Adds a point of the file; its observations follow.
  Result<void> AddPoint(uint64_t, const Vec3&, bool /*has_track*/) { return {}; }
  // Adds an observation of a point by an image. Fails if the image is unknown.
  Result<void> AddObservation(uint64_t point_id, const Vec3& point_world, uint32_t image_id);

  // Returns the id of the image at a position among all images sorted by name; nullopt beyond the
  // last one. May be called after EndImages(). Takes time in proportion to the number of images.
  std::optional<uint32_t> ImageIdAt(uint32_t position) const {
    return image_positions_.IdOf(position);
  }

  size_t image_count() const { return light_field_.cameras.size(); }
  // Moves the result out; the scene is empty afterwards.
  LightField Take();

 private:
  void SortImages();

  std::vector<Intrinsics> cameras_;
  ColmapIds camera_ids_;
  LightField light_field_;           // until the end, intrinsics_index is an index into cameras_
  std::vector<uint32_t> image_ids_;  // parallel to light_field_.cameras; empty after EndImages()
  ColmapIds image_positions_;
  DepthSample depths_;
};

struct ColmapStreams;
// Reads cameras and images in either form (read_colmap.cc). Returns the errors of their readers.
Result<ColmapScene> ReadColmapScene(ColmapStreams* streams);

}  // namespace lf
