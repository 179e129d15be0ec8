// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/point_shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lf/core/check.h"

namespace lf {
namespace {

// Distances of the additional nodes from the first or last node, as parts of the distance between
// nodes.
constexpr double kCloseToEnds[] = {1.0 / 16, 1.0 / 4};

}  // namespace

NodeAxis::NodeAxis(int size_px, int count) {
  LF_CHECK(size_px > 0 && count > 0);
  const double end_px = size_px - 0.5;
  if (count == 1 || size_px == 1) {
    nodes_px_ = {0.5 * size_px};
    places_.resize(size_px);
    return;
  }
  const double step_px = (size_px - 1.0) / (count - 1);
  for (int i = 0; i < count; ++i) nodes_px_.push_back(0.5 + step_px * i);
  for (const double part : kCloseToEnds) {
    if (count == 2 || part * step_px < 1) continue;
    nodes_px_.push_back(0.5 + part * step_px);
    nodes_px_.push_back(end_px - part * step_px);
  }
  std::sort(nodes_px_.begin(), nodes_px_.end());
  for (int element = 0, node = 0; element < size_px; ++element) {
    const double at_px = element + 0.5;
    while (node + 2 < static_cast<int>(nodes_px_.size()) && nodes_px_[node + 1] <= at_px) ++node;
    const double fraction = (at_px - nodes_px_[node]) / (nodes_px_[node + 1] - nodes_px_[node]);
    places_.push_back({node, node + 1, static_cast<float>(std::clamp(fraction, 0.0, 1.0))});
  }
}

void PointShares::At(int x, int y, size_t first, size_t count, float* out) const {
  const NodeAxis::Place across = columns.PlaceOf(x), down = rows.PlaceOf(y);
  const auto node = [&](int column, int row) {
    return values.data() + (static_cast<size_t>(row) * columns.count() + column) * point_count +
           first;
  };
  const float* const corners[4] = {node(across.first, down.first), node(across.second, down.first),
                                   node(across.first, down.second),
                                   node(across.second, down.second)};
  for (size_t i = 0; i < count; ++i) {
    const float above = corners[0][i] + across.fraction * (corners[1][i] - corners[0][i]);
    const float below = corners[2][i] + across.fraction * (corners[3][i] - corners[2][i]);
    out[i] = above + down.fraction * (below - above);
  }
}

bool PointShares::IsAny(const PixelRect& rect, size_t first, size_t count) const {
  const int left = columns.PlaceOf(rect.x_begin).first;
  const int right = columns.PlaceOf(rect.x_end - 1).second;
  const int bottom = rows.PlaceOf(rect.y_end - 1).second;
  for (int row = rows.PlaceOf(rect.y_begin).first; row <= bottom; ++row)
    for (int column = left; column <= right; ++column) {
      const auto begin =
          values.begin() +
          static_cast<std::ptrdiff_t>(
              (static_cast<size_t>(row) * columns.count() + column) * point_count + first);
      if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(count),
                      [](float value) { return value > 0; }))
        return true;
    }
  return false;
}

AskedSquares PointShares::Squares(double reach_px) const {
  const int side = AskedSquares::kSide, reach = static_cast<int>(std::ceil(reach_px));
  const int width_px = columns.size_px(), height_px = rows.size_px();
  AskedSquares squares;
  squares.columns = (width_px + side - 1) / side;
  for (int y = 0; y < height_px; y += side)
    for (int x = 0; x < width_px; x += side)
      squares.asked.push_back(
          IsAny(Intersection({x - reach, y - reach, x + side + reach, y + side + reach},
                             {0, 0, width_px, height_px}),
                0, point_count));
  return squares;
}

PointShares PointShares::OfPoint(size_t point) const {
  PointShares one{columns, rows, 1, {}};
  for (size_t i = point; i < values.size(); i += point_count) one.values.push_back(values[i]);
  return one;
}

PointShares PointShares::MeansOfSets(const LensPointSets& points) const {
  PointShares means{columns, rows, points.sets.size(), {}};
  for (auto value = values.begin(); value != values.end();)
    for (const auto& set : points.sets) {
      const auto end = value + static_cast<std::ptrdiff_t>(set.size());
      means.values.push_back(std::accumulate(value, end, 0.0F) / static_cast<float>(set.size()));
      value = end;
    }
  return means;
}

}  // namespace lf
