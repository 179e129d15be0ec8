// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/frame_metadata.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "lf/camera/thin_lens.h"
#include "lf/pixels/files/picture_header.h"

namespace lf {
namespace {

using Mat4 = Eigen::Matrix4d;

std::string Text(const Vec3& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z()); }

// Converts a matrix that column vectors are multiplied by to the form of EXR files.
std::array<float, 16> ForRowVectors(const Mat4& matrix) {
  std::array<float, 16> rows = {};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      rows[4 * row + column] = static_cast<float>(matrix(column, row));
  return rows;
}

Mat4 CamFromWorld(const PinholeCamera& pinhole) {
  Mat4 matrix = Mat4::Identity();
  matrix.topLeftCorner<3, 3>() = pinhole.cam_from_world.rotation;
  matrix.topRightCorner<3, 1>() = pinhole.cam_from_world.translation;
  return matrix;
}

// Returns the matrix that projects points in camera axes (StandardAttributes(), worldToNDC).
Mat4 NdcFromCam(const RenderCamera& camera) {
  const Intrinsics& sensor = camera.pinhole.intrinsics;
  Mat4 matrix = Mat4::Zero();
  matrix.topLeftCorner<1, 3>() = sensor.Matrix().row(0) / sensor.width_px;
  matrix.block<1, 3>(1, 0) = sensor.Matrix().row(1) / sensor.height_px;
  matrix(2, 2) = matrix(3, 2) = 1;
  matrix(2, 3) = -camera.focus_distance_w;
  return matrix;
}

std::array<float, 8> ChromaticitiesOf(ColourSpace colours) {
  const Primaries primaries = PrimariesOf(colours);
  std::array<float, 8> xy = {};
  size_t i = 0;
  for (const Vec2& point : {primaries.red, primaries.green, primaries.blue, primaries.white})
    for (const double coordinate : point) xy[i++] = static_cast<float>(coordinate);
  return xy;
}

}  // namespace

ImageMetadata FrameMetadata(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                            Estimator estimator, double fps, const std::string& version,
                            const std::optional<FrameShutter>& shutter) {
  const PinholeCamera& pinhole = camera.pinhole;
  const double mm_per_w = 1000 * camera.unit_m;
  const double diameter_w = 2 * camera.aperture.radius_w;
  ImageMetadata metadata = {
      {"Software", "lfrendertools " + version},
      {"lf:estimator", std::string(NameOf(estimator))},
      {"lf:frame", static_cast<int>(frame.value)},
      {"lf:time_s", camera.time_s},
      {"lf:fps", fps},
      {"lf:unit_m", camera.unit_m},
      {"lf:position", Text(pinhole.CentreWorld())},
      {"lf:forward", Text(pinhole.ForwardWorld())},
      {"lf:up", Text(pinhole.UpWorld())},
      {"lf:fx_px", pinhole.intrinsics.fx_px},
      {"lf:focal_length_mm", camera.focal_length_w * mm_per_w},
      {"lf:sensor_width_mm", camera.sensor_width_w * mm_per_w},
      {"lf:aperture_diameter_mm", diameter_w * mm_per_w},
      {"lf:blades", camera.aperture.blades},
      {"lf:blade_rotation_deg", DegreesFromRadians(camera.aperture.rotation_rad)},
      {"lf:focus_distance_w", camera.focus_distance_w},
      {"lf:focus_tilt_horizontal_deg", DegreesFromRadians(camera.focus_tilt.horizontal_rad)},
      {"lf:focus_tilt_vertical_deg", DegreesFromRadians(camera.focus_tilt.vertical_rad)},
      {"lf:focus_plane",
       fmt::format("{} {:.9g}", Text(camera.focus_plane.normal), camera.focus_plane.offset_w)},
      {"lf:lf_images", fmt::format("{}", rays.image_count)},
      {"lf:rays_accepted", fmt::format("{}", rays.accepted_count)},
  };
  if (HasShape(camera)) {
    metadata.emplace_back("lf:aperture_ratio", camera.aperture.ratio);
    metadata.emplace_back("lf:blade_roundness", camera.aperture.roundness);
  }
  if (camera.hood.exists()) {
    metadata.emplace_back("lf:hood_distance_mm", camera.hood.distance_w * mm_per_w);
    metadata.emplace_back("lf:hood_diameter_mm", 2 * camera.hood.radius_w * mm_per_w);
  }
  const Vec2 shift_w = ShiftOf(camera);
  if (!shift_w.isZero(0)) {
    metadata.emplace_back("lf:shift_horizontal_mm", shift_w.x() * mm_per_w);
    metadata.emplace_back("lf:shift_vertical_mm", shift_w.y() * mm_per_w);
  }
  if (shutter) {
    metadata.emplace_back("lf:shutter_angle_deg", shutter->shutter.angle_deg);
    metadata.emplace_back("lf:shutter_samples", shutter->shutter.samples);
  }
  if (rays.virtual_count > 0)
    metadata.emplace_back("lf:virtual_lf_images", fmt::format("{}", rays.virtual_count));
  const double f_number = FNumber(camera.focal_length_w, diameter_w);
  if (std::isfinite(f_number)) metadata.emplace_back("lf:f_number", f_number);
  return metadata;
}

