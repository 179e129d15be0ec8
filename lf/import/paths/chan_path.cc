// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/chan_path.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "lf/import/paths/euler_angles.h"
#include "lf/light_field/colmap/text_words.h"
#include "lf/light_field/transforms_json/opengl_pose.h"

namespace lf {
namespace {

constexpr double kLargestAngle_deg = 1e6;  // beyond it, rounding would be seen
constexpr double kLargestFrame = 1e9;
constexpr const char* kColumns =
    "expected the columns frame tx ty tz rx ry rz and, if it is known, the vertical field of view";

// A line of the file.
struct ChanLine {
  double frame = 0;
  Mat34 world_from_camera;
  std::optional<double> fov;  // in the unit of the file
};

Result<double> NumberWithin(TextWords* words, const char* name, double limit) {
  if (words->AtLineEnd()) return words->Fault(fmt::format("{} is missing: {}", name, kColumns));
  LF_ASSIGN_OR_RETURN(const double number, words->Number(name));
  if (!(std::abs(number) <= limit))
    return words->Fault(fmt::format("{} is {:g}: expected a number from {:g} to {:g}", name, number,
                                    -limit, limit));
  return number;
}

Result<ChanLine> ReadLine(TextWords* words, const PathOptions& options) {
  ChanLine line;
  LF_ASSIGN_OR_RETURN(line.frame, NumberWithin(words, "the frame number", kLargestFrame));
  if (line.frame != std::round(line.frame))
    return words->Fault(fmt::format("the frame number is {}: expected a whole number", line.frame));
  Vec3 position, angles_deg;
  constexpr const char* kPositions[] = {"tx", "ty", "tz"};
  constexpr const char* kAngles[] = {"rx", "ry", "rz"};
  for (int i = 0; i < 3; ++i) {
    LF_ASSIGN_OR_RETURN(position[i], NumberWithin(words, kPositions[i], 1e12));
  }
  for (int i = 0; i < 3; ++i) {
    LF_ASSIGN_OR_RETURN(angles_deg[i], NumberWithin(words, kAngles[i], kLargestAngle_deg));
  }
  line.world_from_camera << RotationOfAngles(angles_deg * RadiansFromDegrees(1),
                                             options.rotation_order),
      position;
  if (words->AtLineEnd()) return line;
  LF_ASSIGN_OR_RETURN(line.fov, words->Number("the vertical field of view"));
  const NumberRule rule = FovRule(options);
  if (!rule.holds(*line.fov))
    return words->Fault(
        fmt::format("the vertical field of view is {}: expected {}", *line.fov, rule.expected));
  if (!words->AtLineEnd())
    return words->Fault(fmt::format("has more than 8 columns: {}", kColumns));
  return line;
}

// Checks that the frame follows the one before, because a gap would make the film shorter.
Result<void> CheckFollows(const TextWords& words, double frame, std::optional<double> before) {
  if (!before || frame == *before + 1) return {};
  return words.Fault(
      fmt::format("the frame number is {}, after {}: expected {}; export every frame, in order",
                  frame, *before, *before + 1));
}

}  // namespace

Result<ForeignPath> ParseChan(ByteStream stream, const PathOptions& options) {
  ForeignPath path;
  path.fps = FpsOr(options, &path);
  const std::array<int, 2> resolution_px = ResolutionOr(options, &path);
  TextWords words(&stream);
  std::optional<double> before;       // number of the frame of the line before
  std::optional<Intrinsics> of_lens;  // of lines without a field of view
  while (words.NextEntry()) {
    if (path.cameras.size() == kMostFrames)
      return words.Fault(fmt::format("is one line too many: expected at most {}", kMostFrames));
    LF_ASSIGN_OR_RETURN(const ChanLine line, ReadLine(&words, options));
    LF_RETURN_IF_ERROR(CheckFollows(words, line.frame, before));
    before = line.frame;
    const Result<RigidTransform> pose = CamFromWorldOfOpenGl(line.world_from_camera);
    if (!pose) return words.Fault(pose.error().message);
    if (!line.fov && !of_lens) of_lens = IntrinsicsOfLens(options, resolution_px, &path);
    ForeignCamera camera;
    camera.pinhole = {
        line.fov ? IntrinsicsOfFov(FovDeg(*line.fov, options, &path), resolution_px) : *of_lens,
        *pose};
    path.cameras.push_back(std::move(camera));
  }
  LF_RETURN_IF_ERROR(stream.Status());
  if (path.cameras.empty())
    return InputError(fmt::format("{}: has no frames: {}", stream.path().string(), kColumns));
  const double first = *before + 1 - static_cast<double>(path.cameras.size());
  if (first >= 0 && *before <= kLargestFrameNumber)
    path.first_frame = static_cast<uint32_t>(first);
  else
    path.lacks.push_back(
        fmt::format("no frame numbers from 0 to {} (the first is {}; frames are numbered from 1; "
                    "set {{first_frame}})",
                    kLargestFrameNumber, first));
  if (path.largest_fov && options.focal_length_mm)
    return UsageError(
        fmt::format("{{focal_length_mm}} is only for .chan files without a field of view, but {} "
                    "states it: leave the option out",
                    stream.path().string()));
  return path;
}

Result<ForeignPath> ReadChan(const std::filesystem::path& file, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(ByteStream stream, ByteStream::Open(file));
  return ParseChan(std::move(stream), options);
}

std::string ChanText(const CameraPath& path, RotationOrder order) {
  std::string text;
  Vec3 angles_rad = Vec3::Zero();
  for (size_t i = 0; i < path.frame_count(); ++i) {
    const PinholeCamera& camera = path.cameras[i].pinhole;
    const Mat34 pose = OpenGlOfCamFromWorld(camera.cam_from_world);
    angles_rad = AnglesOfRotation(pose.leftCols<3>(), order, angles_rad);
    // The sum with 0 makes 0 of -0.
    const Vec3 position = pose.col(3) + Vec3::Zero();
    const Vec3 angles_deg = angles_rad * DegreesFromRadians(1) + Vec3::Zero();
    text += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", path.frames().At(i).value, position.x(),
                        position.y(), position.z(), angles_deg.x(), angles_deg.y(), angles_deg.z(),
                        VerticalFov_deg(camera.intrinsics));
  }
  return text;
}

}  // namespace lf
