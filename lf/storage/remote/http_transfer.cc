// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/http_transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/storage/remote/curl_library.h"
#include "lf/storage/remote/store_url.h"

namespace lf {
namespace {

std::atomic<const std::atomic<bool>*> stop_flag = nullptr;

}  // namespace

void StopRemoteReadsIf(const std::atomic<bool>* flag) { stop_flag = flag; }

bool AreRemoteReadsStopped() {
  const std::atomic<bool>* const flag = stop_flag;
  return flag != nullptr && *flag;
}

#ifdef LF_CURL_LIBRARY_NAME
Result<const CurlCalls*> Curl() {
  static const CurlCalls* const calls = []() -> const CurlCalls* {
    for (const char* const name : {LF_CURL_LIBRARY_NAME, "libcurl.so.4", "libcurl-gnutls.so.4"}) {
      // Stays loaded until the program ends, like the threads that may use it.
      const auto* const found = new CurlCalls{.library = LoadedLibrary(name)};
      if (found->library.has_all() && found->curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK)
        return found;
      delete found;
    }
    return nullptr;
  }();
  if (calls == nullptr)
    return OutputError(
        "light fields on web servers are read by libcurl, which is not installed: install the "
        "package libcurl4 (on Fedora libcurl)");
  return calls;
}

namespace {

constexpr size_t kMostHeaderBytes = 64 << 10;
constexpr long kLeastBytesPerSecond = 100;
constexpr long kMostRedirects = 5;

constexpr long kPartialContent = 206;

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// Returns the value of a header line if it has this name, in small letters.
std::optional<std::string_view> ValueOf(std::string_view line, std::string_view name) {
  const size_t colon = line.find(':');
  if (colon != name.size()) return std::nullopt;
  for (size_t i = 0; i < colon; ++i)
    if (std::tolower(static_cast<unsigned char>(line[i])) != name[i]) return std::nullopt;
  return Trimmed(line.substr(colon + 1));
}

// Returns a text of a server for a message.
std::string Quoted(std::string_view text) {
  constexpr size_t kMostShown = 100;
  return fmt::format("'{}'", OneLine(text.substr(0, kMostShown)));
}

// The headers of one answer.
struct Headers {
  std::string content_range, etag, last_modified, encoding;
  double retry_after_s = 0;
};

// One transfer, as libcurl's callbacks see it.
struct Transfer {
  const CurlCalls* calls;
  CURL* handle;
  uint64_t begin, count;
  const RemoteFacts& known;
  std::string* bytes;
  uint64_t got = 0;
  size_t header_bytes = 0;
  bool is_judged = false;
  Headers headers = {};
  TransferAnswer answer = {};

  bool Fail(TransferFault fault, std::string what) {
    if (answer.fault == TransferFault::kNone) answer.fault = fault, answer.what = std::move(what);
    return false;
  }

  long Status() const {
    long status = 0;
    calls->curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &status);
    return status;
  }

  bool TakeHeader(std::string_view line) {
    header_bytes += line.size();
    if (header_bytes > kMostHeaderBytes)
      return Fail(TransferFault::kBadAnswer, "headers of more than 64 KiB");
    if (line.starts_with("HTTP/")) headers = {};  // of the answer to which a redirection has led
    if (const auto range = ValueOf(line, "content-range")) headers.content_range = *range;
    if (const auto etag = ValueOf(line, "etag")) headers.etag = *etag;
    if (const auto time = ValueOf(line, "last-modified")) headers.last_modified = *time;
    if (const auto encoding = ValueOf(line, "content-encoding")) headers.encoding = *encoding;
    if (const auto text = ValueOf(line, "retry-after"))
      if (const std::optional<double> seconds = ParseNumber(std::string(*text));
          seconds && *seconds > 0)
        headers.retry_after_s = *seconds;
    return true;
  }

  // Judges status and headers. Returns true if the body is a part of what was asked for.
  bool Judge() {
    if (is_judged) return answer.fault == TransferFault::kNone;
    is_judged = true;
    const long status = Status();
    answer.retry_after_s = headers.retry_after_s;
    if (status == kPartialContent) return JudgeRange();
    const std::string what = fmt::format("status {}", status);
    if (status == 200)
      return Fail(TransferFault::kNoRanges, "the whole file (status 200) instead of a range");
    if (status == 404 || status == 410) return Fail(TransferFault::kNotThere, what);
    if (status == 416) return Fail(TransferFault::kBeyondEnd, what);
    if (status == 408 || status == 429 || status >= 500)
      return Fail(TransferFault::kUnreachable, what);
    return Fail(status >= 400 ? TransferFault::kRefused : TransferFault::kBadAnswer, what);
  }

