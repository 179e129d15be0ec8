#include "lf/selection/image_index.h"

#include <utility>

#include "lf/core/check.h"

namespace lf {

ImageIndex::ImageIndex(const LightField& light_field, ImagePlaces places)
    : tree_(light_field), places_(std::move(places)) {
  LF_CHECK(places_.of_images.size() == light_field.size());
}

ImageIndex::ImageIndex(const LightField& light_field, uint64_t seed)
    : ImageIndex(light_field, ShuffledPlaces(light_field.size(), seed)) {}

}  // namespace lf
