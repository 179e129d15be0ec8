// Tells which channels of an LF image's file are colours, and which is alpha.
#pragma once

#include <optional>

#include "lf/imageio/image_file.h"

namespace lf {

struct ChannelUse {
  int channels = 1;
  int colours = 1;  // 1: grey or mosaic; 3: R, G, B; they come first
  std::optional<int> alpha;
};

// Three channels or more are colours. The channel behind the colours is alpha if it is named so;
// other channels, such as depth, are not used.
ChannelUse UseOf(const ImageFileInfo& info);

}  // namespace lf
