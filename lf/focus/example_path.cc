// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/example_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/core/folder_names.h"
#include "lf/core/log.h"
#include "lf/focus/example_aperture.h"
#include "lf/focus/example_focus.h"
#include "lf/focus/orbit_coverage.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

constexpr double kMostRoll_deg = 30;
constexpr int kFrameCount = 50;
constexpr int kFps = 25;
constexpr double kDuration_s = static_cast<double>(kFrameCount - 1) / kFps;
constexpr double kNominalSensorWidth_mm = 36;

std::string Text(const Vec3& v) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x(), v.y(), v.z());
}

// Returns the up direction of a camera that looks in the same direction as `camera`, with a level
// horizon. Returns the up direction of `camera` itself if the LF cameras have no mean up direction,
// or if `camera` is rolled by more than kMostRoll_deg against that direction.
Vec3 LevelUp(const LightField& light_field, const PinholeCamera& camera) {
  const Vec3 up = MeanUpWorld(light_field);
  const double roll_rad = RollOf(camera, up);
  if (up == Vec3::Zero() || roll_rad > RadiansFromDegrees(kMostRoll_deg)) return camera.UpWorld();
  const Vec3 forward = camera.ForwardWorld();
  const Vec3 across = up - forward * forward.dot(up);
  return roll_rad == 0 ? camera.UpWorld() : Vec3(across.normalized());
}

// Returns the largest even size that is not above `size`, but at least 2, because video needs even
// sizes.
int Even(int size) { return std::max(2, size - size % 2); }

// Returns the largest frame within the LF camera's view, at most as wide as the LF image and at
// least a quarter as wide. The frame has the proportions of the LF image. Its elements are as large
// as the LF pixels in the middle of the LF image.
Intrinsics InscribedFrame(const PinholeCamera& camera, const Vec3& up_world) {
  const Intrinsics& k = camera.intrinsics;
  const RayThrough rays(camera, camera.ForwardWorld());
  const std::optional<RigidTransform> pose =
      LookAlong(camera.CentreWorld(), camera.ForwardWorld(), up_world);
  const auto frame_of = [&](double share) {
    const int width = Even(static_cast<int>(std::lround(share * k.width_px)));
    const int height = Even(static_cast<int>(std::lround(share * k.height_px)));
    return Intrinsics{k.fx_px, k.fx_px, width / 2.0, height / 2.0, 0, width, height};
  };
  const auto is_seen = [&](const Intrinsics& frame) {
    constexpr int kPoints = 16;  // number of steps between the tested points of each side
    constexpr double kTolerance_px = 0.5;
    const PinholeCamera pinhole{frame, *pose};
    for (int i = 0; i <= kPoints; ++i) {
      const double x = frame.width_px * static_cast<double>(i) / kPoints;
      const double y = frame.height_px * static_cast<double>(i) / kPoints;
      const double w = frame.width_px, h = frame.height_px;
      for (const Vec2& at : {Vec2(x, 0), Vec2(x, h), Vec2(0, y), Vec2(w, y)}) {
        const auto place = rays.RecordedAt(RayOfPixel(pinhole, at.x(), at.y()).direction);
        if (!place || place->x() < -kTolerance_px || place->y() < -kTolerance_px ||
            place->x() > k.width_px + kTolerance_px || place->y() > k.height_px + kTolerance_px)
          return false;
      }
    }
    return true;
  };
  if (!pose || is_seen(frame_of(1))) return frame_of(1);
  constexpr double kLeastShare = 0.25;
  double seen = kLeastShare, unseen = 1;
  for (int i = 0; i < 20; ++i) {
    const double middle = (seen + unseen) / 2;
    (is_seen(frame_of(middle)) ? seen : unseen) = middle;
  }
  return frame_of(seen);
}

// Returns the first and the last focus distance of a focus pull. It ends at the depths of the scene
// if they are known, so that each of its pictures is sharp somewhere, but passes the focus by a
// tenth on either side, so that a flat scene comes into focus and leaves it.
std::pair<double, double> PullOf(const ExampleFocus& focus) {
  const double near_w = 0.7 * focus.distance_w, far_w = 1.6 * focus.distance_w;
  if (!(focus.near_w > 0)) return {near_w, far_w};
  return {std::clamp(focus.near_w, near_w, 0.9 * focus.distance_w),
          std::clamp(focus.far_w, 1.1 * focus.distance_w, far_w)};
}

