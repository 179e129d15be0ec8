// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_port.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace lf {
namespace {

bool Listen(int socket, int port) {
  const int yes = 1;  // allows the port of a server that has just ended; SO_REUSEPORT would allow
                      // sharing it with another program
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 &&
         ::listen(socket, SOMAXCONN) == 0;
}

}  // namespace

Result<PagePort> ListenOnThisMachine(int port) {
  PagePort opened;
  opened.socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_in address = {};
  socklen_t size = sizeof(address);
  if (opened.socket < 0 || !Listen(opened.socket, port) ||
      ::getsockname(opened.socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    if (opened.socket >= 0) ::close(opened.socket);
    return OutputError(
        fmt::format("--serve {}: the port cannot be opened, perhaps because another program uses "
                    "it: give another port, or --serve 0 for any free port",
                    port));
  }
  opened.port = ntohs(address.sin_port);
  return opened;
}

}  // namespace lf