ImageMetadata StandardAttributes(FrameId frame, const RenderCamera& camera, double fps,
                                 ColourSpace colours, const std::optional<FrameShutter>& shutter) {
  const auto number = [](double value) { return static_cast<float>(value); };
  const Intrinsics& sensor = camera.pinhole.intrinsics;
  const double mm_per_w = 1000 * camera.unit_m;
  const double width_mm = camera.sensor_width_w * mm_per_w;
  const double focal_length_mm = camera.focal_length_w * mm_per_w;
  const Mat4 left_handed = Eigen::Vector4d(1, -1, 1, 1).asDiagonal();
  const Mat4 cam_from_world = CamFromWorld(camera.pinhole);
  ImageMetadata attributes = {
      {"chromaticities", ChromaticitiesOf(colours)},
      {"worldToCamera", ForRowVectors(left_handed * cam_from_world)},
      {"worldToNDC", ForRowVectors(NdcFromCam(camera) * cam_from_world)},
      {"screenWindowWidth", number(sensor.width_px / sensor.fx_px)},
      {"screenWindowCenter",
       std::array<float, 2>{number((sensor.cx_px - sensor.width_px / 2.0) / sensor.fx_px),
                            number((sensor.cy_px - sensor.height_px / 2.0) / sensor.fy_px)}},
      {"pixelAspectRatio", number(sensor.fy_px / sensor.fx_px)},
      {"framesPerSecond", FrameRate{fps}},
      {"imageCounter", static_cast<int>(frame.value)},
      {"focus", number(camera.focus_distance_w * camera.unit_m)},
      {"nominalFocalLength", number(focal_length_mm)},
      {"effectiveFocalLength", number(focal_length_mm)},
      {"pinholeFocalLength", number(width_mm * sensor.fx_px / sensor.width_px)},
      {"sensorOverallDimensions",
       std::array<float, 2>{number(width_mm), number(width_mm * sensor.height_px * sensor.fx_px /
                                                     (sensor.width_px * sensor.fy_px))}}};
  const double f_number = FNumber(camera.focal_length_w, 2 * camera.aperture.radius_w);
  if (std::isfinite(f_number)) attributes.emplace_back("aperture", number(f_number));
  if (shutter) attributes.emplace_back("expTime", number(shutter->shutter.angle_deg / 360 / fps));
  return attributes;
}

ImageMetadata FileMetadata(const PlateNotes& notes, FrameFormat format, ColourSpace colours) {
  ImageMetadata metadata = FrameMetadata(notes.frame, notes.camera, notes.rays, notes.estimator,
                                         notes.fps, notes.version, notes.shutter);
  if (const std::string digest = notes.FocalSurface(); !digest.empty())
    metadata.emplace_back("lf:focal_surface", digest);
  if (notes.first_frame != 1)
    metadata.emplace_back(kFirstFrameText, fmt::format("{}", notes.first_frame));
  if (notes.ranks_done)
    metadata.emplace_back("lf:finished_early_before_rank", static_cast<int>(*notes.ranks_done));
  if (!IsExr(format)) return metadata;
  for (auto& entry :
       StandardAttributes(notes.frame, notes.camera, notes.fps, colours, notes.shutter))
    metadata.push_back(std::move(entry));
  return metadata;
}

}  // namespace lf
