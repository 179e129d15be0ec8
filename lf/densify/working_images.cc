// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/working_images.h"

namespace lf {
namespace {

size_t BytesOf(const WorkingImage& image) {
  return image.light.size_bytes() + image.tones.size_bytes() + image.compared.size_bytes() +
         image.empty.size_bytes() + image.without_depth.size_bytes();
}

}  // namespace

Result<std::shared_ptr<const WorkingImage>> WorkingImages::Get(LfImageId id) {
  return kept_.Get(
      id, [&] { return LoadWorkingImage(light_field_, store_, id, divisor_, curve_); }, BytesOf);
}

}  // namespace lf
