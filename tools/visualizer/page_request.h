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
#include "tools/visualizer/web_origin.h"

namespace lf {

// Largest body of a request: the text of a camera path, at most 8 MiB, and the JSON around it.
inline constexpr size_t kMostBodyBytes = size_t{9} << 20;

struct RequestHead {
  std::string method;  // such as GET
  std::string path;    // the path as it was sent, up to the first question mark
  std::vector<std::pair<std::string, std::string>> headers;
};

// The secret and the names by which requests are answered.
struct PageDoor {
  std::string token;  // a folder of the address; all names that the page requests lie below it
  // Origins of reverse proxies, besides the pages that the server itself serves to this machine.
  std::vector<WebOrigin> allowed_origins;
};

// Returns the refusal of a request, or nullopt if it may be answered. 403 and 405 are checked
// first.
//   403  the name in Host is neither a loopback name nor that of an allowed origin (otherwise the
//        DNS name of another site could point to this server); the port does not count, because
//        forwarded ports differ from ours
//   403  the path lacks the token; the path holds "..", "\" or "%", which no name of ours does
//   403  Origin names another page (ComesFromOurPage()), or Sec-Fetch-Site another site
//   405  the method is not GET, HEAD or POST
//   415  Content-Encoding is not "identity": compressed bodies are never accepted
//   400  GET or HEAD with a body; the length of the body is stated twice, or is no number
//   501  Transfer-Encoding is not "chunked"
//   413  Content-Length exceeds kMostBodyBytes
std::optional<PageAnswer> RefusalOf(const RequestHead& head, const PageDoor& door);

// Returns the part of the path below the token. The request must not have been refused.
std::string_view NameOf(const RequestHead& head, const PageDoor& door);

}  // namespace lf
