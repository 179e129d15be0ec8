#include "lf/plate/tile_sums.h"

#include <algorithm>

namespace lf {

void TileSums::Begin(PlateTile* tile) {
  LF_CHECK(ray_limit_ <= tile->max_reserve());
  tile_ = tile;
  const size_t count = static_cast<size_t>(stride()) * tile->rect().height();
  if (elements_.size() < count) elements_.resize(count);
  headroom_ = ray_limit_;
}

void TileSums::MakeRoom(uint32_t rays) {
  LF_CHECK(rays <= ray_limit_);
  Flush();
}

void TileSums::Flush() {
  const uint32_t most_rays = ray_limit_ - headroom_;  // that an element can have got
  if (most_rays == 0) return;
  tile_->Reserve(most_rays);
  const PixelRect& rect = tile_->rect();
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    Element* element = elements_.data() + static_cast<ptrdiff_t>(y - rect.y_begin) * stride();
    uint64_t* word = tile_->row(y) + static_cast<size_t>(rect.x_begin) * SensorPlate::kChannels;
    for (int x = rect.x_begin; x < rect.x_end; ++x, ++element, word += SensorPlate::kChannels) {
      const uint64_t rays = uint64_t{element->rgb_rays[3]} << SensorPlate::kSumBits;
      word[0] += rays | element->rgb_rays[0];
      word[1] += rays | element->rgb_rays[1];
      word[2] += rays | element->rgb_rays[2];
      *element = Element{};
    }
  }
  headroom_ = ray_limit_;
}

}  // namespace lf
