// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/channel_fill.h"

#include <algorithm>
#include <cmath>

#include "lf/film/develop/develop.h"

namespace lf {
namespace {

constexpr uint64_t kMinElements = 4;
constexpr double kOwnDistance = 0.5;

}  // namespace

ChannelFill::ChannelFill(const Image<float>& mean, const Image<uint32_t>& ray_count, int channel,
                         uint32_t rays_needed, int fill_radius_px,
                         const std::function<bool()>& is_interrupted)
    : mean_(mean),
      ray_count_(ray_count),
      width_(mean.width()),
      height_(mean.height()),
      channel_(channel),
      rays_needed_(rays_needed),
      // No two elements of a plate are further apart than width + height.
      fill_radius_px_(std::min(fill_radius_px, width_ + height_)) {
  const size_t size = SumIndex(width_ + 1, height_);
  element_sums_.resize(size);
  if (rays_needed_ > 1) ray_sums_.resize(size);
  for (int y = 0; y < height_; ++y) {
    if (is_interrupted()) return;
    row_begin_.push_back(columns_.size());
    Collected row;
    for (int x = 0; x < width_; ++x) {
      const uint32_t rays = std::min(ray_count.at(x, y, channel), rays_needed);
      row.elements += rays > 0 ? 1 : 0;
      row.rays += rays;
      if (rays > 0) columns_.push_back(x);
      const size_t here = SumIndex(x + 1, y + 1), above = SumIndex(x + 1, y);
      element_sums_[here] = element_sums_[above] + static_cast<uint32_t>(row.elements);
      if (!ray_sums_.empty()) ray_sums_[here] = ray_sums_[above] + row.rays;
    }
  }
  const int64_t most_px =
      rays_needed > 1 ? std::max(fill_radius_px_, kSmoothRadius_px) : fill_radius_px_;
  for (int64_t distance2 = 0; distance2 <= most_px * most_px; ++distance2)
    weights_.push_back(1 / (distance2 == 0 ? kOwnDistance : std::sqrt(distance2)));
}

int ChannelFill::RadiusAt(int x, int y) const {
  return ray_count_.at(x, y, channel_) > 0 ? kSmoothRadius_px : fill_radius_px_;
}

bool ChannelFill::IsEnough(const Collected& collected) const {
  return collected.elements >= kMinElements && collected.rays >= rays_needed_;
}

ChannelFill::Collected ChannelFill::InSquare(int x, int y, int half_side) const {
  const int x_begin = std::max(x - half_side, 0), x_end = std::min(x + half_side + 1, width_);
  const int y_begin = std::max(y - half_side, 0), y_end = std::min(y + half_side + 1, height_);
  const size_t a = SumIndex(x_begin, y_begin), b = SumIndex(x_end, y_begin);
  const size_t c = SumIndex(x_begin, y_end), d = SumIndex(x_end, y_end);
  const uint32_t elements =
      element_sums_[d] - element_sums_[b] - element_sums_[c] + element_sums_[a];
  if (ray_sums_.empty()) return {elements, elements};
  return {elements, ray_sums_[d] - ray_sums_[b] - ray_sums_[c] + ray_sums_[a]};
}

// Returns half the side, in elements, of the smallest square around (x, y) that contains enough
// collected elements (elements with rays) and enough rays, as IsEnough() defines it; `most` + 1 if
// even the square of half side `most` does not. Doubles the half side at first, because for nearly
// all elements a small square is enough.
int ChannelFill::SmallestSquare(int x, int y, int most) const {
  if (!IsEnough(InSquare(x, y, most))) return most + 1;
  int too_small = 0, enough = 1;  // half side 0 is 1 element: never enough
  while (enough < most && !IsEnough(InSquare(x, y, enough))) {
    too_small = enough;
    enough *= 2;
  }
  enough = std::min(enough, most);
  while (enough - too_small > 1) {
    const int middle = (enough + too_small) / 2;
    (IsEnough(InSquare(x, y, middle)) ? enough : too_small) = middle;
  }
  return enough;
}

// Finds the collected elements (elements with rays) whose squared distance from (x, y) is at most
// `radius2`, always in the same order (row by row), because At() adds floating-point numbers in
// this order.
void ChannelFill::FindNeighbours(int x, int y, int64_t radius2, Scratch& scratch) const {
  scratch.neighbours_.clear();
  const int radius = static_cast<int>(std::sqrt(static_cast<double>(radius2)));
  const int x_begin = std::max(x - radius, 0), x_end = std::min(x + radius + 1, width_);
  const int y_begin = std::max(y - radius, 0), y_end = std::min(y + radius + 1, height_);
  // Numbers of collected elements above row v and to the left of x_begin, and to the left of x_end.
  // From row v to row v + 1, each of them grows by the number of such elements in row v.
  uint32_t above_begin = element_sums_[SumIndex(x_begin, y_begin)];
  uint32_t above_end = element_sums_[SumIndex(x_end, y_begin)];
  for (int v = y_begin; v < y_end; ++v) {
    const uint32_t below_begin = element_sums_[SumIndex(x_begin, v + 1)];
    const uint32_t below_end = element_sums_[SumIndex(x_end, v + 1)];
    const int* const row = columns_.data() + row_begin_[v];
    for (const int* u = row + (below_begin - above_begin); u < row + (below_end - above_end); ++u) {
      const int64_t dx = *u - x, dy = v - y, distance2 = dx * dx + dy * dy;
      if (distance2 <= radius2) scratch.neighbours_.push_back({*u, v, distance2});
    }
    above_begin = below_begin;
    above_end = below_end;
  }
}

// Returns the squared radius of the smallest disk around the element to be filled that contains
// enough of its neighbours. If there are too few, the disk contains all of them.
int64_t ChannelFill::SmallestDisk(Scratch& scratch) const {
  const auto further = [](const Scratch::Ring& a, const Scratch::Ring& b) {
    return a.distance2 > b.distance2;
  };
  auto& heap = scratch.nearest_first_;
  heap.clear();
  for (const Neighbour& neighbour : scratch.neighbours_)
    heap.push_back({neighbour.distance2,
                    std::min(ray_count_.at(neighbour.x, neighbour.y, channel_), rays_needed_)});
  std::make_heap(heap.begin(), heap.end(), further);
  Collected inside;
  int64_t radius2 = 0;
  for (; !heap.empty() && !IsEnough(inside); heap.pop_back()) {
    std::pop_heap(heap.begin(), heap.end(), further);
    inside.elements += 1;
    inside.rays += heap.back().rays;
    radius2 = heap.back().distance2;
  }
  return radius2;
}

float ChannelFill::At(int x, int y, Scratch& scratch) const {
  const int most = RadiusAt(x, y);
  const int square = SmallestSquare(x, y, most);
  scratch.neighbours_.clear();
  if (square > most && InSquare(x, y, most).elements == 0) return 0;
  // A square of half side k lies within the disk of radius k sqrt(2). This disk therefore contains
  // enough neighbours if the square does.
  FindNeighbours(x, y, std::min(2 * int64_t{square} * square, int64_t{most} * most), scratch);
  const int64_t radius2 = SmallestDisk(scratch);
  double sum = 0, weights = 0;
  for (const Neighbour& neighbour : scratch.neighbours_) {
    if (neighbour.distance2 > radius2) continue;
    const double weight = weights_[neighbour.distance2];
    sum += weight * mean_.at(neighbour.x, neighbour.y, channel_);
    weights += weight;
  }
  return weights > 0 ? static_cast<float>(sum / weights) : 0;
}

}  // namespace lf
