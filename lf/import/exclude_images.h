// Leaving LF images out of a light field, such as those whose calibration failed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

// The patterns of options: each a list separated by commas, or @FILE with one pattern per line
// (for names that hold commas); blank lines and entries are skipped. kInput: FILE cannot be read.
Result<std::vector<std::string>> ReadPatterns(std::span<const std::string> options);

// Removes every LF image that a pattern names: its name as the calibration has it, or the part of
// it behind the last '/'. A pattern is such a name, or one with * ? [abc] in it, as shells have
// them (* matches '/' too).
// Returns how many were removed.
// kInput: a pattern that names no image (nothing is removed then), or nothing is left.
Result<size_t> ExcludeImages(std::span<const std::string> patterns, LightField* light_field);

}  // namespace lf
