// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/web_origin.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/core/parse_number.h"

namespace lf {
namespace {

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

bool ConsistsOf(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

bool IsHostName(std::string_view name) {
  if (name.starts_with('['))
    return name.size() > 2 && name.ends_with(']') &&
           ConsistsOf(name.substr(1, name.size() - 2), "0123456789abcdef:.");
  return ConsistsOf(name, "0123456789abcdefghijklmnopqrstuvwxyz-._");
}

int UsualPort(std::string_view scheme) { return scheme == "https" ? 443 : 80; }

}  // namespace

std::optional<WebHost> ParseWebHost(std::string_view text) {
  WebHost host;
  const size_t colon = text.rfind(':');
  if (colon != std::string_view::npos && text.find(']', colon) == std::string_view::npos) {
    const std::string digits(text.substr(colon + 1));
    const std::optional<int> port =
        ConsistsOf(digits, "0123456789") ? ParseWhole<int>(digits) : std::nullopt;
    if (!port || *port < 1 || *port > 65535) return std::nullopt;
    host.port = *port;
    text = text.substr(0, colon);
  }
  host.name = LowerCase(text);
  if (!IsHostName(host.name)) return std::nullopt;
  return host;
}

std::optional<WebOrigin> ParseWebOrigin(std::string_view text) {
  const size_t end = text.find("://");
  if (end == std::string_view::npos) return std::nullopt;
  WebOrigin origin{LowerCase(text.substr(0, end)), {}};
  if (origin.scheme != "http" && origin.scheme != "https") return std::nullopt;
  const auto host = ParseWebHost(text.substr(end + 3));
  if (!host) return std::nullopt;
  origin.host = *host;
  if (origin.host.port == 0) origin.host.port = UsualPort(origin.scheme);
  return origin;
}

std::string OriginText(const WebOrigin& origin) {
  std::string text = origin.scheme + "://" + origin.host.name;
  if (origin.host.port != UsualPort(origin.scheme)) text += fmt::format(":{}", origin.host.port);
  return text;
}

bool IsLoopbackName(std::string_view name) {
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace lf
