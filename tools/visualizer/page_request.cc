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

bool IsOurHost(std::string_view host, int port) {
  return host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port);
}

// Returns false if a browser sent the request for another page, which Origin or Sec-Fetch-Site then
// states. Programs other than browsers send neither of these headers.
bool ComesFromOurPage(const RequestHead& head, int port) {
  constexpr std::string_view kScheme = "http://";
  for (const std::string_view origin : ValuesOf(head, "Origin"))
    if (!origin.starts_with(kScheme) || !IsOurHost(origin.substr(kScheme.size()), port))
      return false;
  const auto sites = ValuesOf(head, "Sec-Fetch-Site");
  return std::all_of(sites.begin(), sites.end(), [](std::string_view site) {
    return site == "same-origin" || site == "none";  // none: typed or pasted by the user
  });
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
  if (hosts.size() != 1 || !IsOurHost(hosts[0], door.port))
    return Refusal(403, "this address is not served");
  if (!HasToken(head.path, door.token))
    return Refusal(403,
                   "the address has no token, or a wrong one: open the one that lfvisualizer "
                   "has printed");
  if (head.path.find("..") != std::string::npos ||
      head.path.find_first_of(std::string_view("\\%\0", 3)) != std::string::npos)
    return Refusal(403, "nothing outside of the page is served");
  if (!ComesFromOurPage(head, door.port))
    return Refusal(403,
                   "another site requests this: paste the address into the browser's address bar");
  if (head.method != "GET" && head.method != "HEAD" && head.method != "POST")
    return Refusal(405, "only GET, HEAD and POST are answered");
  return RefusalOfBody(head);
}

std::string_view NameOf(const RequestHead& head, const PageDoor& door) {
  return std::string_view(head.path).substr(door.token.size() + 2);
}

}  // namespace lf
