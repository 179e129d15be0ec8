// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/capture_warnings.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/core/median.h"
#include "lf/core/shell_word.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

LfImageId IdOf(size_t index) { return LfImageId{static_cast<uint32_t>(index)}; }

// Returns true if the cameras look towards `point` or away from it: for at least half of them, the
// distance from the optical axis to the point is less than a fifth of the distance from the camera
// to the point. Otherwise the point says nothing about where a camera should look.
bool AxesConverge(const std::vector<Ray>& axes, const Vec3& point) {
  std::vector<double> ratios;
  for (const Ray& axis : axes) {
    const Vec3 offset = point - axis.origin;
    ratios.push_back(axis.direction.cross(offset).norm() / std::max(1e-300, offset.norm()));
  }
  return Median(std::move(ratios)) < 0.2;
}

}  // namespace

std::vector<CaptureWarning> WarnOfDirections(const LightField& light_field) {
  std::vector<Ray> axes;
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < light_field.size(); ++i) {
    axes.push_back(CentralRay(light_field.Camera(IdOf(i))));
    sum += axes.back().direction;
  }
  const std::optional<Vec3> point = PointNearestToAxes(light_field);
  const bool converges = point && AxesConverge(axes, *point);
  // Cameras without a common point may have a common direction. It is significant if the mean of
  // the unit vectors of their directions is longer than 0.5.
  if (!converges && !(sum.norm() > 0.5 * static_cast<double>(axes.size()))) return {};

  std::vector<LfImageId> away;
  for (size_t i = 0; i < axes.size(); ++i) {
    const Vec3 expected = converges ? Vec3(*point - axes[i].origin) : sum;
    if (axes[i].direction.dot(expected) < 0) away.push_back(IdOf(i));
  }
  if (away.empty()) return {};
  if (converges && 2 * away.size() > axes.size())
    return {{"diverging-axes",
             fmt::format(
                 "{} of {} cameras look away from ({:.4g}, {:.4g}, {:.4g}), where their optical "
                 "axes meet. This is right for a capture that looks outwards. Otherwise the camera "
                 "axes are wrong: in transforms.json, cameras have x to the right and y up, and "
                 "look along -z; negate the 2nd and 3rd column of each transform_matrix",
                 away.size(), axes.size(), point->x(), point->y(), point->z()),
             away.size(),
             {}}};
  return {WarningAbout(
      light_field, "facing-away",
      fmt::format("{} of {} cameras look away from the common point or direction of most cameras. "
                  "If their calibration has failed, leave them out with {{lfimport exclude}}",
                  away.size(), axes.size()),
      away)};
}

std::vector<CaptureWarning> WarnOfUpsideDown(const LightField& light_field) {
  std::vector<Vec3> ups;
  Mat3 spread = Mat3::Zero();
  Vec3 forward = Vec3::Zero();  // mean of the optical axes
  for (size_t i = 0; i < light_field.size(); ++i) {
    const PinholeCamera camera = light_field.Camera(IdOf(i));
    forward += camera.ForwardWorld() / static_cast<double>(light_field.size());
    ups.push_back(camera.UpWorld());
    spread += ups.back() * ups.back().transpose() / static_cast<double>(light_field.size());
  }
  // The eigenvector of the largest eigenvalue of `spread` is the axis along which most up vectors
  // lie, in either direction. The eigenvalue is 2/3 for cameras on a dome. Cameras that lie on
  // their side around a ring have no common up direction; for arcs of such rings, the eigenvalue is
  // up to 0.61.
  constexpr double kCommonUp = 0.65;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(spread);
  if (!(eigen.eigenvalues()[2] >= kCommonUp)) return {};
  Vec3 axis = eigen.eigenvectors().col(2);
  const auto along =
      std::count_if(ups.begin(), ups.end(), [&](const Vec3& up) { return up.dot(axis) > 0; });
  if (2 * static_cast<size_t>(along) < ups.size()) axis = -axis;
  std::vector<LfImageId> down;
  for (size_t i = 0; i < ups.size(); ++i)
    if (ups[i].dot(axis) < -0.5) down.push_back(IdOf(i));
  // Cameras that look in one direction, such as those of a drone that looks down, need no common up
  // direction: a flight in lines to and fro turns a third of the images, or more, by 180 degrees.
  constexpr double kOneDirection = 0.8, kMostFaulty = 0.25;
  const bool flies_to_and_fro =
      forward.norm() > kOneDirection &&
      static_cast<double>(down.size()) > kMostFaulty * static_cast<double>(ups.size());
  if (down.empty() || flies_to_and_fro) return {};
  return {WarningAbout(
      light_field, "upside-down",
      fmt::format("{} of {} images are upside down compared with the others. This is right if the "
                  "camera was turned over. Otherwise rotate these poses by 180 degrees about their "
                  "optical axis, or leave them out with {{lfimport exclude}}",
                  down.size(), ups.size()),
      down)};
}