// The keyframes of the path. At time 0, they have the values that the sections above them in the
// file state.
struct Movement {
  std::string keyframes;
  double first_focus_distance_w = 0;
};

Movement MakeMovement(ExampleMove move, const PinholeCamera& camera, const Reach& reach,
                      const ExampleFocus& focus, double aperture_diameter_w, const OrbitWish& wish,
                      const Orbit& orbit) {
  const double focus_distance_w = focus.distance_w;
  const Vec3 centre = camera.CentreWorld();
  Movement movement{"keyframes:\n", focus_distance_w};
  if (move == ExampleMove::kStatic)
    return {"# Nothing moves. Add accelerations: or keyframes: to change that.\n",
            focus_distance_w};
  if (move == ExampleMove::kFocusPull) {
    const auto [from_w, to_w] = PullOf(focus);
    movement.first_focus_distance_w = from_w;
    movement.keyframes += fmt::format(
        "  # From near to far; lens quantities never overshoot between keys.\n"
        "  focus_distance: [{{time: 0, value: {:.6g}}}, {{time: {:.6g}, value: {:.6g}}}, "
        "{{time: {:.6g}, value: {:.6g}}}]\n",
        from_w, kDuration_s / 2, focus_distance_w, kDuration_s, to_w);
    return movement;
  }
  if (move == ExampleMove::kDolly) {
    // Distance that the lens can move ahead. Farther ahead, the rays of the picture's borders,
    // which diverge, no longer come through the captured positions.
    const Intrinsics& k = camera.intrinsics;
    const double room_w =
        std::min((reach.right_w - aperture_diameter_w / 2) * 2 * k.fx_px / k.width_px,
                 (reach.up_w - aperture_diameter_w / 2) * 2 * k.fy_px / k.height_px);
    const double step_w = std::clamp(room_w, 0.0, 0.05 * focus_distance_w);
    movement.keyframes += fmt::format(
        "  # Straight ahead, by up to 5 % of the focus distance, as far as the captured positions "
        "fill the picture.\n"
        "  position: [{{time: 0, value: {}}}, {{time: {:.6g}, value: {}}}]\n",
        Text(centre), kDuration_s, Text(centre + step_w * camera.ForwardWorld()));
    return movement;
  }
  movement.keyframes +=
      "  # Once around an ellipse, as far as LF cameras have recorded the frames.\n  position:\n";
  for (int i = 0; i <= kOrbitKeys; ++i) {
    const double turn = i / double{kOrbitKeys};
    movement.keyframes += fmt::format("    - {{time: {:.6g}, value: {}}}\n", kDuration_s * turn,
                                      Text(OrbitPosition(wish, orbit.scale, turn)));
  }
  return movement;
}

// Returns the frame around the middle of `frame` that has this share of its width and height.
Intrinsics Cropped(const Intrinsics& frame, double share) {
  if (share == 1) return frame;
  const int width = Even(static_cast<int>(std::lround(share * frame.width_px)));
  const int height = Even(static_cast<int>(std::lround(share * frame.height_px)));
  return {frame.fx_px, frame.fy_px, width / 2.0, height / 2.0, 0, width, height};
}

// Tells how far the orbit is from the one that the positions of the LF cameras would allow.
void TellOrbit(const OrbitWish& wish, const Orbit& orbit, ExamplePath* example) {
  constexpr double kFewUnseen = 0.01;
  if (orbit.scale == 1 && orbit.crop == 1 && orbit.unseen <= kFewUnseen) return;
  const std::string size = fmt::format(
      "the orbit is {:.3g} wide and {:.3g} high in world units, {:.0f} % of what the positions of "
      "the LF cameras would allow, and its frames are {:.0f} % as wide as a standing camera's, "
      "because LF cameras have not recorded {:.0f} % of a frame of the larger orbit",
      2 * orbit.scale * wish.right_w, 2 * orbit.scale * wish.up_w, 100 * orbit.scale,
      100 * orbit.crop, 100 * orbit.unseen_of_largest);
  if (orbit.unseen <= kFewUnseen)
    example->move_note = size;
  else
    example->move_warning = fmt::format(
        "{}. Even in this orbit they have not recorded {:.0f} % of a frame, which will be black: "
        "begin at an LF camera that has neighbours on all sides (--camera), or let the camera "
        "stand (--move focus-pull)",
        size, 100 * orbit.unseen);
}

