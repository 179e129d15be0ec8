// Removes LF images from a light field, such as those whose calibration failed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Reads the patterns in options. Each option is a list separated by commas, or @FILE with one
// pattern per line (for names that contain commas); blank lines and entries are skipped. kInput:
// FILE cannot be read.
Result<std::vector<std::string>> ReadPatterns(std::span<const std::string> options);

// Removes every LF image whose name matches a pattern. The name is that in the calibration, or the
// part of it after the last '/'. A pattern is a name or a shell pattern with * ? [abc], in which *
// also matches '/'.
// Returns the number of removed LF images.
// kInput: a pattern that matches no image (nothing is removed then), or no image would remain.
Result<size_t> ExcludeImages(std::span<const std::string> patterns, LightField* light_field);

}  // namespace lf
