// SIGINT and SIGTERM as a flag that long work looks at.
#pragma once

#include <atomic>

#include "lf/pipeline/render.h"

namespace lf {

// From now on the first SIGINT or SIGTERM sets the flag; a second one ends the program at once.
const std::atomic<bool>& CatchInterrupts();

// The same for a render, which also listens to SIGUSR1 and SIGHUP: the first SIGINT, SIGTERM or,
// but under nohup, SIGHUP asks for the state and the end. A SIGINT more than half a second after it
// ends the program at once (a SIGTERM does not: batch systems repeat it). SIGUSR1 asks for the
// state. To be called once.
RenderSignals& CatchRenderSignals();

}  // namespace lf
