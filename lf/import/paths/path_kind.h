// Finds out in which form a camera path is written. Internal to this folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

enum class PathKind { kYaml, kNerfstudio, kNgp, kChan };

// Returns the keys of the top level of a JSON object, in the order of the text; those before the
// first error if the text is not JSON. Empty if the text begins with something other than {.
std::vector<std::string> TopLevelKeys(std::string_view text);

// Returns the form of a text. kInput if it is JSON of no known form: the message lists the keys
// that were found and those that were expected.
//   file  for messages
Result<PathKind> PathKindOf(std::string_view text, const std::filesystem::path& file);

}  // namespace lf
