// SPDX-License-Identifier: Apache-2.0
// Opens the port that serves the page, on this machine only.
#pragma once

#include "lf/core/result.h"

namespace lf {

struct PagePort {
  int socket = -1;  // the listening socket, which its owner must close
  int port = 0;
};

// Listens on 127.0.0.1. The port is never shared with another program, not even another
// lfvisualizer.
//   port  0: any free port
// kOutput: the port is in use or not permitted.
Result<PagePort> ListenOnThisMachine(int port);

}  // namespace lf