// Warns of moves that a sparse capture cannot show. `copies` is the reason of its small aperture.
void TellSparse(ExampleMove move, double spacing_w, const std::string& copies,
                ExamplePath* example) {
  if (!example->move_warning.empty()) return;
  if (move == ExampleMove::kFocusPull)
    example->move_warning = fmt::format(
        "the focus pull will hardly be visible, because the aperture holds one LF camera, and such "
        "a picture is sharp everywhere. For blur, put virtual LF images between the recorded ones "
        "(lfdensify), or set aperture_diameter to {:.3g}, which shows copies; --move dolly moves "
        "the camera instead",
        kLeastSpacings * spacing_w);
  else if (move != ExampleMove::kStatic)
    example->move_warning = fmt::format(
        "the LF cameras are far apart ({}): where the camera passes between them, the film shows "
        "the pictures of several. Put virtual LF images between the recorded ones (lfdensify, "
        "or lfrenderer --densify), or record more",
        copies);
}

}  // namespace

std::optional<ExampleMove> ParseExampleMove(std::string_view name) {
  if (name == "static") return ExampleMove::kStatic;
  if (name == "orbit") return ExampleMove::kOrbit;
  if (name == "dolly") return ExampleMove::kDolly;
  if (name == "focus-pull") return ExampleMove::kFocusPull;
  return std::nullopt;
}

Result<LfImageId> FirstCamera(const LightField& light_field, const LfImageStore& store) {
  MachineFailure failure;
  FolderNames names;
  const bool has_files = !HoldsPackedStore(light_field);
  // Once an LF image cannot be read, those whose files do not exist are not tried: there may be a
  // million of them.
  std::vector<bool> is_unreadable;
  const auto is_readable = [&](LfImageId id) {
    if (!is_unreadable.empty() &&
        (is_unreadable[id.value] || (has_files && !names.Has(light_field.ImagePath(id)))))
      return false;
    const Result<LfPixels> pixel =
        LoadWithoutThrowing(store, id, {0, 0, 1, 1}, light_field.image_names[id.value], LfPixels());
    if (pixel) return true;
    failure.Note(pixel.error());
    is_unreadable.resize(light_field.size());
    is_unreadable[id.value] = true;
    return false;
  };
  const Vec3 up = MeanUpWorld(light_field);
  const double most_rad = RadiansFromDegrees(3);
  const auto is_level = [&](LfImageId id) {
    return RollOf(light_field.Camera(id), up) <= most_rad;
  };
  const LfImageId level =
      MiddleCamera(light_field, [&](LfImageId id) { return is_level(id) && is_readable(id); });
  const LfImageId found =
      is_level(level) && is_readable(level) ? level : MiddleCamera(light_field, is_readable);
  LF_RETURN_IF_ERROR(failure.Check());
  return found;
}

