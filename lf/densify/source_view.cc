// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/source_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lf {

SourceView::SourceView(const PinholeCamera& camera, const Source& source,
                       const InverseDepths& range)
    : source_(source),
      from_source_(MapBetween(source.image->camera, camera)),
      to_source_(MapBetween(camera, source.image->camera)),
      step_(static_cast<float>(range.Step())),
      // The number 1 stands for the least inverse depth.
      first_(static_cast<float>(range.least - range.Step())) {}

void SourceView::Project(Image<float>* candidates, InterruptFlag interrupted) const {
  constexpr float kReach = 0.75f;
  const DepthPlane& plane = *source_.plane;
  const Image<uint8_t>& without_depth = source_.image->without_depth;
  const int width = candidates->width(), height = candidates->height();
  const auto right = static_cast<float>(width), bottom = static_cast<float>(height);
  std::fill(candidates->pixels().begin(), candidates->pixels().end(), kNoDepth);
  std::array<float, kChunk> u_px, v_px, depths;
  for (int y = 0; y < plane.height() && !IsSet(interrupted); ++y)
    for (int begin = 0; begin < plane.width(); begin += kChunk) {
      const int count = std::min(kChunk, plane.width() - begin);
      ProjectRow(from_source_, plane.row(y) + begin, begin, y, count, first_, step_, u_px.data(),
                 v_px.data(), depths.data());
      for (int k = 0; k < count; ++k) {
        const auto i = static_cast<size_t>(k);
        const float u = u_px[i], v = v_px[i];
        if (!(u > -kReach && v > -kReach && u < right && v < bottom)) continue;
        if (!without_depth.empty() && without_depth.at(begin + k, y) != 0) continue;
        // One or two columns and rows are near enough.
        const int first_column = std::max(static_cast<int>(u + 1 - kReach), 0);
        const int first_row = std::max(static_cast<int>(v + 1 - kReach), 0);
        const int last_column = std::min(static_cast<int>(u + kReach), width - 1);
        const int last_row = std::min(static_cast<int>(v + kReach), height - 1);
        for (int row = first_row; row <= last_row; ++row)
          for (int column = first_column; column <= last_column; ++column) {
            float& candidate = candidates->at(column, row);
            candidate = std::max(candidate, depths[i]);
          }
      }
    }
}

void SourceView::See(int x_begin, int y, int count, const float* depths, float per_tolerance,
                     SeenPoints* seen, float* errors, float* votes) const {
  const DepthPlane& plane = *source_.plane;
  SeeRow(to_source_, x_begin, y, count, depths, plane.width(), plane.height(), seen);
  std::array<float, kChunk> there;
  const uint16_t* numbers = plane.pixels().data();
  const bool has_empty = HasEmpty();
  for (int i = 0; i < count; ++i) {
    const int32_t pixel = std::max(seen->pixel[i], 0);
    there[static_cast<size_t>(i)] =
        has_empty ? DepthSeenAt(seen->u_px[i], seen->v_px[i]) : DepthOf(numbers[pixel]);
  }
  AddVotes(*seen, there.data(), count, per_tolerance, weight(), errors, votes);
}

float SourceView::DepthSeenAt(float u_px, float v_px) const {
  const int x = static_cast<int>(u_px), y = static_cast<int>(v_px);
  const DepthPlane& plane = *source_.plane;
  if (!ShowsNothing(x, y)) return DepthOf(plane.at(x, y));
  const int beside =
      std::clamp(u_px - static_cast<float>(x) < 0.5f ? x - 1 : x + 1, 0, plane.width() - 1);
  const int below =
      std::clamp(v_px - static_cast<float>(y) < 0.5f ? y - 1 : y + 1, 0, plane.height() - 1);
  if (!ShowsNothing(beside, y)) return DepthOf(plane.at(beside, y));
  if (!ShowsNothing(x, below)) return DepthOf(plane.at(x, below));
  if (!ShowsNothing(beside, below)) return DepthOf(plane.at(beside, below));
  return -std::numeric_limits<float>::infinity();
}

}  // namespace lf
