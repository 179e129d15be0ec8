// News for the pages that are open: server-sent events.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace lf {

// Holds the newest of each kind alone: a page that is slow misses old news, and nothing piles up.
class EventBoard {
 public:
  //   data  one line of JSON
  void Post(const std::string& kind, const std::string& data);

  // What is newer than `seen` as text of an event stream, which `seen` then is; "" after patience
  // or when closed.
  std::string WaitForNews(uint64_t* seen, std::chrono::milliseconds patience);

  // All who wait return, now and later.
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
