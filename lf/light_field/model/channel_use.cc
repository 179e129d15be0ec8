// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/channel_use.h"

#include <string>

namespace lf {
namespace {

// In EXR files the name of a layer may precede the name of the channel.
bool IsAlpha(const std::string& channel_name) {
  const std::string name = channel_name.substr(channel_name.rfind('.') + 1);
  return name == "A" || name == "alpha" || name == "Alpha";
}

}  // namespace

ChannelUse UseOf(const ImageFileInfo& info) {
  ChannelUse use;
  use.channels = info.channels;
  use.colours = use.channels >= 3 ? 3 : 1;
  if (use.channels > use.colours && IsAlpha(info.channel_names[use.colours]))
    use.alpha = use.colours;
  return use;
}

}  // namespace lf
