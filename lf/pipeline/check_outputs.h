// Files that a render would write over, and must not: those that it reads.
#pragma once

#include <filesystem>
#include <vector>

#include "lf/core/result.h"
#include "lf/package/package.h"
#include "lf/pipeline/render.h"

namespace lf {

// kUsage if one of the outputs is the same file as one of the inputs, by whatever names. Outputs
// that are not there yet replace nothing. Each input costs a look at the disk.
Result<void> CheckReplacesNone(const std::vector<std::filesystem::path>& outputs,
                               const std::vector<std::filesystem::path>& inputs);

// kUsage if a file that the render writes into its folder is an LF image or a mask of the package,
// or one of options.inputs. CheckVideoTarget() looks at the video. Links to folders are followed;
// links to files are in light fields of up to 20,000 LF images, since that costs a look at the disk
// for each.
Result<void> CheckOutputs(const Package& package, const RenderOptions& options);

}  // namespace lf
