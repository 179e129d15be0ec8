// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/shared_ideal_pixels.h"

#include <utility>
#include <vector>

#include "lf/render/collect/collect_batch.h"

namespace lf {

void SharedIdealPixels::Keep(const LightField& light_field, std::span<const BatchImage> batch,
                             const ForEach& for_each) {
  std::map<uint32_t, std::shared_ptr<const IdealPixels>> in_use;
  std::vector<uint32_t> missing;
  for (const BatchImage& image : batch) {
    const uint32_t index = light_field.cameras[image.id.value].intrinsics_index;
    if (!light_field.intrinsics[index].has_distortion() || in_use.contains(index)) continue;
    in_use[index] = Of(index);
    if (!in_use[index]) missing.push_back(index);
  }
  for_each(missing.size(), [&](size_t i) {
    in_use.find(missing[i])->second =
        std::make_shared<const IdealPixels>(light_field.intrinsics[missing[i]]);
  });
  kept_ = std::move(in_use);
}

std::shared_ptr<const IdealPixels> SharedIdealPixels::Of(uint32_t intrinsics_index) const {
  const auto found = kept_.find(intrinsics_index);
  return found == kept_.end() ? nullptr : found->second;
}

}  // namespace lf
