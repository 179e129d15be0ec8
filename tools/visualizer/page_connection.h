// SPDX-License-Identifier: Apache-2.0
// A connection of libmicrohttpd, and the head of its current request.
#pragma once

#include <microhttpd.h>

#include <string_view>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_request.h"

namespace lf {

int SocketOf(MHD_Connection* connection);

// Returns the head of the current request. Throws std::bad_alloc if there is no memory for a
// header, because this header might be the one for which the request must be refused.
RequestHead HeadOf(MHD_Connection* connection, const char* path, const char* method);

// Writes a refusal to the socket, because libmicrohttpd accepts no answer while a body is read. The
// caller must then close the connection.
//   status  the status line, such as "413 Content Too Large"
void SendLast(MHD_Connection* connection, std::string_view status, const PageAnswer& refusal);

}  // namespace lf
