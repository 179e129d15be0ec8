// SPDX-License-Identifier: Apache-2.0
// Holds the news for open pages, which page_streams.h sends as server-sent events.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace lf {

// Keeps only the newest event of each kind: a slow page misses old news, and nothing accumulates.
class EventBoard {
 public:
  // Posts an event, which replaces the one of the same kind.
  //   kind  film, watch, preview, live, path or poses (doc/formats/page_data.md)
  //   data  one line of JSON
  void Post(const std::string& kind, const std::string& data);

  // Waits for events with a number above *seen. Returns the newest one of each kind as text of an
  // event stream, and sets *seen to the number of the last event. Returns "" if `patience` expires
  // first, or if the board is closed.
  std::string WaitForNews(uint64_t* seen, std::chrono::milliseconds patience);

  // Ends all waits, now and in the future.
  void Close();
  bool is_closed() const { return is_closed_; }

 private:
  struct News {
    uint64_t number;
    std::string data;
  };
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, News> news_;
  uint64_t last_number_ = 0;
  std::atomic<bool> is_closed_ = false;
};

}  // namespace lf
