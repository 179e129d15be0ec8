// SPDX-License-Identifier: Apache-2.0
// Converts a COLMAP model to a LightField while the model's binary or text files are read. Internal
// to this folder.
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

// Largest number of cameras, and of images, that a model may have.
inline constexpr size_t kMaxColmapEntryCount = size_t{1} << 24;
inline constexpr size_t kMaxColmapNameSize = 4096;  // longest name of an image, in bytes

struct ColmapImage {
  uint32_t id = 0;
  std::array<double, 4> quaternion = {1, 0, 0, 0};  // w x y z; the rotation of cam_from_world
  std::array<double, 3> translation = {};
  uint32_t camera_id = 0;
  std::string name;
};

// Maps COLMAP's ids of cameras or images to positions in a list. An entry takes 8 bytes.
class ColmapIds {
 public:
  void Reserve(size_t count) { positions_.reserve(count); }
  void Add(uint32_t id, uint32_t position) { positions_.emplace_back(id, position); }
  // Must be called before the first Find(). Returns an id that was added twice, or nullopt.
  std::optional<uint32_t> Sort();
  std::optional<uint32_t> Find(uint32_t id) const;
  // Returns the id that was added with this position, or nullopt. Takes linear time.
  std::optional<uint32_t> IdOf(uint32_t position) const;

 private:
  std::vector<std::pair<uint32_t, uint32_t>> positions_;
};

// Receives all cameras, then all images, then all points of a model. The errors are kInput; the
// caller adds the file and the entry to their messages.
class ColmapScene {
 public:
  // Reserves memory for `count` images.
  void ReserveImages(size_t count);

  Result<void> AddCamera(uint32_t id, const ColmapCameraModel& model, uint64_t width,
                         uint64_t height, std::span<const double> parameters);
  // Must be called after the last camera. Fails if an id occurred twice.
  Result<void> EndCameras();

  // Fails for an unknown camera; a quaternion whose length differs from 1 by more than 1e-3; a
  // translation with a number that is not finite or beyond +-1e12; a name that is empty, has
  // control characters or more than kMaxColmapNameSize bytes; more than kMaxColmapEntryCount
  // images.
  Result<void> AddImage(ColmapImage&& image);
  // Must be called after the last image. Sorts the images by name. Fails if there are none, or if
  // an id or a name occurred twice.
  Result<void> EndImages();

  // Does nothing, because a depth belongs to an observation of the point by an image. The
  // observations are added next (AddObservation()).
  Result<void> AddPoint(uint64_t, const Vec3&, bool /*has_track*/) { return {}; }
  // Adds the depth of a point in an image that observes it. Fails if the image is unknown.
  Result<void> AddObservation(uint64_t point_id, const Vec3& point_world, uint32_t image_id);

  // Returns the id of the image at a position among all images sorted by name; nullopt beyond the
  // last one. May be called after EndImages(). Takes time proportional to the number of images.
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
  LightField light_field_;  // until Take(), LfCamera::intrinsics_index is an index into cameras_
  std::vector<uint32_t> image_ids_;  // ids of light_field_.cameras; empty after EndImages()
  ColmapIds image_positions_;
  DepthSample depths_;
};

struct ColmapStreams;
// Reads the cameras and images of a model, in binary or text form (read_colmap.cc). Returns the
// errors of the functions that read them.
Result<ColmapScene> ReadColmapScene(ColmapStreams* streams);

}  // namespace lf
