// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/splat.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>

#include "lf/core/check.h"
#include "lf/film/plate/tile_grid.h"
#include "lf/rebinning/splat_tile.h"

namespace lf {
namespace {

// The sums of a tile of this size stay in the L2 cache (splat_tile.h).
constexpr int kTileWidth = 64;
constexpr int kTileHeight = 32;

// Indices of the rays that reach each tile: rays[i] for i in [begins[tile], begins[tile + 1]).
struct TileRays {
  std::vector<size_t> begins;
  std::vector<uint32_t> rays;
};

// Calls visit(tile) for the tiles that a ray reaches.
template <class Visit>
void ForEachTile(const TileGrid& grid, const FrameRay& ray, double reach_px, const Visit& visit) {
  const auto tile_of = [](double position, int size, int count) {
    return std::clamp(static_cast<int>(std::floor(position / size)), 0, count - 1);
  };
  const int columns = grid.columns(), rows = grid.rows();
  const int x0 = tile_of(ray.x_px - reach_px, kTileWidth, columns);
  const int x1 = tile_of(ray.x_px + reach_px, kTileWidth, columns);
  const int y0 = tile_of(ray.y_px - reach_px, kTileHeight, rows);
  const int y1 = tile_of(ray.y_px + reach_px, kTileHeight, rows);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) visit(static_cast<size_t>(y) * columns + x);
}

// Sorts rays into tiles by a counting sort. The indices of a tile are ascending, for any number of
// threads.
TileRays SortIntoTiles(std::span<const FrameRay> rays, const TileGrid& grid, double reach_px,
                       ThreadPool& pool) {
  constexpr size_t kParts = 32;
  const size_t tiles = grid.tile_count();
  std::vector<std::vector<size_t>> places(kParts, std::vector<size_t>(tiles));
  const auto part_begin = [&](size_t part) { return part * rays.size() / kParts; };
  pool.ForEach(kParts, [&](size_t part) {
    for (size_t i = part_begin(part); i < part_begin(part + 1); ++i)
      ForEachTile(grid, rays[i], reach_px, [&](size_t tile) { ++places[part][tile]; });
  });
  TileRays sorted;
  size_t next = 0;
  for (size_t tile = 0; tile < tiles; ++tile) {
    sorted.begins.push_back(next);
    for (size_t part = 0; part < kParts; ++part) {
      const size_t count = places[part][tile];
      places[part][tile] = next;
      next += count;
    }
  }
  sorted.begins.push_back(next);
  sorted.rays.resize(next);
  pool.ForEach(kParts, [&](size_t part) {
    for (size_t i = part_begin(part); i < part_begin(part + 1); ++i)
      ForEachTile(grid, rays[i], reach_px, [&](size_t tile) {
        sorted.rays[places[part][tile]++] = static_cast<uint32_t>(i);
      });
  });
  return sorted;
}

// Divides the lens, and reach_w around it, into squares that are at least as wide as the reach: all
// rays within reach of a lens point are in its square or the eight around that square.
class LensGrid {
 public:
  LensGrid(const LensPointSets& points, double reach_w) : low_(points.sets[0][0]) {
    Vec2 high = low_;
    for (const auto& set : points.sets)
      for (const Vec2& point : set) {
        low_ = low_.cwiseMin(point);
        high = high.cwiseMax(point);
      }
    low_ -= Vec2::Constant(reach_w);
    high += Vec2::Constant(reach_w);
    side_w_ = std::max(reach_w, (high - low_).maxCoeff() / kMostSide);
    for (int axis = 0; axis < 2; ++axis)
      count_[axis] = 1 + static_cast<int>((high[axis] - low_[axis]) / side_w_);
  }
  size_t cells() const { return static_cast<size_t>(count_[0]) * count_[1]; }
  int Column(double x) const { return Cut((x - low_.x()) / side_w_, count_[0]); }
  int Row(double y) const { return Cut((y - low_.y()) / side_w_, count_[1]); }
  size_t CellAt(int column, int row) const { return static_cast<size_t>(row) * count_[0] + column; }

