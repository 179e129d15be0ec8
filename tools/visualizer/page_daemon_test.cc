// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_daemon.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tools/visualizer/page_port.h"

namespace lf {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";

// A running daemon with the answerer and the event board of a test.
class Daemon {
 public:
  explicit Daemon(PageDaemon::Answerer answerer) {
    const auto listening = ListenOnThisMachine(0);
    EXPECT_TRUE(listening);
    port_ = listening->port;
    daemon_ = std::make_unique<PageDaemon>(PageDoor{kToken, {}}, events, std::move(answerer));
    EXPECT_TRUE(daemon_->Start(listening->socket));
  }
  ~Daemon() { Stop(); }

  void Stop() {
    events.Close();
    daemon_->Stop();
  }
  int port() const { return port_; }

  EventBoard events;

 private:
  int port_ = 0;
  std::unique_ptr<PageDaemon> daemon_;
};

// A connection on which one request has been sent.
class Request {
 public:
  Request(const Daemon& daemon, const std::string& method, const std::string& name,
          const std::string& version = "HTTP/1.1") {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(daemon.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    const std::string text =
        method + " /" + kToken + "/" + name + " " + version +
        "\r\nConnection: close\r\nHost: 127.0.0.1:" + std::to_string(daemon.port()) + "\r\n\r\n";
    EXPECT_EQ(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  ~Request() { ::close(socket_); }
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  // Waits until the received text contains `words` (if they are empty, until the connection ends),
  // and returns that text.
  const std::string& Until(const std::string& words) {
    char bytes[4096];
    while (words.empty() || received_.find(words) == std::string::npos) {
      const ssize_t count = ::recv(socket_, bytes, sizeof(bytes), 0);
      if (count <= 0) {
        EXPECT_TRUE(words.empty()) << received_;
        break;
      }
      received_.append(bytes, static_cast<size_t>(count));
    }
    return received_;
  }
  const std::string& Whole() { return Until(""); }

 private:
  int socket_ = -1;
  std::string received_;
};

PageAnswer Echo(const RequestHead& head, std::string_view name, std::string&& body) {
  return {200, "text/plain", head.method + " " + std::string(name) + " " + body};
}

TEST(PageDaemon, AnswersHaveTheNameAndHeadersThatKeepOthersOut) {
  Daemon daemon(Echo);
  const std::string answer = Request(daemon, "GET", "path/1.json").Whole();
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200 ")) << answer;
  EXPECT_TRUE(answer.ends_with("\r\n\r\nGET path/1.json ")) << answer;
  for (const char* header :
       {"Content-Type: text/plain", "Cache-Control: no-store", "Referrer-Policy: no-referrer",
        "X-Content-Type-Options: nosniff", "frame-ancestors 'none'"})
    EXPECT_NE(answer.find(header), std::string::npos) << header << "\n" << answer;
}

TEST(PageDaemon, HeadIsGetWithoutTheBody) {
  Daemon daemon(Echo);
  const std::string answer = Request(daemon, "HEAD", "x").Whole();
  EXPECT_NE(answer.find("Content-Length: 7\r\n"), std::string::npos) << answer;
  EXPECT_TRUE(answer.ends_with("\r\n\r\n")) << answer;
}

TEST(PageDaemon, AnExceptionIsAnAnswer) {
  Daemon daemon([](const RequestHead&, std::string_view, std::string&&) -> PageAnswer {
    throw std::runtime_error("no such luck");
  });
  const std::string answer = Request(daemon, "GET", "x").Whole();
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 500 ")) << answer;
  EXPECT_NE(answer.find("failed: no such luck"), std::string::npos) << answer;
}

TEST(PageDaemon, SlowAnswersHoldUpNeitherOthersNorTheEnd) {
  std::mutex mutex;
  std::condition_variable changed;
  bool may_end = false;
  int slow_count = 0;
  Daemon daemon([&](const RequestHead& head, std::string_view name, std::string&& body) {
    if (name == "slow") {
      std::unique_lock lock(mutex);
      ++slow_count;
      changed.notify_all();
      changed.wait(lock, [&] { return may_end; });
    }
    return Echo(head, name, std::move(body));
  });
  std::vector<std::unique_ptr<Request>> slow;
  for (int i = 0; i < 7; ++i) slow.push_back(std::make_unique<Request>(daemon, "GET", "slow"));
  {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return slow_count == 7; });
  }
  EXPECT_TRUE(Request(daemon, "GET", "quick").Whole().starts_with("HTTP/1.1 200 "));
  // There are more requests than threads: some are still in the queue when the daemon stops.
  for (int i = 0; i < 20; ++i) slow.push_back(std::make_unique<Request>(daemon, "GET", "slow"));
  {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return slow_count == 8; });
    may_end = true;
    changed.notify_all();
  }
  daemon.Stop();
  for (const auto& request : slow) {
    const std::string& answer = request->Whole();
    EXPECT_TRUE(answer.empty() || answer.starts_with("HTTP/1.1 ")) << answer;
  }
}

TEST(PageDaemon, AStreamTellsNewsUntilTheBoardIsClosed) {
  Daemon daemon(Echo);
  Request stream(daemon, "GET", "events"), other(daemon, "GET", "events");
  stream.Until(": hello\n\n");
  daemon.events.Post("path", "{\"id\":1}");
  stream.Until("event: path\ndata: {\"id\":1}\n\n");
  daemon.events.Post("film", "{}");
  stream.Until("event: film\ndata: {}\n\n");
  other.Until("event: film\ndata: {}\n\n");
  stream.Until(": still here\n\n");  // a sign of life without news
  daemon.Stop();
  stream.Whole();
  other.Whole();
}

// A response of HTTP/1.0 is not sent in chunks, so that no head of a chunk interrupts the long news
// in the received text.
TEST(PageDaemon, LongNewsArriveWhole) {
  Daemon daemon(Echo);
  Request stream(daemon, "GET", "events", "HTTP/1.0");
  stream.Until(": hello\n\n");
  const std::string news(100000, 'x');
  daemon.events.Post("watch", news);
  stream.Until("event: watch\ndata: " + news + "\n\n");
}

}  // namespace
}  // namespace lf
