// What writer and reader of package files share. Internal to package.
#pragma once

#include <array>
#include <span>

#include "lf/camera/render_camera.h"
#include "lf/database/database.h"

namespace lf {

inline constexpr DatabaseFormat kPackageFormat = {"package", 0x4C465047 /* "LFPG" */, 2, 4096};

// All that a frame's camera is, exact: fx, fy, cx, cy, skew, width, height; pose; radius, blades
// and rotation of the aperture; normal and offset of the focus plane; time, focal length, sensor
// width, focus distance, horizontal and vertical tilt, unit_m.
inline constexpr size_t kCameraNumbers = 33;
std::array<double, kCameraNumbers> NumbersOfCamera(const RenderCamera& camera);
RenderCamera CameraOfNumbers(std::span<const double, kCameraNumbers> numbers);

// FrameSurroundings in the order of its fields.
inline constexpr size_t kSurroundingsNumbers = 6;

}  // namespace lf
