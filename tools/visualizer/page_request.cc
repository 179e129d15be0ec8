// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace lf {
namespace {

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool IsSameWord(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return Lower(x) == Lower(y); });
}

// Returns the values of all headers of this name: a header may occur twice, and each must be valid.
std::vector<std::string_view> ValuesOf(const RequestHead& head, std::string_view name) {
  std::vector<std::string_view> values;
  for (const auto& [key, value] : head.headers)
    if (IsSameWord(key, name)) values.push_back(value);
  return values;
}

// Returns true if the texts are equal, after a time that does not depend on where they differ.
bool AreEqual(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  return difference == 0;
}

// Returns a header's value for a message: what is not printable is left out, and the end of long
// values.
std::string Quoted(std::string_view value) {
  constexpr size_t kMostLetters = 100;
  std::string text;
  for (const char c : value.substr(0, kMostLetters))
    if (c > ' ' && c <= '~' && c != '{' && c != '}') text += c;  // braces name options
  return '"' + text + (value.size() > kMostLetters ? "...\"" : "\"");
}

bool IsAllowed(const WebOrigin& origin, const PageDoor& door) {
  return std::find(door.allowed_origins.begin(), door.allowed_origins.end(), origin) !=
         door.allowed_origins.end();
}

// Returns the origins of the pages that may send a request to this host.
std::string ExpectedOrigins(const WebHost& host, const PageDoor& door) {
  std::vector<std::string> texts;
  if (IsLoopbackName(host.name))
    texts.push_back(OriginText({"http", {host.name, host.port == 0 ? 80 : host.port}}));
  for (const WebOrigin& origin : door.allowed_origins) texts.push_back(OriginText(origin));
  return fmt::format("{}", fmt::join(texts, " or "));
}

bool IsOurHost(const WebHost& host, const PageDoor& door) {
  return IsLoopbackName(host.name) ||
         std::any_of(door.allowed_origins.begin(), door.allowed_origins.end(),
                     [&](const WebOrigin& origin) { return origin.host.name == host.name; });
}

std::optional<PageAnswer> RefusalOfHost(const std::vector<std::string_view>& hosts,
                                        const PageDoor& door) {
  if (hosts.size() != 1)
    return Refusal(403, fmt::format("the request has {} headers Host: expected one", hosts.size()));
  const auto host = ParseWebHost(hosts[0]);
  if (host && IsOurHost(*host, door)) return std::nullopt;
  std::string names = "127.0.0.1 or localhost, with any port";
  for (const WebOrigin& origin : door.allowed_origins) names += ", or " + OriginText(origin);
  const std::string advice =
      host ? fmt::format(
                 "; if this is your reverse proxy, start lfvisualizer with the address that the "
                 "browser shows, up to the host and port, such as --allow-origin https://{}{}",
                 host->name, host->port ? fmt::format(":{}", host->port) : "")
           : "";
  return Refusal(403, fmt::format("the page is not served to the host {}: open it at {}{}",
                                  Quoted(hosts[0]), names, advice));
}

// Returns true if a page of ours sent a request with this Origin, which browsers state for each
// POST. Other local web servers have loopback names like ours, so the name is not enough:
//   - the page has the host and port of the request, as the browser sees them; or
//   - it is that of an allowed proxy; or
//   - it has a loopback name, and Sec-Fetch-Site, which only browsers set, says that the page and
//     the address of the request have the same origin. A proxy on this machine that replaces Host,
//     as nginx does by default, is recognised by this.
bool ComesFromOurPage(const WebOrigin& origin, const WebHost& host, bool is_same_origin,
                      const PageDoor& door) {
  if (IsAllowed(origin, door)) return true;
  if (!IsLoopbackName(origin.host.name)) return false;
  return is_same_origin ||
         origin == WebOrigin{"http", {host.name, host.port == 0 ? 80 : host.port}};
}

