// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/remote_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "lf/storage/remote/test_web_server.h"

namespace lf {
namespace {

std::string Content(size_t size) {
  std::string bytes(size, '\0');
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 7 + i / 251);
  return bytes;
}

const std::string kContent = Content(100'000);
constexpr RemoteOptions kQuick = {.connect_s = 2,
                                  .stall_s = 1,
                                  .most_attempts = 3,
                                  .first_wait_s = 0.01,
                                  .most_wait_s = 0.3,
                                  .total_s = 20};

struct Outcome {
  Result<void> result;
  std::string bytes;
  TransferFault fault;
  double seconds;
  int requests;
};

// Reads [begin, begin + count) of a file from a server that answers so.
Outcome ReadFrom(std::function<void(TestRequest)> answer, uint64_t begin = 1000,
                 uint64_t count = 50'000, const RemoteOptions& options = kQuick) {
  const TestWebServer server(std::move(answer));
  Result<RemoteFile> file = RemoteFile::Open(server.Url() + "?token=secret", options);
  LF_CHECK(file.has_value());
  Outcome outcome{};
  const auto start = std::chrono::steady_clock::now();
  outcome.result = file->Read(begin, count, &outcome.bytes);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.fault = file->fault();
  outcome.requests = server.request_count();
  return outcome;
}

void ExpectFails(const Outcome& outcome, TransferFault fault, ErrorKind kind,
                 std::string_view words) {
  ASSERT_FALSE(outcome.result.has_value());
  EXPECT_EQ(outcome.fault, fault) << outcome.result.error().message;
  EXPECT_EQ(outcome.result.error().kind, kind);
  EXPECT_NE(outcome.result.error().message.find(words), std::string::npos)
      << outcome.result.error().message;
  EXPECT_NE(outcome.result.error().message.find("/field.lfs: "), std::string::npos);
  EXPECT_EQ(outcome.result.error().message.find("secret"), std::string::npos);
  EXPECT_LE(outcome.bytes.size(), 50'000u);
  EXPECT_LE(outcome.bytes.capacity(), 110'000u);
}

void ExpectReads(const Outcome& outcome) {
  ASSERT_TRUE(outcome.result.has_value()) << outcome.result.error().message;
  EXPECT_EQ(outcome.bytes, kContent.substr(1000, 50'000));
}

TEST(RemoteFile, ReadsARange) {
  const Outcome outcome = ReadFrom([](TestRequest request) { request.Answer(kContent); });
  ExpectReads(outcome);
  EXPECT_EQ(outcome.requests, 1);
}

TEST(RemoteFile, ContinuesWhereATransferEnded) {
  std::atomic<uint64_t> second_begin = 0;
  const Outcome outcome = ReadFrom([&](TestRequest request) {
    if (request.number > 0) {
      second_begin = request.begin;
      return request.Answer(kContent);
    }
    request.SendHead(kContent);
    request.Send(std::string_view(kContent).substr(request.begin, 20'000));
  });
  ExpectReads(outcome);
  EXPECT_EQ(second_begin, 21'000u);
}

TEST(RemoteFile, GivesUpIfEveryTransferEndsEarly) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.SendHead(kContent);
    request.Send(std::string_view(kContent).substr(request.begin, 10));
  });
  ExpectFails(outcome, TransferFault::kUnreachable, ErrorKind::kOutput, "3 attempts");
  EXPECT_EQ(outcome.requests, 3);
  EXPECT_EQ(outcome.bytes, kContent.substr(1000, 30));
}

TEST(RemoteFile, RefusesMoreBytesThanAskedFor) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.Send(
        fmt::format("HTTP/1.1 206 Partial Content\r\nContent-Range: bytes {}-{}/100000\r\n"
                    "Connection: close\r\n\r\n",
                    request.begin, request.end - 1));
    const std::string many(1 << 20, 'x');
    while (!*request.ends && request.Send(many)) {
    }
  });
  ASSERT_FALSE(outcome.result.has_value());
  EXPECT_EQ(outcome.fault, TransferFault::kBadAnswer);
  EXPECT_LE(outcome.bytes.capacity(), 110'000u);
}

TEST(RemoteFile, RefusesAnotherRange) {
  for (const char* const range :
       {"bytes 0-49999/100000", "bytes 1000-51000/100000", "bytes 1000-50999/20", "bytes */100000",
        "bytes 1000-50999/99999999999999999999999", "bytes 50999-1000/100000", "", "lines 1-2/3",
        "bytes 18446744073709551615-18446744073709551615/18446744073709551615"}) {
    const Outcome outcome = ReadFrom([&](TestRequest request) {
      request.Send(
          fmt::format("HTTP/1.1 206 Partial Content\r\nContent-Range: {}\r\n"
                      "Content-Length: 50000\r\nConnection: close\r\n\r\n{}",
                      range, std::string(50'000, 'x')));
    });
    ExpectFails(outcome, TransferFault::kBadAnswer, ErrorKind::kInput, "Content-Range");
    EXPECT_TRUE(outcome.bytes.empty());
  }
}

TEST(RemoteFile, TakesAShorterRangeAndAsksForTheRest) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.end = std::min(request.end, request.begin + 20'000);
    request.Answer(kContent);
  });
  ExpectReads(outcome);
  EXPECT_EQ(outcome.requests, 3);
}

TEST(RemoteFile, RefusesAServerWithoutRangesAtOnce) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.Send("HTTP/1.1 200 OK\r\nContent-Length: 1000000000000\r\n\r\n");
    const std::string many(1 << 20, 'x');
    while (!*request.ends && request.Send(many)) {
    }
  });
  ExpectFails(outcome, TransferFault::kNoRanges, ErrorKind::kInput, "must send ranges");
  EXPECT_EQ(outcome.requests, 1);
  EXPECT_LT(outcome.seconds, 5);
}

TEST(RemoteFile, GivesUpAServerThatStalls) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.SendHead(kContent);
    request.Sleep(30);
  });
  ExpectFails(outcome, TransferFault::kUnreachable, ErrorKind::kOutput, "0 bytes");
  EXPECT_LT(outcome.seconds, 20);
}

