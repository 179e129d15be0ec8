// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/image_order.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/random.h"
#include "lf/core/value_named.h"
#include "lf/selection/group_order.h"
#include "lf/selection/spread_order.h"

namespace lf {
namespace {

constexpr uint64_t kShuffleStream = 1;  // streams of other random numbers: spread_sequence.cc
constexpr const char* kNames[] = {"spread", "shuffle", "round-robin", "area", "groups"};

std::vector<uint32_t> Shuffle(size_t image_count, uint64_t seed) {
  std::vector<std::pair<uint64_t, uint32_t>> keyed(image_count);
  for (uint32_t i = 0; i < image_count; ++i) keyed[i] = {RandomBits(seed, kShuffleStream, i), i};
  std::sort(keyed.begin(), keyed.end());
  std::vector<uint32_t> ids;
  ids.reserve(image_count);
  for (const auto& [key, id] : keyed) ids.push_back(id);
  return ids;
}

ImageRanks RanksOf(const std::vector<uint32_t>& ids) {
  ImageRanks ranks;
  ranks.end = static_cast<uint32_t>(ids.size());
  ranks.of_images.resize(ids.size());
  for (uint32_t rank = 0; rank < ids.size(); ++rank) ranks.of_images[ids[rank]] = rank;
  return ranks;
}

std::vector<uint32_t> ByArea(std::vector<uint32_t> shuffled,
                             std::span<const std::vector<ImageRays>> frames) {
  std::vector<uint64_t> rays(shuffled.size(), 0);
  for (const std::vector<ImageRays>& images : frames)
    for (const ImageRays& image : images) rays[image.id.value] += image.ray_count;
  std::stable_sort(shuffled.begin(), shuffled.end(),
                   [&](uint32_t a, uint32_t b) { return rays[a] > rays[b]; });
  return shuffled;
}

// Finds the frames that take an LF image, and the number of its rays for each of them.
class Takers {
 public:
  Takers(size_t image_count, std::span<const std::vector<ImageRays>> frames)
      : begin_(image_count + 2, 0) {
    for (const std::vector<ImageRays>& images : frames)
      for (const ImageRays& image : images) ++begin_[image.id.value + 2];
    for (size_t i = 2; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    takers_.resize(begin_.back());
    for (uint32_t f = 0; f < frames.size(); ++f)
      for (const ImageRays& image : frames[f])
        takers_[begin_[image.id.value + 1]++] = {f, image.ray_count};
  }
  std::span<const std::pair<uint32_t, uint64_t>> Of(uint32_t id) const {
    return std::span(takers_).subspan(begin_[id], begin_[id + 1] - begin_[id]);
  }

 private:
  std::vector<size_t> begin_;
  std::vector<std::pair<uint32_t, uint64_t>> takers_;  // index of a frame, number of rays
};

std::vector<uint32_t> RoundRobin(const std::vector<uint32_t>& shuffled,
                                 std::span<const std::vector<ImageRays>> frames) {
  const Takers takers(shuffled.size(), frames);
  const ImageRanks ranks = RanksOf(shuffled);
  // [frame]: LF images that the frame takes, the next one last. An LF image that is already in the
  // order is removed once it is last.
  std::vector<std::vector<uint32_t>> waiting(frames.size());
  for (size_t f = 0; f < frames.size(); ++f) {
    for (const ImageRays& image : frames[f]) waiting[f].push_back(image.id.value);
    std::sort(waiting[f].begin(), waiting[f].end(),
              [&](uint32_t a, uint32_t b) { return ranks.of_images[a] > ranks.of_images[b]; });
  }
  std::vector<uint64_t> rays(frames.size(), 0);
  using Turn = std::pair<uint64_t, uint32_t>;  // number of rays of a frame so far, its index
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns;
  for (uint32_t f = 0; f < frames.size(); ++f) turns.emplace(0, f);
  std::vector<bool> is_taken(shuffled.size(), false);
  std::vector<uint32_t> order;
  const auto take = [&](uint32_t id) {
    is_taken[id] = true;
    order.push_back(id);
    for (const auto& [frame, count] : takers.Of(id)) rays[frame] += count;
  };
  while (!turns.empty()) {
    const auto [had, f] = turns.top();
    turns.pop();
    std::vector<uint32_t>& queue = waiting[f];
    while (!queue.empty() && is_taken[queue.back()]) queue.pop_back();
    if (queue.empty()) continue;
    // A frame that has got rays in turns of other frames since it was queued takes no LF image now,
    // and is queued again.
    if (had == rays[f]) take(queue.back());
    turns.emplace(rays[f], f);
  }
  for (const uint32_t id : shuffled)
    if (!is_taken[id]) order.push_back(id);
  return order;
}

}  // namespace

bool DependsOnFrames(ImageOrder order) {
  return order == ImageOrder::kRoundRobin || order == ImageOrder::kArea;
}

bool TakesNeighboursTogether(ImageOrder order) {
  return order == ImageOrder::kArea || order == ImageOrder::kGroups;
}

const char* NameOf(ImageOrder order) { return kNames[static_cast<int>(order)]; }

std::optional<ImageOrder> ImageOrderOf(const std::string& name) {
  return ValueNamed(name, {ImageOrder::kSpread, ImageOrder::kShuffle, ImageOrder::kRoundRobin,
                           ImageOrder::kArea, ImageOrder::kGroups});
}

ImageRanks ShuffledRanks(size_t image_count, uint64_t seed) {
  return RanksOf(Shuffle(image_count, seed));
}

ImageRanks RanksOf(ImageOrder order, const LightField& light_field, uint64_t seed) {
  LF_CHECK(!DependsOnFrames(order));
  if (order == ImageOrder::kShuffle) return ShuffledRanks(light_field.size(), seed);
  if (order == ImageOrder::kGroups) return RanksOf(OrderByGroups(light_field, seed));
  return RanksOf(SpreadOrder(light_field, seed));
}

ImageRanks RanksInOrder(ImageOrder order, size_t image_count, uint64_t seed,
                        std::span<const std::vector<ImageRays>> frames) {
  std::vector<uint32_t> shuffled = Shuffle(image_count, seed);
  LF_CHECK(DependsOnFrames(order));
  if (order == ImageOrder::kArea) return RanksOf(ByArea(std::move(shuffled), frames));
  return RanksOf(RoundRobin(shuffled, frames));
}

}  // namespace lf
