// Answers in the form that libmicrohttpd sends.
#pragma once

#include <microhttpd.h>

#include <atomic>
#include <cstddef>
#include <memory>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_files.h"

namespace lf {

struct ResponseEnd {
  void operator()(MHD_Response* response) const { MHD_destroy_response(response); }
};
using Response = std::unique_ptr<MHD_Response, ResponseEnd>;  // null: no memory

// Bounds the bytes that all connections together make the server hold. Thread-safe.
class ByteBudget {
 public:
  explicit ByteBudget(size_t most_bytes) : most_bytes_(most_bytes) {}

  // False if others hold so much that these would exceed the bound. One holder alone may exceed it.
  bool Take(size_t bytes) {
    const size_t held_before = held_bytes_.fetch_add(bytes);
    if (held_before == 0 || held_before + bytes <= most_bytes_) return true;
    held_bytes_ -= bytes;
    return false;
  }
  void Return(size_t bytes) { held_bytes_ -= bytes; }

 private:
  const size_t most_bytes_;
  std::atomic<size_t> held_bytes_ = 0;
};

// The page must not be shown inside another, must not be cached, and loads nothing from elsewhere.
void AddHeaders(MHD_Response* response, const char* type);

// The body is sent as it is: a browser would gain nothing from compression on one machine. It
// counts in the budget until it is sent; an answer that does not fit becomes a refusal with 503.
Response ResponseOf(PageAnswer& answer, ByteBudget& budget);
Response ResponseOf(const PageFile& file);

}  // namespace lf
