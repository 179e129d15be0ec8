// SPDX-License-Identifier: Apache-2.0
#include "lf/view/scene_bytes.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace lf {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void Append(std::string* bytes, std::span<const T> values) {
  bytes->append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

void AddVector(std::vector<double>* numbers, const Vec3& v) {
  numbers->insert(numbers->end(), {v.x(), v.y(), v.z()});
}

}  // namespace

Vec3 SceneOrigin(const LightField& light_field) {
  Vec3 sum = Vec3::Zero();
  for (uint32_t i = 0; i < light_field.size(); ++i)
    sum += light_field.Camera(LfImageId{i}).CentreWorld();
  return sum / static_cast<double>(std::max<size_t>(1, light_field.size()));
}

std::string CamerasBytes(const LightField& light_field) {
  const Vec3 origin = SceneOrigin(light_field);
  std::vector<float> places;
  places.reserve(3 * light_field.size());
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const Vec3 centre = light_field.Camera(LfImageId{i}).CentreWorld() - origin;
    for (int axis = 0; axis < 3; ++axis) places.push_back(static_cast<float>(centre[axis]));
  }
  std::string bytes;
  Append<float>(&bytes, places);
  return bytes;
}

std::string FramesBytes(const PathFrames& path, std::span<const FrameId> frames) {
  std::vector<double> numbers;
  numbers.reserve(kFrameNumbers * frames.size());
  for (const FrameId frame : frames) {
    const RenderCamera camera = *path.Camera(frame);
    AddVector(&numbers, camera.pinhole.CentreWorld());
    AddVector(&numbers, camera.pinhole.RightWorld());
    AddVector(&numbers, camera.pinhole.UpWorld());
    AddVector(&numbers, camera.pinhole.ForwardWorld());
    const Intrinsics& k = camera.pinhole.intrinsics;
    numbers.insert(numbers.end(),
                   {k.fx_px, k.fy_px, k.cx_px, k.cy_px, camera.aperture.radius_w,
                    camera.aperture.rotation_rad, static_cast<double>(camera.aperture.blades)});
    AddVector(&numbers, camera.focus_plane.normal);
    numbers.insert(
        numbers.end(),
        {camera.focus_plane.offset_w, camera.time_s, camera.focal_length_w, camera.sensor_width_w,
         camera.focus_distance_w, camera.focus_tilt.horizontal_rad, camera.focus_tilt.vertical_rad,
         static_cast<double>(k.width_px), static_cast<double>(k.height_px), camera.aperture.ratio,
         camera.aperture.roundness, camera.hood.distance_w, camera.hood.radius_w});
  }
  std::string bytes;
  Append<double>(&bytes, numbers);
  return bytes;
}

std::string FrameUseBytes(const LightField& light_field, const FrameUse& use) {
  std::string bytes;
  const uint32_t counts[] = {static_cast<uint32_t>(use.of_cameras.size()),
                             static_cast<uint32_t>(use.used.size())};
  Append<uint32_t>(&bytes, counts);
  const float distance[] = {use.camera_distance_w ? static_cast<float>(*use.camera_distance_w)
                                                  : std::numeric_limits<float>::quiet_NaN()};
  Append<float>(&bytes, distance);
  const uint32_t nothing[] = {0};
  Append<uint32_t>(&bytes, nothing);
  std::vector<uint32_t> ids;
  std::vector<float> shares;
  for (const FrameNeeds::Image& image : use.used) {
    const Intrinsics& k = light_field.Camera(image.id).intrinsics;
    ids.push_back(image.id.value);
    shares.push_back(static_cast<float>(static_cast<double>(image.rect.pixel_count()) /
                                        (static_cast<double>(k.width_px) * k.height_px)));
  }
  Append<uint32_t>(&bytes, ids);
  Append<float>(&bytes, shares);
  static_assert(sizeof(CameraUse) == 1);
  Append<CameraUse>(&bytes, use.of_cameras);
  return bytes;
}

std::string FilmUseBytes(const FilmUse::Facts& facts) {
  std::string bytes;
  Append<uint16_t>(&bytes, facts.frames_of_image);
  return bytes;
}

std::string PictureBytes(const GrowingPicture& picture) {
  const Image<float>& elements = picture.elements;
  const uint32_t head[] = {static_cast<uint32_t>(elements.width()),
                           static_cast<uint32_t>(elements.height()),
                           static_cast<uint32_t>(picture.full_width_px),
                           static_cast<uint32_t>(picture.full_height_px),
                           picture.has_rays ? 1u : 0u,
                           0,
                           0,
                           0};
  std::vector<Eigen::half> halves;
  halves.reserve(elements.pixels().size());
  for (const float value : elements.pixels()) halves.push_back(Eigen::half(value));
  std::string bytes;
  Append<uint32_t>(&bytes, head);
  Append<Eigen::half>(&bytes, halves);
  return bytes;
}

}  // namespace lf
