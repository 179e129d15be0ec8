// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "lf/core/median.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/pair_map.h"
#include "lf/densify/plane_set.h"
#include "lf/densify/semi_global.h"

namespace lf {
namespace {

constexpr int kReducedSide = 200;  // least number of pixels along the longer side if reduced
constexpr int kMostReduction = 4;
constexpr int kBlock = 60;        // pixels along the side of a block if all planes are compared
constexpr int kBandedBlock = 14;  // the same if each block compares a band of planes

// Returns the divisor of the reduced image whose depths are found first; 1: there is none.
int ReductionOf(int width, int height) {
  return std::clamp(std::max(width, height) / kReducedSide, 1, kMostReduction);
}

// The planes that are compared in the blocks of an image.
struct BlockPlanes {
  int side;
  int columns, rows;
  std::vector<PlaneSet> sets = {};  // row by row

  BlockPlanes(int width, int height, int block_side)
      : side(block_side),
        columns(CostBlocks::CountAlong(width, block_side)),
        rows(CostBlocks::CountAlong(height, block_side)) {}
  const PlaneSet& At(int column, int row) const {
    return sets[static_cast<size_t>(row) * columns + column];
  }
};

// Sweeps an image, in tiles that overlap.
class Sweep {
 public:
  // All must outlive this object.
  Sweep(const WorkingImage& reference, std::span<const SweepView> views, const InverseDepths& range,
        int planes, const BlockPlanes& blocks, InterruptFlag interrupted)
      : reference_(reference),
        views_(views),
        range_(range),
        planes_(planes),
        blocks_(blocks),
        interrupted_(interrupted),
        plane_(reference.width(), reference.height()) {}

  DepthPlane Run() {
    SweepTile({0, 0, blocks_.columns, blocks_.rows});
    return std::move(plane_);
  }

 private:
  // Returns the pixels of a rectangle of blocks.
  PixelRect PixelsOf(const PixelRect& tile) const {
    return Intersection({tile.x_begin * blocks_.side, tile.y_begin * blocks_.side,
                         tile.x_end * blocks_.side, tile.y_end * blocks_.side},
                        {0, 0, plane_.width(), plane_.height()});
  }

  size_t BytesOf(const PixelRect& tile) const {
    constexpr size_t kOfEntry = sizeof(uint8_t) + sizeof(uint16_t);  // a cost and a sum
    size_t entries = 0;
    for (int row = tile.y_begin; row < tile.y_end; ++row)
      for (int column = tile.x_begin; column < tile.x_end; ++column) {
        const PixelRect pixels = PixelsOf({column, row, column + 1, row + 1});
        entries += static_cast<size_t>(pixels.width()) * pixels.height() *
                   MatchingCosts::StrideOf(blocks_.At(column, row).entries());
      }
    return entries * kOfEntry;
  }

  // Sweeps a rectangle of blocks, in parts if it needs too much memory.
  void SweepTile(const PixelRect& tile) {
    constexpr int kMargin_px = 48;  // around a tile, matched with it
    constexpr int kLeastSide_px = 240;
    constexpr size_t kMostBytes = 180'000'000;
    if (IsSet(interrupted_)) return;
    const int margin = CostBlocks::CountAlong(kMargin_px, blocks_.side);
    const PixelRect around = Intersection(
        {tile.x_begin - margin, tile.y_begin - margin, tile.x_end + margin, tile.y_end + margin},
        {0, 0, blocks_.columns, blocks_.rows});
    const int longer = std::max(tile.width(), tile.height());
    if (BytesOf(around) <= kMostBytes || longer * blocks_.side < kLeastSide_px)
      return Match(tile, around);
    PixelRect first = tile, second = tile;
    if (tile.width() >= tile.height())
      first.x_end = second.x_begin = tile.x_begin + tile.width() / 2;
    else
      first.y_end = second.y_begin = tile.y_begin + tile.height() / 2;
    SweepTile(first);
    SweepTile(second);
  }

  // Matches the blocks `around`, and keeps the depths of `tile`.
  void Match(const PixelRect& tile, const PixelRect& around) {
    CostBlocks costs{PixelsOf(around), blocks_.side, {}};
    for (int row = around.y_begin; row < around.y_end; ++row)
      for (int column = around.x_begin; column < around.x_end; ++column) {
        costs.blocks.push_back({blocks_.At(column, row), {}});
        CostBlocks::Block& block = costs.blocks.back();
        ComputeMatchingCosts(reference_, views_, block.planes.Depths(range_, planes_),
                             PixelsOf({column, row, column + 1, row + 1}), &block.costs,
                             interrupted_);
      }
    const ChosenPlanes chosen = ChoosePlanes(costs, reference_.tones, interrupted_);
    const auto scale = static_cast<float>(InverseDepths::kLast / (planes_ - 1));
    const PixelRect inner = PixelsOf(tile);
    for (int y = inner.y_begin; y < inner.y_end; ++y)
      for (int x = inner.x_begin; x < inner.x_end; ++x) {
        const float place = chosen.place.at(x - costs.rect.x_begin, y - costs.rect.y_begin);
        plane_.at(x, y) = static_cast<uint16_t>(1.5f + place * scale);
      }
  }

