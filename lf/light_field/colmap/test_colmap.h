// SPDX-License-Identifier: Apache-2.0
// Small COLMAP models in memory, for tests.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/light_field/colmap/read_colmap.h"

namespace lf {

// Packs numbers one after the other, as in COLMAP's binary files.
class PackedBytes {
 public:
  template <class T>
  PackedBytes& Put(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  PackedBytes& Text(std::string_view text) {
    bytes_.append(text).push_back('\0');
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

struct TestCamera {
  uint32_t id = 1;
  int32_t model = 1;  // PINHOLE
  uint64_t width = 8;
  uint64_t height = 6;
  std::vector<double> parameters = {10, 11, 4, 3};
};

struct TestImage {
  uint32_t id = 1;
  std::array<double, 4> quaternion = {1, 0, 0, 0};
  std::array<double, 3> translation = {};
  uint32_t camera_id = 1;
  std::string name = "a.png";
  uint64_t point_count = 0;
};

struct TestPoint {
  uint64_t id = 1;
  std::array<double, 3> xyz = {0, 0, 1};
  std::vector<uint32_t> track = {};
};

inline std::string CamerasBin(const std::vector<TestCamera>& cameras) {
  PackedBytes file;
  file.Put(uint64_t{cameras.size()});
  for (const TestCamera& camera : cameras) {
    file.Put(camera.id).Put(camera.model).Put(camera.width).Put(camera.height);
    for (const double parameter : camera.parameters) file.Put(parameter);
  }
  return file.bytes();
}

inline std::string ImagesBin(const std::vector<TestImage>& images) {
  PackedBytes file;
  file.Put(uint64_t{images.size()});
  for (const TestImage& image : images) {
    file.Put(image.id).Put(image.quaternion).Put(image.translation).Put(image.camera_id);
    file.Text(image.name).Put(image.point_count);
    for (uint64_t i = 0; i < image.point_count; ++i) file.Put(1.5).Put(2.5).Put(UINT64_MAX);
  }
  return file.bytes();
}

inline std::string PointsBin(const std::vector<TestPoint>& points) {
  PackedBytes file;
  file.Put(uint64_t{points.size()});
  for (const TestPoint& point : points) {
    file.Put(point.id).Put(point.xyz).Put(std::array<uint8_t, 3>{1, 2, 3}).Put(0.5);
    file.Put(uint64_t{point.track.size()});
    for (const uint32_t image_id : point.track) file.Put(image_id).Put(uint32_t{0});
  }
  return file.bytes();
}

inline Result<LightField> ParseColmap(bool is_binary, std::string_view cameras,
                                      std::string_view images,
                                      std::optional<std::string_view> points = std::nullopt) {
  const std::string extension = is_binary ? ".bin" : ".txt";
  ColmapStreams streams{ByteStream(cameras, "m/cameras" + extension),
                        ByteStream(images, "m/images" + extension), std::nullopt, is_binary};
  if (points) streams.points.emplace(*points, "m/points3D" + extension);
  return ParseColmapModel(std::move(streams));
}

// Checks the invariants that every light field from a model must satisfy; for fuzzing.
inline void CheckIsSane(const LightField& light_field) {
  LF_CHECK(light_field.size() > 0);
  LF_CHECK(light_field.image_names.size() == light_field.size());
  for (const Intrinsics& k : light_field.intrinsics) {
    LF_CHECK(k.InverseMatrix().allFinite());
    LF_CHECK(k.width_px > 0 && k.height_px > 0);
    DistortionMap(k.distortion).Distort(Vec3(0.1, 0.2, 1));
  }
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    LF_CHECK(light_field.cameras[i].intrinsics_index < light_field.intrinsics.size());
    const RigidTransform& pose = light_field.cameras[i].cam_from_world;
    const Mat3 error = pose.rotation * pose.rotation.transpose() - Mat3::Identity();
    LF_CHECK(error.cwiseAbs().maxCoeff() < 1e-14);
    LF_CHECK(pose.translation.allFinite());
    LF_CHECK(!light_field.image_names[i].empty());
    LF_CHECK(i == 0 || light_field.image_names[i - 1] < light_field.image_names[i]);
  }
  if (!light_field.depth_range) return;
  LF_CHECK(light_field.depth_range->near_w > 0);
  LF_CHECK(light_field.depth_range->near_w <= light_field.depth_range->far_w);
  LF_CHECK(std::isfinite(light_field.depth_range->far_w));
}

inline std::string ErrorOf(const Result<LightField>& light_field) {
  return light_field ? "no error" : light_field.error().message;
}

// Expects that the message contains the part.
#define EXPECT_HAS(message, part) EXPECT_NE((message).find(part), std::string::npos) << (message)

}  // namespace lf