  bool JudgeRange() {
    if (!headers.encoding.empty() && headers.encoding != "identity")
      return Fail(
          TransferFault::kBadAnswer,
          fmt::format("the encoding {}, although none was asked for", Quoted(headers.encoding)));
    const std::optional<ContentRange> range = ParseContentRange(headers.content_range);
    const auto bad_range = [&] {
      return Fail(TransferFault::kBadAnswer,
                  fmt::format("the Content-Range {}", Quoted(headers.content_range)));
    };
    if (!range || range->begin != begin || range->end > begin + count) return bad_range();
    if (range->end < begin + count && range->size == range->end)
      return Fail(TransferFault::kBeyondEnd, fmt::format("a file of only {} bytes", *range->size));
    answer.facts.size_bytes = range->size;
    answer.facts.validator = headers.etag.empty() ? headers.last_modified : headers.etag;
    const bool has_other_size =
        known.size_bytes && range->size && *range->size != *known.size_bytes;
    if (has_other_size)
      return Fail(TransferFault::kChanged,
                  fmt::format("a file of {} bytes instead of {}", *range->size, *known.size_bytes));
    if (!known.validator.empty() && answer.facts.validator != known.validator)
      return Fail(TransferFault::kChanged,
                  fmt::format("a file with the ETag or time of change {} instead of {}",
                              Quoted(answer.facts.validator), Quoted(known.validator)));
    return true;
  }

  bool TakeBody(std::string_view part) {
    if (!Judge()) return false;
    if (part.size() > count - got)
      return Fail(TransferFault::kBadAnswer, "more bytes than asked for");
    bytes->append(part);
    got += part.size();
    return true;
  }

  static size_t OnHeader(char* text, size_t size, size_t count, void* transfer) {
    return static_cast<Transfer*>(transfer)->TakeHeader({text, size * count}) ? size * count : 0;
  }
  static size_t OnBody(char* text, size_t size, size_t count, void* transfer) {
    return static_cast<Transfer*>(transfer)->TakeBody({text, size * count}) ? size * count : 0;
  }
  static int OnProgress(void*, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
    return AreRemoteReadsStopped() ? 1 : 0;
  }
};

TransferFault FaultOf(CURLcode code) {
  switch (code) {
    case CURLE_PEER_FAILED_VERIFICATION:
    case CURLE_SSL_CACERT_BADFILE:
    case CURLE_SSL_ISSUER_ERROR:
    case CURLE_TOO_MANY_REDIRECTS:
    case CURLE_UNSUPPORTED_PROTOCOL:
      return TransferFault::kUntrusted;
    case CURLE_URL_MALFORMAT:
      return TransferFault::kRefused;
    case CURLE_FILESIZE_EXCEEDED:
    case CURLE_WEIRD_SERVER_REPLY:
    case CURLE_BAD_CONTENT_ENCODING:
      return TransferFault::kBadAnswer;
    default:
      return TransferFault::kUnreachable;
  }
}

}  // namespace

struct HttpConnection::State {
  const CurlCalls* calls = nullptr;
  CURL* handle = nullptr;
  curl_slist* headers = nullptr;
  std::array<char, CURL_ERROR_SIZE> error_text = {};

  explicit State(const CurlCalls* of_library) : calls(of_library) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    calls->curl_easy_cleanup(handle);
    calls->curl_slist_free_all(headers);
  }
};

HttpConnection::HttpConnection(std::unique_ptr<State> state) : state_(std::move(state)) {}
HttpConnection::HttpConnection(HttpConnection&&) noexcept = default;
HttpConnection& HttpConnection::operator=(HttpConnection&&) noexcept = default;
HttpConnection::~HttpConnection() = default;

