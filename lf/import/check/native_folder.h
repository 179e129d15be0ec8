// Writes a transforms.json into a folder, which may be the folder of the images or another one.
#pragma once

#include <filesystem>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Renames images and masks relative to `folder`, which must exist and becomes LightField::folder. A
// name stays absolute if the calibration gave an absolute one that shares only the root with the
// folder. Links on the way to the folders are followed.
// kInput: the folder does not exist.
Result<void> MoveToFolder(const std::filesystem::path& folder, LightField* light_field);

// Checks that folder/transforms.json may be written for the light field that was read from
// `source`. kUsage, unless forced, if the file exists and is being read from, or was changed or not
// written by WriteNativeFolder().
Result<void> CheckMayWrite(const std::filesystem::path& source, const std::filesystem::path& folder,
                           bool force);

// Creates the folder, moves the light field to it, and writes its transforms.json. Returns the
// file's path. kOutput; kUsage: a packed store, whose LF images are no files.
Result<std::string> WriteNativeFolder(const std::filesystem::path& folder, LightField* light_field);

}  // namespace lf
