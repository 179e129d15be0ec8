// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/develop_options.h"

#include "lf/light_field/model/lf_pixels.h"

namespace lf {

DevelopOptions DevelopOptionsOf(const RadianceEncoding& encoding) {
  DevelopOptions develop;
  develop.pedestal = encoding.pedestal;
  develop.scale = encoding.Scale();
  develop.white_balance = encoding.white_balance;
  develop.linear_srgb_from_camera = encoding.linear_srgb_from_camera;
  develop.transparent = LfPixels::kTransparent;
  develop.opaque = LfPixels::kOpaque;
  return develop;
}

}  // namespace lf
