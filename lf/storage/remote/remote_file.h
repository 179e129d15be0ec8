// SPDX-License-Identifier: Apache-2.0
// Reads ranges of bytes of a file on a web server (doc/remote_stores.md).
//
// Redirections are followed at most 5 times, to http and https, and from https to https only.
// Certificates are checked, and nothing switches that off. Proxies are taken from the environment
// (https_proxy), users and passwords from the file .netrc of the home folder. Whatever a server
// sends, a read holds the bytes that were asked for and less than 1 MiB in memory, and ends within
// the times of RemoteOptions.
#pragma once

#include <climits>
#include <cstdint>
#include <string>

#include "lf/core/result.h"
#include "lf/storage/remote/http_transfer.h"
#include "lf/storage/remote/remote_options.h"

namespace lf {

// For one thread. Keeps its connection between reads.
class RemoteFile {
 public:
  // Asks nothing of the server yet. kUsage: the build has no libcurl. kOutput: libcurl is not
  // installed.
  static Result<RemoteFile> Open(const std::string& url, const RemoteOptions& options = {});

  // Reads the bytes [begin, begin + count); `count` must be at least 1. A transfer that fails is
  // begun again where it ended. kInterrupted: StopRemoteReadsIf(). kOutput: the server cannot be
  // reached, refuses access or fails, so that any other read would fail in the same way. kInput:
  // the file is not there, ends before the range, or was changed since the first read; the server
  // does not send ranges, or sends something else than was asked for. Messages name the URL, the
  // range, what came, and what to do. After an error, `bytes` is what came before it.
  Result<void> Read(uint64_t begin, uint64_t count, std::string* bytes);

  // Returns what the server states about the file, by reading its first byte. Errors as Read().
  //   most_attempts  replaces RemoteOptions::most_attempts, if it is smaller
  Result<RemoteFacts> Facts(int most_attempts = INT_MAX);

  // Returns why the last call failed; kNone: it did not.
  TransferFault fault() const { return fault_; }
  const std::string& url() const { return url_; }

 private:
  RemoteFile(std::string url, const RemoteOptions& options, HttpConnection connection);
  Result<void> ReadIn(uint64_t begin, uint64_t count, int most_attempts, std::string* bytes);
  Error Failed(uint64_t begin, uint64_t count, int attempts, const TransferAnswer& answer);

  std::string url_;
  RemoteOptions options_;
  HttpConnection connection_;
  RemoteFacts facts_;  // of the first answer
  TransferFault fault_ = TransferFault::kNone;
};

}  // namespace lf
