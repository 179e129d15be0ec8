// Tells which channels of an LF image's file are colours, and which is alpha.
#pragma once

#include <optional>

#include "lf/pixels/files/image_file.h"

namespace lf {

struct ChannelUse {
  int channels = 1;
  int colours = 1;  // 1: grey or mosaic; 3: R, G, B; the colours are the first channels
  std::optional<int> alpha;
};

// Returns the use of the channels: the first three are colours if there are three or more,
// otherwise the first is grey. The channel behind the colours is alpha if its name says so. Other
// channels, such as depth, are unused.
ChannelUse UseOf(const ImageFileInfo& info);

}  // namespace lf
