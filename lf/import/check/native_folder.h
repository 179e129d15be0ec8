// Writes a transforms.json into a folder, which may be the folder of the images or another one.
#pragma once

#include <filesystem>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Renames images and masks relative to `folder`, which must exist and becomes LightField::folder.
// Names that were absolute stay absolute if they share only the root with the folder. Symbolic
// links in the paths of the folders are resolved.
// kInput: this folder or the light field's folder does not exist.
Result<void> MoveToFolder(const std::filesystem::path& folder, LightField* light_field);

// Checks that folder/transforms.json may be written for the light field that was read from
// `source`. kUsage if the file exists and the light field was read from it, or if it was not
// written by WriteNativeFolder() or was changed since. If `force` is true, it may always be
// written.
Result<void> CheckMayWrite(const std::filesystem::path& source, const std::filesystem::path& folder,
                           bool force);

// Creates the folder, moves the light field to it with MoveToFolder(), and writes its
// transforms.json. Returns the path of the file. kOutput: the folder or file cannot be written.
// kUsage: the light field is a packed store, whose LF images are no files.
Result<std::string> WriteNativeFolder(const std::filesystem::path& folder, LightField* light_field);

}  // namespace lf
