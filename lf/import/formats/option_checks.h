// SPDX-License-Identifier: Apache-2.0
// Checks which options of OpenLightField() a kind of calibration allows. Internal to this folder.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/formats/open_light_field.h"

namespace lf {

// Returns the first option in `options` that only folders with Stanford names accept, as messages
// name it; "" if there is none.
std::string_view StanfordOptionOf(const OpenOptions& options);

// Each returns kUsage if an option is given that the calibration at `path` does not allow: those
// that only folders with Stanford names accept; fov_deg, which only poses of Airborne Optical
// Sectioning lack; images_folder, if the calibration contains its own images.
Result<void> CheckNoStanfordOptions(const std::filesystem::path& path, const OpenOptions& options);
Result<void> CheckNoFov(const std::filesystem::path& path, const OpenOptions& options);
Result<void> CheckNoImagesFolder(const std::filesystem::path& path, const OpenOptions& options);

}  // namespace lf
