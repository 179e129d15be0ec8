// SPDX-License-Identifier: Apache-2.0
// Connections on which the headers of the next request are incomplete. They are limited so that
// they cannot keep other connections out.
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <mutex>

namespace lf {

// A connection waits from its start, or from the end of its last answer, until the headers of its
// next request are complete. libmicrohttpd's own time limit restarts with each byte, so a client
// that sends one now and then would never reach it; the limits here count from the start.
// Connections are identified by their sockets, which must stay open until Remove(). Thread-safe.
class WaitingConnections {
 public:
  // If there are more than `most_count`, the connection that has waited longest is closed, so that
  // a new connection always gets an answer to a complete request.
  WaitingConnections(size_t most_count, std::chrono::milliseconds patience)
      : most_count_(most_count), patience_(patience) {}

  // Adds a connection, or closes it if there is no memory to store it.
  void Add(int socket);
  // Called when the headers of the connection's request are complete, or when the connection has
  // ended. Does nothing if the connection is not waiting.
  void Remove(int socket);
  // Closes all connections that have waited longer than `patience`.
  void HangUpLate();

 private:
  using Clock = std::chrono::steady_clock;
  struct Connection {
    int socket;
    Clock::time_point since;
  };
  void HangUpOldest();

  const size_t most_count_;
  const std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::list<Connection> connections_;  // in the order of `since`
};

}  // namespace lf
