// SPDX-License-Identifier: Apache-2.0
// Finds the colour channels of an EXR file. Internal to this folder.
#pragma once

#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Returns the indices of all channels, with R, G, B and A first. If a channel is named R, G or B
// without a layer, the colours are the channels without a layer. Otherwise they are the channels of
// the only layer that has R, G and B, if there is one. The other channels follow in the order of
// the file.
//   channel_names  "R", "beauty.R", ...
//   name           name of the file, for messages
// kInput: no channel without a layer is R, G or B, and several layers have all three.
Result<std::vector<int>> ColoursFirst(const std::vector<std::string>& channel_names,
                                      const std::string& name);

}  // namespace lf
