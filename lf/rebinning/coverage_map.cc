// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/coverage_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kPixelsPerCell = 8;
constexpr double kReachPerCell = 2;
// Distance between neighbouring spawned rays, in cells. Because it is below 1, every cell that a
// ray between them runs through is marked, or is a neighbour of a marked cell.
constexpr double kSpawnStep = 0.9;

// Returns points in lens coordinates, step_w apart, that fill the reach of the lens points that are
// queried, and a margin of step_w around it.
//   asked  [point_count of all sets]: true for the lens points that are queried
std::vector<Vec2> PlacesAround(const FrameQueries& frame, const std::vector<bool>& asked,
                               double step_w) {
  std::vector<Vec2> centres;
  std::vector<double> reaches;
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  size_t number = 0;
  for (size_t s = 0; s < frame.points.sets.size(); ++s)
    for (size_t i = 0; i < frame.points.sets[s].size(); ++i, ++number) {
      if (!asked[number]) continue;
      const double reach_w =
          kReach_sigmas * frame.kernel.sigma_st_w * frame.points.SpreadOf(s, i) + step_w;
      centres.push_back(frame.points.sets[s][i]);
      reaches.push_back(reach_w);
      low = low.cwiseMin(centres.back() - Vec2::Constant(reach_w));
      high = high.cwiseMax(centres.back() + Vec2::Constant(reach_w));
    }
  std::vector<Vec2> places;
  if (centres.empty()) return places;
  for (double y = low.y(); y <= high.y(); y += step_w)    // NOLINT: rounding of y does no harm
    for (double x = low.x(); x <= high.x(); x += step_w)  // NOLINT: rounding of x does no harm
      for (size_t i = 0; i < centres.size(); ++i)
        if ((Vec2(x, y) - centres[i]).squaredNorm() <= reaches[i] * reaches[i]) {
          places.emplace_back(x, y);
          break;
        }
  return places;
}

}  // namespace

CoverageMap::CoverageMap(const SlabSection& section, std::span<const FrameQueries> frames,
                         const CoverageOptions& options, ThreadPool& pool) {
  if (std::none_of(frames.begin(), frames.end(),
                   [](const FrameQueries& frame) { return frame.AsksForAny(); }))
    return;
  SetGrid(section, frames, options);
  pool.ForEach(frames.size(), [&](size_t f) { Spawn(section.slab, frames[f]); });
  for (int axis = 0; axis < kCellAxes; ++axis) WidenAlong(axis, pool);
}

void CoverageMap::SetGrid(const SlabSection& section, std::span<const FrameQueries> frames,
                          const CoverageOptions& options) {
  double st = std::numeric_limits<double>::infinity(), uv = st;
  const Slab& slab = section.slab;
  const double distance = (slab.uv.origin_world - slab.st.origin_world).norm();
  for (const FrameQueries& frame : frames) {
    const Intrinsics& plate = frame.camera.pinhole.intrinsics;
    st = std::min(st, kReach_sigmas * frame.kernel.sigma_st_w / kReachPerCell);
    uv = std::min(uv, distance / plate.fx_px * plate.width_px / options.cells_across);
  }
  width_w_ = {std::max(st, slab.r_st_w),
              std::max({uv, kPixelsPerCell * section.pixel_uv_w, slab.r_uv_w})};
  const SlabPoint size = section.bounds.high - section.bounds.low;
  while (true) {
    double bits = 1;
    for (int k = 0; k < kCellAxes; ++k) {
      // Adds one cell beyond the bounds on either side.
      double cells = std::floor(size[k] / width_w_[k / 2]) + 3;
      if (k == kCellAxes - 1) cells = std::ceil(cells / kBits) * kBits;
      bits *= cells;
      count_[k] = static_cast<size_t>(std::min(cells, 1e9));
    }
    if (bits <= 8.0 * static_cast<double>(options.most_bytes)) break;
    for (double& width : width_w_) width *= 1.1;
  }
  for (int k = 0; k < kCellAxes; ++k) {
    per_width_[k] = 1 / width_w_[k / 2];
    low_[k] = section.bounds.low[k] - width_w_[k / 2];
  }
  bits_.assign(count_[0] * count_[1] * count_[2] * count_[3] / kBits, 0);
}

void CoverageMap::Mark(const SlabPoint& point) {
  size_t index = 0;
  for (int k = 0; k < kCellAxes; ++k) {
    // A ray beyond the bounds comes from the margin that PlacesAround() adds; no frame queries it.
    const double place = (point[k] - low_[k]) * per_width_[k];
    if (!(place >= 0 && place < static_cast<double>(count_[k]))) return;
    index = index * count_[k] + static_cast<size_t>(place);
  }
  const uint64_t bit = uint64_t{1} << (index % kBits);
  std::atomic_ref<uint64_t> word(bits_[index / kBits]);
  if ((word.load(std::memory_order_relaxed) & bit) == 0)
    word.fetch_or(bit, std::memory_order_relaxed);
}

