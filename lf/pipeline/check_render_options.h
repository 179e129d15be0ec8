// What of a render's options cannot be together, or not with its package: to be said before the
// work, and before anything waits in a queue.
#pragma once

#include "lf/core/result.h"
#include "lf/package/package.h"
#include "lf/pipeline/render.h"

namespace lf {

// Render() asks this, too. kUsage, or kInput of a camera without a lens area where weights need
// one.
Result<void> CheckRenderOptions(const Package& package, const RenderOptions& options);

}  // namespace lf
