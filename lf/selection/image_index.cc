#include "lf/selection/image_index.h"

#include <algorithm>
#include <utility>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr uint64_t kShuffleStream = 1;

}  // namespace

std::vector<LfImageId> ImageOrder(size_t image_count, uint64_t seed) {
  std::vector<std::pair<uint64_t, LfImageId>> keyed(image_count);
  for (uint32_t i = 0; i < image_count; ++i)
    keyed[i] = {RandomBits(seed, kShuffleStream, i), LfImageId{i}};
  std::sort(keyed.begin(), keyed.end());
  std::vector<LfImageId> order;
  order.reserve(image_count);
  for (const auto& [key, id] : keyed) order.push_back(id);
  return order;
}

ImageIndex::ImageIndex(const LightField& light_field, uint64_t seed)
    : tree_(light_field),
      order_(ImageOrder(light_field.size(), seed)),
      places_(light_field.size()) {
  for (uint32_t place = 0; place < order_.size(); ++place) places_[order_[place].value] = place;
}

}  // namespace lf
