// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/spread_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

#include "lf/core/geometry.h"
#include "lf/core/hash.h"
#include "lf/selection/spread_sequence.h"

namespace lf {
namespace {

// Assigns points of the sequence to points of the surface.
class Assignment {
 public:
  Assignment(std::span<const SurfacePoint> places, const std::vector<SpreadPoint>& sequence)
      : order_(places.size()) {
    for (uint32_t i = 0; i < places.size(); ++i) {
      items_.push_back({{places[i].x, places[i].y}, i});
      targets_.push_back({{sequence[i].x, sequence[i].y}, i});
    }
    others_.reserve(places.size());
  }
  std::vector<uint32_t> Order() && {
    if (!order_.empty()) Assign(0, order_.size(), Box());
    return std::move(order_);
  }

 private:
  struct Item {
    std::array<int32_t, 2> at;
    uint32_t index;
  };
  struct Less {
    explicit Less(int axis) : along(static_cast<size_t>(axis)) {}
    bool operator()(const Item& a, const Item& b) const {
      return std::tuple(a.at[along], a.at[1 - along], a.index) <
             std::tuple(b.at[along], b.at[1 - along], b.index);
    }
    size_t along;
  };
  struct Target {
    std::array<uint32_t, 2> at;
    uint32_t rank;
  };
  // A rectangle of the unit square, [begin, end) across and down, in units of 2^-32.
  struct Box {
    std::array<uint64_t, 2> begin = {0, 0};
    std::array<uint64_t, 2> end = {uint64_t{1} << 32, uint64_t{1} << 32};
  };
  struct Cut {
    int axis;
    size_t count;  // number of items before the cut
  };

  // Gives each of the targets [begin, end), by ascending ranks, one of the items [begin, end).
  //   box  the rectangle of these items
  void Assign(size_t begin, size_t end, const Box& box) {
    if (end - begin == 1) {
      order_[targets_[begin].rank] = items_[begin].index;
      return;
    }
    const Cut cut = Divide(begin, end);
    const auto axis = static_cast<size_t>(cut.axis);
    const uint64_t at =
        box.begin[axis] + (box.end[axis] - box.begin[axis]) * cut.count / (end - begin);
    DivideTargets(begin, end, cut, at);
    Box before = box, behind = box;
    before.end[axis] = behind.begin[axis] = at;
    Assign(begin, begin + cut.count, before);
    Assign(begin + cut.count, end, behind);
  }

  // Divides items such that those before the cut come first. Both parts have at least a third of
  // the items, so that a grid of three columns can be cut between two of them.
  Cut Divide(size_t begin, size_t end) {
    std::array<int32_t, 2> least = items_[begin].at, most = least;
    for (size_t i = begin; i < end; ++i)
      for (size_t k = 0; k < 2; ++k) {
        least[k] = std::min(least[k], items_[i].at[k]);
        most[k] = std::max(most[k], items_[i].at[k]);
      }
    const int longer = most[1] - least[1] > most[0] - least[0] ? 1 : 0;
    for (const int axis : {longer, 1 - longer})
      if (const size_t count = CutAcross(begin, end, axis); count > 0) return {axis, count};
    // Most items are at one position.
    const size_t half = (end - begin) / 2;
    Isolate(begin, end, half, longer);
    return {longer, half};
  }

  // Finds the widest gaps between successive items of the middle third, and cuts in the one nearest
  // to the middle of those at least half as wide. Returns the number of items before it; 0: there
  // is no gap.
  size_t CutAcross(size_t begin, size_t end, int axis) {
    const size_t count = end - begin, first = (count + 2) / 3, last = count - first;
    const auto along = static_cast<size_t>(axis);
    Isolate(begin, end, first - 1, axis);
    Isolate(begin + first - 1, end, last - first + 1, axis);
    std::sort(At(begin + first - 1), At(begin + last + 1), Less(axis));
    const auto gap_before = [&](size_t i) {
      return items_[begin + i].at[along] - items_[begin + i - 1].at[along];
    };
    int32_t widest = 0;
    for (size_t i = first; i <= last; ++i) widest = std::max(widest, gap_before(i));
    if (widest == 0) return 0;
    const auto from_middle = [&](size_t i) {
      return 2 * i > count ? 2 * i - count : count - 2 * i;
    };
    size_t best = 0;
    for (size_t i = first; i <= last; ++i)
      if (int64_t{2} * gap_before(i) >= widest && (best == 0 || from_middle(i) < from_middle(best)))
        best = i;
    return best;
  }

  // Puts the `count` smallest items first, and the next one behind them.
  void Isolate(size_t begin, size_t end, size_t count, int axis) {
    std::nth_element(At(begin), At(begin + count), At(end), Less(axis));
  }
  std::vector<Item>::iterator At(size_t i) { return items_.begin() + static_cast<ptrdiff_t>(i); }

