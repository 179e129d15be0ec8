// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/event_board.h"

namespace lf {

void EventBoard::Post(const std::string& kind, const std::string& data) {
  const std::lock_guard lock(mutex_);
  news_[kind] = {++last_number_, data};
  changed_.notify_all();
}

std::string EventBoard::WaitForNews(uint64_t* seen, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return is_closed_ || last_number_ > *seen; });
  std::string text;
  if (is_closed_) return text;
  for (const auto& [kind, news] : news_)
    if (news.number > *seen) text += "event: " + kind + "\ndata: " + news.data + "\n\n";
  *seen = last_number_;
  return text;
}

void EventBoard::Close() {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  changed_.notify_all();
}

}  // namespace lf
