// HTTP between the page and the program: the only place with libmicrohttpd, together with
// page_connection, page_responses and page_streams.
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

// A hostile client takes no more than this: headers of a request 32 kB, connections without a whole
// request 128, each for 5 s, bodies of all requests together 18 MiB. Only requests with the token
// get past their headers (page_request.h).
class PageDaemon {
 public:
  // Called by several threads at once. May throw.
  //   name  below the token's folder
  using Answerer =
      std::function<PageAnswer(const RequestHead& head, std::string_view name, std::string&& body)>;

  // The files of the page and "events", the stream of news, are answered without the answerer.
  PageDaemon(PageDoor door, EventBoard& events, Answerer answerer);
  ~PageDaemon();

  // kOutput: the machine has no thread or memory left.
  //   socket  listens; it is closed in the end
  Result<void> Start(int socket);
  // Hangs up on connections that send no request for too long. To be called now and then.
  void HangUpLate();
  // Returns when what is being answered is. Events must be closed.
  void Stop();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lf
