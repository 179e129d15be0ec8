// SPDX-License-Identifier: Apache-2.0
// Hints for folders that hold no light field: what they hold instead. Internal to this folder.
#pragma once

#include <filesystem>
#include <string>

namespace lf {

// Returns a hint for a folder that holds photographs but no calibration, as the end of a message;
// "" for other folders.
std::string PhotographsIn(const std::filesystem::path& path);

// Returns a hint that names up to five subfolders that hold a light field, and ends with the
// command for the first of them; "" if there are none.
std::string LightFieldsBelow(const std::filesystem::path& folder);

}  // namespace lf
