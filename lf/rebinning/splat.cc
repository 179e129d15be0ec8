#include "lf/rebinning/splat.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/core/check.h"

namespace lf {
namespace {

// Sums of a tile for one lens point stay in the first level cache.
constexpr int kTileWidth = 64;
constexpr int kTileHeight = 32;
constexpr float kReach2 = kReach_sigmas * kReach_sigmas;

// exp(-q / 2) for q up to the reach, 0 beyond. Rounded to 2^-20, so that it is the same whatever
// the machine's exp() makes of its last bit.
class GaussianTable {
 public:
  GaussianTable() {
    for (size_t i = 0; i < kSize; ++i)
      values_[i] = static_cast<float>(
          std::round(std::exp(-(static_cast<double>(i) + 0.5) / kSteps / 2) * 0x1p20) * 0x1p-20);
  }
  float At(float q) const { return q <= kReach2 ? values_[static_cast<size_t>(q * kSteps)] : 0.0F; }

 private:
  static constexpr int kSteps = 512;  // of one q
  static constexpr size_t kSize = static_cast<size_t>(kReach2) * kSteps + 1;
  std::array<float, kSize> values_;
};

// Which rays reach which tile: [begins[tile], begins[tile + 1]) of `rays`.
struct TileRays {
  std::vector<size_t> begins;
  std::vector<uint32_t> rays;
};

struct TileGridOfFrame {
  int columns;
  int rows;
  double reach_px;

