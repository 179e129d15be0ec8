// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/rebin_settings.h"

namespace lf {

const char* NameOf(KeptRays kept) {
  switch (kept) {
    case KeptRays::kAll:
      return "all";
    case KeptRays::kEdges:
      return "edges";
    default:
      return "auto";
  }
}

const char* NameOf(RayInterpolation interpolation) {
  switch (interpolation) {
    case RayInterpolation::kPixels:
      return "pixels";
    case RayInterpolation::kCells:
      return "cells";
    default:
      return "auto";
  }
}

const char* NameOf(Previews previews) {
  switch (previews) {
    case Previews::kOn:
      return "on";
    case Previews::kOff:
      return "off";
    default:
      return "auto";
  }
}

}  // namespace lf