Result<HttpConnection> HttpConnection::Open(const std::string& url, const RemoteOptions& options) {
  LF_ASSIGN_OR_RETURN(const CurlCalls* const calls, Curl());
  auto state = std::make_unique<State>(calls);
  state->handle = calls->curl_easy_init();
  // Nobody may compress the bytes on their way.
  state->headers = calls->curl_slist_append(nullptr, "Accept-Encoding: identity");
  if (state->handle == nullptr || state->headers == nullptr)
    return OutputError(fmt::format("{}: libcurl cannot be used: no memory", ShownUrl(url)));
  bool is_set = true;
  const auto set = [&](CURLoption option, auto value) {
    is_set &= calls->curl_easy_setopt(state->handle, option, value) == CURLE_OK;
  };
  const auto milliseconds = [](double seconds) {
    return static_cast<long>(std::clamp(seconds * 1000, 1.0, 1e9));
  };
  const bool is_https = (url.size() > 4) && (url[4] == 's' || url[4] == 'S');
  set(CURLOPT_URL, url.c_str());
  set(CURLOPT_PROTOCOLS_STR, "http,https");
  set(CURLOPT_REDIR_PROTOCOLS_STR, is_https ? "https" : "http,https");
  set(CURLOPT_FOLLOWLOCATION, 1L);
  set(CURLOPT_MAXREDIRS, kMostRedirects);
  set(CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
  set(CURLOPT_HTTPHEADER, state->headers);
  set(CURLOPT_USERAGENT, "lfrendertools");
  set(CURLOPT_NETRC, static_cast<long>(CURL_NETRC_OPTIONAL));
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_CONNECTTIMEOUT_MS, milliseconds(options.connect_s));
  set(CURLOPT_LOW_SPEED_LIMIT, kLeastBytesPerSecond);
  set(CURLOPT_LOW_SPEED_TIME, std::max(1L, std::lround(options.stall_s)));
  set(CURLOPT_ERRORBUFFER, state->error_text.data());
  set(CURLOPT_HEADERFUNCTION, &Transfer::OnHeader);
  set(CURLOPT_WRITEFUNCTION, &Transfer::OnBody);
  set(CURLOPT_XFERINFOFUNCTION, &Transfer::OnProgress);
  set(CURLOPT_NOPROGRESS, 0L);
  if (!is_set)
    return OutputError(
        fmt::format("{}: libcurl is too old: expected version 7.85 or later", ShownUrl(url)));
  return HttpConnection(std::move(state));
}

TransferAnswer HttpConnection::Get(uint64_t begin, uint64_t count, const RemoteFacts& known,
                                   double most_s, std::string* bytes) {
  const CurlCalls& calls = *state_->calls;
  CURL* const handle = state_->handle;
  Transfer transfer{.calls = &calls,
                    .handle = handle,
                    .begin = begin,
                    .count = count,
                    .known = known,
                    .bytes = bytes};
  const std::string range = fmt::format("{}-{}", begin, begin + count - 1);
  calls.curl_easy_setopt(handle, CURLOPT_RANGE, range.c_str());
  calls.curl_easy_setopt(handle, CURLOPT_TIMEOUT_MS,
                         static_cast<long>(std::clamp(most_s * 1000, 1.0, 1e9)));
  calls.curl_easy_setopt(handle, CURLOPT_HEADERDATA, &transfer);
  calls.curl_easy_setopt(handle, CURLOPT_WRITEDATA, &transfer);
  state_->error_text[0] = '\0';
  const CURLcode code = calls.curl_easy_perform(handle);
  if (AreRemoteReadsStopped()) {
    transfer.Fail(TransferFault::kInterrupted, "interrupted");
  } else if (code == CURLE_OK || code == CURLE_WRITE_ERROR) {
    if (transfer.answer.fault == TransferFault::kNone && transfer.Judge() && transfer.got < count)
      transfer.Fail(TransferFault::kUnreachable,
                    fmt::format("{} bytes of {}", transfer.got, count));
  } else {
    const std::string why =
        state_->error_text[0] != '\0' ? state_->error_text.data() : calls.curl_easy_strerror(code);
    transfer.Fail(FaultOf(code), fmt::format("{} bytes, then: {}", transfer.got, OneLine(why)));
  }
  return std::move(transfer.answer);
}

#else

struct HttpConnection::State {};
HttpConnection::HttpConnection(std::unique_ptr<State> state) : state_(std::move(state)) {}
HttpConnection::HttpConnection(HttpConnection&&) noexcept = default;
HttpConnection& HttpConnection::operator=(HttpConnection&&) noexcept = default;
HttpConnection::~HttpConnection() = default;

Result<HttpConnection> HttpConnection::Open(const std::string& url, const RemoteOptions&) {
  return UsageError(fmt::format(
      "{}: this build reads no light fields on web servers: it was made without libcurl",
      ShownUrl(url)));
}

TransferAnswer HttpConnection::Get(uint64_t, uint64_t, const RemoteFacts&, double, std::string*) {
  return {};
}

#endif

}  // namespace lf