void CoverageMap::Spawn(const Slab& slab, const FrameQueries& frame) {
  if (!frame.AsksForAny()) return;
  const RenderCamera& camera = frame.camera;
  const Intrinsics& plate = camera.pinhole.intrinsics;
  const double margin_px = ReachOf(frame.kernel, frame.points).plate_px;
  // Rays are spawned at positions on the plate that are less than a cell apart on the uv plane,
  // measured at three places along the plate's diagonal.
  const Vec3 centre = camera.pinhole.CentreWorld();
  const auto on_uv = [&](double x, double y) -> std::optional<SlabPoint> {
    const std::optional<Vec3> focus = FocusPointOfElement(camera, x, y);
    return focus ? Parameterize(slab, Ray{centre, *focus - centre}) : std::nullopt;
  };
  double element_uv_w = 0;
  for (const double along : {0.01, 0.5, 0.99}) {
    const double x = along * plate.width_px, y = along * plate.height_px;
    const std::optional<SlabPoint> here = on_uv(x, y), right = on_uv(x + 1, y),
                                   below = on_uv(x, y + 1);
    for (const auto& next : {right, below})
      if (here && next) element_uv_w = std::max(element_uv_w, (*next - *here).tail<2>().norm());
  }
  if (element_uv_w == 0) return;
  const double step_px = std::max(kSpawnStep * width_w_[1] / element_uv_w, 0.5);
  const double step_w = kSpawnStep * width_w_[0];
  const size_t point_count = frame.points.point_count();
  std::map<std::vector<bool>, std::vector<Vec2>> places_of;  // key: `asked` of PlacesAround()
  std::vector<bool> asked(point_count, true);
  const auto steps = [&](int size_px) {
    return static_cast<int>(std::ceil((size_px + 2 * margin_px) / step_px));
  };
  const int columns = steps(plate.width_px), rows = steps(plate.height_px);
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column) {
      const double x = -margin_px + (plate.width_px + 2 * margin_px) * column / columns;
      const double y = -margin_px + (plate.height_px + 2 * margin_px) * row / rows;
      if (frame.shares) {
        const int x_px = std::clamp(static_cast<int>(x), 0, plate.width_px - 1);
        const int y_px = std::clamp(static_cast<int>(y), 0, plate.height_px - 1);
        for (size_t i = 0; i < point_count; ++i)
          asked[i] = frame.shares->IsAny({x_px, y_px, x_px + 1, y_px + 1}, i, 1);
      }
      auto found = places_of.find(asked);
      if (found == places_of.end())
        found = places_of.emplace(asked, PlacesAround(frame, asked, step_w)).first;
      if (found->second.empty()) continue;
      const std::optional<Vec3> focus = FocusPointOfElement(camera, x, y);
      if (!focus) continue;
      for (const Vec2& place : found->second) {
        const Vec3 lens = LensPointWorld(camera, place);
        if (const auto point = Parameterize(slab, Ray{lens, *focus - lens})) Mark(*point);
      }
    }
}

// Marks the neighbours of each marked cell along an axis.
void CoverageMap::WidenAlong(int axis, ThreadPool& pool) {
  constexpr size_t kWordsAtOnce = 16384;
  const LargeVector<uint64_t> before = bits_;
  const bool is_last = axis == kCellAxes - 1;
  // Number of words from a cell to the next one along the axis. The bits of a word are neighbours
  // along the last axis.
  size_t stride = 1;
  for (int k = axis + 1; k < kCellAxes; ++k) stride *= count_[k];
  if (!is_last) stride /= kBits;
  const size_t count = is_last ? count_[axis] / kBits : count_[axis];
  pool.ForEach((bits_.size() + kWordsAtOnce - 1) / kWordsAtOnce, [&](size_t part) {
    const size_t end = std::min(bits_.size(), (part + 1) * kWordsAtOnce);
    for (size_t i = part * kWordsAtOnce; i < end; ++i) {
      const size_t number = i / stride % count;
      const uint64_t one_before = number > 0 ? before[i - stride] : 0;
      const uint64_t one_after = number + 1 < count ? before[i + stride] : 0;
      bits_[i] |= is_last ? before[i] << 1 | before[i] >> 1 | one_before >> (kBits - 1) |
                                one_after << (kBits - 1)
                          : one_before | one_after;
    }
  });
}

double CoverageMap::share() const {
  size_t marked = 0;
  for (const uint64_t word : bits_) marked += static_cast<size_t>(std::popcount(word));
  return bits_.empty() ? 0
                       : static_cast<double>(marked) / static_cast<double>(bits_.size() * kBits);
}

}  // namespace lf
