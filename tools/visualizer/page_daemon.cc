// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_daemon.h"

#include <fmt/format.h>
#include <microhttpd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "tools/visualizer/answer_threads.h"
#include "tools/visualizer/page_connection.h"
#include "tools/visualizer/page_files.h"
#include "tools/visualizer/page_responses.h"
#include "tools/visualizer/page_streams.h"
#include "tools/visualizer/waiting_connections.h"

namespace lf {
namespace {

// One thread of libmicrohttpd reads and writes all connections and never blocks on one: an
// incomplete request costs a socket and 32 kB but no thread, so that hundreds of them slow nobody
// down. A few threads of our own make the answers while the connections are suspended.
constexpr unsigned kMode = MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME;
constexpr size_t kHeaderBytes = 32 << 10;
constexpr size_t kThreads = 8, kMostStreams = 16;
constexpr int kMostRequests = 96;  // largest number of requests in progress whose headers were read
constexpr size_t kMostWaiting = 128;
// Must exceed kMostRequests + kMostWaiting: at this limit libmicrohttpd accepts no more
// connections, and a new client would not even get a refusal.
constexpr unsigned kMostConnections = 256;
constexpr std::chrono::milliseconds kPatience(5000);
constexpr unsigned kSilence_s = 10;  // limit for a client that sends no more or reads nothing
constexpr size_t kMostBodiesBytes = 2 * kMostBodyBytes;
constexpr size_t kMostAnswersBytes = size_t{256} << 20;  // for comparison, the positions of a
                                                         // million LF cameras take 12 MB

// Paths are compared as they were sent: no name of ours needs unescaping.
size_t KeepEscapes(void*, MHD_Connection*, char* text) { return std::string_view(text).size(); }

struct Request {
  MHD_Connection* connection = nullptr;
  RequestHead head;
  std::string body;
  size_t body_bytes = 0;  // share of the byte budget that `body` takes
  bool is_begun = false;  // true once a thread was asked for the answer
  std::optional<PageAnswer> answer;
};

}  // namespace

struct PageDaemon::Parts {
  Parts(PageDoor page_door, EventBoard& events, Answerer page_answerer)
      : door(std::move(page_door)),
        answerer(std::move(page_answerer)),
        streams(events, kMostStreams) {}

  MHD_Result Handle(MHD_Connection* connection, const char* path, const char* method,
                    const char* bytes, size_t* byte_count, void** request);
  MHD_Result Begin(MHD_Connection* connection, const char* path, const char* method,
                   void** request);
  MHD_Result Collect(Request& request, const char* bytes, size_t byte_count);
  MHD_Result Answer(Request& request);
  void AnswerLater(Request& request);
  PageAnswer Make(Request& request);
  MHD_Result Send(MHD_Connection* connection, PageAnswer answer);
  void End(MHD_Connection* connection, void** request);

  static MHD_Result OnRequest(void* parts, MHD_Connection* connection, const char* path,
                              const char* method, const char* version, const char* bytes,
                              size_t* byte_count, void** request);
  static void OnEnd(void* parts, MHD_Connection* connection, void** request,
                    MHD_RequestTerminationCode);
  static void OnConnection(void* parts, MHD_Connection* connection, void**,
                           MHD_ConnectionNotificationCode what);