 private:
  static constexpr int kMostSide = 64;
  static int Cut(double place, int count) {
    return static_cast<int>(std::clamp(place, 0.0, count - 1.0));
  }
  Vec2 low_;
  double side_w_;
  std::array<int, 2> count_;
};

// A lens point of a GroupedSet.
struct GroupedPoint {
  Vec2 at;
  double sigma_st_w;  // QueryKernel::sigma_st_w times the spread of the point
  size_t number;      // index of the point in PointShares
};

// Divides the points of a set into groups of at most eight points near each other: cuts the lens
// into strips, and the strips into groups. Sorts `points` so that each group is a range of
// consecutive points, which begins at LensPointGroup::first.
std::vector<LensPointGroup> GroupsOf(std::vector<GroupedPoint>& points) {
  constexpr size_t kPoints = LensPointGroup::kPoints;
  const size_t groups = (points.size() + kPoints - 1) / kPoints;
  const auto strips = static_cast<size_t>(std::round(std::sqrt(static_cast<double>(groups))));
  const size_t per_strip = (groups + strips - 1) / strips * kPoints;
  const auto sort = [&points](size_t begin, size_t end, int axis) {
    const auto first = points.begin() + static_cast<std::ptrdiff_t>(begin);
    std::sort(
        first, first + static_cast<std::ptrdiff_t>(end - begin),
        [axis](const GroupedPoint& a, const GroupedPoint& b) { return a.at[axis] < b.at[axis]; });
  };
  sort(0, points.size(), 0);
  std::vector<LensPointGroup> all;
  for (size_t begin = 0; begin < points.size(); begin += per_strip) {
    const size_t end = std::min(begin + per_strip, points.size());
    sort(begin, end, 1);
    for (size_t i = begin; i < end; i += kPoints) {
      LensPointGroup group;
      group.x.fill(LensPointGroup::kNowhere);
      group.y.fill(LensPointGroup::kNowhere);
      group.per_st2.fill(1);
      group.first = i;
      for (size_t k = i; k < std::min(i + kPoints, end); ++k, ++group.count) {
        const double sigma_w = points[k].sigma_st_w;
        group.x[group.count] = static_cast<float>(points[k].at.x());
        group.y[group.count] = static_cast<float>(points[k].at.y());
        group.per_st2[group.count] = static_cast<float>(1 / (sigma_w * sigma_w));
        group.reach_w = std::max(group.reach_w, kReach_sigmas * sigma_w);
      }
      all.push_back(group);
    }
  }
  return all;
}

struct GroupedSet {
  std::vector<GroupedPoint> points;
  std::vector<LensPointGroup> groups;
};

std::vector<GroupedSet> GroupsOfSets(const LensPointSets& lens_points, const QueryKernel& kernel) {
  std::vector<GroupedSet> sets(lens_points.sets.size());
  size_t number = 0;
  for (size_t s = 0; s < sets.size(); ++s) {
    for (size_t i = 0; i < lens_points.sets[s].size(); ++i)
      sets[s].points.push_back(
          {lens_points.sets[s][i], kernel.sigma_st_w * lens_points.SpreadOf(s, i), number++});
    sets[s].groups = GroupsOf(sets[s].points);
  }
  return sets;
}

// Renders one tile at a time.
class TileSplatter {
 public:
  TileSplatter(const QueryKernel& kernel, std::span<const GroupedSet> sets, const LensGrid& lens,
               const PointShares* shares, SplatFrame* frame)
      : kernel_(kernel), sets_(sets), lens_(lens), shares_(shares), frame_(frame) {}

  // Renders the elements of `rect`, one set of lens points after the other.
  //   of_tile  indices of the rays that reach the tile
  //   k        LensPointSets::k
  void Run(std::span<const FrameRay> rays, std::span<const uint32_t> of_tile, const PixelRect& rect,
           int k) {
    SortByLens(rays, of_tile);
    for (int phase = 0; phase < k * k; ++phase) {
      const GroupedSet& set = sets_[phase];
      const auto first = [k](int begin, int remainder) {
        return begin + ((remainder - begin) % k + k) % k;
      };
      SplatGrid grid{first(rect.x_begin, phase % k), first(rect.y_begin, phase / k), k, 0, 0};
      grid.columns = (rect.x_end - grid.x0 + k - 1) / k;
      grid.rows = (rect.y_end - grid.y0 + k - 1) / k;
      if (grid.columns <= 0 || grid.rows <= 0) continue;
      sums_.Reset(grid);
      for (const LensPointGroup& group : set.groups) {
        if (shares_ != nullptr && !FindShares(set, group, rect, grid)) continue;
        AddNear(group, grid);
        AddMeans(grid, &sums_);
      }
      Store(set.points.size(), grid);
    }
  }

