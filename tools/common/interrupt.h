// SIGINT and SIGTERM as a flag that long work looks at.
#pragma once

#include <atomic>

namespace lf {

// From now on the first SIGINT or SIGTERM sets the flag; a second one ends the program at once.
const std::atomic<bool>& CatchInterrupts();

}  // namespace lf
