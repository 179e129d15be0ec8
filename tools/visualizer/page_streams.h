// Server-sent events: a stream of news for each page that is open.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "tools/visualizer/event_board.h"
#include "tools/visualizer/page_responses.h"

namespace lf {

// A stream holds no thread: its connection is suspended between news, and one thread, that of
// Run(), resumes them all.
class PageStreams {
 public:
  PageStreams(EventBoard& events, size_t most_count) : events_(events), most_count_(most_count) {}

  // False: so many are open already, or there is no memory.
  //   response  sends news to this connection until either side ends it
  bool Open(MHD_Connection* connection, Response* response);

  // Wakes the streams when there are news, and each second without. Returns when the board is
  // closed; no connection is suspended then, now and later.
  void Run();

 private:
  struct Stream {
    PageStreams& streams;
    MHD_Connection* connection;
    uint64_t seen = 0;  // number of the last news
    // Still to be sent. The first goes at once, so that the page knows that it is connected.
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
