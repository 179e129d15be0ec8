// The former names of lf/core/child_process.h.
#pragma once

#include "lf/core/child_process.h"

namespace lf {

using Command = ChildProcess;
using CommandEnd = ProcessEnd;

}  // namespace lf
