// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/remote_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/log.h"
#include "lf/storage/remote/store_url.h"

namespace lf {
namespace {

using Clock = std::chrono::steady_clock;

// An attempt that brings as much shows that the server works.
constexpr size_t kProgressBytes = size_t{1} << 20;
// The time of a read grows by a second for each of these bytes.
constexpr double kBytesOfOneSecond = 1e4;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Waits, unless reads are stopped.
void Wait(double seconds) {
  constexpr double kStep_s = 0.1;
  for (const Clock::time_point begin = Clock::now(); !AreRemoteReadsStopped();) {
    const double left_s = seconds - SecondsSince(begin);
    if (left_s <= 0) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left_s, kStep_s)));
  }
}

// Returns true if the same request may succeed later.
bool MayPass(TransferFault fault) {
  return fault == TransferFault::kUnreachable || fault == TransferFault::kBadAnswer ||
         fault == TransferFault::kChanged;
}

// Returns what to do about a fault.
const char* AdviceOn(TransferFault fault) {
  switch (fault) {
    case TransferFault::kUnreachable:
      return "check the network and the server, and repeat the call: what was read is kept";
    case TransferFault::kChanged:
      return "the file was replaced on the server: repeat the call";
    case TransferFault::kUntrusted:
      return "neither is trusted: check the URL; the certificate of a server must be signed by an "
             "authority that this machine knows";
    case TransferFault::kNotThere:
      return "check the URL";
    case TransferFault::kRefused:
      return "the server refuses access: check the URL and, if it is signed, whether it has "
             "expired; users and passwords are read from the file .netrc of the home folder";
    case TransferFault::kBeyondEnd:
      return "the file on the server is not complete: copy it there again";
    case TransferFault::kNoRanges:
      return "the server must send ranges of files, as nginx, Apache and S3 do; Python's "
             "http.server "
             "does not";
    default:
      return "the server, or a proxy before it, breaks the rules of HTTP";
  }
}

ErrorKind KindOf(TransferFault fault) {
  switch (fault) {
    case TransferFault::kInterrupted:
      return ErrorKind::kInterrupted;
    case TransferFault::kUnreachable:
    case TransferFault::kUntrusted:
    case TransferFault::kRefused:
      return ErrorKind::kOutput;
    default:
      return ErrorKind::kInput;
  }
}

}  // namespace

RemoteFile::RemoteFile(std::string url, const RemoteOptions& options, HttpConnection connection)
    : url_(std::move(url)), options_(options), connection_(std::move(connection)) {}

Result<RemoteFile> RemoteFile::Open(const std::string& url, const RemoteOptions& options) {
  LF_ASSIGN_OR_RETURN(HttpConnection connection, HttpConnection::Open(url, options));
  return RemoteFile(url, options, std::move(connection));
}

Error RemoteFile::Failed(uint64_t begin, uint64_t count, int attempts,
                         const TransferAnswer& answer) {
  fault_ = answer.fault;
  if (fault_ == TransferFault::kInterrupted)
    return {KindOf(fault_), fmt::format("{}: interrupted", ShownUrl(url_))};
  return {KindOf(fault_),
          fmt::format("{}: cannot be read: asked for the bytes {} to {}, got {}{}: {}",
                      ShownUrl(url_), begin, begin + count - 1, answer.what,
                      attempts > 1 ? fmt::format(" at the last of {} attempts", attempts) : "",
                      AdviceOn(fault_))};
}

Result<void> RemoteFile::Read(uint64_t begin, uint64_t count, std::string* bytes) {
  return ReadIn(begin, count, options_.most_attempts, bytes);
}

Result<void> RemoteFile::ReadIn(uint64_t begin, uint64_t count, int most_attempts,
                                std::string* bytes) {
  LF_CHECK(count >= 1);
  bytes->clear();
  fault_ = TransferFault::kNone;
  const Clock::time_point start = Clock::now();
  const double total_s = options_.total_s + static_cast<double>(count) / kBytesOfOneSecond;
  int attempts = 0, failed_in_a_row = 0;
  double wait_s = options_.first_wait_s;
  while (true) {
    const size_t before = bytes->size();
    const TransferAnswer answer = connection_.Get(begin + before, count - before, facts_,
                                                  total_s - SecondsSince(start), bytes);
    ++attempts;
    if (facts_.validator.empty() && answer.fault != TransferFault::kChanged) {
      if (answer.facts.size_bytes) facts_.size_bytes = answer.facts.size_bytes;
      facts_.validator = answer.facts.validator;
    }
    if (answer.fault == TransferFault::kNone) return {};
    if (!MayPass(answer.fault)) return Failed(begin + before, count - before, attempts, answer);
    if (bytes->size() - before >= kProgressBytes) {
      failed_in_a_row = 0;
      wait_s = options_.first_wait_s;
    }
    const double next_s = std::max(wait_s, std::min(answer.retry_after_s, options_.most_wait_s));
    if (++failed_in_a_row >= most_attempts || SecondsSince(start) + next_s >= total_s)
      return Failed(begin + bytes->size(), count - (bytes->size()), attempts, answer);
    LogDebug("{}: got {}; asks again in {:.1f} s", ShownUrl(url_), answer.what, next_s);
    Wait(next_s);
    wait_s *= 2;
  }
}

Result<RemoteFacts> RemoteFile::Facts(int most_attempts) {
  std::string first;
  LF_RETURN_IF_ERROR(ReadIn(0, 1, std::min(most_attempts, options_.most_attempts), &first));
  return facts_;
}

}  // namespace lf
