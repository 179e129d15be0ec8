// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/plane_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "lf/analysis/depth/sweep_sums.h"

namespace lf {
namespace {

constexpr int kSets = 5;
// The quarters (LensView::Quarter()) of each set, as bits: the whole lens, left, right, lower and
// upper half.
constexpr std::array<unsigned, kSets> kQuartersOf = {0b1111, 0b0101, 0b1010, 0b0011, 0b1100};
constexpr float kNoCost = std::numeric_limits<float>::infinity();
// Variance of the roots that 8 bits of a stored value leave, about 65535 / 255 / sqrt(12) in each
// of three colours. Smaller differences between costs mean nothing.
constexpr float kFloor = 3 * 74.0f * 74.0f;
// A half of the lens is believed instead of the whole one if its least cost is at most this share
// of the other's, because costs of halves are smaller everywhere.
constexpr float kHalfBelow = 0.4f;
// An element's own cost should be this much higher one element away from its least cost.
constexpr float kOwnRise = 1.5f;
constexpr float kOwnFloor = kFloor / 4;
// Minima within this number of distances from the best one belong to it.
constexpr int kSameMinimum = 2;

// Makes the sums of all rows of an area. A few rows at once take a view after the other, those of a
// quarter of the lens in a row, so that the sums, and the pixels that two rows share, stay in the
// cache.
void AddViews(const std::vector<ViewOfPlane>& planes, const PixelRect& area,
              std::vector<RowSums>* rows) {
  constexpr size_t kRowsAtOnce = 8;
  for (size_t begin = 0; begin < rows->size(); begin += kRowsAtOnce) {
    const size_t end = std::min(begin + kRowsAtOnce, rows->size());
    for (size_t row = begin; row < end; ++row) (*rows)[row].Clear();
    for (const ViewOfPlane& plane : planes)
      for (size_t row = begin; row < end; ++row)
        AddView(plane, area.x_begin, area.y_begin + static_cast<int>(row), &(*rows)[row]);
  }
}

// Writes the costs of a row: costs[set][element].
void CostsOfRow(const RowSums& sums, const std::array<float*, kSets>& costs) {
  for (size_t i = 0; i < static_cast<size_t>(sums.element_count()); ++i) {
    std::array<uint64_t, kLensQuarters> counts, squares;
    std::array<std::array<uint64_t, 3>, kLensQuarters> roots;
    for (size_t q = 0; q < kLensQuarters; ++q) {
      counts[q] = sums.Count(q, i);
      squares[q] = sums.Squares(q, i);
      for (size_t c = 0; c < 3; ++c) roots[q][c] = sums.Root(q, i, c);
    }
    for (size_t set = 0; set < kSets; ++set) {
      uint64_t count = 0, square = 0;
      std::array<uint64_t, 3> root = {};
      for (size_t q = 0; q < kLensQuarters; ++q) {
        if ((kQuartersOf[set] >> q & 1) == 0) continue;
        count += counts[q];
        square += squares[q];
        for (size_t c = 0; c < 3; ++c) root[c] += roots[q][c];
      }
      uint64_t spread = count * square;
      for (const uint64_t of_colour : root) spread -= of_colour * of_colour;
      costs[set][i] =
          count < kLeastViews
              ? kNoCost
              : static_cast<float>(static_cast<double>(spread) /
                                   (static_cast<double>(count) * static_cast<double>(count - 1)));
    }
  }
}

// The mean roots of each set of views at its least cost so far.
class LeastColours {
 public:
  explicit LeastColours(const PixelRect& tile)
      : area_(static_cast<size_t>(tile.pixel_count())),
        least_(kSets * area_, kNoCost),
        roots_(kSets * area_) {}

  // Adds the sums of a distance.
  //   costs  means over windows of the set, of each element of the tile
  //   rows   sums of the rows of the tile and `radius` elements around it
  void Add(size_t set, const float* costs, const std::vector<RowSums>& rows, const PixelRect& tile,
           int radius) {
    for (size_t i = 0; i < area_; ++i) {
      if (!(costs[i] < least_[set * area_ + i])) continue;
      least_[set * area_ + i] = costs[i];
      const int x = static_cast<int>(i) % tile.width(), y = static_cast<int>(i) / tile.width();
      roots_[set * area_ + i] = MeanOf(rows[static_cast<size_t>(y + radius)],
                                       static_cast<size_t>(x + radius), kQuartersOf[set]);
    }
  }
  const std::array<uint16_t, 3>& At(size_t set, size_t element) const {
    return roots_[set * area_ + element];
  }

 private:
  static std::array<uint16_t, 3> MeanOf(const RowSums& row, size_t element, unsigned quarters) {
    uint32_t count = 0;
    std::array<uint64_t, 3> sums = {};
    for (size_t q = 0; q < kLensQuarters; ++q) {
      if ((quarters >> q & 1) == 0) continue;
      count += row.Count(q, element);
      for (size_t c = 0; c < 3; ++c) sums[c] += row.Root(q, element, c);
    }
    std::array<uint16_t, 3> mean = {};
    for (size_t c = 0; c < 3; ++c) mean[c] = static_cast<uint16_t>(sums[c] / count);
    return mean;
  }