std::vector<CaptureWarning> WarnOfRepeats(const LightField& light_field,
                                          std::span<const LfImageId> ids,
                                          std::span<const double> nearest_w) {
  constexpr double kSamePlace = 1e-8, kRounding = 1e-14;
  // Returns an upper bound of the distance that rounding can cause between two equal positions.
  const auto rounding_w = [&](size_t i) {
    return kRounding * light_field.cameras[ids[i].value].cam_from_world.translation.norm();
  };
  std::vector<double> apart_w;  // nearest-neighbour distances of cameras that share no position
  for (size_t i = 0; i < nearest_w.size(); ++i)
    if (nearest_w[i] > rounding_w(i)) apart_w.push_back(nearest_w[i]);
  // One distant camera has little influence on the median.
  const double typical_w = apart_w.empty() ? 0 : Median(std::move(apart_w));
  std::vector<LfImageId> repeated;
  for (size_t i = 0; i < nearest_w.size(); ++i)
    if (nearest_w[i] <= kSamePlace * typical_w + rounding_w(i)) repeated.push_back(ids[i]);
  if (repeated.empty()) return {};
  return {WarningAbout(
      light_field, "repeated-positions",
      fmt::format("{} of {} cameras are at the same position as another: rays from there count "
                  "twice. If images were listed twice, leave one of each pair out with {{lfimport "
                  "exclude}}",
                  repeated.size(), light_field.size()),
      repeated)};
}

std::vector<CaptureWarning> WarnOfBrackets(const FoundBrackets& brackets, bool masks_clipped,
                                           const CallAgain& import_again) {
  if (brackets.are_gains && masks_clipped) return {};
  std::vector<std::string> options;
  if (!brackets.are_gains) options.emplace_back("--gain-from-exif");
  if (!masks_clipped) options.emplace_back("--mask-clipped");
  const char* const why =
      brackets.are_gains
          ? "clipped highlights of the brighter images are averaged with the others"
          : "they are averaged as if they had the same exposure, and highlights stay clipped";
  return {{"brackets",
           fmt::format("{} images are exposure brackets of {} poses: {}. To write a light field "
                       "that merges them to linear light: {}",
                       brackets.image_count, brackets.pose_count, why,
                       import_again ? import_again(options)
                                    : ShellCommand({"lfimport", "LIGHTFIELD", "-o", "DIR"}) + " " +
                                          ShellCommand(options)),
           brackets.image_count,
           {}}};
}

std::vector<CaptureWarning> WarnOfSparseness(const Density& density, double width_px,
                                             double spacing_w) {
  constexpr double kVisibleShare = 0.01;
  const double share = density.near_ghost_px / width_px;
  if (!(share > kVisibleShare)) return {};
  return {
      {"sparse",
       fmt::format(
           "The cameras are {:.3g} degrees apart, seen from distance {:.4g}: objects 25 % in front "
           "of or behind the focus plane will not be blurred, but appear as copies {:.3g} or "
           "{:.3g} pixels of the recorded images apart ({:.2g} % of their width). For 1 %, record "
           "cameras at most {:.3g} apart; or film with small apertures, and scenes of little depth",
           DegreesFromRadians(density.spacing_rad), density.distance_w, density.near_ghost_px,
           density.far_ghost_px, 100 * share, spacing_w * kVisibleShare / share),
       0,
       {}}};
}

}  // namespace lf
