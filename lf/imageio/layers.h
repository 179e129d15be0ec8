// Which channels of an EXR file are its colours. Internal to this folder.
#pragma once

#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Indices of the channels, R, G, B and A first: those without a layer, or those of the one layer
// that has R, G and B; the others in the order of the file.
//   channel_names  "R", "beauty.R", ...
//   name           of the file, for messages
// kInput: colours in several layers alone.
Result<std::vector<int>> ColoursFirst(const std::vector<std::string>& channel_names,
                                      const std::string& name);

}  // namespace lf
