// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/filtered_images.h"

#include <algorithm>
#include <utility>

#include "lf/core/check.h"

namespace lf {
namespace {

// Returns true if the pixels of the image itself are the result of the filter.
bool HasOwn(const BatchImage& image, const Prefilter& filter) {
  return image.filtered_by ? *image.filtered_by == filter : filter.changes_nothing();
}

}  // namespace

void FilteredImages::Clear() {
  for (std::list<Filtered>& of_image : filtered_) spare_.splice(spare_.end(), of_image);
  filtered_.clear();
}

void FilteredImages::Filter(std::vector<BatchImage>& batch,
                            std::vector<std::vector<Prefilter>> filters, bool keep_pixels,
                            const ForEach& for_each) {
  struct Item {
    BatchImage* image;
    Filtered* filtered;  // null: the result replaces the pixels of the image
  };
  std::vector<Item> items;
  filtered_.resize(batch.size());
  for (size_t k = 0; k < batch.size(); ++k) {
    std::sort(filters[k].begin(), filters[k].end());
    filters[k].erase(std::unique(filters[k].begin(), filters[k].end()), filters[k].end());
    if (batch[k].filtered_by) continue;
    if (!keep_pixels && filters[k].size() == 1 && filtered_[k].empty() &&
        !filters[k][0].changes_nothing()) {
      batch[k].filtered_by = filters[k][0];
      items.push_back({&batch[k], nullptr});
      continue;
    }
    std::list<Filtered> kept;
    for (const Prefilter& filter : filters[k]) {
      if (filter.changes_nothing()) continue;
      const auto done = std::find_if(filtered_[k].begin(), filtered_[k].end(),
                                     [&](const Filtered& f) { return f.filter == filter; });
      if (done != filtered_[k].end()) {
        kept.splice(kept.end(), filtered_[k], done);
        continue;
      }
      if (spare_.empty()) spare_.emplace_back();
      kept.splice(kept.end(), spare_, spare_.begin());
      kept.back().filter = filter;
      items.push_back({&batch[k], &kept.back()});
    }
    spare_.splice(spare_.end(), filtered_[k]);
    filtered_[k] = std::move(kept);
  }
  for_each(items.size(), [&](size_t i) {
    BatchImage& image = *items[i].image;
    const bool has_opacity = !image.Opacity().radiance.empty();
    if (items[i].filtered == nullptr) {
      FilterInPlace(*image.filtered_by, &image.pixels);
      if (has_opacity) FilterInPlace(*image.filtered_by, &image.opacity);
      return;
    }
    Filtered& filtered = *items[i].filtered;
    FilterPixels(filtered.filter, image.Pixels(), &filtered.pixels);
    if (has_opacity) FilterPixels(filtered.filter, image.Opacity(), &filtered.opacity);
  });
}

const LfPixels& FilteredImages::Pixels(const std::vector<BatchImage>& batch, size_t k,
                                       const Prefilter& filter) const {
  return HasOwn(batch[k], filter) ? batch[k].Pixels() : Of(k, filter).pixels;
}

const LfPixels& FilteredImages::Opacity(const std::vector<BatchImage>& batch, size_t k,
                                        const Prefilter& filter) const {
  return HasOwn(batch[k], filter) ? batch[k].Opacity() : Of(k, filter).opacity;
}

const FilteredImages::Filtered& FilteredImages::Of(size_t k, const Prefilter& filter) const {
  const auto found = std::find_if(filtered_[k].begin(), filtered_[k].end(),
                                  [&](const Filtered& f) { return f.filter == filter; });
  LF_CHECK(found != filtered_[k].end());
  return *found;
}

}  // namespace lf
