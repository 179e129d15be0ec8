// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_streams.h"

#include <algorithm>
#include <chrono>
#include <exception>

namespace lf {
namespace {

constexpr std::chrono::milliseconds kHeartbeat(1000);
constexpr size_t kBlockBytes = 4096;

}  // namespace

bool PageStreams::Open(MHD_Connection* connection, Response* response) {
  {
    const std::lock_guard lock(mutex_);
    if (count_ >= most_count_) return false;
    ++count_;
  }
  auto stream = std::unique_ptr<Stream>(new Stream{*this, connection});
  response->reset(
      MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, kBlockBytes, Read, stream.get(), Free));
  if (!*response) {
    Free(stream.release());
    return false;
  }
  [[maybe_unused]] Stream* const kept = stream.release();  // Free() deletes it
  AddHeaders(response->get(), "text/event-stream");
  // A reverse proxy such as nginx would collect news in a buffer, and send them when it is full.
  MHD_add_response_header(response->get(), "X-Accel-Buffering", "no");
  return true;
}

void PageStreams::Run() {
  uint64_t seen = 0;
  while (!events_.is_closed()) {
    events_.WaitForNews(&seen, kHeartbeat);
    WakeAll();
  }
  WakeAll();
}

void PageStreams::WakeAll() {
  const std::lock_guard lock(mutex_);
  for (Stream* stream : suspended_) {
    stream->is_woken = true;
    MHD_resume_connection(stream->connection);
  }
  suspended_.clear();
}

ssize_t PageStreams::Read(void* stream, uint64_t /*position*/, char* text, size_t most_bytes) {
  Stream& of = *static_cast<Stream*>(stream);
  try {
    return of.streams.ReadNews(of, text, most_bytes);
  } catch (const std::exception&) {  // there is no memory for the text
    return MHD_CONTENT_READER_END_WITH_ERROR;
  }
}

ssize_t PageStreams::ReadNews(Stream& stream, char* text, size_t most_bytes) {
  // The lock prevents WakeAll() from running between the reading of the board and the suspension.
  const std::lock_guard lock(mutex_);
  if (events_.is_closed()) return MHD_CONTENT_READER_END_OF_STREAM;
  if (stream.text.empty()) {
    stream.text = events_.WaitForNews(&stream.seen, std::chrono::milliseconds(0));
    // If the page has gone, sending this text fails, and libmicrohttpd ends the stream.
    if (stream.text.empty() && stream.is_woken) stream.text = ": still here\n\n";
    stream.is_woken = false;
  }
  if (stream.text.empty()) {
    suspended_.push_back(&stream);
    MHD_suspend_connection(stream.connection);
    return 0;
  }
  const size_t count = std::min(most_bytes, stream.text.size());
  std::copy_n(stream.text.data(), count, text);
  stream.text.erase(0, count);
  return static_cast<ssize_t>(count);
}

void PageStreams::Free(void* stream) {
  const std::unique_ptr<Stream> ended(static_cast<Stream*>(stream));
  PageStreams& streams = ended->streams;
  const std::lock_guard lock(streams.mutex_);
  --streams.count_;
}

}  // namespace lf
