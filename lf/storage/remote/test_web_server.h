// SPDX-License-Identifier: Apache-2.0
// A web server of tests, on a port of its own, which answers as a test says. For tests only.
#pragma once

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "lf/core/check.h"

namespace lf {

// A request, and the connection that it came by, which is closed after the answer.
struct TestRequest {
  int fd;
  int number;                   // of the request, from 0
  std::string text;             // its lines
  uint64_t begin = 0, end = 0;  // the range that it asks for
  const std::atomic<bool>* ends;

  // Returns false if the reader has closed the connection.
  bool Send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<size_t>(sent));
    }
    return true;
  }
  void Sleep(double seconds) const {
    const auto begin_time = std::chrono::steady_clock::now();
    while (!*ends &&
           std::chrono::steady_clock::now() - begin_time < std::chrono::duration<double>(seconds))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // Sends the head of an answer with a range of `content`.
  bool SendHead(const std::string& content, const std::string& more = "ETag: \"a\"\r\n") const {
    return Send(fmt::format(
        "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes {}-{}/{}\r\nContent-Length: {}\r\n"
        "Connection: close\r\n{}\r\n",
        begin, end - 1, content.size(), end - begin, more));
  }
  // Answers as a good server does.
  void Answer(const std::string& content, const std::string& more = "ETag: \"a\"\r\n") {
    end = std::min<uint64_t>(end, content.size());
    if (begin >= end) {
      Send("HTTP/1.1 416 Range Not Satisfiable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
      return;
    }
    if (SendHead(content, more)) Send(std::string_view(content).substr(begin, end - begin));
  }
  void AnswerStatus(std::string_view status, std::string_view more = "") const {
    Send(fmt::format("HTTP/1.1 {}\r\nContent-Length: 0\r\nConnection: close\r\n{}\r\n", status,
                     more));
  }
};

class TestWebServer {
 public:
  explicit TestWebServer(std::function<void(TestRequest)> answer) : answer_(std::move(answer)) {
    fd_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    LF_CHECK(::bind(fd_, any, size) == 0 && ::listen(fd_, 64) == 0);
    LF_CHECK(::getsockname(fd_, any, &size) == 0);
    port_ = ntohs(address.sin_port);
    accepts_ = std::thread([this] { Accept(); });
  }
  ~TestWebServer() { Stop(); }

  // Ends all connections. Later ones are refused.
  void Stop() {
    ends_ = true;
    if (accepts_.joinable()) accepts_.join();  // adds threads until it ends
    for (std::thread& thread : threads_)
      if (thread.joinable()) thread.join();
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

  std::string Url(const std::string& path = "/field.lfs") const {
    return fmt::format("http://127.0.0.1:{}{}", port_, path);
  }
  int request_count() const { return request_count_; }

 private:
  static constexpr int kPoll_ms = 5;

  void Accept() {
    while (!ends_) {
      pollfd waits = {fd_, POLLIN, 0};
      if (::poll(&waits, 1, kPoll_ms) <= 0) continue;
      const int fd = ::accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC);
      if (fd >= 0) threads_.emplace_back([this, fd] { Serve(fd); });
    }
  }

  void Serve(int fd) {
    TestRequest request{.fd = fd, .number = 0, .text = {}, .ends = &ends_};
    char part[4096];
    while (!ends_ && request.text.find("\r\n\r\n") == std::string::npos) {
      pollfd waits = {fd, POLLIN, 0};
      if (::poll(&waits, 1, kPoll_ms) <= 0) continue;
      const ssize_t got = ::recv(fd, part, sizeof(part), 0);
      if (got <= 0) break;
      request.text.append(part, static_cast<size_t>(got));
    }
    const size_t range = request.text.find("Range: bytes=");
    unsigned long long first = 0, last = 0;
    if (range != std::string::npos &&
        std::sscanf(request.text.c_str() + range, "Range: bytes=%llu-%llu", &first, &last) == 2) {
      request.begin = first;
      request.end = last + 1;
      request.number = request_count_++;
      answer_(request);
    }
    ::close(fd);
  }

  std::function<void(TestRequest)> answer_;
  int fd_ = -1;
  int port_ = 0;
  std::atomic<bool> ends_ = false;
  std::atomic<int> request_count_ = 0;
  std::thread accepts_;
  std::vector<std::thread> threads_;  // one for each connection
};

}  // namespace lf