TEST(RemoteFile, GivesUpAServerThatSendsNothing) {
  const Outcome outcome = ReadFrom([](TestRequest request) { request.Sleep(30); });
  ExpectFails(outcome, TransferFault::kUnreachable, ErrorKind::kOutput, "3 attempts");
  EXPECT_LT(outcome.seconds, 20);
}

TEST(RemoteFile, WaitsForASlowServerThatGoesOn) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.SendHead(kContent);
    for (uint64_t at = request.begin; at < request.end; at += 2000) {
      request.Send(std::string_view(kContent).substr(at, 2000));
      request.Sleep(0.1);
    }
  });
  ExpectReads(outcome);
  EXPECT_GT(outcome.seconds, 2);
  EXPECT_EQ(outcome.requests, 1);
}

TEST(RemoteFile, TakesNoLongerThanAsked) {
  RemoteOptions options = kQuick;
  options.total_s = -3;  // 2 s, because 5 s are added for 50 kB
  options.stall_s = 60;
  const Outcome outcome = ReadFrom(
      [](TestRequest request) {
        request.SendHead(kContent);
        while (!*request.ends && request.Send("x")) request.Sleep(0.05);
      },
      1000, 50'000, options);
  ExpectFails(outcome, TransferFault::kUnreachable, ErrorKind::kOutput, "timed out");
  EXPECT_LT(outcome.seconds, 10);
}

TEST(RemoteFile, TellsStatusesApart) {
  const struct {
    const char* status;
    TransferFault fault;
    ErrorKind kind;
    int requests;
  } cases[] = {{"404 Not Found", TransferFault::kNotThere, ErrorKind::kInput, 1},
               {"403 Forbidden", TransferFault::kRefused, ErrorKind::kOutput, 1},
               {"416 Range Not Satisfiable", TransferFault::kBeyondEnd, ErrorKind::kInput, 1},
               {"500 Internal Server Error", TransferFault::kUnreachable, ErrorKind::kOutput, 3},
               {"429 Too Many Requests", TransferFault::kUnreachable, ErrorKind::kOutput, 3}};
  for (const auto& expected : cases) {
    const Outcome outcome =
        ReadFrom([&](TestRequest request) { request.AnswerStatus(expected.status); });
    ExpectFails(outcome, expected.fault, expected.kind,
                fmt::format("status {:.3}", expected.status));
    EXPECT_EQ(outcome.requests, expected.requests);
  }
}

TEST(RemoteFile, AsksAgainAfterAFailureOfTheServer) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.number == 0 ? request.AnswerStatus("500 Oops") : request.Answer(kContent);
  });
  ExpectReads(outcome);
}

TEST(RemoteFile, WaitsAsLongAsTheServerWantsUpToABound) {
  const struct {
    const char* wanted;
    double least_s, most_s;
  } cases[] = {{"0.2", 0.2, 0.3}, {"100000", 0.3, 1}, {"-1", 0, 0.2}, {"nan", 0, 0.2}};
  for (const auto& [wanted, least_s, most_s] : cases) {
    const std::string header = fmt::format("Retry-After: {}\r\n", wanted);
    const Outcome outcome = ReadFrom([&](TestRequest request) {
      request.number == 0 ? request.AnswerStatus("429 Too Many Requests", header)
                          : request.Answer(kContent);
    });
    ExpectReads(outcome);
    EXPECT_GE(outcome.seconds, least_s);
    EXPECT_LT(outcome.seconds, most_s + 5);
  }
}

