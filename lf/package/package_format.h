// What writer and reader of package files share. Internal to package.
#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/database/database.h"

namespace lf {

inline constexpr DatabaseFormat kPackageFormat = {"package", 0x4C465047 /* "LFPG" */, 1, 4096};

// Numbers in blobs: the least byte first.
static_assert(std::endian::native == std::endian::little);

template <class Number>
std::string BytesOf(std::span<const Number> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

// As many as fit in.
template <class Number>
std::vector<Number> NumbersOf(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

// Rotation by rows, translation.
inline constexpr size_t kPoseNumbers = 12;
std::array<double, kPoseNumbers> NumbersOfPose(const RigidTransform& pose);
RigidTransform PoseOfNumbers(std::span<const double, kPoseNumbers> numbers);

// All that a frame's camera is, exact: fx, fy, cx, cy, skew, width, height; pose; radius, blades
// and rotation of the aperture; normal and offset of the focus plane; time, focal length, sensor
// width, focus distance, horizontal and vertical tilt, unit_m.
inline constexpr size_t kCameraNumbers = 33;
std::array<double, kCameraNumbers> NumbersOfCamera(const RenderCamera& camera);
RenderCamera CameraOfNumbers(std::span<const double, kCameraNumbers> numbers);

// Of a rectangle: frame, x_begin, y_begin, x_end, y_end.
inline constexpr size_t kRectNumbers = 5;

// "none", "radial_tangential", "fisheye", "fov": by DistortionModel.
inline constexpr const char* kModelNames[] = {"none", "radial_tangential", "fisheye", "fov"};
// By Transfer.
inline constexpr const char* kTransferNames[] = {"srgb", "linear", "response"};

}  // namespace lf
