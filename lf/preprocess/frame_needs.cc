#include "lf/preprocess/frame_needs.h"

#include <algorithm>
#include <iterator>
#include <span>

#include "lf/collector/frame_lens.h"

namespace lf {

uint64_t FrameNeeds::RayCount() const {
  uint64_t count = 0;
  for (const Image& image : images) count += static_cast<uint64_t>(image.rect.pixel_count());
  return count;
}

FrameNeeds NeedsOf(const ImageIndex& index, const RenderCamera& frame, const NeedsOptions& options,
                   ThreadPool& pool) {
  FrameNeeds needs;
  const FrameLens lens(index, frame, options.lens_weights, options.select, pool);
  if (options.lens_weights != LensWeights::kNone)
    needs.camera_distance_w = lens.camera_distance_w();
  const std::span<const RenderCamera> frames(&lens.camera(), 1);
  std::vector<PlaceRange> places(1);
  if (options.max_image_count)
    places = PlacesOfFirst(*options.max_image_count, index, frames, options.select, pool);
  std::vector<LfImageId> counted, selected;
  for (const SelectedImage& image : SelectImages(index, frames, options.select, pool, places)) {
    selected.push_back(image.id);
    if (lens.WeightsOf(image.id).are_none()) continue;
    needs.images.push_back({image.id, image.rect});
    counted.push_back(image.id);
  }
  if (options.lens_weights == LensWeights::kNone) return needs;
  // Those without weight were selected all the same, and count towards limits.
  std::vector<LfImageId> all = lens.near();
  all.insert(all.end(), selected.begin(), selected.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::sort(counted.begin(), counted.end());
  std::set_difference(all.begin(), all.end(), counted.begin(), counted.end(),
                      std::back_inserter(needs.neighbours));
  return needs;
}

}  // namespace lf
