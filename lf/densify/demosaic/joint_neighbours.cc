// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/core/median.h"
#include "lf/densify/camera_chart.h"
#include "lf/densify/demosaic/pixel_places.h"
#include "lf/densify/working_image.h"

namespace lf {
namespace {

// A period of the mosaic has kSteps x kSteps phases.
constexpr int kSteps = 4, kPeriod_px = 2;

struct Candidate {
  double square = 0;  // squared distance of the LF cameras
  uint32_t id = 0;
  size_t phase = 0;
};

int PhaseOf(double shift_px) {
  const double steps = std::floor(shift_px * kSteps / kPeriod_px + 0.5);
  const int phase = static_cast<int>(std::fmod(steps, kSteps));
  return phase < 0 ? phase + kSteps : phase;
}

// Returns the LF images that see the middle of another one, the nearest first.
std::vector<Candidate> CandidatesFor(const LightField& light_field, std::span<const Vec3> centres,
                                     uint32_t id, double inverse_depth) {
  constexpr double kLeastCosine = 0.87;  // 30 degrees
  constexpr double kMostShift_px = 1e6;
  const PinholeCamera camera = WorkingCamera(light_field.Camera(LfImageId{id}), 1);
  const Vec3 forward = camera.ForwardWorld();
  const float x = static_cast<float>(camera.intrinsics.width_px) / 2,
              y = static_cast<float>(camera.intrinsics.height_px) / 2;
  std::vector<Candidate> candidates;
  for (uint32_t i = 0; i < centres.size(); ++i) {
    const PinholeCamera other = WorkingCamera(light_field.Camera(LfImageId{i}), 1);
    if (i == id || other.ForwardWorld().dot(forward) < kLeastCosine) continue;
    const PairMap::Place place =
        MapBetween(camera, other).At(x, y, static_cast<float>(inverse_depth));
    const double shift_x = place.u_px - x, shift_y = place.v_px - y;
    if (!(place.w > 0) || !(std::abs(shift_x) + std::abs(shift_y) < kMostShift_px)) continue;
    candidates.push_back({(centres[i] - centres[id]).squaredNorm(), i,
                          static_cast<size_t>(PhaseOf(shift_y) * kSteps + PhaseOf(shift_x))});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.square < b.square || (a.square == b.square && a.id < b.id);
  });
  return candidates;
}

}  // namespace

std::vector<ChosenNeighbour> ChooseNeighbours(const LightField& light_field,
                                              std::span<const Vec3> centres, uint32_t id,
                                              const InverseDepths& range, size_t most) {
  const std::vector<Candidate> candidates =
      CandidatesFor(light_field, centres, id, (range.least + range.greatest) / 2);
  if (candidates.empty()) return {};
  // The distance at which samples count 1 / (1 + kFar): that of the fourth LF camera, or that at
  // which near points move by kUnit_px.
  constexpr double kFar = 0.4, kUnit_px = 1.5;
  double unit = candidates[std::min<size_t>(3, candidates.size() - 1)].square;
  const double shift_px = light_field.Camera(LfImageId{id}).intrinsics.fx_px * range.greatest;
  if (shift_px > 0) unit = std::max(unit, kUnit_px * kUnit_px / (shift_px * shift_px));

  // Phases of the middle of the scene say nothing of its ends if these move by a pixel against it.
  const double reach = std::sqrt(candidates[std::min(most, candidates.size()) - 1].square);
  const double spread_px = reach * light_field.Camera(LfImageId{id}).intrinsics.fx_px *
                           (range.greatest - range.least) / 2;
  const double phase_weight = std::clamp(2 * (1 - spread_px), 0.0, 1.0);

  // One at a time, the LF image of the least distance times a factor that grows with the number of
  // those that were chosen with its phase.
  std::array<int, kSteps* kSteps> chosen_count = {};
  chosen_count[0] = 8;  // these LF images have the colours that the target has
  std::vector<bool> is_chosen(candidates.size());
  std::vector<ChosenNeighbour> chosen;
  while (chosen.size() < std::min(most, candidates.size())) {
    size_t best = candidates.size();
    double least = INFINITY;
    for (size_t i = 0; i < candidates.size() && candidates[i].square < least; ++i) {
      const double factor = 1 + phase_weight * chosen_count[candidates[i].phase];
      const double cost = candidates[i].square * factor * factor;
      if (is_chosen[i] || cost >= least) continue;
      least = cost;
      best = i;
    }
    if (best == candidates.size()) break;
    is_chosen[best] = true;
    ++chosen_count[candidates[best].phase];
    const double farness = unit > 0 ? kFar * candidates[best].square / unit : 0;
    chosen.push_back({candidates[best].id, static_cast<float>(1 / (1 + farness))});
  }
  return chosen;
}

std::vector<std::vector<uint32_t>> FarEnoughForDepths(
    const LightField& light_field, std::span<const Vec3> centres,
    const std::optional<Vec3>& subject, const InverseDepths& range,
    std::vector<std::vector<uint32_t>> compare_with) {
  constexpr double kLeastShift_px = 2;
  std::vector<double> shifts, distances;
  for (uint32_t i = 0; i < compare_with.size(); ++i)
    for (const uint32_t other : compare_with[i]) {
      shifts.push_back(ShiftPerInverseDepth(WorkingCamera(light_field.Camera(LfImageId{i}), 1),
                                            light_field.Camera(LfImageId{other})));
      distances.push_back((centres[i] - centres[other]).norm());
    }
  if (shifts.empty()) return compare_with;
  const double shift_px = Median(std::move(shifts)) * (range.greatest - range.least);
  if (!(shift_px > 0) || shift_px >= kLeastShift_px) return compare_with;
  const double distance = Median(std::move(distances)) * kLeastShift_px / shift_px;
  // LF cameras none of which is nearer to another than this.
  std::vector<uint32_t> among;
  for (uint32_t i = 0; i < centres.size(); ++i)
    if (std::all_of(among.begin(), among.end(), [&](uint32_t other) {
          return (centres[i] - centres[other]).norm() >= distance;
        }))
      among.push_back(i);
  constexpr size_t kFewest = 4;
  if (among.size() < kFewest) return compare_with;
  return CompareWith(light_field, among, subject);
}

}  // namespace lf
