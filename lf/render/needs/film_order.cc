// SPDX-License-Identifier: Apache-2.0
#include "lf/render/needs/film_order.h"

namespace lf {

Result<ImageRanks> RanksOfFilm(ImageOrder order, uint64_t seed, const LightField& light_field,
                               const CameraPath& path, const NeedsOptions& needs,
                               ThreadPool& pool) {
  if (!DependsOnFrames(order)) return RanksOf(order, light_field, seed);
  const ImageIndex index(light_field, seed);
  NeedsOptions unlimited = needs;
  unlimited.max_image_count.reset();
  // The order must not depend on the filter, because packages can be rendered with any filter.
  if (DependsOnElement(unlimited.select.reach)) unlimited.select.reach = PixelReach::kNeighbours;
  std::vector<std::vector<ImageRays>> taken;
  for (const FrameId frame : path.frames().All()) {
    taken.emplace_back();
    for (const FrameNeeds::Image& image : NeedsOf(index, path, frame, unlimited, pool).images)
      taken.back().push_back({image.id, image.ray_count});
    if (needs.select.interrupted != nullptr && *needs.select.interrupted)
      return Error{ErrorKind::kInterrupted, "interrupted"};
  }
  return RanksInOrder(order, light_field.size(), seed, taken);
}

}  // namespace lf
