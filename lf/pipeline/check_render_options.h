// Checks that the options of a render go with each other and with its package: before the render,
// and before a job waits in a queue.
#pragma once

#include "lf/core/result.h"
#include "lf/package/package.h"
#include "lf/pipeline/render.h"

namespace lf {

// Render() calls this before it starts. Returns kUsage, or kInput if a camera has no lens area and
// the lens weights need one.
Result<void> CheckRenderOptions(const Package& package, const RenderOptions& options);

}  // namespace lf
