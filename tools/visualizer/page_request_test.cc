// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_request.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace lf {
namespace {

const PageDoor kDoor = {8080, "0123456789abcdef0123456789abcdef"};

RequestHead Head(const std::string& method = "GET", const std::string& name = "scene.json") {
  return {method, "/" + kDoor.token + "/" + name, {{"Host", "127.0.0.1:8080"}}};
}

int StatusOf(const RequestHead& head) {
  const auto refusal = RefusalOf(head, kDoor);
  return refusal ? refusal->status : 200;
}

int StatusWith(const std::string& key, const std::string& value,
               const std::string& method = "POST") {
  RequestHead head = Head(method);
  head.headers.emplace_back(key, value);
  return StatusOf(head);
}

TEST(PageRequest, RequestsOfThePageAreAnswered) {
  EXPECT_EQ(StatusOf(Head()), 200);
  EXPECT_EQ(StatusOf(Head("HEAD", "")), 200);
  EXPECT_EQ(StatusWith("Origin", "http://127.0.0.1:8080"), 200);
  EXPECT_EQ(StatusWith("origin", "http://localhost:8080"), 200);
  EXPECT_EQ(StatusWith("Sec-Fetch-Site", "same-origin"), 200);
  EXPECT_EQ(StatusWith("Sec-Fetch-Site", "none"), 200);
  EXPECT_EQ(StatusWith("Content-Length", std::to_string(kMostBodyBytes)), 200);
  EXPECT_EQ(StatusWith("Transfer-Encoding", "Chunked"), 200);
  EXPECT_EQ(StatusWith("Content-Encoding", "identity"), 200);
  EXPECT_EQ(NameOf(Head("GET", "path/1/use/7.bin"), kDoor), "path/1/use/7.bin");
}

TEST(PageRequest, AnotherHostIsRefused) {
  for (const char* host : {"evil.example:8080", "127.0.0.1", "127.0.0.1:80801", "127.0.0.2:8080",
                           "localhost.evil.example:8080", ""}) {
    RequestHead head = Head();
    head.headers = {{"Host", host}};
    EXPECT_EQ(StatusOf(head), 403) << host;
  }
  RequestHead head = Head();
  head.headers.clear();
  EXPECT_EQ(StatusOf(head), 403);
  EXPECT_EQ(StatusWith("host", "evil.example:8080"), 403);  // this is the second Host header
}

TEST(PageRequest, PathsWithoutTheTokenAreRefused) {
  for (const std::string& path :
       {std::string("/"), std::string(""), std::string("*"), "/" + kDoor.token,
        "/" + kDoor.token + "0/scene.json", "/" + std::string(32, '0') + "/scene.json",
        "//" + kDoor.token + "/", "http://127.0.0.1:8080/" + kDoor.token + "/"}) {
    RequestHead head = Head();
    head.path = path;
    EXPECT_EQ(StatusOf(head), 403) << path;
  }
}

TEST(PageRequest, PathsThatLeadOutsideAreRefused) {
  for (const char* name : {"..", "../x", "a/../../b", "%2e%2e/x", "a\\b", "%00", "a%5cb"})
    EXPECT_EQ(StatusOf(Head("GET", name)), 403) << name;
  EXPECT_EQ(StatusOf(Head("GET", std::string("a\0b", 3))), 403);
}

TEST(PageRequest, OtherSitesAreRefused) {
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8080",
                             "http://127.0.0.1:8081", "http://127.0.0.1:8080.evil.example", ""})
    EXPECT_EQ(StatusWith("Origin", origin), 403) << origin;
  for (const char* site : {"cross-site", "same-site", "", "Same-Origin, none"})
    EXPECT_EQ(StatusWith("Sec-Fetch-Site", site, "GET"), 403) << site;
}

TEST(PageRequest, OtherMethodsAreRefused) {
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "get", "PRI", ""})
    EXPECT_EQ(StatusOf(Head(method)), 405) << method;
}

TEST(PageRequest, BodiesThatExpandOrAreTooLongAreRefused) {
  EXPECT_EQ(StatusWith("Content-Encoding", "gzip"), 415);
  EXPECT_EQ(StatusWith("Content-Encoding", "identity, br"), 415);
  EXPECT_EQ(StatusWith("Transfer-Encoding", "gzip, chunked"), 501);
  EXPECT_EQ(StatusWith("Content-Length", std::to_string(kMostBodyBytes + 1)), 413);
  EXPECT_EQ(StatusWith("Content-Length", "99999999999999999999999"), 413);
  for (const char* length : {"-1", "", "1e3", "0x10", "+5", "5 5"})
    EXPECT_EQ(StatusWith("Content-Length", length), 400) << length;
}

TEST(PageRequest, LengthsThatContradictEachOtherAreRefused) {
  RequestHead head = Head("POST");
  head.headers.emplace_back("Content-Length", "5");
  head.headers.emplace_back("Content-Length", "6");
  EXPECT_EQ(StatusOf(head), 400);
  head.headers.back() = {"Transfer-Encoding", "chunked"};
  EXPECT_EQ(StatusOf(head), 400);
  EXPECT_EQ(StatusWith("Content-Length", "1", "GET"), 400);
  EXPECT_EQ(StatusWith("Transfer-Encoding", "chunked", "HEAD"), 400);
  EXPECT_EQ(StatusWith("Content-Length", "0", "GET"), 200);
}

}  // namespace
}  // namespace lf
