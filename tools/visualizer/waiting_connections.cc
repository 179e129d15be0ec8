// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/waiting_connections.h"

#include <sys/socket.h>

#include <new>

namespace lf {

void WaitingConnections::Add(int socket) {
  const std::lock_guard lock(mutex_);
  try {
    connections_.push_back({socket, Clock::now()});
  } catch (const std::bad_alloc&) {
    ::shutdown(socket, SHUT_RDWR);
  }
  if (connections_.size() > most_count_) HangUpOldest();
}

void WaitingConnections::Remove(int socket) {
  const std::lock_guard lock(mutex_);
  connections_.remove_if([&](const Connection& one) { return one.socket == socket; });
}

void WaitingConnections::HangUpLate() {
  const std::lock_guard lock(mutex_);
  while (!connections_.empty() && Clock::now() - connections_.front().since > patience_)
    HangUpOldest();
}

// The thread that serves the connection notices its end and closes the socket.
void WaitingConnections::HangUpOldest() {
  ::shutdown(connections_.front().socket, SHUT_RDWR);
  connections_.pop_front();
}

}  // namespace lf