TEST(RemoteFile, RefusesAnotherFileInTheMiddle) {
  const Outcome other_tag = ReadFrom([](TestRequest request) {
    if (request.number > 0) return request.Answer(kContent, "ETag: \"b\"\r\n");
    request.SendHead(kContent);
    request.Send(std::string_view(kContent).substr(request.begin, 20'000));
  });
  ExpectFails(other_tag, TransferFault::kChanged, ErrorKind::kInput, "'\"b\"' instead of '\"a\"'");
  EXPECT_EQ(other_tag.bytes.size(), 20'000u);
  const Outcome other_size = ReadFrom([](TestRequest request) {
    if (request.number > 0) return request.Answer(kContent + "x");
    request.SendHead(kContent);
    request.Send(std::string_view(kContent).substr(request.begin, 20'000));
  });
  ExpectFails(other_size, TransferFault::kChanged, ErrorKind::kInput, "100001 bytes");
}

TEST(RemoteFile, FollowsRedirectionsToWebServersAlone) {
  ExpectReads(ReadFrom([](TestRequest request) {
    request.number == 0 ? request.AnswerStatus("302 Found", "Location: /elsewhere\r\n")
                        : request.Answer(kContent);
  }));
  const Outcome loop = ReadFrom(
      [](TestRequest request) { request.AnswerStatus("302 Found", "Location: /field.lfs\r\n"); });
  ExpectFails(loop, TransferFault::kUntrusted, ErrorKind::kOutput, "redirects");
  EXPECT_EQ(loop.requests, 6);
  for (const char* const target :
       {"file:///etc/passwd", "ftp://127.0.0.1/x", "gopher://127.0.0.1/x", "dict://127.0.0.1/x"}) {
    const Outcome outcome = ReadFrom([&](TestRequest request) {
      request.AnswerStatus("302 Found", fmt::format("Location: {}\r\n", target));
    });
    ExpectFails(outcome, TransferFault::kUntrusted, ErrorKind::kOutput, "check the URL");
    EXPECT_EQ(outcome.requests, 1);
  }
}

TEST(RemoteFile, RefusesEndlessHeaders) {
  const Outcome outcome = ReadFrom([](TestRequest request) {
    request.Send("HTTP/1.1 206 Partial Content\r\n");
    const std::string line = "X: " + std::string(1000, 'x') + "\r\n";
    while (!*request.ends && request.Send(line)) {
    }
  });
  ExpectFails(outcome, TransferFault::kBadAnswer, ErrorKind::kInput, "64 KiB");
  const Outcome one_line = ReadFrom([](TestRequest request) {
    request.Send("HTTP/1.1 206 Partial Content\r\nX: ");
    const std::string many(1 << 20, 'x');
    while (!*request.ends && request.Send(many)) {
    }
  });
  EXPECT_FALSE(one_line.result.has_value());
}

TEST(RemoteFile, RefusesEncodedBytes) {
  const Outcome outcome =
      ReadFrom([](TestRequest request) { request.Answer(kContent, "Content-Encoding: gzip\r\n"); });
  ExpectFails(outcome, TransferFault::kBadAnswer, ErrorKind::kInput, "'gzip'");
}

TEST(RemoteFile, RefusesWhatIsNoHttp) {
  const Outcome outcome =
      ReadFrom([](TestRequest request) { request.Send(std::string(100'000, 'x')); });
  EXPECT_FALSE(outcome.result.has_value());
  EXPECT_TRUE(outcome.bytes.empty());
}

TEST(RemoteFile, SaysThatAServerIsNotThere) {
  TestWebServer server([](const TestRequest&) {});
  const std::string url = server.Url();
  server.Stop();
  Result<RemoteFile> file = RemoteFile::Open(url, kQuick);
  ASSERT_TRUE(file.has_value());
  std::string bytes;
  const Result<void> read = file->Read(0, 10, &bytes);
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().kind, ErrorKind::kOutput);
  EXPECT_NE(read.error().message.find("connect"), std::string::npos) << read.error().message;
}

TEST(RemoteFile, StopsSoonAfterAnInterrupt) {
  std::atomic<bool> flag = false;
  StopRemoteReadsIf(&flag);
  std::thread interrupts([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    flag = true;
  });
  RemoteOptions patient;
  const Outcome outcome = ReadFrom([](TestRequest request) { request.Sleep(30); }, 0, 100, patient);
  interrupts.join();
  StopRemoteReadsIf(nullptr);
  ASSERT_FALSE(outcome.result.has_value());
  EXPECT_EQ(outcome.result.error().kind, ErrorKind::kInterrupted);
  EXPECT_LT(outcome.seconds, 10);
}

TEST(RemoteFile, StatesSizeAndValidator) {
  const TestWebServer server([](TestRequest request) {
    request.Answer(kContent, "Last-Modified: Mon, 30 Nov 2026 00:00:00 GMT\r\n");
  });
  Result<RemoteFile> file = RemoteFile::Open(server.Url(), kQuick);
  ASSERT_TRUE(file.has_value());
  const Result<RemoteFacts> facts = file->Facts();
  ASSERT_TRUE(facts.has_value()) << facts.error().message;
  EXPECT_EQ(facts->size_bytes, 100'000u);
  EXPECT_EQ(facts->validator, "Mon, 30 Nov 2026 00:00:00 GMT");
  std::string bytes;
  const Result<void> beyond = file->Read(99'000, 2000, &bytes);
  EXPECT_FALSE(beyond.has_value());
  EXPECT_EQ(file->fault(), TransferFault::kBeyondEnd);
}

}  // namespace
}  // namespace lf
