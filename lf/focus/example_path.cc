// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/example_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/folder_names.h"
#include "lf/core/log.h"
#include "lf/focus/example_aperture.h"
#include "lf/focus/example_focus.h"
#include "lf/focus/moves/along.h"
#include "lf/focus/moves/dolly.h"
#include "lf/focus/moves/example_frame.h"
#include "lf/focus/moves/orbit.h"
#include "lf/focus/moves/recorded_track.h"
#include "lf/focus/moves/shot.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/image_files.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

constexpr int kFps = 25;
constexpr double kNominalSensorWidth_mm = 36;
// Neighbouring LF cameras that are farther apart, as seen from the subject, show it differently.
constexpr double kFarApart_rad = RadiansFromDegrees(3);

// Returns the numbers with as many digits as are needed to read back the same values. Georeferenced
// positions have seven digits before the point.
std::string Text(const Vec3& v) {
  const Vec3 positive = v + Vec3::Zero();  // -0 + 0 is 0
  return fmt::format("[{}, {}, {}]", positive.x(), positive.y(), positive.z());
}

// Returns the point with fewer digits: rounded to a multiple of a power of ten up to `step`.
Vec3 Rounded(const Vec3& v, double step) {
  const double power = std::floor(std::log10(step));
  const double scale = std::pow(10, std::abs(power));
  const auto rounded = [&](double x) {
    return power < 0 ? std::round(x * scale) / scale : std::round(x / scale) * scale;
  };
  return {rounded(v.x()), rounded(v.y()), rounded(v.z())};
}

