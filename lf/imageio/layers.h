// Finds the colour channels of an EXR file. Internal to this folder.
#pragma once

#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Returns the indices of all channels, with R, G, B and A first. These are the ones without a layer
// or, if there are none, those of the only layer that has R, G and B. The others follow in the
// order of the file.
//   channel_names  "R", "beauty.R", ...
//   name           of the file, for messages
// kInput: only layers have colours, and several do.
Result<std::vector<int>> ColoursFirst(const std::vector<std::string>& channel_names,
                                      const std::string& name);

}  // namespace lf
