// SPDX-License-Identifier: Apache-2.0
// Turns SIGINT, SIGTERM and SIGHUP into a flag that long work polls.
#pragma once

#include <atomic>

#include "lf/render/pipeline/render.h"

namespace lf {

// From now on the first SIGINT, SIGTERM or SIGHUP sets the returned flag; under nohup, SIGHUP is
// ignored. A SIGINT more than half a second later ends the program at once. A second SIGTERM does
// not end it, because batch systems repeat SIGTERM.
const std::atomic<bool>& CatchInterrupts();

// As CatchInterrupts(), for a render: after SIGINT, SIGTERM or SIGHUP the render writes a
// checkpoint and ends; after SIGUSR1 it writes a checkpoint and continues. Must be called only
// once.
RenderSignals& CatchRenderSignals();

}  // namespace lf
