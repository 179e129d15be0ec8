// SPDX-License-Identifier: Apache-2.0
// Decides from the head of a request whether it is answered, before any of its body is read.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/visualizer/page_answers.h"

namespace lf {

// Largest body of a request: the text of a camera path, at most 8 MiB, and the JSON around it.
inline constexpr size_t kMostBodyBytes = size_t{9} << 20;

struct RequestHead {
  std::string method;  // such as GET
  std::string path;    // the path as it was sent, up to the first question mark
  std::vector<std::pair<std::string, std::string>> headers;
};

// The address of the page: the token is a folder, and all names that the page requests lie below
// it.
struct PageDoor {
  int port = 0;
  std::string token;
};

// Returns the refusal of a request, or nullopt if it may be answered. 403 and 405 are checked
// first.
//   403  Host is not 127.0.0.1 or localhost with our port (otherwise the DNS name of another site
//        could point to this server); the path lacks the token; the path holds "..", "\" or "%",
//        which no name of ours does; Origin or Sec-Fetch-Site name another site
//   405  the method is not GET, HEAD or POST
//   415  Content-Encoding is not "identity": compressed bodies are never accepted
//   400  GET or HEAD with a body; the length of the body is stated twice, or is no number
//   501  Transfer-Encoding is not "chunked"
//   413  Content-Length exceeds kMostBodyBytes
std::optional<PageAnswer> RefusalOf(const RequestHead& head, const PageDoor& door);

// Returns the part of the path below the token. The request must not have been refused.
std::string_view NameOf(const RequestHead& head, const PageDoor& door);

}  // namespace lf
