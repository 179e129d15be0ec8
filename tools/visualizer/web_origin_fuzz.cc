// SPDX-License-Identifier: Apache-2.0
// Sends requests with any Host, Origin and Sec-Fetch-Site to a server that allows one proxy. The
// input is these headers, one a line; an empty line leaves the header out. Only the page itself and
// the proxy's page may be answered.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tools/visualizer/page_request.h"
#include "tools/visualizer/web_origin.h"

#include "lf/core/check.h"

namespace {

constexpr std::string_view kProxy = "https://fields.example";

void CheckOrigin(std::string_view text) {
  const auto origin = lf::ParseWebOrigin(text);
  if (!origin) return;
  LF_CHECK(origin->host.port >= 1 && origin->host.port <= 65535);
  LF_CHECK(origin->host.name.find_first_of("/@?#\\ %") == std::string::npos);
  LF_CHECK(lf::ParseWebOrigin(lf::OriginText(*origin)) == origin);
}

// The request is not refused: its host and its origin must be ours.
void CheckAnswered(std::string_view host_text, std::string_view origin_text) {
  const auto host = lf::ParseWebHost(host_text);
  LF_CHECK(host && (lf::IsLoopbackName(host->name) || host->name == "fields.example"));
  if (origin_text.empty()) return;
  const auto origin = lf::ParseWebOrigin(origin_text);
  LF_CHECK(origin && (lf::IsLoopbackName(origin->host.name) || lf::OriginText(*origin) == kProxy));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  std::array<std::string_view, 3> lines;  // Host, Origin, Sec-Fetch-Site
  for (std::string_view& line : lines) {
    const size_t end = std::min(text.find('\n'), text.size());
    line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    CheckOrigin(line);
  }
  const lf::PageDoor door = {std::string(32, 'a'), {*lf::ParseWebOrigin(kProxy)}};
  lf::RequestHead head = {"POST", "/" + door.token + "/save", {{"Host", std::string(lines[0])}}};
  if (!lines[1].empty()) head.headers.emplace_back("Origin", lines[1]);
  if (!lines[2].empty()) head.headers.emplace_back("Sec-Fetch-Site", lines[2]);
  const auto refusal = lf::RefusalOf(head, door);
  if (refusal)
    LF_CHECK(refusal->status == 403 && nlohmann::json::accept(refusal->body));
  else
    CheckAnswered(lines[0], lines[1]);
  return 0;
}
