// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_images.h"

#include <utility>

namespace lf {
namespace {

size_t BytesOf(const JointImage& image) {
  const WorkingImage& working = image.working;
  return image.samples.size_bytes() + image.rgb.size_bytes() + image.smooth.size_bytes() +
         working.tones.size_bytes() + working.compared.size_bytes() + working.empty.size_bytes() +
         working.without_depth.size_bytes();
}

}  // namespace

Result<JointImage> JointImages::Load(LfImageId id) const {
  const Intrinsics& k = light_field_.Camera(id).intrinsics;
  LF_ASSIGN_OR_RETURN(const LfPixels mosaic,
                      LoadWithoutThrowing(store_, id, {0, 0, k.width_px, k.height_px},
                                          light_field_.image_names[id.value], LfPixels{}));
  return JointImageOf(light_field_, id, mosaic, curve_);
}

Result<std::shared_ptr<const JointImage>> JointImages::Get(LfImageId id) {
  return kept_.Get(
      id, [&] { return Load(id); }, BytesOf);
}

}  // namespace lf