  size_t area_;
  std::vector<float> least_;                    // [set][element]
  std::vector<std::array<uint16_t, 3>> roots_;  // [set][element]
};

// The costs of a tile: [set][distance][element].
class CostVolume {
 public:
  CostVolume(size_t distance_count, const PixelRect& tile)
      : distance_count_(distance_count),
        stride_(static_cast<size_t>(tile.pixel_count()) + kGap),
        costs_(kSets * distance_count * stride_) {}

  float* Layer(size_t set, size_t distance) {
    return &costs_[(set * distance_count_ + distance) * stride_];
  }
  float At(size_t set, size_t distance, size_t element) const {
    return costs_[(set * distance_count_ + distance) * stride_ + element];
  }
  size_t distance_count() const { return distance_count_; }

 private:
  // Unused numbers between two distances: the costs of an element at all distances would share few
  // lines of the cache if they were a power of two apart.
  static constexpr size_t kGap = 16;

  size_t distance_count_;
  size_t stride_;
  std::vector<float> costs_;
};

// Writes the means of costs over windows. Elements without a cost are left out of the means. Sums
// are always added in the same order, first along rows, so that tiles do not change them.
//   costs  of the tile and `radius` elements around it
void MeanOverWindows(const std::vector<float>& costs, const PixelRect& tile, int radius,
                     float* means) {
  const int stride = tile.width() + 2 * radius, rows = tile.height() + 2 * radius;
  const int side = 2 * radius + 1, width = tile.width();
  thread_local std::vector<float> sums;  // over `side` elements of a row, [rows][tile.width()]
  thread_local std::vector<int32_t> counts;
  // The loops run over elements inside, so that the compiler can add several at once.
  sums.assign(static_cast<size_t>(rows * width), 0);
  counts.assign(static_cast<size_t>(rows * width), 0);
  for (int y = 0; y < rows; ++y) {
    float* const sum = &sums[static_cast<size_t>(y * width)];
    int32_t* const count = &counts[static_cast<size_t>(y * width)];
    for (int i = 0; i < side; ++i) {
      const float* const row = &costs[static_cast<size_t>(y * stride + i)];
      for (int x = 0; x < width; ++x) {
        const bool has_cost = row[x] != kNoCost;
        sum[x] += has_cost ? row[x] : 0;
        count[x] += has_cost ? 1 : 0;
      }
    }
  }
  thread_local std::vector<float> window_sums;  // of a row
  thread_local std::vector<int32_t> window_counts;
  for (int y = 0; y < tile.height(); ++y, means += width) {
    window_sums.assign(static_cast<size_t>(width), 0);
    window_counts.assign(static_cast<size_t>(width), 0);
    float* const window_sum = window_sums.data();
    int32_t* const window_count = window_counts.data();
    for (int j = 0; j < side; ++j) {
      const float* const sum = &sums[static_cast<size_t>((y + j) * width)];
      const int32_t* const count = &counts[static_cast<size_t>((y + j) * width)];
      for (int x = 0; x < width; ++x) {
        window_sum[x] += sum[x];
        window_count[x] += count[x];
      }
    }
    const float* const own = &costs[static_cast<size_t>((y + radius) * stride + radius)];
    for (int x = 0; x < width; ++x)
      means[x] = own[x] != kNoCost ? window_sum[x] / static_cast<float>(window_count[x]) : kNoCost;
  }
}

// Copies the tile's costs without their border.
void CopyInner(const std::vector<float>& costs, const PixelRect& tile, int radius, float* inner) {
  const int stride = tile.width() + 2 * radius;
  for (int y = 0; y < tile.height(); ++y)
    inner = std::copy_n(costs.begin() + (y + radius) * stride + radius, tile.width(), inner);
}

// The least cost of one set at one element, and how it stands out.
struct Minimum {
  size_t index = 0;
  float least = kNoCost;
  float rival = kNoCost;  // least cost of a local minimum elsewhere
  float mean = 0;         // over all distances with a cost
};

Minimum MinimumOf(const CostVolume& costs, size_t set, size_t element) {
  Minimum minimum;
  const size_t count = costs.distance_count();
  double sum = 0;
  size_t valid = 0;
  for (size_t d = 0; d < count; ++d) {
    const float cost = costs.At(set, d, element);
    if (cost == kNoCost) continue;
    sum += cost;
    ++valid;
    if (cost < minimum.least) {
      minimum.least = cost;
      minimum.index = d;
    }
  }
  if (valid == 0) return minimum;
  minimum.mean = static_cast<float>(sum / static_cast<double>(valid));
  for (size_t d = 0; d < count; ++d) {
    if (d + kSameMinimum >= minimum.index && d <= minimum.index + kSameMinimum) continue;
    const float cost = costs.At(set, d, element);
    const float before = d > 0 ? costs.At(set, d - 1, element) : kNoCost;
    const float after = d + 1 < count ? costs.At(set, d + 1, element) : kNoCost;
    if (cost <= before && cost <= after) minimum.rival = std::min(minimum.rival, cost);
  }
  return minimum;
}

// Returns the index, with a fraction, of the lowest point of the parabola through the least cost
// and the costs beside it.
float Vertex(const CostVolume& costs, size_t set, size_t element, size_t index) {
  const float before = costs.At(set, index - 1, element);
  const float least = costs.At(set, index, element);
  const float after = costs.At(set, index + 1, element);
  const float bend = before - 2 * least + after;
  const auto whole = static_cast<float>(index);
  if (!(bend > 0) || before == kNoCost || after == kNoCost) return whole;
  return whole + std::clamp(0.5f * (before - after) / bend, -0.5f, 0.5f);
}

// Returns true if an element's own cost rises on both sides of a distance.
bool Rises(const CostVolume& own, size_t set, size_t element, size_t index, size_t step) {
  const float limit = kOwnRise * own.At(set, index, element) + kOwnFloor;
  const size_t before = index - std::min(index, step);
  const size_t after = std::min(index + step, own.distance_count() - 1);
  return own.At(set, before, element) > limit && own.At(set, after, element) > limit;
}

SweptDepth DepthOf(const CostVolume& costs, const CostVolume& own, const LeastColours& colours,
                   size_t element_step, size_t element) {
  size_t set = 0;
  Minimum best = MinimumOf(costs, 0, element);
  // Only relative to the cost of the whole lens is a half better.
  float limit = kHalfBelow * (best.least + kFloor);
  for (size_t half = 1; half < kSets; ++half) {
    const Minimum minimum = MinimumOf(costs, half, element);
    if (!(minimum.least + kFloor < limit)) continue;
    limit = minimum.least + kFloor;
    best = minimum;
    set = half;
  }
  if (best.least == kNoCost) return {};
  SweptDepth depth;
  depth.index = static_cast<float>(best.index);
  depth.roots = colours.At(set, element);
  if (best.index == 0 || best.index + 1 == costs.distance_count()) return depth;
  depth.index = Vertex(costs, set, element, best.index);
  const float least = best.least + kFloor;
  // A local minimum elsewhere that is nearly as low may be the right one.
  const float rival = best.rival == kNoCost ? best.mean + kFloor : best.rival + kFloor;
  depth.confidence = std::clamp(1 - least / std::min(best.mean + kFloor, rival), 0.0f, 1.0f);
  if (!Rises(own, set, element, best.index, element_step)) depth.confidence *= kDoubtful;
  return depth;
}

}  // namespace

void SweepTile(std::span<const LensView> views, const RenderCamera& frame,
               const SweepOptions& options, const PixelRect& tile,
               std::vector<SweptDepth>* depths) {
  const int radius = options.window_radius;
  const PixelRect area = {tile.x_begin - radius, tile.y_begin - radius, tile.x_end + radius,
                          tile.y_end + radius};
  CostVolume costs(options.distances_w.size(), tile);  // means over windows
  CostVolume own(options.distances_w.size(), tile);    // of single elements
  LeastColours colours(tile);
  std::vector<RowSums> rows(static_cast<size_t>(area.height()), RowSums(area.width()));
  std::array<std::vector<float>, kSets> of_distance;
  for (auto& of_set : of_distance) of_set.resize(static_cast<size_t>(area.pixel_count()));
  std::vector<ViewOfPlane> planes;
  for (size_t d = 0; d < options.distances_w.size(); ++d) {
    planes.clear();
    for (const LensView& view : views)
      if (view.of.is_swept) planes.emplace_back(view, frame, options.distances_w[d]);
    std::stable_sort(planes.begin(), planes.end(), [](const ViewOfPlane& a, const ViewOfPlane& b) {
      return a.view->Quarter() < b.view->Quarter();
    });
    AddViews(planes, area, &rows);
    for (size_t row = 0; row < rows.size(); ++row) {
      std::array<float*, kSets> of_row = {};
      for (size_t set = 0; set < kSets; ++set)
        of_row[set] = &of_distance[set][row * static_cast<size_t>(area.width())];
      CostsOfRow(rows[row], of_row);
    }
    for (size_t set = 0; set < kSets; ++set) {
      MeanOverWindows(of_distance[set], tile, radius, costs.Layer(set, d));
      colours.Add(set, costs.Layer(set, d), rows, tile, radius);
      CopyInner(of_distance[set], tile, radius, own.Layer(set, d));
    }
  }
  depths->clear();
  for (size_t i = 0; i < static_cast<size_t>(tile.pixel_count()); ++i)
    depths->push_back(DepthOf(costs, own, colours, options.element_step, i));
}

}  // namespace lf