  // Divides targets by the cut, each part by ascending ranks. A target for which its own part has
  // no item left goes to the other part.
  void DivideTargets(size_t begin, size_t end, const Cut& cut, uint64_t at) {
    const auto axis = static_cast<size_t>(cut.axis);
    others_.clear();
    size_t first_free = begin;
    for (size_t i = begin; i < end; ++i) {
      const Target target = targets_[i];
      const bool has_room_before = first_free - begin < cut.count;
      const bool has_room_behind = others_.size() < end - begin - cut.count;
      if (has_room_before && (target.at[axis] < at || !has_room_behind))
        targets_[first_free++] = target;
      else
        others_.push_back(target);
    }
    std::copy(others_.begin(), others_.end(),
              targets_.begin() + static_cast<ptrdiff_t>(begin + cut.count));
  }

  std::vector<uint32_t> order_;  // [rank] index of a point
  std::vector<Item> items_;
  std::vector<Target> targets_;
  std::vector<Target> others_;  // targets behind a cut
};

// Returns a hash of the pose, and of whether the LF image is virtual.
uint64_t HashOfPose(const LfCamera& camera) {
  const RigidTransform& pose = camera.cam_from_world;
  const auto bytes_of = [](const auto& matrix) {
    return std::string_view(reinterpret_cast<const char*>(matrix.data()),
                            sizeof(double) * static_cast<size_t>(matrix.size()));
  };
  return HashBytes(bytes_of(pose.translation),
                   HashBytes(bytes_of(pose.rotation), camera.is_virtual ? 1 : 0));
}

// Returns, for each LF image, the first one of exactly its pose. Brackets are not told by
// LfCamera::brighter, because a packed store does not know them, and must have the same order.
std::vector<uint32_t> FirstOfEqualPose(const LightField& light_field) {
  std::vector<std::pair<uint64_t, uint32_t>> hashes(light_field.size());
  for (uint32_t i = 0; i < hashes.size(); ++i) hashes[i] = {HashOfPose(light_field.cameras[i]), i};
  std::sort(hashes.begin(), hashes.end());
  std::vector<uint32_t> firsts(hashes.size());
  for (size_t k = 0; k < hashes.size(); ++k) {
    const bool is_again = k > 0 && hashes[k].first == hashes[k - 1].first;
    firsts[hashes[k].second] = is_again ? firsts[hashes[k - 1].second] : hashes[k].second;
  }
  return firsts;
}

// Returns the LF images `ids` in the order of their positions.
std::vector<uint32_t> Ordered(const LightField& light_field, const std::vector<uint32_t>& ids,
                              uint64_t seed, uint64_t stream) {
  std::vector<Vec3> positions;
  positions.reserve(ids.size());
  for (const uint32_t id : ids)
    positions.push_back(light_field.cameras[id].cam_from_world.Inverse().translation);
  std::vector<uint32_t> order = OrderOfPoints(SurfaceOf(positions), seed, stream);
  for (uint32_t& index : order) index = ids[index];
  return order;
}

// Merges two lists such that every beginning has about the same share of both.
std::vector<uint32_t> Merged(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  std::vector<uint32_t> merged;
  merged.reserve(a.size() + b.size());
  size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool is_a =
        j == b.size() || (i < a.size() && (2 * i + 1) * b.size() <= (2 * j + 1) * a.size());
    merged.push_back(is_a ? a[i++] : b[j++]);
  }
  return merged;
}

}  // namespace

std::vector<uint32_t> OrderOfPoints(std::span<const SurfacePoint> points, uint64_t seed,
                                    uint64_t stream) {
  return Assignment(points, SpreadSequence(points.size(), seed, stream)).Order();
}

std::vector<uint32_t> SpreadOrder(const LightField& light_field, uint64_t seed) {
  const std::vector<uint32_t> firsts = FirstOfEqualPose(light_field);
  std::vector<uint32_t> recorded, of_virtual;
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (firsts[i] == i) (light_field.cameras[i].is_virtual ? of_virtual : recorded).push_back(i);
  const std::vector<uint32_t> order =
      Merged(Ordered(light_field, recorded, seed, 0), Ordered(light_field, of_virtual, seed, 1));
  if (order.size() == light_field.size()) return order;
  std::vector<uint32_t> ranks(light_field.size()), ids(light_field.size());
  for (uint32_t rank = 0; rank < order.size(); ++rank) ranks[order[rank]] = rank;
  std::iota(ids.begin(), ids.end(), 0U);
  std::sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) {
    return std::pair(ranks[firsts[a]], a) < std::pair(ranks[firsts[b]], b);
  });
  return ids;
}

}  // namespace lf
