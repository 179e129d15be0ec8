// Connections that have sent no whole request yet, so that half requests cannot keep others out.
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <mutex>

namespace lf {

// A connection waits from its start, or from the end of its last answer, to the end of the headers
// of its next request. The server's own time limit begins anew with each byte, so that a client
// that sends one now and then would never meet it; the limits of this class count from the start.
// Connections are known by their sockets, which must stay open until Remove(). Thread-safe.
class WaitingConnections {
 public:
  // Hangs up on the connection that has waited longest if there are more than `most_count`: a new
  // one with a whole request is always heard.
  WaitingConnections(size_t most_count, std::chrono::milliseconds patience)
      : most_count_(most_count), patience_(patience) {}

  // Hangs up if there is no memory to know it by.
  void Add(int socket);
  // Its request is here, or it has ended. Does nothing if it does not wait.
  void Remove(int socket);
  // Hangs up on all that have waited longer than `patience`.
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
  std::list<Connection> connections_;  // the oldest first
};

}  // namespace lf
