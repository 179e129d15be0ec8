// SPDX-License-Identifier: Apache-2.0
#include "lf/film/plate/tile_sums.h"

#include <algorithm>

namespace lf {
namespace {

// The processor does not prefetch the next row of a plate by itself, because it is too far away.
void Prefetch(const uint64_t* words) { __builtin_prefetch(words, 1); }

void AddTo(ElementSum* total, const ElementSum& sum) {
  total->sum += sum.sum;
  total->count += sum.count;
}

}  // namespace

void TileSums::Begin(PlateTile* tile, std::span<const PlateElement> watched, const Target& target) {
  LF_CHECK(mosaic_limit_ <= tile->max_reserve());
  LF_CHECK(!has_rgb_ && !has_mosaic_);
  LF_CHECK(target == Target() || watched.empty());
  LF_CHECK(target.first >= 0 && target.count >= 1);
  LF_CHECK(target.first + target.count <= SensorPlate::kChannels);
  LF_CHECK(target.channel >= 0 && target.channel + target.count <= tile->channels());
  tile_ = tile;
  target_ = target;
  watched_ = watched;
  watched_flushed_.assign(watched.size() * SensorPlate::kChannels, {});
}

ElementSum TileSums::Added(size_t index, int channel) const {
  LF_DCHECK(index < watched_.size());
  ElementSum total = watched_flushed_[index * SensorPlate::kChannels + channel];
  AddTo(&total, PendingRgb(watched_[index], channel));
  AddTo(&total, PendingMosaic(watched_[index], channel));
  return total;
}

ElementSum TileSums::PendingRgb(const PlateElement& element, int channel) const {
  if (!has_rgb_) return {};
  const auto row = static_cast<ptrdiff_t>(element.y - rect().y_begin) * stride();
  const Element& sums = elements_[row + element.x - rect().x_begin];
  return {sums.rgb_rays[channel], sums.rgb_rays[3]};
}

// Reads the sums as FlushMosaic() does: each element has one word of red, one of blue and two of
// green.
ElementSum TileSums::PendingMosaic(const PlateElement& element, int channel) const {
  if (!has_mosaic_) return {};
  const int x = element.x - rect().x_begin;
  const auto row = static_cast<ptrdiff_t>(element.y - rect().y_begin) * kMosaicRows;
  const auto word = [&](int kind) { return words_[kMargin + (row + kind) * stride() + x]; };
  const int colour_first = x % 2 == 0 ? kRedFirst : kGreenFirst;
  const int green_first = x % 2 == 0 ? kGreenFirst : kRedFirst;
  uint64_t packed = 0;
  if (channel == 0) packed = word(colour_first);
  if (channel == 1) packed = word(green_first) + word(green_first + kBlueFirst);
  if (channel == 2) packed = word(colour_first + kBlueFirst);
  return {packed & SensorPlate::kSumMask, packed >> SensorPlate::kSumBits};
}

template <class Pending>
void TileSums::KeepWatched(const Pending& pending) {
  for (size_t i = 0; i < watched_.size(); ++i)
    for (int c = 0; c < SensorPlate::kChannels; ++c)
      AddTo(&watched_flushed_[i * SensorPlate::kChannels + c], pending(watched_[i], c));
}

void TileSums::MakeRgbRoom(uint32_t rays) {
  LF_CHECK(rays <= ray_limit_);
  FlushRgb();
  const size_t count = static_cast<size_t>(stride()) * rect().height();
  if (elements_.size() < count) elements_.resize(count);
  rgb_headroom_ = ray_limit_;
  has_rgb_ = true;
}

void TileSums::MakeMosaicRoom(uint32_t rays) {
  LF_CHECK(rays <= mosaic_limit_ && target_ == Target());
  FlushMosaic();
  const size_t count =
      static_cast<size_t>(stride()) * rect().height() * kMosaicRows + size_t{2} * kMargin;
  if (words_.size() < count) words_.resize(count);
  mosaic_headroom_ = mosaic_limit_;
  has_mosaic_ = true;
}

void TileSums::Flush() {
  FlushRgb();
  FlushMosaic();
}

void TileSums::FlushRgb() {
  if (!has_rgb_) return;
  KeepWatched([this](const PlateElement& element, int c) { return PendingRgb(element, c); });
  tile_->Reserve(ray_limit_ - rgb_headroom_);
  if (HasThree())
    FlushRgbBy([channel = target_.channel](const Element& element, uint64_t rays, uint64_t* word) {
      word[channel + 0] += rays | element.rgb_rays[0];
      word[channel + 1] += rays | element.rgb_rays[1];
      word[channel + 2] += rays | element.rgb_rays[2];
    });
  else
    FlushRgbBy([target = target_](const Element& element, uint64_t rays, uint64_t* word) {
      for (int i = 0; i < target.count; ++i)
        word[target.channel + i] += rays | element.rgb_rays[target.first + i];
    });
  has_rgb_ = false;
  rgb_headroom_ = 0;
}

template <class AddTo>
void TileSums::FlushRgbBy(const AddTo& add_to) {
  const int channels = tile_->channels();
  for (int y = rect().y_begin; y < rect().y_end; ++y) {
    Element* element = elements_.data() + static_cast<ptrdiff_t>(y - rect().y_begin) * stride();
    uint64_t* word = tile_->row(y);
    const ptrdiff_t ahead = tile_->row(std::min(y + 1, rect().y_end - 1)) - word;
    for (int x = 0; x < rect().width(); ++x, ++element, word += channels) {
      Prefetch(word + ahead);
      add_to(*element, uint64_t{element->rgb_rays[3]} << SensorPlate::kSumBits, word);
      *element = Element{};
    }
  }
}

void TileSums::FlushMosaic() {
  if (!has_mosaic_) return;
  LF_CHECK(tile_->channels() == SensorPlate::kChannels);  // mosaics have no opacity
  KeepWatched([this](const PlateElement& element, int c) { return PendingMosaic(element, c); });
  tile_->Reserve(mosaic_limit_ - mosaic_headroom_);
  const int width = rect().width();
  for (int y = rect().y_begin; y < rect().y_end; ++y) {
    uint64_t* const rows = words_.data() + kMargin +
                           static_cast<ptrdiff_t>(y - rect().y_begin) * kMosaicRows * stride();
    const auto row = [&](int kind) { return rows + static_cast<ptrdiff_t>(kind) * stride(); };
    const uint64_t *const r_g = row(kRedFirst), *const g_r = row(kGreenFirst);
    const uint64_t *const b_g = row(kBlueFirst), *const g_b = row(kGreenFirst + kBlueFirst);
    uint64_t* word = tile_->row(y);
    const ptrdiff_t ahead = tile_->row(std::min(y + 1, rect().y_end - 1)) - word;
    for (int x = 0; x + 1 < width; x += 2, word += ptrdiff_t{2} * SensorPlate::kChannels) {
      Prefetch(word + ahead);
      word[0] += r_g[x];
      word[1] += g_r[x] + g_b[x];
      word[2] += b_g[x];
      word[3] += g_r[x + 1];
      word[4] += r_g[x + 1] + b_g[x + 1];
      word[5] += g_b[x + 1];
    }
    if (width % 2 != 0) {
      word[0] += r_g[width - 1];
      word[1] += g_r[width - 1] + g_b[width - 1];
      word[2] += b_g[width - 1];
    }
    std::fill_n(rows, static_cast<size_t>(kMosaicRows) * stride(), 0);
  }
  has_mosaic_ = false;
  mosaic_headroom_ = 0;
}

}  // namespace lf
