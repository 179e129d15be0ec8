// SPDX-License-Identifier: Apache-2.0
// The HTTP server for the page. Only page_daemon, page_connection, page_responses and page_streams
// use libmicrohttpd.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "tools/visualizer/event_board.h"
#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_request.h"

#include "lf/core/result.h"

namespace lf {

// Limits what a hostile client can use: 32 kB for the headers of a request; 128 connections that
// wait for complete headers, for 5 s each; 18 MiB for the bodies of all requests together. Requests
// without the token are refused as soon as their headers are complete (page_request.h).
class PageDaemon {
 public:
  // Makes an answer. Called by several threads at the same time. May throw.
  //   name  path below the folder /TOKEN/
  using Answerer =
      std::function<PageAnswer(const RequestHead& head, std::string_view name, std::string&& body)>;

  // The daemon itself answers requests for files of the page and for "events", the stream of news
  // on `events`, which must outlive the daemon.
  PageDaemon(PageDoor door, EventBoard& events, Answerer answerer);
  ~PageDaemon();

  // Takes over the listening `socket` and closes it at the end. kOutput: the machine has no thread
  // or memory left.
  Result<void> Start(int socket);
  // Closes connections whose next request has had incomplete headers for too long. To be called now
  // and then.
  void HangUpLate();
  // Returns when the threads that make answers have ended and all connections are closed. The event
  // board must be closed before.
  void Stop();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lf
