// Checks that the options of a film are compatible with each other and with its package, before the
// render starts and before a job waits in a queue.
#pragma once

#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/film_options.h"

namespace lf {

// Checks the options. FilmSetup::Make() calls this before it starts. The messages name options as
// lfrenderer does.
//   options  need not be resolved: the function calls Resolved()
//   frames   numbers of the frames to render; empty: all frames of the package
// Returns kUsage if the options are not compatible, or if the lens of a frame is a pinhole but lens
// weights by area need its area.
Result<void> CheckFilmOptions(const Package& package, const FilmOptions& options,
                              const std::vector<FrameId>& frames);

// Checks that the film can be guarded, because its light field is densified: frames collect rays
// and have no rebinned ones, LF images have neither opacities nor mosaics, and a package has the LF
// cameras beside the lens. kUsage otherwise.
Result<void> CheckGuard(const Package& package, const FilmOptions& film);

}  // namespace lf