  const PageDoor door;
  const Answerer answerer;
  WaitingConnections waiting{kMostWaiting, kPatience};
  ByteBudget bodies{kMostBodiesBytes}, answers{kMostAnswersBytes};
  std::atomic<bool> is_ending = false;
  int request_count = 0;  // used only by libmicrohttpd's thread
  PageStreams streams;
  std::thread news;
  AnswerThreads threads{kThreads};
  MHD_Daemon* daemon = nullptr;
};

MHD_Result PageDaemon::Parts::Handle(MHD_Connection* connection, const char* path,
                                     const char* method, const char* bytes, size_t* byte_count,
                                     void** request) {
  if (*request == nullptr) return Begin(connection, path, method, request);
  Request& known = *static_cast<Request*>(*request);
  if (*byte_count == 0) return Answer(known);
  const MHD_Result result = Collect(known, bytes, *byte_count);
  *byte_count = 0;
  return result;
}

MHD_Result PageDaemon::Parts::Begin(MHD_Connection* connection, const char* path,
                                    const char* method, void** request) {
  waiting.Remove(SocketOf(connection));
  RequestHead head = HeadOf(connection, path, method);
  if (auto refusal = RefusalOf(head, door)) return Send(connection, *std::move(refusal));
  if (request_count >= kMostRequests)
    return Send(connection, Refusal(503, "too many requests at the same time: try again"));
  auto begun = std::make_unique<Request>();
  begun->connection = connection;
  begun->head = std::move(head);
  *request = begun.release();  // End() deletes it
  ++request_count;
  return MHD_YES;
}

// The budget counts the reserved sizes of the bodies, which grow by doubling.
MHD_Result PageDaemon::Parts::Collect(Request& request, const char* bytes, size_t byte_count) {
  const size_t needed_bytes = request.body.size() + byte_count;
  if (needed_bytes > kMostBodyBytes) {
    SendLast(request.connection, "413 Content Too Large",
             Refusal(413, fmt::format("a body may have at most {} bytes", kMostBodyBytes)));
    return MHD_NO;
  }
  if (needed_bytes > request.body_bytes) {
    const size_t wanted_bytes =
        std::min(std::max(needed_bytes, 2 * request.body_bytes), kMostBodyBytes);
    if (!bodies.Take(wanted_bytes - request.body_bytes)) {
      SendLast(request.connection, "503 Service Unavailable",
               Refusal(503, "too much data is being sent at the same time: try again"));
      return MHD_NO;
    }
    request.body_bytes = wanted_bytes;
    request.body.reserve(wanted_bytes);
  }
  request.body.append(bytes, byte_count);
  return MHD_YES;
}

MHD_Result PageDaemon::Parts::Answer(Request& request) {
  if (request.is_begun)
    return Send(request.connection,
                request.answer
                    ? *std::move(request.answer)
                    : Refusal(503, "the machine has no thread or memory left: try again later"));
  const std::string_view name = NameOf(request.head, door);
  if (request.head.method != "POST") {
    if (name == "events") {
      Response response;
      if (!streams.Open(request.connection, &response))
        return Send(request.connection, Refusal(503, "too many pages are open: close some"));
      return MHD_queue_response(request.connection, 200, response.get());
    }
    if (const PageFile* file = FindPageFile(name.empty() ? "index.html" : name)) {
      const Response response = ResponseOf(*file);
      return response ? MHD_queue_response(request.connection, 200, response.get()) : MHD_NO;
    }
  }
  AnswerLater(request);
  return MHD_YES;
}

// The connection is suspended first, because a thread may resume it before this function returns.
void PageDaemon::Parts::AnswerLater(Request& request) {
  request.is_begun = true;
  MHD_suspend_connection(request.connection);
  bool is_taken = false;
  try {
    is_taken = threads.Run([this, &request] {
      try {
        request.answer = Make(request);
      } catch (const std::exception&) {  // there is no memory, not even for a refusal
      }
      MHD_resume_connection(request.connection);
    });
  } catch (const std::exception&) {  // there is no memory to queue the task
  }
  if (!is_taken) MHD_resume_connection(request.connection);
}

PageAnswer PageDaemon::Parts::Make(Request& request) {
  if (is_ending) return Refusal(503, "lfvisualizer is ending");
  try {
    return answerer(request.head, NameOf(request.head, door), std::move(request.body));
  } catch (const std::exception& exception) {
    return Refusal(500, std::string("failed: ") + exception.what());
  } catch (...) {
    return Refusal(500, "failed");
  }
}

MHD_Result PageDaemon::Parts::Send(MHD_Connection* connection, PageAnswer answer) {
  const Response response = ResponseOf(answer, answers);
  if (!response) return MHD_NO;
  return MHD_queue_response(connection, static_cast<unsigned>(answer.status), response.get());
}

void PageDaemon::Parts::End(MHD_Connection* connection, void** request) {
  const std::unique_ptr<Request> ended(static_cast<Request*>(std::exchange(*request, nullptr)));
  if (ended) {
    --request_count;
    bodies.Return(ended->body_bytes);
  }
  // The connection waits until its next request, or until it ends (OnConnection()).
  waiting.Add(SocketOf(connection));
}

MHD_Result PageDaemon::Parts::OnRequest(void* parts, MHD_Connection* connection, const char* path,
                                        const char* method, const char* /*version*/,
                                        const char* bytes, size_t* byte_count, void** request) {
  try {
    return static_cast<Parts*>(parts)->Handle(connection, path, method, bytes, byte_count, request);
  } catch (const std::exception&) {  // no memory for this request
    return MHD_NO;
  }
}

void PageDaemon::Parts::OnEnd(void* parts, MHD_Connection* connection, void** request,
                              MHD_RequestTerminationCode) {
  static_cast<Parts*>(parts)->End(connection, request);
}

void PageDaemon::Parts::OnConnection(void* parts, MHD_Connection* connection, void**,
                                     MHD_ConnectionNotificationCode what) {
  WaitingConnections& waiting = static_cast<Parts*>(parts)->waiting;
  const int socket = SocketOf(connection);
  if (what == MHD_CONNECTION_NOTIFY_STARTED)
    waiting.Add(socket);
  else
    waiting.Remove(socket);
}

PageDaemon::PageDaemon(PageDoor door, EventBoard& events, Answerer answerer)
    : parts_(std::make_unique<Parts>(std::move(door), events, std::move(answerer))) {}
PageDaemon::~PageDaemon() = default;

Result<void> PageDaemon::Start(int socket) {
  try {
    parts_->news = std::thread([this] { parts_->streams.Run(); });
  } catch (const std::exception&) {
    return OutputError(
        "the page cannot be served, because the system starts no more threads: end other programs, "
        "or raise the limit of processes (ulimit -u)");
  }
  parts_->daemon =
      MHD_start_daemon(kMode, 0, nullptr, nullptr, Parts::OnRequest, parts_.get(),       //
                       MHD_OPTION_LISTEN_SOCKET, socket,                                 //
                       MHD_OPTION_CONNECTION_MEMORY_LIMIT, kHeaderBytes,                 //
                       MHD_OPTION_CONNECTION_LIMIT, kMostConnections,                    //
                       MHD_OPTION_CONNECTION_TIMEOUT, kSilence_s,                        //
                       MHD_OPTION_UNESCAPE_CALLBACK, KeepEscapes, nullptr,               //
                       MHD_OPTION_NOTIFY_COMPLETED, Parts::OnEnd, parts_.get(),          //
                       MHD_OPTION_NOTIFY_CONNECTION, Parts::OnConnection, parts_.get(),  //
                       MHD_OPTION_END);
  if (parts_->daemon == nullptr)
    return OutputError(
        "the page cannot be served, because the machine has no thread or memory left: end other "
        "programs");
  return {};
}

void PageDaemon::HangUpLate() { parts_->waiting.HangUpLate(); }

void PageDaemon::Stop() {
  parts_->is_ending = true;
  // libmicrohttpd must not be stopped while a connection is suspended. Each thread that makes an
  // answer resumes its connection when it ends. The connections of event streams are no longer
  // suspended after `news` has ended, which it does because the event board is closed.
  parts_->threads.Stop();
  if (parts_->news.joinable()) parts_->news.join();
  if (parts_->daemon != nullptr) MHD_stop_daemon(std::exchange(parts_->daemon, nullptr));
}

}  // namespace lf