// Refuses requests that a browser sent for another page, which Origin or Sec-Fetch-Site then state.
// Programs other than browsers send neither of these headers.
std::optional<PageAnswer> RefusalOfPage(const RequestHead& head, const WebHost& host,
                                        const PageDoor& door) {
  const auto sites = ValuesOf(head, "Sec-Fetch-Site");
  const bool is_same_origin = sites.size() == 1 && sites[0] == "same-origin";
  for (const std::string_view text : ValuesOf(head, "Origin")) {
    const auto origin = ParseWebOrigin(text);
    if (origin && ComesFromOurPage(*origin, host, is_same_origin, door)) continue;
    const std::string advice = origin
                                   ? fmt::format(
                                         "; if this is your reverse proxy, start lfvisualizer with "
                                         "--allow-origin {}",
                                         OriginText(*origin))
                                   : "";
    return Refusal(403,
                   fmt::format("a page of the origin {} may not use lfvisualizer: expected {}{}",
                               Quoted(text), ExpectedOrigins(host, door), advice));
  }
  const bool is_ours = std::all_of(sites.begin(), sites.end(), [](std::string_view site) {
    return site == "same-origin" || site == "none";  // none: typed or pasted by the user
  });
  if (is_ours) return std::nullopt;
  return Refusal(403,
                 "another site requests this: paste the address into the browser's address bar");
}

bool HasToken(std::string_view path, const std::string& token) {
  return path.size() >= token.size() + 2 && path[0] == '/' && path[token.size() + 1] == '/' &&
         AreEqual(path.substr(1, token.size()), token);
}

std::optional<PageAnswer> RefusalOfBody(const RequestHead& head) {
  for (const std::string_view coding : ValuesOf(head, "Content-Encoding"))
    if (!IsSameWord(coding, "identity"))
      return Refusal(415, "send the body without Content-Encoding");
  const auto codings = ValuesOf(head, "Transfer-Encoding");
  const auto lengths = ValuesOf(head, "Content-Length");
  if (codings.size() + lengths.size() > 1)
    return Refusal(400, "the length of the body is stated more than once");
  if (!codings.empty()) {
    if (!IsSameWord(codings[0], "chunked"))
      return Refusal(501, "the only supported Transfer-Encoding is chunked");
    if (head.method != "POST") return Refusal(400, "only POST may have a body");
  }
  if (lengths.empty()) return std::nullopt;
  size_t length = 0;
  const char* end = lengths[0].data() + lengths[0].size();
  const auto [rest, error] = std::from_chars(lengths[0].data(), end, length);
  if (rest != end || lengths[0].empty() || error == std::errc::invalid_argument)
    return Refusal(400, "Content-Length is no number");
  if (error != std::errc() || length > kMostBodyBytes)
    return Refusal(413, fmt::format("a body may have at most {} bytes", kMostBodyBytes));
  if (length > 0 && head.method != "POST") return Refusal(400, "only POST may have a body");
  return std::nullopt;
}

}  // namespace

std::optional<PageAnswer> RefusalOf(const RequestHead& head, const PageDoor& door) {
  const auto hosts = ValuesOf(head, "Host");
  if (auto refusal = RefusalOfHost(hosts, door)) return refusal;
  if (!HasToken(head.path, door.token))
    return Refusal(403,
                   "the address has no token, or a wrong one: open the one that lfvisualizer "
                   "has printed");
  if (head.path.find("..") != std::string::npos ||
      head.path.find_first_of(std::string_view("\\%\0", 3)) != std::string::npos)
    return Refusal(403, "nothing outside of the page is served");
  if (auto refusal = RefusalOfPage(head, *ParseWebHost(hosts[0]), door)) return refusal;
  if (head.method != "GET" && head.method != "HEAD" && head.method != "POST")
    return Refusal(405, "only GET, HEAD and POST are answered");
  return RefusalOfBody(head);
}

std::string_view NameOf(const RequestHead& head, const PageDoor& door) {
  return std::string_view(head.path).substr(door.token.size() + 2);
}

}  // namespace lf
