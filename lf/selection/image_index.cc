// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/image_index.h"

#include <utility>

#include "lf/core/check.h"

namespace lf {

ImageIndex::ImageIndex(const LightField& light_field, ImagePlaces places,
                       CameraTree::Content content)
    : content_(content), tree_(light_field, content), places_(std::move(places)) {
  LF_CHECK(places_.of_images.size() == light_field.size());
}

ImageIndex::ImageIndex(const LightField& light_field, ImagePlaces places)
    : ImageIndex(light_field, std::move(places), CameraTree::Content::kAll) {
  if (HasVirtual(light_field))
    recorded_.reset(new ImageIndex(light_field, places_, CameraTree::Content::kRecorded));
}

ImageIndex::ImageIndex(const LightField& light_field, uint64_t seed)
    : ImageIndex(light_field, ShuffledPlaces(light_field.size(), seed)) {}

}  // namespace lf
