// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/plane_votes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"
#include "lf/core/median.h"

namespace lf {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

}  // namespace

Image<float> ProjectedDepths(const LfDepths& depths, const PinholeCamera& lf_camera,
                             const RenderCamera& frame) {
  constexpr double kOverlap = 1.2;  // LF pixels that turn away leave no holes
  const Intrinsics& plate = frame.pinhole.intrinsics;
  Image<float> nearest(plate.width_px, plate.height_px, 1, kNone);
  const Intrinsics& k = lf_camera.intrinsics;
  const DistortionMap map(k.distortion);
  const Mat3 unprojected = k.InverseMatrix();
  const RigidTransform world_from_lf = lf_camera.cam_from_world.Inverse();
  const double step = (depths.greatest - depths.least) / 65534;
  const double pixel_elements = depths.divisor * plate.fx_px / k.fx_px;
  const Image<uint16_t>& numbers = depths.numbers;
  for (int v = 0; v < numbers.height(); ++v)
    for (int u = 0; u < numbers.width(); ++u) {
      if (numbers.at(u, v) == LfDepths::kUnknown) continue;
      const double inverse = depths.least + (numbers.at(u, v) - 1) * step;
      if (!(inverse > 0)) continue;
      const double x = (u + 0.5) * depths.divisor, y = (v + 0.5) * depths.divisor;
      Vec3 ideal(x, y, 1);
      if (k.has_distortion()) {
        const auto found = IdealPosition(k, map, x, y);
        if (!found) continue;
        ideal = *found / found->z();
      }
      const Vec3 point =
          frame.pinhole.cam_from_world * (world_from_lf * (unprojected * ideal / inverse).eval());
      if (!(point.z() > 0)) continue;
      const Vec3 at = plate.Matrix() * point / point.z();
      const double half = 0.5 * std::max(1.0, kOverlap * pixel_elements / (inverse * point.z()));
      const auto value = static_cast<float>(1 / point.z());
      const int left = static_cast<int>(std::ceil(at.x() - half - 0.5));
      const int right = static_cast<int>(std::floor(at.x() + half - 0.5));
      const int top = static_cast<int>(std::ceil(at.y() - half - 0.5));
      const int bottom = static_cast<int>(std::floor(at.y() + half - 0.5));
      for (int row = std::max(0, top); row <= std::min(bottom, plate.height_px - 1); ++row)
        for (int column = std::max(0, left); column <= std::min(right, plate.width_px - 1);
             ++column)
          if (!(nearest.at(column, row) >= value)) nearest.at(column, row) = value;
    }
  return nearest;
}

VotedDepths Vote(std::span<const Image<float>> candidates, double tolerance, ThreadPool& pool) {
  constexpr size_t kLeastVotes = 2;
  const int width = candidates.front().width(), height = candidates.front().height();
  const auto equal = static_cast<float>(tolerance);
  VotedDepths voted;
  voted.inverse = Image<float>(width, height, 1, kNone);
  voted.confidence = Image<float>(width, height);
  voted.view_count = candidates.size();
  pool.ForEach(static_cast<size_t>(height), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      size_t most = 0, seen = 0;
      float elected = 0;
      double sum_of_elected = 0;
      for (const Image<float>& candidate : candidates) {
        const float here = candidate.at(x, y);
        if (std::isnan(here)) continue;
        ++seen;
        size_t votes = 0;
        double sum = 0;
        for (const Image<float>& other : candidates)
          if (std::abs(other.at(x, y) - here) <= equal) {
            ++votes;
            sum += other.at(x, y);
          }
        if (votes < most || (votes == most && here <= elected)) continue;
        most = votes;
        elected = here;
        sum_of_elected = sum;
      }
      if (most < kLeastVotes) continue;
      voted.inverse.at(x, y) = static_cast<float>(sum_of_elected / static_cast<double>(most));
      voted.confidence.at(x, y) = static_cast<float>(most) / static_cast<float>(seen);
    }
  });
  float least = std::numeric_limits<float>::infinity(), greatest = 0;
  for (const float inverse : voted.inverse.pixels()) {
    if (std::isnan(inverse)) continue;
    least = std::min(least, inverse);
    greatest = std::max(greatest, inverse);
  }
  if (greatest > 0) voted.range = {1.0 / greatest, 1.0 / least};
  return voted;
}

Result<VotedDepths> VoteDepths(const LightField& light_field, const LfImageStore& store,
                               const RenderCamera& frame, ThreadPool& pool,
                               const std::atomic<bool>* stop) {
  constexpr size_t kVoters = 12, kLeastVoters = 3;
  constexpr double kEqual_elements = 1.25;
  const auto refusal = [&](size_t count) {
    return UsageError(fmt::format(
        "{{from store}}: the light field has the depths of {} recorded LF images near the camera, "
        "expected at least {}: give a densified store (lfdensify), or leave out this option",
        count, kLeastVoters));
  };
  if (!store.LoadsDepths()) return refusal(0);
  std::vector<std::pair<double, uint32_t>> order;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const Vec3 centre_world = light_field.Camera(LfImageId{i}).CentreWorld();
    if (!light_field.cameras[i].is_virtual)
      order.emplace_back((centre_world - frame.pinhole.CentreWorld()).norm(), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Image<float>> candidates;
  std::vector<double> distances;
  for (const auto& [distance, i] : order) {
    if (candidates.size() == kVoters) break;
    if (stop != nullptr && *stop) return Error{ErrorKind::kInterrupted, "interrupted"};
    LfPixels pixels;
    LF_RETURN_IF_ERROR(store.Load(LfImageId{i}, {0, 0, 1, 1}, &pixels));
    if (pixels.depths.numbers.empty()) continue;
    candidates.push_back(ProjectedDepths(pixels.depths, light_field.Camera(LfImageId{i}), frame));
    distances.push_back(distance);
  }
  if (candidates.size() < kLeastVoters) return refusal(candidates.size());
  const double tolerance =
      kEqual_elements / (frame.pinhole.intrinsics.fx_px * Median(std::move(distances)));
  VotedDepths voted = Vote(candidates, tolerance, pool);
  if (voted.range.near_w > 0) return voted;
  return InputError(fmt::format(
      "{}: no two of {} LF images near the camera have the same depth at any element: expected a "
      "camera among LF cameras that see the same",
      light_field.folder.string(), candidates.size()));
}

}  // namespace lf
