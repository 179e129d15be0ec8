// SPDX-License-Identifier: Apache-2.0
// Files of exports that have one for each image. Internal to this folder.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Returns the files of a folder whose names end in `ending`, sorted by bytes, without hidden files.
// kInput if the folder cannot be listed, or has more than kMaxImageCount of them.
Result<std::vector<std::filesystem::path>> SortedFilesIn(const std::filesystem::path& folder,
                                                         std::string_view ending);

}  // namespace lf
