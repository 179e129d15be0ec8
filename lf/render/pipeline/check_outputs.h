// SPDX-License-Identifier: Apache-2.0
// Checks that a render does not overwrite the files that it reads.
#pragma once

#include <filesystem>
#include <vector>

#include "lf/core/result.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/render.h"

namespace lf {

// Returns kUsage if an output and an input are the same file, even if their paths differ. An output
// that does not exist yet replaces nothing. Each input costs one access to the disk, unless no
// output exists.
Result<void> CheckReplacesNone(const std::vector<std::filesystem::path>& outputs,
                               const std::vector<std::filesystem::path>& inputs);

// Returns the image files and masks of a light field or, if it is a packed store, the file of the
// store.
std::vector<std::filesystem::path> FilesOfLightField(const LightField& light_field);

// Returns kUsage if a file that the render writes into its folder is an LF image or a mask of the
// package, or one of options.folder.inputs. CheckVideoTarget() checks the video. Links to folders
// are followed. Links to image files and masks are followed only if the light field has at most
// 20,000 LF images, because following them costs one access to the disk for each file.
Result<void> CheckOutputs(const Package& package, const RenderOptions& options);

}  // namespace lf
