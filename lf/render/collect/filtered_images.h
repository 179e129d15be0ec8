// SPDX-License-Identifier: Apache-2.0
// The LF images of a batch, filtered for the frames that read them. Internal to this folder.
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <vector>

#include "lf/collection/prefilter/prefilter.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/render/collect/collect_batch.h"

namespace lf {

// Filters each LF image once for all frames that need the same prefilter.
class FilteredImages {
 public:
  // Runs body(i) for i in [0, count), by several threads.
  using ForEach = std::function<void(size_t count, const std::function<void(size_t)>& body)>;

  // Forgets all filtered LF images, because another batch follows, but keeps their memory for it.
  void Clear();

  // Filters each LF image of the batch with each of its filters, unless this was done since the
  // last Clear(). Forgets the results of all other filters, so that the memory stays small if every
  // frame needs another filter.
  //   filters      the prefilters of each LF image of the batch; may contain equal ones
  //   keep_pixels  false: if an LF image has only one filter and no result that was kept, the
  //                result replaces its pixels, and BatchImage::filtered_by is set. This touches
  //                less memory than a copy. This LF image can then not be filtered otherwise
  void Filter(std::vector<BatchImage>& batch, std::vector<std::vector<Prefilter>> filters,
              bool keep_pixels, const ForEach& for_each);

  // Returns the pixels, or the opacity, of image `k` of the batch, filtered by `filter`, which must
  // be one of its filters.
  const LfPixels& Pixels(const std::vector<BatchImage>& batch, size_t k,
                         const Prefilter& filter) const;
  const LfPixels& Opacity(const std::vector<BatchImage>& batch, size_t k,
                          const Prefilter& filter) const;

 private:
  struct Filtered {
    Prefilter filter;
    LfPixels pixels;
    LfPixels opacity;
  };
  const Filtered& Of(size_t k, const Prefilter& filter) const;

  std::vector<std::list<Filtered>> filtered_;  // [k]: filtered copies of LF image k of the batch
  std::list<Filtered> spare_;                  // unused entries, whose memory is used again
};

}  // namespace lf
