// SPDX-License-Identifier: Apache-2.0
// Reads the names of hosts and the origins by which browsers tell whose page sends a request.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lf {

// The host of an address, as in the header Host.
struct WebHost {
  std::string name;  // in lower case; an IPv6 address stands in brackets, as in [::1]
  int port = 0;      // 0: none is stated

  bool operator==(const WebHost&) const = default;
};

// Scheme, host and port of an address, as in the header Origin (RFC 6454). Two pages of the same
// origin may do all that the other one may.
struct WebOrigin {
  std::string scheme;  // http or https
  WebHost host;        // with a port: 80 or 443 if the text has none

  bool operator==(const WebOrigin&) const = default;
};

// Parses NAME or NAME:PORT. Returns nullopt if the text is anything else: user names, paths, spaces
// and letters beyond ASCII are not accepted (browsers send names in other scripts as xn--...).
std::optional<WebHost> ParseWebHost(std::string_view text);
// Parses http://HOST or https://HOST, with or without a port. Returns nullopt for anything else,
// such as "null", which browsers send for pages without an origin.
std::optional<WebOrigin> ParseWebOrigin(std::string_view text);
// Returns the origin as browsers write it: without a port if the port is that of the scheme.
std::string OriginText(const WebOrigin& origin);

// True if the name always leads to the machine of the browser: localhost, 127.0.0.1, or [::1]. No
// DNS server can make another site's name pass, and names such as "localhost." are not accepted.
bool IsLoopbackName(std::string_view name);

}  // namespace lf
