// SPDX-License-Identifier: Apache-2.0
// How long a web server is waited for. All programs use the defaults; tests use shorter times.
#pragma once

#include <atomic>

namespace lf {

struct RemoteOptions {
  double connect_s = 15;  // time for a connection and its TLS handshake
  double stall_s = 30;    // a transfer slower than 100 bytes/s for this time fails
  // A read fails after this many attempts in a row of which none brought 1 MiB or the rest.
  int most_attempts = 6;
  // Time before the second attempt, which doubles before each further one: 15.5 s in all. If the
  // server states a time (Retry-After) that is longer, and at most most_wait_s, that time.
  double first_wait_s = 0.5;
  double most_wait_s = 60;
  // A read is given up after total_s, and 1 s more for each 10 kB that it asks for.
  double total_s = 300;
};

// Makes all reads from web servers end with kInterrupted within a second after `flag` was set.
// Null: no flag. The flag must exist while any read may run. Meant for main().
void StopRemoteReadsIf(const std::atomic<bool>* flag);

// Returns true if that flag is set.
bool AreRemoteReadsStopped();

}  // namespace lf