// Returns a comment of the path, in lines of a readable length.
std::string Comment(std::string_view text) {
  constexpr size_t kWidth = 96;
  std::string lines;
  while (!text.empty()) {
    size_t end = text.size() <= kWidth ? text.size() : text.rfind(' ', kWidth);
    if (end == std::string_view::npos) end = std::min(text.find(' '), text.size());
    lines += fmt::format("  # {}\n", text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

bool MovesCamera(ExampleMove move) {
  return move == ExampleMove::kOrbit || move == ExampleMove::kDolly || move == ExampleMove::kAlong;
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

// The parts of the path that depend on the move. At time 0, keyframes have the values that the
// sections above them in the file state.
struct Movement {
  Vec3 first_position_world = Vec3::Zero();
  std::string focus;  // the key for the focus, with its value
  std::string keyframes;
  int frame_count = 1;
};

Movement StandingMovement(ExampleMove move, const Shot& shot, const ExampleFocus& focus,
                          ExamplePath* example) {
  const Vec3 position = shot.start.CentreWorld();
  if (move == ExampleMove::kStatic)
    return {position,
            fmt::format("focus_distance: {:.6g}         # {}", focus.distance_w, focus.reason),
            "# Nothing moves. Add accelerations: or keyframes: to change that.\n"};
  constexpr int kPullFrames = 50;
  constexpr double kDuration_s = static_cast<double>(kPullFrames - 1) / kFps;
  const auto [from_w, to_w] = PullOf(focus);
  example->move_note = fmt::format(
      "the focus moves from {:.4g} to {:.4g} in world units, {}", from_w, to_w,
      focus.near_w > 0 ? "over the depths found in the scene, at most from 0.7 to 1.6 times the "
                         "focus distance"
                       : "0.7 to 1.6 times the focus distance, because the depths of the scene "
                         "are not known");
  return {position,
          fmt::format("focus_distance: {:.6g}         # at time 0; see keyframes", from_w),
          fmt::format("keyframes:\n"
                      "  # From near to far; lens quantities never overshoot between keys.\n"
                      "  focus_distance: [{{time: 0, value: {:.6g}}}, {{time: {:.6g}, value: "
                      "{:.6g}}}, {{time: {:.6g}, value: {:.6g}}}]\n",
                      from_w, kDuration_s / 2, focus.distance_w, kDuration_s, to_w),
          kPullFrames};
}

Movement CameraMovement(const Shot& shot, const CameraMove& move, const ExampleFocus& focus) {
  constexpr double kOfSpacing = 1e-5;
  const auto key = [&](size_t i) {
    const Vec3& position = move.keys_world[i];
    // The LF camera's own position is written exactly.
    return position == shot.start.CentreWorld() ? position
                                                : Rounded(position, kOfSpacing * shot.spacing_w);
  };
  Movement movement{key(0),
                    fmt::format("focus_point: *subject         # {}, {:.6g} from the LF camera",
                                focus.reason, focus.distance_w),
                    fmt::format("keyframes:\n{}  position:\n", Comment(OneLine(move.limit))),
                    static_cast<int>(std::lround(move.duration_s * kFps)) + 1};
  const double duration_s = static_cast<double>(movement.frame_count - 1) / kFps;
  for (size_t i = 0; i < move.keys_world.size(); ++i)
    movement.keyframes += fmt::format(
        "    - {{time: {:.6g}, value: {}}}\n",
        duration_s * static_cast<double>(i) / static_cast<double>(move.keys_world.size() - 1),
        Text(key(i)));
  return movement;
}

// Warns of moves that a sparse capture cannot show.
//   copies  the reason of its small aperture
//   other   the end of the warning of a focus pull: a move that the capture can show, or nothing
void TellSparse(ExampleMove move, double spacing_w, const std::string& copies,
                const std::string& other, ExamplePath* example) {
  if (!example->move_warning.empty()) return;
  if (move == ExampleMove::kFocusPull)
    example->move_warning = fmt::format(
        "the focus pull will hardly be visible, because the aperture holds one LF camera, and such "
        "a picture is sharp everywhere. For blur, put virtual LF images into the lens ({{densify}} "
        "chooses one that they fill), or set aperture_diameter to {:.3g}, which shows copies{}",
        kLeastSpacings * spacing_w, other);
  else if (move != ExampleMove::kStatic)
    example->move_warning = fmt::format(
        "the LF cameras are far apart ({}): where the camera passes between them, the film shows "
        "the pictures of several. Put virtual LF images into the lens ({{densify}} chooses one "
        "that they fill), or record more",
        copies);
}

// Returns the line of the shift of a frame whose middle is not on the optical axis.
std::string ShiftLine(const Intrinsics& frame) {
  const double mm_per_px = kNominalSensorWidth_mm / frame.width_px;
  const double right_mm = (frame.width_px / 2.0 - frame.cx_px) * mm_per_px;
  const double up_mm = (frame.cy_px - frame.height_px / 2.0) * mm_per_px;
  constexpr double kNone_mm = 1e-6;
  if (std::abs(right_mm) < kNone_mm && std::abs(up_mm) < kNone_mm) return "";
  return fmt::format(
      "  shift_mm: {{horizontal: {:.7g}, vertical: {:.7g}}}  # the middle of the LF image is "
      "beside "
      "its optical axis\n",
      right_mm, up_mm);
}

std::string YamlOf(const LightField& light_field, LfImageId id, const Shot& shot,
                   const Intrinsics& frame, const Movement& movement, const ExamplePath& example) {
  const double field_of_view_deg =
      DegreesFromRadians(2 * std::atan(frame.width_px / (2 * frame.fx_px)));
  const double focal_length_mm = kNominalSensorWidth_mm * frame.fx_px / frame.width_px;
  const bool moves = MovesCamera(example.move);
  constexpr double kOfDistance = 1e-9;  // changes no direction visibly
  return fmt::format(
      "# A camera path for lfrenderer; every key is explained in doc/formats/path.md.\n"
      "# It {} LF camera {} ({}).\n"
      "format: lfpath 1\n"
      "fps: {}\n"
      "frames: {}\n"
      "resolution: [{}, {}]            # pixels; the frame lies within the LF image\n"
      "camera:\n"
      "  field_of_view_deg: {:.7g}     # horizontal, at most that of the LF camera\n"
      "  focal_length_mm: {:.5g}         # if the sensor is {} mm wide; f-numbers refer to this "
      "length\n"
      "{}"
      "  position: {}\n"
      "  look_at: {}{}\n"
      "  up: {}\n"
      "  follow: {}\n"
      "lens:\n"
      "  aperture_diameter: {:.6g}      # world units; LF cameras are {:.4g} apart\n"
      "  {}\n"
      "  blades: 0                     # 5 makes highlights pentagons\n"
      "  focus_tilt_deg: {{horizontal: 0, vertical: 0}}\n"
      "{}",
      StartWords(example.move), id.value, OneLine(light_field.image_names[id.value]), kFps,
      movement.frame_count, frame.width_px, frame.height_px, field_of_view_deg, focal_length_mm,
      kNominalSensorWidth_mm, ShiftLine(frame), Text(movement.first_position_world),
      moves ? "&subject " : "",
      Text(Rounded(shot.SubjectWorld(), kOfDistance * shot.focus_distance_w)),
      Text(Rounded(shot.up_world, kOfDistance)),
      moves ? "look_at                # keeps looking at the subject" : "direction",
      example.aperture_diameter_w, shot.spacing_w, movement.focus, movement.keyframes);
}

// Returns the lens and the frame of a path at an LF camera.
//   is_densified  true: virtual LF images will be put into the lens
Shot ShotOf(const LightField& light_field, LfImageId id, const ExampleFocus& focus,
            double spacing_w, const ExampleAperture& aperture, bool is_densified, ExampleMove move,
            ExamplePath* example) {
  Shot shot;
  shot.start = light_field.Camera(id);
  shot.focus_distance_w = focus.distance_w;
  shot.spacing_w = spacing_w;
  shot.up_world = LevelUpWorld(light_field, shot.start);
  shot.frame = InscribedFrame(shot.start, shot.up_world);
  const double wish_w = aperture.spacings * spacing_w;
  // LF cameras on the far side of a ring are of no use to a movement on the near side.
  constexpr double kNear_rad = RadiansFromDegrees(6);
  shot.reach = MovesCamera(move) ? ReachNear(light_field, shot.start,
                                             kNear_rad * focus.distance_w + wish_w + spacing_w)
                                 : CaptureReach(light_field, shot.start, 400);
  const double reach_w = std::max(shot.reach.right_w, shot.reach.up_w);
  // A moving camera leaves at least half of the reach to the movement. A narrow capture limits a
  // standing lens, but not below the smallest lens that blurs.
  const double most_w =
      MovesCamera(move) ? reach_w : std::max(aperture.least_spacings * spacing_w, 2 * reach_w);
  example->aperture_diameter_w = std::min(wish_w, most_w);
  example->aperture_reason =
      wish_w <= most_w ? aperture.reason
                       : fmt::format("{:.2g} spacings of LF cameras, {} as wide as they reach",
                                     most_w / spacing_w, MovesCamera(move) ? "half" : "about");
  if (wish_w > most_w && most_w < aperture.least_spacings * spacing_w)
    example->aperture_reason += fmt::format(
        "; it holds fewer than {} LF cameras, so that copies may be seen instead of a blur",
        kFewestCameras);
  shot.lens_radius_w = example->aperture_diameter_w / 2;
  if (!is_densified && StandInARow(light_field, shot.start, shot.lens_radius_w))
    example->aperture_reason +=
        "; the LF cameras in it stand in a row, so that it blurs in one direction only";
  return shot;
}

// Returns how the camera moves. kInput: it cannot, or the movement would be invisible.
Result<CameraMove> MoveCamera(const LightField& light_field, LfImageId id, const Shot& shot,
                              ExampleMove move) {
  CameraMove moved;
  if (move == ExampleMove::kOrbit) {
    moved = MakeOrbit(light_field, shot);
  } else if (move == ExampleMove::kDolly) {
    moved = MakeDolly(light_field, shot);
  } else {
    const Result<RecordedTrack> track = FindTrack(light_field, id);
    if (!track)
      return InputError(fmt::format("{}: let the camera move in another way ({{move orbit}})",
                                    track.error().message));
    moved = MakeAlong(light_field, *track, shot);
  }
  constexpr double kVisible_px = 0.01, kClear_px = 3, kClear = 0.005;
  const double visible_px = VisibleMovement(shot, moved);
  if (!(visible_px >= kVisible_px))
    return InputError(fmt::format(
        "at LF camera {} the camera has no room for a visible movement: {}. Begin at another LF "
        "camera ({{camera}}), or let the camera stand ({{move focus-pull}})",
        id.value, moved.limit));
  if (visible_px < std::max(kClear_px, kClear * shot.frame.width_px) && moved.warning.empty())
    moved.warning = fmt::format(
        "the movement will hardly be visible, because it changes the picture by {:.2g} of {} "
        "elements: record from positions farther apart, or let the camera stand "
        "({{move focus-pull}})",
        visible_px, shot.frame.width_px);
  return moved;
}

// Returns words that advise a move of the camera which is clearly visible; "" if there is none.
std::string OtherMove(const LightField& light_field, LfImageId id, const ExampleFocus& focus,
                      double spacing_w, const ExampleAperture& aperture) {
  for (const auto& [move, name] :
       {std::pair(ExampleMove::kDolly, "dolly"), std::pair(ExampleMove::kOrbit, "orbit")}) {
    ExamplePath ignored;
    const Shot shot = ShotOf(light_field, id, focus, spacing_w, aperture, false, move, &ignored);
    const Result<CameraMove> moved = MoveCamera(light_field, id, shot, move);
    if (moved && moved->warning.empty())
      return fmt::format("; {{move {}}} moves the camera instead", name);
  }
  return "";
}

Result<ExamplePath> PathOfMove(const LightField& light_field, const ExampleOptions& options,
                               const ExampleFocus& focus, double spacing_w, ExampleMove move) {
  const LfImageId id = options.camera;
  const PinholeCamera camera = light_field.Camera(id);
  ExamplePath example;
  example.move = move;
  example.focus_distance_w = focus.distance_w;
  example.focus_reason = focus.reason;
  example.doubt = focus.doubt;
  example.candidates_w = focus.candidates_w;
  const ExampleAperture aperture =
      options.densify
          ? ChooseDensifiedAperture(light_field, camera,
                                    InscribedFrame(camera, LevelUpWorld(light_field, camera)),
                                    focus, spacing_w)
          : ChooseAperture(light_field, camera, focus, spacing_w);
  const Shot shot =
      ShotOf(light_field, id, focus, spacing_w, aperture, options.densify, move, &example);
  Intrinsics frame = shot.frame;
  Movement movement;
  if (MovesCamera(move)) {
    LF_ASSIGN_OR_RETURN(const CameraMove moved, MoveCamera(light_field, id, shot, move));
    frame = CroppedFrame(frame, moved.crop);
    example.move_note = moved.limit;
    example.move_warning = moved.warning;
    movement = CameraMovement(shot, moved, focus);
  } else {
    movement = StandingMovement(move, shot, focus, &example);
  }
  const bool is_sparse = !options.densify && aperture.spacings < kLeastSpacings;
  if (is_sparse && focus.doubt.empty())
    TellSparse(move, spacing_w, aperture.copies,
               move == ExampleMove::kFocusPull
                   ? OtherMove(light_field, id, focus, spacing_w, aperture)
                   : "",
               &example);
  else if (is_sparse && MovesCamera(move) && spacing_w > kFarApart_rad * focus.distance_w)
    TellSparse(move, spacing_w,
               fmt::format("neighbours by {:.2g} degrees as seen from the subject",
                           DegreesFromRadians(spacing_w / focus.distance_w)),
               "", &example);
  example.yaml = YamlOf(light_field, id, shot, frame, movement, example);
  return example;
}

}  // namespace

std::optional<ExampleMove> ParseExampleMove(std::string_view name) {
  if (name == "auto") return ExampleMove::kAuto;
  if (name == "static") return ExampleMove::kStatic;
  if (name == "along") return ExampleMove::kAlong;
  if (name == "orbit") return ExampleMove::kOrbit;
  if (name == "dolly") return ExampleMove::kDolly;
  if (name == "focus-pull") return ExampleMove::kFocusPull;
  return std::nullopt;
}

const char* StartWords(ExampleMove move) {
  if (move == ExampleMove::kOrbit) return "moves around";
  return move == ExampleMove::kStatic || move == ExampleMove::kFocusPull ? "starts at" : "passes";
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
        (is_unreadable[id.value] || (has_files && !names.Has(ImageFileOf(light_field, id)))))
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
  const double spacing_w = MedianSpacing(light_field);
  if (!(spacing_w > 0))
    return InputError(
        fmt::format("all {} LF cameras have the same position: expected two positions or more. Are "
                    "the positions "
                    "missing in the calibration?",
                    light_field.size()));
  const size_t image_count =
      std::set<std::string>(light_field.image_names.begin(), light_field.image_names.end()).size();
  if (2 * image_count <= light_field.size())
    return InputError(fmt::format(
        "the {} LF cameras have only {} LF images: were the images listed twice? Run lfimport to "
        "list these LF cameras",
        light_field.size(), image_count));
  LF_ASSIGN_OR_RETURN(const ExampleFocus focus,
                      ChooseFocus(light_field, store, options, spacing_w, pool));
  if (options.move != ExampleMove::kAuto)
    return PathOfMove(light_field, options, focus, spacing_w, options.move);
  const Result<RecordedTrack> track = FindTrack(light_field, options.camera);
  if (track && focus.doubt.empty() && IsDenseTrack(light_field, *track, focus.distance_w)) {
    Result<ExamplePath> along =
        PathOfMove(light_field, options, focus, spacing_w, ExampleMove::kAlong);
    if (along) return along;
    LogInfo("{}; the focus moves instead", along.error().message);
  }
  return PathOfMove(light_field, options, focus, spacing_w, ExampleMove::kFocusPull);
}

}  // namespace lf
