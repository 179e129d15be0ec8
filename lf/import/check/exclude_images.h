// SPDX-License-Identifier: Apache-2.0
// Removes LF images from a light field, such as those whose calibration failed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/import/check/check_images.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Reads the patterns from the values of --exclude. Each value is a list separated by commas, or
// @FILE, a file with one pattern per line (for names that contain commas). Empty entries and lines
// are skipped. kInput: FILE cannot be read.
Result<std::vector<std::string>> ReadPatterns(std::span<const std::string> options);

// The word among the patterns that stands for LF images that are missing or broken.
inline constexpr const char* kMissingPattern = "missing";

// Removes every LF image that is missing or broken, and returns their number. kInput, with nothing
// removed: no LF image would remain.
Result<size_t> ExcludeFaulty(const ImageFaults& faults, LightField* light_field);

// Removes every LF image whose name matches a pattern. Both the name in the calibration and its
// part after the last '/' are compared. A pattern is a name or a shell pattern with * ? [abc], in
// which * also matches '/'.
// Returns the number of removed LF images.
// kInput, with nothing removed: a pattern matches no LF image, or no LF image would remain.
Result<size_t> ExcludeImages(std::span<const std::string> patterns, LightField* light_field);

}  // namespace lf
