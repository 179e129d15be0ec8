// SPDX-License-Identifier: Apache-2.0
// Checks that the options of a film are compatible with each other and with its package, before the
// render starts and before a job waits in a queue.
#pragma once

#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Checks the options. FilmSetup::Make() calls this before it starts. The messages name options as
// lfrenderer does.
//   options  need not be resolved: the function calls Resolved()
//   frames   numbers of the frames to render; empty: all frames of the package
// Returns kUsage if the options are not compatible; if the lens of a frame is a pinhole but lens
// weights by area need its area; if cells are kept (render/settings/interpolation.h) but the path
// has a shutter or moves through time; or if the light field is densified but its frames cannot be
// guarded, because they have cells, the path has a shutter, LF images are mosaics, or the package
// lacks the LF cameras beside the lens; or if the path moves through time and one time is open, or
// the other way round.
Result<void> CheckFilmSettings(const Package& package, const FilmSettings& options,
                               const std::vector<FrameId>& frames);

}  // namespace lf
