// A COLMAP model while it is read, from either form, into a LightField. Internal to colmap.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/colmap/colmap_cameras.h"
#include "lf/colmap/colmap_depths.h"
#include "lf/core/result.h"

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

// Where things lie by the id that COLMAP gave them: 8 bytes each.
class ColmapIds {
 public:
  void Reserve(size_t count) { positions_.reserve(count); }
  void Add(uint32_t id, uint32_t position) { positions_.emplace_back(id, position); }
  // Before the first Find. An id that was added twice, if there is one.
  std::optional<uint32_t> Sort();
  std::optional<uint32_t> Find(uint32_t id) const;
  // The id whose position this is. It looks at all of them.
  std::optional<uint32_t> IdOf(uint32_t position) const;

 private:
  std::vector<std::pair<uint32_t, uint32_t>> positions_;
};

// Cameras, then images, then points. The errors are kInput and have no place: the caller adds file
// and entry.
class ColmapScene {
 public:
  // For `count` images to come.
  void ReserveImages(size_t count);

  Result<void> AddCamera(uint32_t id, const ColmapCameraModel& model, uint64_t width,
                         uint64_t height, std::span<const double> parameters);
  // An id was given twice.
  Result<void> EndCameras();

  // An unknown camera, a quaternion of a length other than 1, a number that is not finite, an empty
  // name or one with control characters.
  Result<void> AddImage(ColmapImage&& image);
  // Sorts the images by name. No images, or an id or a name twice.
  Result<void> EndImages();

  // A point of the file; its observations follow.
  Result<void> AddPoint(uint64_t, const Vec3&, bool /*has_track*/) { return {}; }
  // One of the points is seen by an image. The image is unknown.
  Result<void> AddObservation(uint64_t point_id, const Vec3& point_world, uint32_t image_id);

  // The id of the image at a position among all, sorted by name; none beyond the last one. It may
  // be asked after EndImages(), and takes time in proportion to the number of images.
  std::optional<uint32_t> ImageIdAt(uint32_t position) const {
    return image_positions_.IdOf(position);
  }

  size_t image_count() const { return light_field_.cameras.size(); }
  // Empty afterwards.
  LightField Take();

 private:
  void SortImages();

  std::vector<Intrinsics> cameras_;
  ColmapIds camera_ids_;
  LightField light_field_;           // intrinsics_index counts cameras_ until the end
  std::vector<uint32_t> image_ids_;  // as light_field_.cameras; empty after EndImages
  ColmapIds image_positions_;
  DepthSample depths_;
};

struct ColmapStreams;
// Reads cameras and images, of either form (read_colmap.cc). The errors are those of their readers.
Result<ColmapScene> ReadColmapScene(ColmapStreams* streams);

}  // namespace lf
