// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/keep_images.h"

#include <utility>
#include <vector>

namespace lf {

void KeepImages(std::span<const size_t> kept, LightField* light_field) {
  const bool has_masks = !light_field->mask_names.empty();
  const bool has_times = !light_field->times.empty();
  for (size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] == i) continue;
    light_field->cameras[i] = light_field->cameras[kept[i]];
    light_field->image_names[i] = std::move(light_field->image_names[kept[i]]);
    if (has_masks) light_field->mask_names[i] = std::move(light_field->mask_names[kept[i]]);
    if (has_times) light_field->times[i] = light_field->times[kept[i]];
  }
  light_field->cameras.resize(kept.size());
  light_field->image_names.resize(kept.size());
  if (has_masks) light_field->mask_names.resize(kept.size());
  if (has_times) light_field->times.resize(kept.size());
}

LightField RecordedPart(LightField light_field) {
  std::vector<size_t> kept;
  for (size_t i = 0; i < light_field.size(); ++i)
    if (!light_field.cameras[i].is_virtual) kept.push_back(i);
  KeepImages(kept, &light_field);
  return light_field;
}

}  // namespace lf
