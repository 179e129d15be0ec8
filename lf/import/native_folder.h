// The folder of a transforms.json of ours, beside or away from the images it names.
#pragma once

#include <filesystem>
#include <string>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

// Renames images and masks so that they are found from `folder`, which must exist and becomes
// LightField::folder. Names are relative, unless the calibration gave an absolute one that shares
// nothing with the folder but the root; links in the way of the folders are followed.
// kInput: a folder that does not exist.
Result<void> MoveToFolder(const std::filesystem::path& folder, LightField* light_field);

// Whether folder/transforms.json may be written for the light field that `source` is: kUsage where
// there is one that is being read from, or that was not written by WriteNativeFolder() or was
// changed since; unless forced.
Result<void> CheckMayWrite(const std::filesystem::path& source, const std::filesystem::path& folder,
                           bool force);

// Moves the light field to the folder, which is created, and writes its transforms.json there.
// Returns the file's path. kOutput; kUsage: a packed store, whose LF images are no files.
Result<std::string> WriteNativeFolder(const std::filesystem::path& folder, LightField* light_field);

}  // namespace lf
