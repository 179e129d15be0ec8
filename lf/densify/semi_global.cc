// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/semi_global.h"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "lf/core/large_vector.h"
#include "lf/densify/path_costs.h"

namespace lf {
namespace {

constexpr int kPaths = 8;
// Larger than any path cost: these are at most kCarved + kLargeStep.
constexpr uint16_t kNoPath = 30000;

int Difference(const uint16_t* a, const uint16_t* b) {
  // An object may be as dark as the transparent pixels around it.
  const int of_opacity = a[3] == 0 || b[3] == 0 ? 0 : std::abs(a[3] - b[3]);
  return (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2])) / 3 + of_opacity;
}

// Returns the cost of a large step between two pixels with these tones.
uint16_t LargeStep(const uint16_t* a, const uint16_t* b) {
  return static_cast<uint16_t>(std::max(kSmallStep + 1, kLargeStep / (1 + Difference(a, b) / 6)));
}

// Path costs of a row of pixels, for one direction of paths.
class PathRow {
 public:
  PathRow(int width, int stride)
      : stride_(static_cast<size_t>(stride) + 2 * kGuard),
        values_(static_cast<size_t>(width) * stride_, kNoPath),
        least_(static_cast<size_t>(width)) {}
  uint16_t* At(int x) { return values_.data() + static_cast<size_t>(x) * stride_ + kGuard; }
  uint16_t& LeastAt(int x) { return least_[static_cast<size_t>(x)]; }

  static constexpr size_t kGuard = 1;

 private:
  size_t stride_;
  LargeVector<uint16_t> values_;
  std::vector<uint16_t> least_;
};

// A block of the costs, with the sums of its paths.
struct Block {
  const MatchingCosts* costs = nullptr;
  const PlaneSet* planes = nullptr;
  LargeVector<uint16_t> sums = {};  // [height][width][stride]
};

class Matcher {
 public:
  // The blocks cover the rectangle row by row.
  Matcher(const PixelRect& rect, int side, std::vector<Block> blocks, const Image<uint16_t>& tones)
      : rect_(rect),
        side_(side),
        columns_(CostBlocks::CountAlong(rect.width(), side)),
        blocks_(std::move(blocks)),
        tones_(tones) {
    for (Block& block : blocks_) {
      block.sums.resize(block.costs->costs.size());
      stride_ = std::max(stride_, block.costs->stride);
    }
    moved_.resize(static_cast<size_t>(stride_) + 2 * PathRow::kGuard);
  }

  // A pixel of the rectangle: its costs and the sums of its paths, with an entry for each plane of
  // its block.
  struct Pixel {
    const Block* block = nullptr;
    const uint8_t* costs = nullptr;
    uint16_t* sums = nullptr;
  };
  Pixel At(int x, int y) {
    Block& block = blocks_[IndexAt(x, y)];
    const uint8_t* costs = block.costs->At(x % side_, y % side_);
    return {&block, costs, block.sums.data() + (costs - block.costs->costs.data())};
  }

  // Adds the costs of paths that come from above (step 1) or from below (step -1), and of those
  // along the row in the same sense.
  void Sweep(int step, InterruptFlag interrupted) {
    const int width = rect_.width(), height = rect_.height();
    std::vector<PathRow> last(4, PathRow(width, stride_)), next = last;
    for (int i = 0, y = step > 0 ? 0 : height - 1; i < height && !IsSet(interrupted);
         ++i, y += step) {
      for (int k = 0, x = step > 0 ? 0 : width - 1; k < width; ++k, x += step) {
        const Pixel pixel = At(x, y);
        Extend(pixel, x, y, step, 0, &next[0], &next[0]);
        Extend(pixel, x, y, 0, step, &last[1], &next[1]);
        Extend(pixel, x, y, step, step, &last[2], &next[2]);
        Extend(pixel, x, y, -step, step, &last[3], &next[3]);
      }
      std::swap(last, next);
    }
  }

 private:
  size_t IndexAt(int x, int y) const {
    return static_cast<size_t>(y / side_ * columns_ + x / side_);
  }
  const uint16_t* TonesAt(int x, int y) const {
    return &tones_.at(x + rect_.x_begin, y + rect_.y_begin);
  }
  // Extends the path that comes from pixel (x - dx, y - dy). A path begins at the border of the
  // rectangle.
  void Extend(const Pixel& pixel, int x, int y, int dx, int dy, PathRow* from, PathRow* to) {
    const int from_x = x - dx, from_y = y - dy, stride = pixel.block->costs->stride;
    uint16_t* next = to->At(x);
    next[stride] = kNoPath;  // the memory behind may be left from a block with more planes
    if (from_x < 0 || from_x >= rect_.width() || from_y < 0 || from_y >= rect_.height()) {
      uint16_t least = kNoPath;
      for (int j = 0; j < stride; ++j) {
        next[j] = pixel.costs[j];
        pixel.sums[j] = static_cast<uint16_t>(pixel.sums[j] + pixel.costs[j]);
        least = std::min<uint16_t>(least, pixel.costs[j]);
      }
      to->LeastAt(x) = least;
      return;
    }
    const Block& source = blocks_[IndexAt(from_x, from_y)];
    const uint16_t* last = from->At(from_x);
    if (&source != pixel.block && !(*source.planes == *pixel.block->planes))
      last = Moved(last, *source.planes, *pixel.block->planes);
    to->LeastAt(x) =
        ExtendPath(pixel.costs, last, from->LeastAt(from_x), kSmallStep,
                   LargeStep(TonesAt(x, y), TonesAt(from_x, from_y)), stride, next, pixel.sums);
  }

