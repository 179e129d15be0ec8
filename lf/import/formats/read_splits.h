// SPDX-License-Identifier: Apache-2.0
// Reads data sets that are split into a training, a validation and a test part, each with a
// transforms.json of its own, as one light field: Blender's NeRF scenes and their successors.
// Internal to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the existing files of transforms_train.json, transforms_val.json and transforms_test.json
// in a folder, in this order.
std::vector<std::filesystem::path> SplitsIn(const std::filesystem::path& folder);

// For a folder without transforms.json, returns a hint that names the calibrations in it that are
// called differently, such as transforms_train.json; "" if there is none.
std::string OtherCalibrations(const std::filesystem::path& folder);

// Reads the files, of which there must be at least one, as ReadTransformsJson() does, and returns
// their LF images one after the other. An LF image with the pose and intrinsics of one of an
// earlier file is left out, because it is the same photograph. Logs both numbers. kInput: an error
// of ReadTransformsJson(); files that disagree about the encoding of the pixels or the unit.
Result<LightField> ReadSplits(const std::vector<std::filesystem::path>& files,
                              const std::optional<std::filesystem::path>& images_folder);

}  // namespace lf
