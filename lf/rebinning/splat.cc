#include "lf/rebinning/splat.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/core/check.h"
#include "lf/plate/tile_grid.h"
#include "lf/rebinning/splat_tile.h"

namespace lf {
namespace {

// Sums of a tile stay in the second level cache (splat_tile.h).
constexpr int kTileWidth = 64;
constexpr int kTileHeight = 32;

// Which rays reach which tile: [begins[tile], begins[tile + 1]) of `rays`.
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

// In the order of the rays, whatever the threads: counted, then placed.
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

// Squares over the lens, as large as the reach: what is near a lens point is in nine of them.
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

// The points of a set by eight that are near each other: strips of the lens, cut across.
std::vector<LensPointGroup> GroupsOf(std::vector<Vec2> points) {
  constexpr size_t kPoints = LensPointGroup::kPoints;
  const size_t groups = (points.size() + kPoints - 1) / kPoints;
  const auto strips = static_cast<size_t>(std::round(std::sqrt(static_cast<double>(groups))));
  const size_t per_strip = (groups + strips - 1) / strips * kPoints;
  const auto sort = [&points](size_t begin, size_t end, int axis) {
    const auto first = points.begin() + static_cast<std::ptrdiff_t>(begin);
    std::sort(first, first + static_cast<std::ptrdiff_t>(end - begin),
              [axis](const Vec2& a, const Vec2& b) { return a[axis] < b[axis]; });
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
      for (size_t k = i; k < std::min(i + kPoints, end); ++k, ++group.count) {
        group.x[group.count] = static_cast<float>(points[k].x());
        group.y[group.count] = static_cast<float>(points[k].y());
      }
      all.push_back(group);
    }
  }
  return all;
}

// One tile at a time.
class TileSplatter {
 public:
  // groups  of each set of lens points
  TileSplatter(const QueryKernel& kernel, const LensPointSets& points,
               std::span<const std::vector<LensPointGroup>> groups, const LensGrid& lens)
      : kernel_(kernel), points_(points), groups_(groups), lens_(lens) {}

  void Run(std::span<const FrameRay> rays, std::span<const uint32_t> of_tile, const PixelRect& rect,
           SplatFrame* frame) {
    SortByLens(rays, of_tile);
    const int k = points_.k;
    for (int phase = 0; phase < k * k; ++phase) {
      const auto first = [k](int begin, int remainder) {
        return begin + ((remainder - begin) % k + k) % k;
      };
      SplatGrid grid{first(rect.x_begin, phase % k), first(rect.y_begin, phase / k), k, 0, 0};
      grid.columns = (rect.x_end - grid.x0 + k - 1) / k;
      grid.rows = (rect.y_end - grid.y0 + k - 1) / k;
      if (grid.columns <= 0 || grid.rows <= 0) continue;
      sums_.Reset(grid);
      for (const LensPointGroup& group : groups_[phase]) {
        AddNear(group, grid);
        AddMeans(grid, &sums_);
      }
      Store(points_.sets[phase].size(), grid, frame);
    }
  }

 private:
  void SortByLens(std::span<const FrameRay> rays, std::span<const uint32_t> of_tile) {
    begins_.assign(lens_.cells() + 1, 0);
    cell_of_.resize(of_tile.size());
    sorted_.resize(of_tile.size());
    // Rays of a tile are anywhere in memory.
    constexpr size_t kAhead = 16;
    for (size_t i = 0; i < of_tile.size(); ++i) {
      if (i + kAhead < of_tile.size()) __builtin_prefetch(&rays[of_tile[i + kAhead]]);
      const FrameRay& ray = rays[of_tile[i]];
      cell_of_[i] =
          static_cast<uint32_t>(lens_.CellAt(lens_.Column(ray.lens_x_w), lens_.Row(ray.lens_y_w)));
      ++begins_[cell_of_[i] + 1];
    }
    for (size_t cell = 0; cell < lens_.cells(); ++cell) begins_[cell + 1] += begins_[cell];
    next_ = begins_;
    for (size_t i = 0; i < of_tile.size(); ++i) sorted_[next_[cell_of_[i]]++] = rays[of_tile[i]];
  }

