// SPDX-License-Identifier: Apache-2.0
// Recognises files that people take for camera paths, but that are not read as such, so that an
// error can name them. Internal to this folder.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

// Returns kInput if the beginning of a file's content tells that it is no camera path: the message
// names its format, and says how to come to a path instead.
//   text  the beginning of the file, at least 1 KiB unless the file is shorter
//   file  for messages
Result<void> CheckContentIsNoOther(std::string_view text, const std::filesystem::path& file);

// Returns kInput if the extension of a file tells the same. Must be called only if the content is
// not that of a camera path of another program. A text that says "lfpath" is a path of our own,
// whatever its name.
Result<void> CheckNameIsNoOther(std::string_view text, const std::filesystem::path& file);

}  // namespace lf
