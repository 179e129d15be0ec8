// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/epi/camera_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "lf/camera/path/spelling.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

const char* NameOfLine(LineKind kind) { return kind == LineKind::kRow ? "row" : "column"; }

// An LF camera near the line.
struct OnLine {
  LfImageId id;
  Vec3 offset_w;  // from the LF camera `through`
};

// Returns the mean axis of the LF cameras along which the line begins, of length 1.
std::optional<Vec3> FirstDirection(const LightField& light_field, LineKind kind) {
  Vec3 sum = Vec3::Zero();
  for (const LfCamera& camera : light_field.cameras)
    sum += camera.cam_from_world.rotation.row(kind == LineKind::kRow ? 0 : 1).transpose();
  if (!(sum.norm() > 0.1 * static_cast<double>(light_field.size()))) return std::nullopt;
  return sum.normalized();
}

double DistanceFromLine(const Vec3& offset_w, const Vec3& direction) {
  return (offset_w - offset_w.dot(direction) * direction).norm();
}

std::vector<OnLine> OffsetsFrom(const LightField& light_field, LfImageId through) {
  const Vec3 origin = light_field.Camera(through).CentreWorld();
  std::vector<OnLine> all;
  for (uint32_t i = 0; i < light_field.size(); ++i)
    all.push_back({LfImageId{i}, light_field.Camera(LfImageId{i}).CentreWorld() - origin});
  return all;
}

// Returns the LF cameras within the tolerance of the line, up to `reach_w` from its origin.
std::vector<OnLine> NearLine(const std::vector<OnLine>& all, const Vec3& direction,
                             double tolerance_w, double reach_w) {
  std::vector<OnLine> near;
  for (const OnLine& camera : all)
    if (camera.offset_w.norm() <= reach_w &&
        DistanceFromLine(camera.offset_w, direction) <= tolerance_w)
      near.push_back(camera);
  return near;
}

// Returns the direction of the line through the origin that is nearest to the LF cameras (least
// squares), turned like `before`.
Vec3 FittedDirection(const std::vector<OnLine>& cameras, const Vec3& before) {
  Mat3 scatter = Mat3::Zero();
  for (const OnLine& camera : cameras) scatter += camera.offset_w * camera.offset_w.transpose();
  if (!(scatter.trace() > 0)) return before;
  const Vec3 direction = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvectors().col(2);
  return direction.dot(before) < 0 ? Vec3(-direction) : direction;
}

// Returns the rotation of CameraLine; nullopt if the LF cameras look along the line.
std::optional<Mat3> RotationOf(const LightField& light_field, const CameraLine& line,
                               LineKind kind) {
  Vec3 forward = Vec3::Zero();
  for (const LfImageId id : line.ids) forward += light_field.Camera(id).ForwardWorld();
  forward -= forward.dot(line.direction_world) * line.direction_world;
  if (!(forward.norm() > 0.1 * static_cast<double>(line.ids.size()))) return std::nullopt;
  forward.normalize();
  Mat3 rotation;
  const Vec3& along = line.direction_world;
  if (kind == LineKind::kRow)
    rotation << along.transpose(), forward.cross(along).transpose(), forward.transpose();
  else
    rotation << along.cross(forward).transpose(), along.transpose(), forward.transpose();
  return rotation;
}

bool AreEven(const std::vector<double>& positions_w, double pitch_w) {
  for (size_t i = 0; i < positions_w.size(); ++i) {
    const double even_w = positions_w.front() + pitch_w * static_cast<double>(i);
    if (!(std::abs(positions_w[i] - even_w) <= CameraLine::kEven * pitch_w)) return false;
  }
  return true;
}

void SortAlong(const std::vector<OnLine>& cameras, CameraLine* line) {
  std::vector<std::pair<double, const OnLine*>> sorted;
  for (const OnLine& camera : cameras)
    sorted.emplace_back(camera.offset_w.dot(line->direction_world), &camera);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [position_w, camera] : sorted) {
    // LF images of one position, such as those of a bracket, make one line of the picture.
    if (!line->ids.empty() && position_w - line->positions_w.back() <= 0) continue;
    line->ids.push_back(camera->id);
    line->positions_w.push_back(position_w);
    line->distances_w.push_back(DistanceFromLine(camera->offset_w, line->direction_world));
  }
}

