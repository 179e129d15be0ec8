#include "lf/render/needs/film_order.h"

#include <utility>

namespace lf {
namespace {

Result<void> CheckInterrupted(const SelectOptions& select) {
  if (select.interrupted == nullptr || !*select.interrupted) return {};
  return Error{ErrorKind::kInterrupted, "interrupted"};
}

}  // namespace

Result<ImagePlaces> PlacesOfFilm(ImageOrder order, uint64_t seed, const LightField& light_field,
                                 const CameraPath& path, const NeedsOptions& needs,
                                 ThreadPool& pool) {
  ImagePlaces shuffled = ShuffledPlaces(light_field.size(), seed);
  if (order == ImageOrder::kShuffle) return shuffled;
  const ImageIndex index(light_field, std::move(shuffled));
  NeedsOptions unlimited = needs;
  unlimited.max_image_count.reset();
  // The order must not depend on the filter, because packages can be rendered with any filter.
  if (unlimited.select.reach == PixelReach::kElement)
    unlimited.select.reach = PixelReach::kNeighbours;
  std::vector<std::vector<ImageRays>> taken;
  for (const RenderCamera& frame : path.cameras) {
    taken.emplace_back();
    for (const FrameNeeds::Image& image : NeedsOf(index, frame, unlimited, pool).images)
      taken.back().push_back({image.id, image.ray_count});
    LF_RETURN_IF_ERROR(CheckInterrupted(needs.select));
  }
  return PlacesInOrder(order, light_field.size(), seed, taken);
}

Result<std::vector<FrameSampling>> SamplingOfFilm(const ImageIndex& index, const CameraPath& path,
                                                  const SelectOptions& select, ThreadPool& pool) {
  std::vector<FrameSampling> sampling;
  for (const RenderCamera& frame : path.cameras) {
    sampling.push_back(SamplingOf(index, frame, select, pool));
    LF_RETURN_IF_ERROR(CheckInterrupted(select));
  }
  return sampling;
}

}  // namespace lf
