// The port that the page is served at: of this machine alone.
#pragma once

#include "lf/core/result.h"

namespace lf {

struct PagePort {
  int socket = -1;  // listens; whoever has it closes it
  int port = 0;
};

// Listens on 127.0.0.1. Never shares the port with another program, another lfvisualizer included.
//   port  0: any that is free
// kOutput: the port is taken, or may not be had.
Result<PagePort> ListenOnThisMachine(int port);

}  // namespace lf