// Returns the LF image if it was recorded; otherwise an error that names the nearest recorded ones.
Result<LfImageId> Recorded(const LightField& light_field, LfImageId id) {
  if (!light_field.cameras[id.value].is_virtual) return id;
  constexpr size_t kMostNamed = 3;
  const Vec3 centre = light_field.Camera(id).CentreWorld();
  std::vector<std::pair<double, uint32_t>> recorded;  // distance and LF image
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (!light_field.cameras[i].is_virtual)
      recorded.emplace_back((light_field.Camera(LfImageId{i}).CentreWorld() - centre).norm(), i);
  const auto named =
      recorded.begin() + static_cast<ptrdiff_t>(std::min(kMostNamed, recorded.size()));
  std::partial_sort(recorded.begin(), named, recorded.end());
  std::vector<std::string> names;
  for (auto one = recorded.begin(); one != named; ++one)
    names.push_back(light_field.image_names[one->second]);
  return UsageError(fmt::format(
      "{}: is a virtual LF image, which lfdensify has interpolated: expected a recorded one; the "
      "nearest are {}",
      light_field.image_names[id.value], fmt::join(names, ", ")));
}

}  // namespace

Result<CameraLine> FindCameraLine(const LightField& light_field, LfImageId through, LineKind kind,
                                  std::optional<double> tolerance_w) {
  const double within_w = tolerance_w.value_or(0.25 * MedianSpacing(light_field));
  const auto none = [&](const std::string& why) {
    return InputError(fmt::format("{}: stands in no {} of LF cameras: {}",
                                  light_field.image_names[through.value], NameOfLine(kind), why));
  };
  const std::optional<Vec3> first = FirstDirection(light_field, kind);
  if (!first) return none("the LF cameras look in too many directions");
  CameraLine line;
  line.direction_world = *first;
  const std::vector<OnLine> all = OffsetsFrom(light_field, through);
  double extent_w = 0;
  for (const OnLine& camera : all) extent_w = std::max(extent_w, camera.offset_w.norm());
  // The line is fitted to near LF cameras first and to farther ones later, because the first
  // direction may lead to other rows.
  constexpr int kMostFits = 100;
  std::vector<OnLine> near;
  double reach_w = within_w > 0 ? 6 * within_w : extent_w;
  for (int i = 0; i < kMostFits; ++i, reach_w *= 2) {
    const size_t count_before = near.size();
    near = NearLine(all, line.direction_world, within_w, reach_w);
    if (reach_w > 2 * extent_w && near.size() == count_before) break;
    line.direction_world = FittedDirection(near, line.direction_world);
  }
  SortAlong(near, &line);
  if (line.ids.size() < 2)
    return none(
        fmt::format("no other is within {:.4g} world units of a line through it; give a "
                    "larger tolerance, or another LF camera",
                    within_w));
  line.pitch_w = (line.positions_w.back() - line.positions_w.front()) /
                 static_cast<double>(line.ids.size() - 1);
  line.is_even = AreEven(line.positions_w, line.pitch_w);
  const std::optional<Mat3> rotation = RotationOf(light_field, line, kind);
  if (!rotation) return none("the LF cameras look along it");
  line.rotation = *rotation;
  return line;
}

Result<LfImageId> LfImageNamed(const LightField& light_field, const std::string& name) {
  const std::vector<std::string>& names = light_field.image_names;
  const auto exact = std::find(names.begin(), names.end(), name);
  if (exact != names.end())
    return Recorded(light_field, LfImageId{static_cast<uint32_t>(exact - names.begin())});
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < names.size(); ++i)
    if (std::filesystem::path(names[i]).filename() == name) found.push_back(i);
  if (found.size() == 1) return Recorded(light_field, LfImageId{found[0]});
  if (found.size() > 1)
    return UsageError(
        fmt::format("{}: {} LF images have this name, such as {} and {}: give the "
                    "name as the calibration states it",
                    name, found.size(), names[found[0]], names[found[1]]));
  const std::string nearest = NearestWord(name, names);
  return UsageError(fmt::format("{}: no LF image has this name: expected a name such as {}", name,
                                nearest.empty() ? names[0] : nearest));
}

}  // namespace lf
