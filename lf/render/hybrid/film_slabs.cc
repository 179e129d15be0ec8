// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/film_slabs.h"

namespace lf {

FilmSlabs::FilmSlabs(std::span<const SampledFrame> frames, uint32_t first_frame,
                     const QueryOptions& options, const SlabChoices& choices)
    : slab_of_(frames.size()), first_frame_(first_frame) {
  std::vector<FrameQueries> queries;
  std::vector<size_t> asking;
  for (size_t f = 0; f < frames.size(); ++f) {
    if (!(frames[f].sampling.lf.camera_distance_w > 0)) continue;
    queries.push_back(QueriesOf(frames[f].camera, frames[f].sampling, options));
    asking.push_back(f);
  }
  sections_ = PlanSlabs(queries, choices);
  for (size_t slab = 0; slab < sections_.size(); ++slab)
    for (size_t i = sections_[slab].begin; i < sections_[slab].end; ++i) slab_of_[asking[i]] = slab;
}

}  // namespace lf
