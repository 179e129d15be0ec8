// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/image_index.h"

#include <utility>

#include "lf/core/check.h"

namespace lf {

ImageIndex::ImageIndex(const LightField& light_field, ImageRanks ranks, CameraTree::Content content)
    : content_(content), tree_(light_field, content), ranks_(std::move(ranks)) {
  LF_CHECK(ranks_.of_images.size() == light_field.size());
}

ImageIndex::ImageIndex(const LightField& light_field, ImageRanks ranks)
    : ImageIndex(light_field, std::move(ranks), CameraTree::Content::kAll) {
  if (HasVirtual(light_field))
    recorded_.reset(new ImageIndex(light_field, ranks_, CameraTree::Content::kRecorded));
}

ImageIndex::ImageIndex(const LightField& light_field, uint64_t seed)
    : ImageIndex(light_field, ShuffledRanks(light_field.size(), seed)) {}

}  // namespace lf