  // Returns the path costs of a pixel of one block as entries of another block.
  const uint16_t* Moved(const uint16_t* costs, const PlaneSet& from, const PlaneSet& to) {
    std::fill(moved_.begin(), moved_.end(), kNoPath);
    uint16_t* moved = moved_.data() + PathRow::kGuard;
    auto source = from.runs().begin();
    for (const PlaneSet::Run& run : to.runs())
      for (; source != from.runs().end() && source->first < run.End(); ++source) {
        const int first = std::max(run.first, source->first);
        const int end = std::min(run.End(), source->End());
        if (first < end)
          std::copy_n(costs + source->EntryOf(first), end - first, moved + run.EntryOf(first));
        if (source->End() > run.End()) break;  // the next run may have planes of it
      }
    return moved;
  }

  const PixelRect rect_;
  const int side_, columns_;
  std::vector<Block> blocks_;
  const Image<uint16_t>& tones_;
  int stride_ = 0;  // the largest of all blocks
  std::vector<uint16_t> moved_;
};

// Returns the place of the least sum, by a parabola through it and the sums beside it.
//   run  that the entry belongs to
float PlaceOf(const uint16_t* sums, int best, const PlaneSet::Run& run) {
  const auto plane = static_cast<float>(run.first + (best - run.entry));
  if (best <= run.entry || best + 1 >= run.entry + run.count) return plane;
  const int before = sums[best - 1], here = sums[best], behind = sums[best + 1];
  const int curvature = before - 2 * here + behind;
  if (curvature <= 0) return plane;
  return plane + 0.5f * static_cast<float>(before - behind) / static_cast<float>(curvature);
}

uint16_t LeadOf(const uint16_t* sums, int best, int planes) {
  constexpr int kBeside = 2;
  int other = 65535;
  for (int j = 0; j < planes; ++j)
    if (std::abs(j - best) > kBeside) other = std::min<int>(other, sums[j]);
  return static_cast<uint16_t>(std::max(0, other - sums[best]) / kPaths);
}

ChosenPlanes Choose(Matcher&& matcher, int width, int height, bool with_lead,
                    InterruptFlag interrupted) {
  matcher.Sweep(1, interrupted);
  matcher.Sweep(-1, interrupted);
  ChosenPlanes chosen{Image<float>(width, height), Image<uint8_t>(width, height),
                      with_lead ? Image<uint16_t>(width, height) : Image<uint16_t>()};
  for (int y = 0; y < height && !IsSet(interrupted); ++y)
    for (int x = 0; x < width; ++x) {
      const auto [block, costs, sums] = matcher.At(x, y);
      const int entries = block->costs->planes;
      const int best = static_cast<int>(std::min_element(sums, sums + entries) - sums);
      chosen.place.at(x, y) = PlaceOf(sums, best, block->planes->RunAt(best));
      chosen.cost.at(x, y) = costs[best];
      if (with_lead) chosen.lead.at(x, y) = LeadOf(sums, best, entries);
    }
  return chosen;
}

}  // namespace

ChosenPlanes ChoosePlanes(const MatchingCosts& costs, const Image<uint16_t>& tones, bool with_lead,
                          InterruptFlag interrupted) {
  const PlaneSet planes = PlaneSet::All(costs.planes);
  const int width = costs.rect.width(), height = costs.rect.height();
  return Choose(Matcher(costs.rect, std::max(width, height), {{&costs, &planes}}, tones), width,
                height, with_lead, interrupted);
}

ChosenPlanes ChoosePlanes(const CostBlocks& blocks, const Image<uint16_t>& tones,
                          InterruptFlag interrupted) {
  std::vector<Block> all;
  for (const CostBlocks::Block& block : blocks.blocks) all.push_back({&block.costs, &block.planes});
  return Choose(Matcher(blocks.rect, blocks.side, std::move(all), tones), blocks.rect.width(),
                blocks.rect.height(), false, interrupted);
}

}  // namespace lf
