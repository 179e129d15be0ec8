// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/matching_costs.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/core/check.h"
#include "lf/densify/matching_row.h"
#include "lf/densify/plane_set.h"

namespace lf {
namespace {

// Returns groups of views: those on one side of the reference camera, for eight sides, and all.
// Groups of one view and groups that occur twice are left out.
std::vector<std::vector<int>> GroupsOf(std::span<const SweepView> views) {
  constexpr double kLeastCosine = 0.2;
  constexpr double kDiagonal = 0.70710678118654752;
  const Vec2 sides[] = {{1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
                        {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};
  std::vector<std::vector<int>> groups;
  for (const Vec2& side : sides) {
    std::vector<int> group;
    for (size_t i = 0; i < views.size(); ++i)
      if (views[i].direction.dot(side) >= kLeastCosine) group.push_back(static_cast<int>(i));
    if (group.size() >= 2 && group.size() < views.size() &&
        std::find(groups.begin(), groups.end(), group) == groups.end())
      groups.push_back(std::move(group));
  }
  std::vector<int> all(views.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  groups.push_back(std::move(all));
  return groups;
}

// Differences of three rows of pixels, for each view and plane. Rows have a pixel more on each
// side.
class ThreeRows {
 public:
  ThreeRows(size_t views, int planes, int width)
      : planes_(static_cast<size_t>(planes)),
        width_(static_cast<size_t>(width) + 2),
        values_(views * planes_ * width_ * 3) {}
  uint16_t* Row(size_t view, int plane, int y) {
    const size_t row =
        (view * planes_ + static_cast<size_t>(plane)) * 3 + static_cast<size_t>(y % 3);
    return values_.data() + row * width_;
  }

 private:
  size_t planes_, width_;
  LargeVector<uint16_t> values_;
};

// Sets the costs of the pixels of row y, at inverse depth z, at whose places a view is empty.
//   columns  those of the pixels, in the reference image
//   costs    of the pixels from column x_begin on
void Carve(std::span<const SweepView> views, std::span<const int> columns, int y, float z,
           int x_begin, uint8_t* costs) {
  for (const SweepView& view : views) {
    const Image<uint8_t>& empty = view.image->empty;
    if (empty.empty()) continue;
    for (const int x : columns)
      if (IsMarkedAt(empty, view.from_reference.At(static_cast<float>(x) + 0.5f,
                                                   static_cast<float>(y) + 0.5f, z)))
        costs[x - x_begin] = MatchingCosts::kCarved;
  }
}

}  // namespace

SweepView ViewFrom(const WorkingImage& reference, const WorkingImage& image) {
  const Vec3 offset = reference.camera.cam_from_world * image.camera.CentreWorld();
  const double length = offset.head<2>().norm();
  return {&image, MapBetween(reference.camera, image.camera),
          length > 0 ? Vec2(offset.head<2>() / length) : Vec2(Vec2::Zero())};
}

void ComputeMatchingCosts(const WorkingImage& reference, std::span<const SweepView> views,
                          const InverseDepths& range, int planes, const PixelRect& rect,
                          MatchingCosts* result, InterruptFlag interrupted) {
  ComputeMatchingCosts(reference, views, PlaneSet::All(planes).Depths(range, planes), rect, result,
                       interrupted);
}

void ComputeMatchingCosts(const WorkingImage& reference, std::span<const SweepView> views,
                          std::span<const float> depths, const PixelRect& rect,
                          MatchingCosts* result, InterruptFlag interrupted) {
  LF_CHECK(!views.empty() && depths.size() >= 2 && !rect.empty());
  const auto planes = static_cast<int>(depths.size());
  const int width = rect.width(), last_y = reference.height() - 1, last_x = reference.width() - 1;
  result->rect = rect;
  result->planes = planes;
  result->stride = MatchingCosts::StrideOf(planes);
  const size_t row_size = static_cast<size_t>(width) * result->stride;
  result->costs.resize(row_size * rect.height());

  const std::vector<std::vector<int>> groups = GroupsOf(views);
  const std::vector<std::span<const int>> group_spans(groups.begin(), groups.end());
  const int x_begin = std::max(rect.x_begin - 1, 0), x_end = std::min(rect.x_end + 1, last_x + 1);
  ThreeRows differences(views.size(), planes, width);
  const auto compare = [&](int y) {
    for (size_t v = 0; v < views.size(); ++v) {
      const Image<uint16_t>& tones = views[v].image->compared;
      for (int plane = 0; plane < planes; ++plane) {
        if (std::isnan(depths[plane])) continue;
        uint16_t* row = differences.Row(v, plane, y);
        CompareRow(reference.compared.row(y) + static_cast<size_t>(x_begin) * LfPixels::kRgbLanes,
                   x_begin, y, x_end - x_begin, views[v].from_reference, depths[plane],
                   {tones.row(0), tones.width(), tones.height()},
                   row + (x_begin - rect.x_begin + 1));
        if (x_begin == rect.x_begin) row[0] = row[1];
        if (x_end == rect.x_end) row[width + 1] = row[width];
      }
    }
  };
  std::vector<LargeVector<uint16_t>> means(views.size(),
                                           LargeVector<uint16_t>(static_cast<size_t>(width)));
  std::vector<const uint16_t*> mean_rows;
  for (const LargeVector<uint16_t>& row : means) mean_rows.push_back(row.data());
  LargeVector<uint8_t> by_plane(static_cast<size_t>(width) * planes);

  for (int y = std::max(rect.y_begin - 1, 0); y <= std::min(rect.y_begin, last_y); ++y) compare(y);
  std::vector<int> shown;  // columns of the pixels that can be carved
  for (int y = rect.y_begin; y < rect.y_end && !IsSet(interrupted); ++y) {
    if (y < last_y) compare(y + 1);
    shown.clear();
    for (int x = rect.x_begin; x < rect.x_end; ++x)
      if (!IsTransparent(&reference.tones.at(x, y))) shown.push_back(x);
    const int above = std::max(y - 1, 0), below = std::min(y + 1, last_y);
    for (int plane = 0; plane < planes; ++plane) {
      uint8_t* of_plane = by_plane.data() + static_cast<size_t>(plane) * width;
      if (std::isnan(depths[plane])) {
        std::fill(of_plane, of_plane + width, uint8_t{MatchingCosts::kCarved});
        continue;
      }
      for (size_t v = 0; v < views.size(); ++v)
        MeanOfNine(differences.Row(v, plane, above), differences.Row(v, plane, y),
                   differences.Row(v, plane, below), width, means[v].data());
      LeastOfGroups(mean_rows.data(), group_spans, width, of_plane);
      Carve(views, shown, y, depths[plane], rect.x_begin, of_plane);
    }
    uint8_t* out = result->costs.data() + static_cast<size_t>(y - rect.y_begin) * row_size;
    for (int x = 0; x < width; ++x, out += result->stride) {
      for (int plane = 0; plane < planes; ++plane)
        out[plane] = by_plane[static_cast<size_t>(plane) * width + x];
      std::fill(out + planes, out + result->stride, uint8_t{MatchingCosts::kMost});
    }
  }
}

}  // namespace lf