 private:
  void SortByLens(std::span<const FrameRay> rays, std::span<const uint32_t> of_tile) {
    begins_.assign(lens_.cells() + 1, 0);
    cell_of_.resize(of_tile.size());
    sorted_.resize(of_tile.size());
    // The rays of a tile are scattered in memory, so they are prefetched.
    constexpr size_t kRaysAhead = 16;
    for (size_t i = 0; i < of_tile.size(); ++i) {
      if (i + kRaysAhead < of_tile.size()) __builtin_prefetch(&rays[of_tile[i + kRaysAhead]]);
      const FrameRay& ray = rays[of_tile[i]];
      cell_of_[i] =
          static_cast<uint32_t>(lens_.CellAt(lens_.Column(ray.lens_x_w), lens_.Row(ray.lens_y_w)));
      ++begins_[cell_of_[i] + 1];
    }
    for (size_t cell = 0; cell < lens_.cells(); ++cell) begins_[cell + 1] += begins_[cell];
    next_ = begins_;
    for (size_t i = 0; i < of_tile.size(); ++i) sorted_[next_[cell_of_[i]]++] = rays[of_tile[i]];
  }

  // Writes the shares of a group's lens points at the elements of the grid to sums_.shares. Returns
  // false, and writes nothing, if no element of `rect` queries these points.
  bool FindShares(const GroupedSet& set, const LensPointGroup& group, const PixelRect& rect,
                  const SplatGrid& grid) {
    bool is_any = false;
    for (int i = 0; i < group.count && !is_any; ++i)
      is_any = shares_->IsAny(rect, set.points[group.first + i].number, 1);
    if (!is_any) return false;
    constexpr size_t kPoints = LensPointGroup::kPoints;
    sums_.shares.assign(static_cast<size_t>(grid.columns) * grid.rows * kPoints, 0.0F);
    float* out = sums_.shares.data();
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column, out += kPoints)
        for (int i = 0; i < group.count; ++i)
          shares_->At(grid.x0 + grid.k * column, grid.y0 + grid.k * row,
                      set.points[group.first + i].number, 1, out + i);
    return true;
  }

  void AddNear(const LensPointGroup& group, const SplatGrid& grid) {
    const double reach_w = group.reach_w;
    const auto [left, right] = std::minmax_element(group.x.begin(), group.x.begin() + group.count);
    const auto [low, high] = std::minmax_element(group.y.begin(), group.y.begin() + group.count);
    const int first = lens_.Column(*left - reach_w), last = lens_.Column(*right + reach_w);
    for (int row = lens_.Row(*low - reach_w); row <= lens_.Row(*high + reach_w); ++row) {
      const size_t begin = begins_[lens_.CellAt(first, row)];
      const size_t end = begins_[lens_.CellAt(last, row) + 1];
      AddRays(std::span(sorted_).subspan(begin, end - begin), group, kernel_, grid, &sums_);
    }
  }

  void Store(size_t point_count, const SplatGrid& grid) const {
    const float* mean = sums_.means.data();
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column, mean += SplatSums::kChannels) {
        const int x = grid.x0 + grid.k * column, y = grid.y0 + grid.k * row;
        const float found = mean[3];
        frame_->share.at(x, y) = found / static_cast<float>(point_count);
        if (found > 0)
          for (int c = 0; c < 3; ++c) frame_->rgb.at(x, y, c) = mean[c] / found;
      }
  }

  const QueryKernel kernel_;
  const std::span<const GroupedSet> sets_;
  const LensGrid& lens_;
  const PointShares* const shares_;
  SplatFrame* const frame_;
  std::vector<FrameRay> sorted_;  // rays of the tile, sorted by squares of the lens
  std::vector<size_t> begins_, next_;
  std::vector<uint32_t> cell_of_;
  SplatSums sums_;
};

SplatFrame EmptyFrame(int width_px, int height_px) {
  return {Image<float>(width_px, height_px, 3), Image<float>(width_px, height_px)};
}

}  // namespace

