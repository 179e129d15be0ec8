// SPDX-License-Identifier: Apache-2.0
// Completes a light field with what its calibration does not state: where the image files are, how
// large they are, what their numbers and their alpha mean. Internal to this folder.
#pragma once

#include <filesystem>

#include "lf/core/result.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// `path` is the light field as the user named it, for messages. All return kInput or kUsage as
// OpenLightField() does.

// Finds image files that were moved or renamed after they were calibrated, and scales the
// intrinsics if the files are of another size than calibrated.
Result<void> FindImages(const OpenOptions& options, const std::filesystem::path& path,
                        LightField* light_field);

// Finds the masks in OpenOptions::masks_folder, if it is given.
Result<void> FindMasks(const OpenOptions& options, LightField* light_field);

// Completes the encoding after the calibration was read, which may state nothing about the
// encoding.
Result<void> CompleteEncoding(const OpenOptions& options, const std::filesystem::path& path,
                              LightField* light_field);

// Sets the meaning of alpha: from the options; if they do not state it, from the calibration; if
// that does not either, from the pixels.
Result<void> CompleteAlpha(const OpenOptions& options, const std::filesystem::path& path,
                           LightField* light_field);

}  // namespace lf
