// SPDX-License-Identifier: Apache-2.0
// Writes a transforms.json into a folder, which may be the folder of the images or another one.
#pragma once

#include <filesystem>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Makes the names of images and masks relative to `folder`, which must exist and becomes
// LightField::folder. No file is moved. An absolute name stays absolute if it shares only the root
// with `folder`. Symbolic links in the paths of the old and the new folder are resolved.
// kInput: `folder` or the previous LightField::folder does not exist.
Result<void> MoveToFolder(const std::filesystem::path& folder, LightField* light_field);

// Checks that folder/transforms.json may be written for the light field that was read from
// `source`. kUsage if that file exists, and either the light field was read from it, or
// WriteNativeFolder() did not write it, or somebody changed it afterwards. If `force` is true, the
// file may always be written.
//   source  calibration file or its folder; empty: the light field was not read from the file
Result<void> CheckMayWrite(const std::filesystem::path& source, const std::filesystem::path& folder,
                           bool force);

// Checks that WriteNativeFolder() can name all images and masks. kUsage: a name is not UTF-8.
// kInput: LightField::folder does not exist.
Result<void> CheckNames(const std::filesystem::path& folder, const LightField& light_field);

// Creates the folder, moves the light field to it with MoveToFolder(), and writes its
// transforms.json. Returns the path of the file. kOutput: the folder or file cannot be written.
// kUsage: the light field is a packed store, whose LF images are no files.
Result<std::string> WriteNativeFolder(const std::filesystem::path& folder, LightField* light_field);

}  // namespace lf
