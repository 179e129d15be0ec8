// SPDX-License-Identifier: Apache-2.0
// Server-sent events: a stream of news for each open page.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "tools/visualizer/event_board.h"
#include "tools/visualizer/page_responses.h"

namespace lf {

// A stream occupies no thread: its connection is suspended between news, and the single thread of
// Run() resumes all connections.
class PageStreams {
 public:
  PageStreams(EventBoard& events, size_t most_count) : events_(events), most_count_(most_count) {}

  // Opens a stream. Returns false if too many streams are open, or if there is no memory.
  //   response  set to the response that sends news to this connection until either side closes it
  bool Open(MHD_Connection* connection, Response* response);

  // Wakes the streams for news, and once per second without news. Returns when the board is closed;
  // from then on, no connection is suspended.
  void Run();

 private:
  struct Stream {
    PageStreams& streams;
    MHD_Connection* connection;
    uint64_t seen = 0;  // number of the last event that was read from the board
    // Text to be sent. The first text is sent at once, so that the page knows that it is connected.
    std::string text = ": hello\n\n";
    bool is_woken = false;
  };
  static ssize_t Read(void* stream, uint64_t position, char* text, size_t most_bytes);
  static void Free(void* stream);
  ssize_t ReadNews(Stream& stream, char* text, size_t most_bytes);
  void WakeAll();

  EventBoard& events_;
  const size_t most_count_;
  std::mutex mutex_;
  size_t count_ = 0;
  std::list<Stream*> suspended_;
};

}  // namespace lf