  // Calls visit(tile) for the tiles that a ray reaches.
  template <class Visit>
  void ForEachTile(const FrameRay& ray, const Visit& visit) const {
    const auto tile_of = [](double position, int size, int count) {
      return std::clamp(static_cast<int>(std::floor(position / size)), 0, count - 1);
    };
    const int x0 = tile_of(ray.x_px - reach_px, kTileWidth, columns);
    const int x1 = tile_of(ray.x_px + reach_px, kTileWidth, columns);
    const int y0 = tile_of(ray.y_px - reach_px, kTileHeight, rows);
    const int y1 = tile_of(ray.y_px + reach_px, kTileHeight, rows);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) visit(static_cast<size_t>(y) * columns + x);
  }
};

// In the order of the rays, whatever the threads: counted, then placed.
TileRays SortIntoTiles(std::span<const FrameRay> rays, const TileGridOfFrame& grid,
                       ThreadPool& pool) {
  constexpr size_t kParts = 32;
  const size_t tiles = static_cast<size_t>(grid.columns) * grid.rows;
  std::vector<std::vector<size_t>> places(kParts, std::vector<size_t>(tiles));
  const auto part_begin = [&](size_t part) { return part * rays.size() / kParts; };
  pool.ForEach(kParts, [&](size_t part) {
    for (size_t i = part_begin(part); i < part_begin(part + 1); ++i)
      grid.ForEachTile(rays[i], [&](size_t tile) { ++places[part][tile]; });
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
      grid.ForEachTile(rays[i], [&](size_t tile) {
        sorted.rays[places[part][tile]++] = static_cast<uint32_t>(i);
      });
  });
  return sorted;
}

// Squares over the lens, as large as the reach: what is near a lens point is in nine of them.
class LensGrid {
 public:
  LensGrid(std::span<const FrameRay> rays, const LensPointSets& points, double reach_w) {
    low_ = {1e30, 1e30};
    Vec2 high = {-1e30, -1e30};
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
    (void)rays;
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

// One tile at a time.
class TileSplatter {
 public:
  TileSplatter(const QueryKernel& kernel, const LensPointSets& points, const LensGrid& lens)
      : points_(points),
        lens_(lens),
        reach_w_(kReach_sigmas * kernel.sigma_st_w),
        reach_px_(static_cast<float>(kReach_sigmas * kernel.sigma_uv_px)),
        per_st2_(static_cast<float>(1 / (kernel.sigma_st_w * kernel.sigma_st_w))),
        per_uv2_(static_cast<float>(1 / (kernel.sigma_uv_px * kernel.sigma_uv_px))) {}

  void Run(std::span<const FrameRay> rays, std::span<const uint32_t> of_tile, const PixelRect& rect,
           SplatFrame* frame) {
    SortByLens(rays, of_tile);
    const int k = points_.k;
    for (int phase = 0; phase < k * k; ++phase) {
      // The elements of this set: (x0 + k i, y0 + k j).
      const auto first = [k](int begin, int remainder) {
        return begin + ((remainder - begin) % k + k) % k;
      };
      x0_ = first(rect.x_begin, phase % k);
      y0_ = first(rect.y_begin, phase / k);
      columns_ = (rect.x_end - x0_ + k - 1) / k;
      rows_ = (rect.y_end - y0_ + k - 1) / k;
      if (columns_ <= 0 || rows_ <= 0) continue;
      const size_t count = static_cast<size_t>(columns_) * rows_;
      totals_.assign(count, {});
      for (const Vec2& point : points_.sets[phase]) {
        sums_.assign(count, {});
        AddNear(point);
        for (size_t i = 0; i < count; ++i) {
          if (!(sums_[i][3] > 0)) continue;
          const float per_weight = 1 / sums_[i][3];
          for (int c = 0; c < 3; ++c) totals_[i][c] += sums_[i][c] * per_weight;
          totals_[i][3] += 1;
        }
      }
      Store(points_.sets[phase].size(), frame);
    }
  }

 private:
  using Sum = std::array<float, 4>;  // weighted R, G, B, and the weights

  void SortByLens(std::span<const FrameRay> rays, std::span<const uint32_t> of_tile) {
    begins_.assign(lens_.cells() + 1, 0);
    cell_of_.resize(of_tile.size());
    for (size_t i = 0; i < of_tile.size(); ++i) {
      const FrameRay& ray = rays[of_tile[i]];
      cell_of_[i] =
          static_cast<uint32_t>(lens_.CellAt(lens_.Column(ray.lens_x_w), lens_.Row(ray.lens_y_w)));
      ++begins_[cell_of_[i] + 1];
    }
    for (size_t cell = 0; cell < lens_.cells(); ++cell) begins_[cell + 1] += begins_[cell];
    std::vector<size_t>& next = next_;
    next = begins_;
    sorted_.resize(of_tile.size());
    for (size_t i = 0; i < of_tile.size(); ++i) sorted_[next[cell_of_[i]]++] = rays[of_tile[i]];
  }

  void AddNear(const Vec2& point) {
    const int column0 = lens_.Column(point.x() - reach_w_);
    const int column1 = lens_.Column(point.x() + reach_w_);
    const int row1 = lens_.Row(point.y() + reach_w_);
    const auto x = static_cast<float>(point.x()), y = static_cast<float>(point.y());
    for (int row = lens_.Row(point.y() - reach_w_); row <= row1; ++row) {
      const size_t begin = begins_[lens_.CellAt(column0, row)];
      const size_t end = begins_[lens_.CellAt(column1, row) + 1];
      for (size_t i = begin; i < end; ++i) {
        const FrameRay& ray = sorted_[i];
        const float dx = ray.lens_x_w - x, dy = ray.lens_y_w - y;
        const float q = (dx * dx + dy * dy) * per_st2_;
        if (q <= kReach2) AddRay(ray, q);
      }
    }
  }

  void AddRay(const FrameRay& ray, float q) {
    const auto k = static_cast<float>(points_.k);
    // Of the elements of this set, whose centres are at x0 + 0.5 + k i.
    const float x = ray.x_px - static_cast<float>(x0_) - 0.5F;
    const float y = ray.y_px - static_cast<float>(y0_) - 0.5F;
    const int column0 = std::max(0, static_cast<int>(std::ceil((x - reach_px_) / k)));
    const int column1 = std::min(columns_ - 1, static_cast<int>(std::floor((x + reach_px_) / k)));
    const int row0 = std::max(0, static_cast<int>(std::ceil((y - reach_px_) / k)));
    const int row1 = std::min(rows_ - 1, static_cast<int>(std::floor((y + reach_px_) / k)));
    for (int row = row0; row <= row1; ++row) {
      const float dy = static_cast<float>(row) * k - y;
      const float of_row = q + dy * dy * per_uv2_;
      Sum* const sums = sums_.data() + static_cast<size_t>(row) * columns_;
      for (int column = column0; column <= column1; ++column) {
        const float dx = static_cast<float>(column) * k - x;
        const float weight = gaussian_.At(of_row + dx * dx * per_uv2_);
        Sum& sum = sums[column];
        sum[0] += weight * ray.rgb[0];
        sum[1] += weight * ray.rgb[1];
        sum[2] += weight * ray.rgb[2];
        sum[3] += weight;
      }
    }
  }

  void Store(size_t point_count, SplatFrame* frame) const {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) {
        const Sum& total = totals_[static_cast<size_t>(row) * columns_ + column];
        const int x = x0_ + points_.k * column, y = y0_ + points_.k * row;
        frame->share.at(x, y) = total[3] / static_cast<float>(point_count);
        if (total[3] > 0)
          for (int c = 0; c < 3; ++c) frame->rgb.at(x, y, c) = total[c] / total[3];
      }
  }

  const LensPointSets& points_;
  const LensGrid& lens_;
  const double reach_w_;
  const float reach_px_, per_st2_, per_uv2_;
  const GaussianTable gaussian_;
  int x0_ = 0, y0_ = 0, columns_ = 0, rows_ = 0;
  std::vector<FrameRay> sorted_;  // of the tile, by places on the lens
  std::vector<size_t> begins_, next_;
  std::vector<uint32_t> cell_of_;
  std::vector<Sum> sums_, totals_;
};

SplatFrame EmptyFrame(int width_px, int height_px) {
  return {Image<float>(width_px, height_px, 3), Image<float>(width_px, height_px)};
}

}  // namespace

LensPointSets MakeLensPoints(const Aperture& aperture, int count, int k, uint64_t seed) {
  LF_CHECK(count >= 1 && k >= 1);
  LensPointSets points;
  if (aperture.radius_w == 0) {
    points.sets = {{Vec2::Zero()}};
    return points;
  }
  points.k = k;
  points.sets.resize(static_cast<size_t>(k) * k);
  // Every k * k-th of one sequence: each set is spread, and all together are.
  const std::vector<Vec2> all = SampleLens(aperture, count * k * k, seed);
  for (size_t i = 0; i < all.size(); ++i) points.sets[i % points.sets.size()].push_back(all[i]);
  return points;
}

FrameReach ReachOf(const QueryKernel& kernel) {
  return {kReach_sigmas * kernel.sigma_st_w, kReach_sigmas * kernel.sigma_uv_px};
}

SplatFrame Splat(std::span<const FrameRay> rays, int width_px, int height_px,
                 const LensPointSets& lens_points, const QueryKernel& kernel, ThreadPool& pool) {
  LF_CHECK(kernel.sigma_st_w > 0 && kernel.sigma_uv_px > 0);
  LF_CHECK(rays.size() < UINT32_MAX);
  SplatFrame frame = EmptyFrame(width_px, height_px);
  const TileGridOfFrame grid{(width_px + kTileWidth - 1) / kTileWidth,
                             (height_px + kTileHeight - 1) / kTileHeight,
                             kReach_sigmas * kernel.sigma_uv_px};
  const TileRays by_tile = SortIntoTiles(rays, grid, pool);
  const LensGrid lens(rays, lens_points, kReach_sigmas * kernel.sigma_st_w);
  pool.ForEach(static_cast<size_t>(grid.columns) * grid.rows, [&](size_t tile) {
    const int x = static_cast<int>(tile % grid.columns) * kTileWidth;
    const int y = static_cast<int>(tile / grid.columns) * kTileHeight;
    const PixelRect rect{x, y, std::min(x + kTileWidth, width_px),
                         std::min(y + kTileHeight, height_px)};
    TileSplatter splatter(kernel, lens_points, lens);
    splatter.Run(
        rays,
        std::span(by_tile.rays)
            .subspan(by_tile.begins[tile], by_tile.begins[tile + 1] - by_tile.begins[tile]),
        rect, &frame);
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
