#include "lf/render/pipeline/frame_metadata.h"

#include <fmt/format.h>

#include <cmath>

#include "lf/camera/thin_lens.h"

namespace lf {
namespace {

std::string Text(const Vec3& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z()); }

}  // namespace

ImageMetadata FrameMetadata(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                            Estimator estimator, double fps, const std::string& version) {
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
  if (rays.virtual_count > 0)
    metadata.emplace_back("lf:virtual_lf_images", fmt::format("{}", rays.virtual_count));
  const double f_number = FNumber(camera.focal_length_w, diameter_w);
  if (std::isfinite(f_number)) metadata.emplace_back("lf:f_number", f_number);
  return metadata;
}

}  // namespace lf