FrameReach ReachOf(const QueryKernel& kernel, const LensPointSets& lens_points) {
  return {kReach_sigmas * kernel.sigma_st_w * lens_points.MostSpread(),
          kReach_sigmas * kernel.sigma_uv_px};
}

SplatFrame Splat(std::span<const FrameRay> rays, int width_px, int height_px,
                 const LensPointSets& lens_points, const QueryKernel& kernel, ThreadPool& pool,
                 const PointShares* shares) {
  LF_CHECK(kernel.sigma_st_w > 0 && kernel.sigma_uv_px > 0);
  LF_CHECK(shares == nullptr || shares->point_count == lens_points.point_count());
  LF_CHECK(rays.size() < UINT32_MAX);
  SplatFrame frame = EmptyFrame(width_px, height_px);
  const TileGrid grid{width_px, height_px, kTileWidth, kTileHeight};
  const TileRays by_tile = SortIntoTiles(rays, grid, kReach_sigmas * kernel.sigma_uv_px, pool);
  const LensGrid lens(lens_points, ReachOf(kernel, lens_points).lens_w);
  const std::vector<GroupedSet> sets = GroupsOfSets(lens_points, kernel);
  // A thread keeps its splatter, because the system takes long to give each tile new memory.
  std::atomic<size_t> next = 0;
  pool.ForEach(std::min(grid.tile_count(), static_cast<size_t>(pool.thread_count())), [&](size_t) {
    TileSplatter splatter(kernel, sets, lens, shares, &frame);
    for (size_t tile = next++; tile < grid.tile_count(); tile = next++)
      splatter.Run(
          rays,
          std::span(by_tile.rays)
              .subspan(by_tile.begins[tile], by_tile.begins[tile + 1] - by_tile.begins[tile]),
          grid.RectOf(tile), lens_points.k);
  });
  return frame;
}

SplatFrame SplatReference(std::span<const FrameRay> rays, int width_px, int height_px,
                          const LensPointSets& lens_points, const QueryKernel& kernel,
                          ThreadPool& pool, const PointShares* shares, size_t nearest) {
  SplatFrame frame = EmptyFrame(width_px, height_px);
  if (rays.empty()) return frame;
  std::map<double, std::unique_ptr<RayQuery>> queries;  // key: spread of a lens point
  std::vector<size_t> firsts = {0};  // index in the shares of each set's first point
  for (size_t set = 0; set < lens_points.sets.size(); ++set) {
    firsts.push_back(firsts.back() + lens_points.sets[set].size());
    for (size_t i = 0; i < lens_points.sets[set].size(); ++i) {
      const double spread = lens_points.SpreadOf(set, i);
      std::unique_ptr<RayQuery>& query = queries[spread];
      if (!query)
        query = std::make_unique<RayQuery>(
            rays, QueryKernel{kernel.sigma_st_w * spread, kernel.sigma_uv_px});
    }
  }
  pool.ForEach(static_cast<size_t>(height_px), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width_px; ++x) {
      const size_t s = static_cast<size_t>(y % lens_points.k) * lens_points.k + x % lens_points.k;
      const auto& set = lens_points.sets[s];
      std::array<double, 3> rgb{};
      double found = 0;
      for (size_t i = 0; i < set.size(); ++i) {
        float share = 1;
        if (shares != nullptr) shares->At(x, y, firsts[s] + i, 1, &share);
        if (share == 0) continue;
        const RayQuery& query = *queries.at(lens_points.SpreadOf(s, i));
        const Vec2 position_px(x + 0.5, y + 0.5);
        const QuerySum sum = nearest > 0 ? query.Nearest(set[i], position_px, nearest)
                                         : query.WithinReach(set[i], position_px);
        if (!(sum.weight > 0)) continue;
        for (int c = 0; c < 3; ++c) rgb[c] += share * sum.rgb[c] / sum.weight;
        found += share;
      }
      frame.share.at(x, y) = static_cast<float>(found / static_cast<double>(set.size()));
      for (int c = 0; c < 3 && found > 0; ++c)
        frame.rgb.at(x, y, c) = static_cast<float>(rgb[c] / found);
    }
  });
  return frame;
}

}  // namespace lf
