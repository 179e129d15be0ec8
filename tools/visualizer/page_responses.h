// SPDX-License-Identifier: Apache-2.0
// Converts answers to responses of libmicrohttpd.
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
using Response = std::unique_ptr<MHD_Response, ResponseEnd>;  // nullptr if there is no memory

// Bounds the total size of the bytes that connections make the server hold. Thread-safe.
class ByteBudget {
 public:
  explicit ByteBudget(size_t most_bytes) : most_bytes_(most_bytes) {}

  // Takes bytes from the budget. Returns false, and takes none, if these bytes and those of other
  // holders would exceed the bound. A single holder may exceed the bound.
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

// Adds the header of the MIME type `type`, and headers that forbid showing the page inside another
// page, caching it, and loading anything from elsewhere.
void AddHeaders(MHD_Response* response, const char* type);

// Returns the response that sends an answer, whose body it takes over; nullptr if there is no
// memory. The body is not compressed, because compression gains nothing on one machine. It counts
// in the budget until it is sent. An answer beyond the budget becomes a refusal with 503: `answer`
// itself is changed.
Response ResponseOf(PageAnswer& answer, ByteBudget& budget);
Response ResponseOf(const PageFile& file);

}  // namespace lf
