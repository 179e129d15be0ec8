#include "lf/render/hybrid/film_slabs.h"

#include "lf/core/check.h"

namespace lf {

FilmSlabs::FilmSlabs(std::span<const RenderCamera> frames, std::span<const FrameSampling> sampling,
                     const QueryOptions& options, const SlabChoices& choices)
    : slab_of_(frames.size()) {
  LF_CHECK(frames.size() == sampling.size());
  std::vector<FrameQueries> queries;
  std::vector<LfSampling> sampled;
  std::vector<size_t> asking;
  for (size_t f = 0; f < frames.size(); ++f) {
    if (!(sampling[f].lf.camera_distance_w > 0)) continue;
    queries.push_back(QueriesOf(frames[f], sampling[f], options));
    sampled.push_back(sampling[f].lf);
    asking.push_back(f);
  }
  sections_ = PlanSlabs(queries, sampled, choices);
  for (size_t slab = 0; slab < sections_.size(); ++slab)
    for (size_t i = sections_[slab].begin; i < sections_[slab].end; ++i) slab_of_[asking[i]] = slab;
}

}  // namespace lf
