// SIGINT, SIGTERM and SIGHUP as a flag that long work looks at.
#pragma once

#include <atomic>

#include "lf/pipeline/render.h"

namespace lf {

// From now on the first SIGINT, SIGTERM or, but under nohup, SIGHUP sets the flag. A SIGINT more
// than half a second after it ends the program at once (a SIGTERM does not: batch systems repeat
// it).
const std::atomic<bool>& CatchInterrupts();

// The same for a render: the flag asks for the state and the end, and SIGUSR1 for the state. To be
// called once.
RenderSignals& CatchRenderSignals();

}  // namespace lf
