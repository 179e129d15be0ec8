// SPDX-License-Identifier: Apache-2.0
// Asks a web server once for a range of bytes. Internal to this folder: remote_file.h asks again if
// that fails.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/storage/remote/remote_options.h"

namespace lf {

// Reasons for which a transfer brought less than was asked for.
enum class TransferFault {
  kNone,
  kInterrupted,  // the flag of StopRemoteReadsIf() is set
  kUnreachable,  // no connection, a connection that ended or stalled, status 408, 429 or 5xx
  kBadAnswer,    // an answer that HTTP does not allow, or that does not fit what was asked for
  kChanged,      // the file is another one than before
  kUntrusted,    // the certificate of the server, or where it redirects to
  kNotThere,     // status 404 or 410
  kRefused,      // any other status 4xx
  kBeyondEnd,    // status 416
  kNoRanges,     // the server sends whole files only
};

// Statements of a server about a file.
struct RemoteFacts {
  std::optional<uint64_t> size_bytes;
  std::string validator;  // its ETag, else its time of change; empty: it states none
};

struct TransferAnswer {
  TransferFault fault = TransferFault::kNone;
  std::string what;          // description of the answer, for messages
  double retry_after_s = 0;  // time after which the server wants to be asked again
  RemoteFacts facts;         // of the answer, if it has the status 206
};

// A connection to a server, which is kept for later transfers. For one thread.
class HttpConnection {
 public:
  // kOutput: libcurl is not installed.
  static Result<HttpConnection> Open(const std::string& url, const RemoteOptions& options);
  HttpConnection(HttpConnection&&) noexcept;
  HttpConnection& operator=(HttpConnection&&) noexcept;
  ~HttpConnection();

  // Asks for the bytes [begin, begin + count) of the file, and appends those that come to `bytes`,
  // never more than `count`, also if the transfer fails later.
  //   known      facts of earlier answers, which this answer must agree with
  //   most_s     time after which the transfer fails
  TransferAnswer Get(uint64_t begin, uint64_t count, const RemoteFacts& known, double most_s,
                     std::string* bytes);

 private:
  struct State;
  explicit HttpConnection(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