  const WorkingImage& reference_;
  const std::span<const SweepView> views_;
  const InverseDepths& range_;
  const int planes_;
  const BlockPlanes& blocks_;
  const InterruptFlag interrupted_;
  DepthPlane plane_;
};

DepthPlane MedianOfNine(const DepthPlane& plane, InterruptFlag interrupted) {
  DepthPlane smooth(plane.width(), plane.height());
  const int last_x = plane.width() - 1, last_y = plane.height() - 1;
  for (int y = 0; y <= last_y && !IsSet(interrupted); ++y)
    for (int x = 0; x <= last_x; ++x) {
      std::array<uint16_t, 9> values;
      size_t count = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          values[count++] = plane.at(std::clamp(x + i, 0, last_x), std::clamp(y + j, 0, last_y));
      std::nth_element(values.begin(), values.begin() + 4, values.end());
      smooth.at(x, y) = values[4];
    }
  return smooth;
}

// Returns the planes around those that were found in and beside each block of a reduced image.
//   reduced         its depths
//   reduced_planes  number of planes that these were found among
//   planes          number of planes of the larger image
BlockPlanes BandsAround(const DepthPlane& reduced, int reduced_planes, int divisor, int width,
                        int height, int planes) {
  constexpr int kBeside = 2;       // pixels of the reduced image around a block
  constexpr double kAround = 1.5;  // planes of the reduced image on each side
  const double around = kAround * (planes - 1) / (reduced_planes - 1);
  BlockPlanes bands(width, height, kBandedBlock);
  std::vector<uint8_t> marks(static_cast<size_t>(planes));
  // Returns the first and the last reduced pixel of a row or column of blocks.
  const auto reach = [&](int block, int size) {
    return std::pair{std::clamp(block * kBandedBlock / divisor - kBeside, 0, size - 1),
                     std::clamp(((block + 1) * kBandedBlock - 1) / divisor + kBeside, 0, size - 1)};
  };
  for (int row = 0; row < bands.rows; ++row)
    for (int column = 0; column < bands.columns; ++column) {
      std::fill(marks.begin(), marks.end(), uint8_t{0});
      const auto [left, right] = reach(column, reduced.width());
      const auto [top, bottom] = reach(row, reduced.height());
      for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
          const double place = (reduced.at(x, y) - 1) * (planes - 1) / InverseDepths::kLast;
          const int first = std::max(0, static_cast<int>(std::floor(place - around)));
          const int last = std::min(planes - 1, static_cast<int>(std::ceil(place + around)));
          std::fill(marks.begin() + first, marks.begin() + last + 1, uint8_t{1});
        }
      bands.sets.push_back(PlaneSet::Marked(marks));
    }
  return bands;
}

// Returns the median shift between an image and others over a range of inverse depths, in pixels.
double ShiftOf(std::span<const SweepView> views, const WorkingImage& reference,
               const InverseDepths& range) {
  std::vector<double> shifts;
  for (const SweepView& view : views)
    shifts.push_back(ShiftPerInverseDepth(reference.camera, view.image->camera));
  return Median(std::move(shifts)) * (range.greatest - range.least);
}

}  // namespace

DepthPlane SweepDepths(const WorkingImage& reference, std::span<const SweepView> views,
                       const InverseDepths& range, int planes, InterruptFlag interrupted) {
  const int width = reference.width(), height = reference.height();
  const int divisor = ReductionOf(width, height);
  const auto sweep = [&](const BlockPlanes& blocks) {
    return MedianOfNine(Sweep(reference, views, range, planes, blocks, interrupted).Run(),
                        interrupted);
  };
  if (divisor == 1) {
    BlockPlanes all(width, height, kBlock);
    all.sets.assign(static_cast<size_t>(all.columns) * all.rows, PlaneSet::All(planes));
    return sweep(all);
  }
  const WorkingImage reduced = ReducedTones(reference, divisor);
  std::vector<WorkingImage> images;
  for (const SweepView& view : views) images.push_back(ReducedTones(*view.image, divisor));
  std::vector<SweepView> reduced_views;
  for (const WorkingImage& image : images) reduced_views.push_back(ViewFrom(reduced, image));
  const int reduced_planes = std::min(planes, PlanesFor(ShiftOf(reduced_views, reduced, range)));
  const DepthPlane found = SweepDepths(reduced, reduced_views, range, reduced_planes, interrupted);
  if (IsSet(interrupted)) return found;
  return sweep(BandsAround(found, reduced_planes, divisor, width, height, planes));
}

double ComparedShare(int width, int height) {
  constexpr double kBands = 0.15;  // measured
  const int divisor = ReductionOf(width, height);
  if (divisor == 1) return 1;
  return kBands + ComparedShare(width / divisor, height / divisor) / (divisor * divisor);
}

}  // namespace lf
