#include "lf/pipeline/example_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lf/capture/capture_geometry.h"
#include "lf/core/log.h"
#include "lf/pipeline/focus_sweep.h"

namespace lf {
namespace {

constexpr double kSpacingsPerAperture = 8;
constexpr double kSpacingsPerSweep = 24;  // a wider lens tells depths apart better
constexpr int kFrameCount = 50;
constexpr int kFps = 25;
constexpr double kDuration_s = static_cast<double>(kFrameCount - 1) / kFps;
constexpr double kNominalSensorWidth_mm = 36;

std::string Text(const Vec3& v) {
  return fmt::format("[{:.7g}, {:.7g}, {:.7g}]", v.x(), v.y(), v.z());
}

struct Focus {
  double distance_w = 0;
  std::string reason;
};

Result<Focus> ChooseFocus(const LightField& light_field, const LfImageStore& store,
                          const ExampleOptions& options, double aperture_diameter_w,
                          double spacing_w, const Reach& reach, ThreadPool& pool) {
  if (options.focus_distance_w) return Focus{*options.focus_distance_w, "as asked for"};
  const PinholeCamera camera = light_field.Camera(options.camera);
  if (const std::optional<Vec3> point = AxesMeetingPoint(light_field)) {
    const double depth_w = camera.ForwardWorld().dot(*point - camera.CentreWorld());
    if (depth_w > spacing_w) return Focus{depth_w, "where the optical axes meet"};
  }
  // The depths at which neighbours see things between 8 and a tenth of a pixel apart.
  const double widest_w = 2 * std::max(reach.right_w, reach.up_w);
  const double sweep_diameter_w =
      std::max(aperture_diameter_w, std::min(kSpacingsPerSweep * spacing_w, widest_w));
  LogInfo("the optical axes are parallel: looking for the sharpest plane");
  const double disparity_w_px = camera.intrinsics.fx_px * spacing_w;
  const double near_w = disparity_w_px / 8;
  const double far_w = disparity_w_px / 0.1;
  LF_ASSIGN_OR_RETURN(
      const double distance_w,
      SharpestFocusDistance(light_field, store, camera, sweep_diameter_w, near_w, far_w, pool));
  return Focus{distance_w,
               "the sharpest of a sweep of planes, since the optical axes are parallel"};
}

// The part of the path that moves. At time 0 every quantity has the value it has elsewhere in the
// file.
struct Movement {
  std::string keyframes;
  double first_focus_distance_w = 0;
};

Movement MakeMovement(ExampleMove move, const PinholeCamera& camera, const Reach& reach,
                      double focus_distance_w, double aperture_diameter_w) {
  const Vec3 centre = camera.CentreWorld();
  Movement movement{"keyframes:\n", focus_distance_w};
  if (move == ExampleMove::kStatic)
    return {"# Nothing moves. Add accelerations: or keyframes: to change that.\n",
            focus_distance_w};
  if (move == ExampleMove::kFocusPull) {
    movement.first_focus_distance_w = 0.7 * focus_distance_w;
    movement.keyframes += fmt::format(
        "  # From near to far; lens quantities never overshoot between keys.\n"
        "  focus_distance: [{{time: 0, value: {:.6g}}}, {{time: {:.6g}, value: {:.6g}}}, "
        "{{time: {:.6g}, value: {:.6g}}}]\n",
        movement.first_focus_distance_w, kDuration_s / 2, focus_distance_w, kDuration_s,
        1.6 * focus_distance_w);
    return movement;
  }
  if (move == ExampleMove::kDolly) {
    // The rays of the corners of the picture fan out to where LF cameras must have been.
    const Intrinsics& k = camera.intrinsics;
    const double room_w =
        std::min((reach.right_w - aperture_diameter_w / 2) * 2 * k.fx_px / k.width_px,
                 (reach.up_w - aperture_diameter_w / 2) * 2 * k.fy_px / k.height_px);
    const double step_w = std::clamp(room_w, 0.0, 0.05 * focus_distance_w);
    movement.keyframes += fmt::format(
        "  # Straight ahead, as far as the captured positions fill the picture.\n"
        "  position: [{{time: 0, value: {}}}, {{time: {:.6g}, value: {}}}]\n",
        Text(centre), kDuration_s, Text(centre + step_w * camera.ForwardWorld()));
    return movement;
  }
  // An ellipse from the start to the left and back, half as wide as the captured positions let the
  // lens go.
  const double right_w = std::max(0.0, reach.right_w - aperture_diameter_w / 2) / 2;
  const double up_w = std::max(0.0, reach.up_w - aperture_diameter_w / 2) / 2;
  constexpr int kKeys = 8;
  movement.keyframes += "  # Once around an ellipse within the captured positions.\n  position:\n";
  for (int i = 0; i <= kKeys; ++i) {
    const double angle = 2 * kPi * i / kKeys;
    const Vec3 point = centre + right_w * (std::cos(angle) - 1) * camera.RightWorld() +
                       up_w * std::sin(angle) * camera.UpWorld();
    movement.keyframes +=
        fmt::format("    - {{time: {:.6g}, value: {}}}\n", kDuration_s * i / kKeys, Text(point));
  }
  return movement;
}

// Plates of even size, for video.
int Even(int size) { return std::max(2, size - size % 2); }

}  // namespace

std::optional<ExampleMove> ParseExampleMove(std::string_view name) {
  if (name == "static") return ExampleMove::kStatic;
  if (name == "orbit") return ExampleMove::kOrbit;
  if (name == "dolly") return ExampleMove::kDolly;
  if (name == "focus-pull") return ExampleMove::kFocusPull;
  return std::nullopt;
}

Result<ExamplePath> MakeExamplePath(const LightField& light_field, const LfImageStore& store,
                                    const ExampleOptions& options, ThreadPool& pool) {
  if (light_field.size() < 2)
    return InputError(
        fmt::format("a light field of {} LF camera has no lens to offer: two or more "
                    "are needed",
                    light_field.size()));
  if (options.camera.value >= light_field.size())
    return InputError(fmt::format("there is no LF camera {}: the light field has 0 to {}",
                                  options.camera.value, light_field.size() - 1));
  const PinholeCamera camera = light_field.Camera(options.camera);
  const double spacing_w = MedianSpacing(light_field);
  const Reach reach = CaptureReach(light_field, camera, 400);
  const double largest_w = 2 * std::max(reach.right_w, reach.up_w);
  ExamplePath example;
  example.aperture_diameter_w =
      std::max(2.2 * spacing_w, std::min(kSpacingsPerAperture * spacing_w, largest_w));
  LF_ASSIGN_OR_RETURN(const Focus focus,
                      ChooseFocus(light_field, store, options, example.aperture_diameter_w,
                                  spacing_w, reach, pool));
  example.focus_distance_w = focus.distance_w;
  example.focus_reason = focus.reason;

  const Movement movement =
      MakeMovement(options.move, camera, reach, focus.distance_w, example.aperture_diameter_w);
  const Intrinsics& k = camera.intrinsics;
  const double field_of_view_deg =
      DegreesFromRadians(2 * std::atan(Even(k.width_px) / (2 * k.fx_px)));
  const double focal_length_mm = kNominalSensorWidth_mm * k.fx_px / Even(k.width_px);
  example.yaml = fmt::format(
      "# A camera path for lfrenderer; every key is explained in doc/formats/path.md.\n"
      "# It starts at LF camera {} ({}).\n"
      "format: lfpath 1\n"
      "fps: {}\n"
      "frames: {}\n"
      "resolution: [{}, {}]            # that of the LF image\n"
      "camera:\n"
      "  field_of_view_deg: {:.7g}     # horizontal, that of the LF camera\n"
      "  focal_length_mm: {:.5g}         # on a sensor {} mm wide: what f-numbers count from\n"
      "  position: {}\n"
      "  look_at: {}\n"
      "  up: {}\n"
      "  follow: {}\n"
      "lens:\n"
      "  aperture_diameter: {:.6g}      # world units; LF cameras are {:.4g} apart\n"
      "  focus_distance: {:.6g}         # {}\n"
      "  blades: 0                     # 5 makes highlights pentagons\n"
      "  focus_tilt_deg: {{horizontal: 0, vertical: 0}}\n",
      options.camera.value, light_field.image_names[options.camera.value], kFps, kFrameCount,
      Even(k.width_px), Even(k.height_px), field_of_view_deg, focal_length_mm,
      kNominalSensorWidth_mm, Text(camera.CentreWorld()),
      Text(camera.CentreWorld() + focus.distance_w * camera.ForwardWorld()), Text(camera.UpWorld()),
      options.move == ExampleMove::kOrbit ? "look_at                # keeps looking at the focus"
                                          : "direction",
      example.aperture_diameter_w, spacing_w, movement.first_focus_distance_w,
      options.move == ExampleMove::kFocusPull ? "moves, see below" : focus.reason);
  example.yaml += movement.keyframes;
  return example;
}

}  // namespace lf
