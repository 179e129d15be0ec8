// Checks that the options of a film go with each other and with its package: before the render, and
// before a job waits in a queue.
#pragma once

#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/film_options.h"

namespace lf {

// FilmSetup::Make() calls this before it starts. The messages name options as lfrenderer does.
//   options  are resolved by the function (Resolved())
//   frames   empty: all of the package
// Returns kUsage, or kInput if a camera has no lens area and the lens weights need one.
Result<void> CheckFilmOptions(const Package& package, const FilmOptions& options,
                              const std::vector<FrameId>& frames);

}  // namespace lf
