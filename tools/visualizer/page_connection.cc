// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_connection.h"

#include <fmt/format.h>
#include <sys/socket.h>

#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace lf {
namespace {

struct Headers {
  std::vector<std::pair<std::string, std::string>> all;
  bool is_whole = true;
};

MHD_Result AddHeader(void* headers, MHD_ValueKind, const char* key, size_t key_size,
                     const char* value, size_t value_size) {
  Headers& to = *static_cast<Headers*>(headers);
  try {
    to.all.emplace_back(std::string(key, key_size),
                        value ? std::string(value, value_size) : std::string());
  } catch (const std::exception&) {  // exceptions must not reach C code
    to.is_whole = false;
  }
  return to.is_whole ? MHD_YES : MHD_NO;
}

}  // namespace

int SocketOf(MHD_Connection* connection) {
  return MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
}

RequestHead HeadOf(MHD_Connection* connection, const char* path, const char* method) {
  Headers headers;
  MHD_get_connection_values_n(connection, MHD_HEADER_KIND, AddHeader, &headers);
  if (!headers.is_whole) throw std::bad_alloc();
  return {method, path, std::move(headers.all)};
}

void SendLast(MHD_Connection* connection, std::string_view status, const PageAnswer& refusal) {
  const std::string text = fmt::format(
      "HTTP/1.1 {}\r\nConnection: close\r\nContent-Type: application/json\r\n"
      "Content-Length: {}\r\n\r\n{}",
      status, refusal.body.size(), refusal.body);
  (void)::send(SocketOf(connection), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace lf
