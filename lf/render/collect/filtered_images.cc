#include "lf/render/collect/filtered_images.h"

#include <algorithm>
#include <utility>

#include "lf/core/check.h"

namespace lf {

void FilteredImages::Clear() {
  for (std::list<Filtered>& of_image : filtered_) spare_.splice(spare_.end(), of_image);
  filtered_.clear();
}

void FilteredImages::Filter(const std::vector<BatchImage>& batch,
                            std::vector<std::vector<Prefilter>> filters, const ForEach& for_each) {
  struct Item {
    const BatchImage* image;
    Filtered* filtered;
  };
  std::vector<Item> items;
  filtered_.resize(batch.size());
  for (size_t k = 0; k < batch.size(); ++k) {
    std::list<Filtered> kept;
    std::sort(filters[k].begin(), filters[k].end());
    filters[k].erase(std::unique(filters[k].begin(), filters[k].end()), filters[k].end());
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
    const BatchImage& image = *items[i].image;
    Filtered& filtered = *items[i].filtered;
    FilterPixels(filtered.filter, image.pixels, &filtered.pixels);
    if (!image.opacity.radiance.empty())
      FilterPixels(filtered.filter, image.opacity, &filtered.opacity);
  });
}

const LfPixels& FilteredImages::Pixels(const std::vector<BatchImage>& batch, size_t k,
                                       const Prefilter& filter) const {
  return filter.changes_nothing() ? batch[k].pixels : Of(k, filter).pixels;
}

const LfPixels& FilteredImages::Opacity(const std::vector<BatchImage>& batch, size_t k,
                                        const Prefilter& filter) const {
  return filter.changes_nothing() ? batch[k].opacity : Of(k, filter).opacity;
}

const FilteredImages::Filtered& FilteredImages::Of(size_t k, const Prefilter& filter) const {
  const auto found = std::find_if(filtered_[k].begin(), filtered_[k].end(),
                                  [&](const Filtered& f) { return f.filter == filter; });
  LF_CHECK(found != filtered_[k].end());
  return *found;
}

}  // namespace lf