  void AddNear(const LensPointGroup& group, const SplatGrid& grid) {
    const double reach_w = kReach_sigmas * kernel_.sigma_st_w;
    const auto [left, right] = std::minmax_element(group.x.begin(), group.x.begin() + group.count);
    const auto [low, high] = std::minmax_element(group.y.begin(), group.y.begin() + group.count);
    const int first = lens_.Column(*left - reach_w), last = lens_.Column(*right + reach_w);
    for (int row = lens_.Row(*low - reach_w); row <= lens_.Row(*high + reach_w); ++row) {
      const size_t begin = begins_[lens_.CellAt(first, row)];
      const size_t end = begins_[lens_.CellAt(last, row) + 1];
      AddRays(std::span(sorted_).subspan(begin, end - begin), group, kernel_, grid, &sums_);
    }
  }

  void Store(size_t point_count, const SplatGrid& grid, SplatFrame* frame) const {
    const float* mean = sums_.means.data();
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column, mean += SplatSums::kChannels) {
        const int x = grid.x0 + grid.k * column, y = grid.y0 + grid.k * row;
        const float found = mean[3];
        frame->share.at(x, y) = found / static_cast<float>(point_count);
        if (found > 0)
          for (int c = 0; c < 3; ++c) frame->rgb.at(x, y, c) = mean[c] / found;
      }
  }

  const QueryKernel kernel_;
  const LensPointSets& points_;
  const std::span<const std::vector<LensPointGroup>> groups_;
  const LensGrid& lens_;
  std::vector<FrameRay> sorted_;  // of the tile, by places on the lens
  std::vector<size_t> begins_, next_;
  std::vector<uint32_t> cell_of_;
  SplatSums sums_;
};

SplatFrame EmptyFrame(int width_px, int height_px) {
  return {Image<float>(width_px, height_px, 3), Image<float>(width_px, height_px)};
}

}  // namespace

FrameReach ReachOf(const QueryKernel& kernel) {
  return {kReach_sigmas * kernel.sigma_st_w, kReach_sigmas * kernel.sigma_uv_px};
}

SplatFrame Splat(std::span<const FrameRay> rays, int width_px, int height_px,
                 const LensPointSets& lens_points, const QueryKernel& kernel, ThreadPool& pool) {
  LF_CHECK(kernel.sigma_st_w > 0 && kernel.sigma_uv_px > 0);
  LF_CHECK(rays.size() < UINT32_MAX);
  SplatFrame frame = EmptyFrame(width_px, height_px);
  const TileGrid grid{width_px, height_px, kTileWidth, kTileHeight};
  const TileRays by_tile = SortIntoTiles(rays, grid, kReach_sigmas * kernel.sigma_uv_px, pool);
  const LensGrid lens(lens_points, kReach_sigmas * kernel.sigma_st_w);
  std::vector<std::vector<LensPointGroup>> groups;
  for (const auto& set : lens_points.sets) groups.push_back(GroupsOf(set));
  pool.ForEach(grid.tile_count(), [&](size_t tile) {
    TileSplatter splatter(kernel, lens_points, groups, lens);
    splatter.Run(
        rays,
        std::span(by_tile.rays)
            .subspan(by_tile.begins[tile], by_tile.begins[tile + 1] - by_tile.begins[tile]),
        grid.RectOf(tile), &frame);
  });
  return frame;
}

SplatFrame SplatReference(std::span<const FrameRay> rays, int width_px, int height_px,
                          const LensPointSets& lens_points, const QueryKernel& kernel,
                          ThreadPool& pool) {
  SplatFrame frame = EmptyFrame(width_px, height_px);
  const RayQuery query(rays, kernel);
  pool.ForEach(static_cast<size_t>(height_px), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width_px; ++x) {
      const auto& set = lens_points.sets[(y % lens_points.k) * lens_points.k + x % lens_points.k];
      std::array<double, 3> rgb{};
      int found = 0;
      for (const Vec2& point : set) {
        const QuerySum sum = query.WithinReach(point, Vec2(x + 0.5, y + 0.5));
        if (!(sum.weight > 0)) continue;
        for (int c = 0; c < 3; ++c) rgb[c] += sum.rgb[c] / sum.weight;
        ++found;
      }
      frame.share.at(x, y) = static_cast<float>(found) / static_cast<float>(set.size());
      for (int c = 0; c < 3 && found > 0; ++c)
        frame.rgb.at(x, y, c) = static_cast<float>(rgb[c] / found);
    }
  });
  return frame;
}

}  // namespace lf