Result<ExamplePath> MakeExamplePath(const LightField& light_field, const LfImageStore& store,
                                    const ExampleOptions& options, ThreadPool& pool) {
  if (light_field.size() < 2)
    return InputError(
        fmt::format("the light field has {} LF image(s): expected two or more, because the lens of "
                    "an example path spans several LF cameras",
                    light_field.size()));
  if (options.camera.value >= light_field.size())
    return InputError(fmt::format("LF camera {} does not exist: expected a number from 0 to {}",
                                  options.camera.value, light_field.size() - 1));
  const PinholeCamera camera = light_field.Camera(options.camera);
  const double spacing_w = MedianSpacing(light_field);
  if (!(spacing_w > 0))
    return InputError(fmt::format(
        "most of the {} LF cameras have the same position as another one: were the images listed "
        "twice, or are the positions missing? Run lfimport to list these LF cameras",
        light_field.size()));
  const Reach reach = CaptureReach(light_field, camera, 400);
  LF_ASSIGN_OR_RETURN(const ExampleFocus focus,
                      ChooseFocus(light_field, store, options, spacing_w, pool));
  ExamplePath example;
  example.focus_distance_w = focus.distance_w;
  example.focus_reason = focus.reason;
  example.doubt = focus.doubt;
  example.candidates_w = focus.candidates_w;
  const ExampleAperture aperture = ChooseAperture(focus, camera.intrinsics.fx_px, spacing_w);
  example.aperture_reason = aperture.reason;
  const double largest_w = 2 * std::max(reach.right_w, reach.up_w);
  // Diameter, as a multiple of the spacing of the LF cameras, that the lens may have even if the
  // capture is narrower.
  constexpr double kLeastOfBand = 2.2;
  example.aperture_diameter_w =
      std::min(aperture.spacings * spacing_w, std::max(kLeastOfBand * spacing_w, largest_w));

  const Vec3 up = LevelUp(light_field, camera);
  Intrinsics frame = InscribedFrame(camera, up);
  // The ellipse is at most half as wide as the captured positions would allow.
  const double radius_w = example.aperture_diameter_w / 2;
  const OrbitWish wish = {camera,
                          frame,
                          up,
                          focus.distance_w,
                          radius_w,
                          spacing_w,
                          std::max(0.0, reach.right_w - radius_w) / 2,
                          std::max(0.0, reach.up_w - radius_w) / 2};
  Orbit orbit;
  if (options.move == ExampleMove::kOrbit) {
    orbit = ChooseOrbit(light_field, wish);
    frame = Cropped(frame, orbit.crop);
    TellOrbit(wish, orbit, &example);
  }
  if (aperture.spacings < kLeastSpacings && focus.doubt.empty())
    TellSparse(options.move, spacing_w, aperture.copies, &example);
  const Movement movement =
      MakeMovement(options.move, camera, reach, focus, example.aperture_diameter_w, wish, orbit);
  const double field_of_view_deg =
      DegreesFromRadians(2 * std::atan(frame.width_px / (2 * frame.fx_px)));
  const double focal_length_mm = kNominalSensorWidth_mm * frame.fx_px / frame.width_px;
  const bool is_still = options.move == ExampleMove::kStatic;
  example.yaml = fmt::format(
      "# A camera path for lfrenderer; every key is explained in doc/formats/path.md.\n"
      "# It starts at LF camera {} ({}).\n"
      "format: lfpath 1\n"
      "fps: {}\n"
      "frames: {}\n"
      "resolution: [{}, {}]            # pixels; the frame lies within the LF image\n"
      "camera:\n"
      "  field_of_view_deg: {:.7g}     # horizontal, at most that of the LF camera\n"
      "  focal_length_mm: {:.5g}         # if the sensor is {} mm wide; f-numbers refer to this "
      "length\n"
      "  position: {}\n"
      "  look_at: {}\n"
      "  up: {}\n"
      "  follow: {}\n"
      "lens:\n"
      "  aperture_diameter: {:.6g}      # world units; LF cameras are {:.4g} apart\n"
      "  focus_distance: {:.6g}         # {}\n"
      "  blades: 0                     # 5 makes highlights pentagons\n"
      "  focus_tilt_deg: {{horizontal: 0, vertical: 0}}\n",
      options.camera.value, OneLine(light_field.image_names[options.camera.value]), kFps,
      is_still ? 1 : kFrameCount, frame.width_px, frame.height_px, field_of_view_deg,
      focal_length_mm, kNominalSensorWidth_mm, Text(camera.CentreWorld()),
      Text(camera.CentreWorld() + focus.distance_w * camera.ForwardWorld()), Text(up),
      options.move == ExampleMove::kOrbit ? "look_at                # keeps looking at the focus"
                                          : "direction",
      example.aperture_diameter_w, spacing_w, movement.first_focus_distance_w,
      options.move == ExampleMove::kFocusPull ? "at time 0; see keyframes" : focus.reason);
  example.yaml += movement.keyframes;
  return example;
}

}  // namespace lf
