// A connection of libmicrohttpd, and the request that is being made on it.
#pragma once

#include <microhttpd.h>

#include <string_view>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_request.h"

namespace lf {

int SocketOf(MHD_Connection* connection);

// Throws std::bad_alloc: a header that is not seen might be the one that refuses the request.
RequestHead HeadOf(MHD_Connection* connection, const char* path, const char* method);

// Writes a refusal past libmicrohttpd, which takes answers only before or after a body, while a
// body is read. The connection must be closed then.
//   status  413 Content Too Large
void SendLast(MHD_Connection* connection, std::string_view status, const PageAnswer& refusal);

}  // namespace lf
