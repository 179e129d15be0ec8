// SPDX-License-Identifier: Apache-2.0
// Tells which channels of an LF image's file are colours, and which is alpha.
#pragma once

#include <optional>

#include "lf/pixels/files/image_file.h"

namespace lf {

struct ChannelUse {
  int channels = 1;  // number of all channels
  int colours = 1;   // number of colours, which are the first channels; 1: grey or mosaic; 3: RGB
  std::optional<int> alpha;  // index of the alpha channel, if there is one
};

// Returns the use of the channels: the first three are colours if there are three or more,
// otherwise the first is grey. The channel behind the colours is alpha if its name says so. Other
// channels, such as depth, are unused.
ChannelUse UseOf(const ImageFileInfo& info);

}  // namespace lf
