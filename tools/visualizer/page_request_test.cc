// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_request.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace lf {
namespace {

const PageDoor kDoor = {"0123456789abcdef0123456789abcdef",
                        {*ParseWebOrigin("https://fields.example")}};

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
  EXPECT_EQ(StatusWith("origin", "http://127.0.0.1:8080"), 200);
  EXPECT_EQ(StatusWith("Sec-Fetch-Site", "same-origin"), 200);
  EXPECT_EQ(StatusWith("Sec-Fetch-Site", "none"), 200);
  EXPECT_EQ(StatusWith("Content-Length", std::to_string(kMostBodyBytes)), 200);
  EXPECT_EQ(StatusWith("Transfer-Encoding", "Chunked"), 200);
  EXPECT_EQ(StatusWith("Content-Encoding", "identity"), 200);
  EXPECT_EQ(NameOf(Head("GET", "path/1/use/7.bin"), kDoor), "path/1/use/7.bin");
}

// A request to a host, as a browser sends it for a page of `origin`; nullptr leaves a header out.
RequestHead HeadFor(const char* host, const char* origin, const char* site = nullptr) {
  RequestHead head = Head("POST");
  head.headers = {{"Host", host}};
  if (origin) head.headers.emplace_back("Origin", origin);
  if (site) head.headers.emplace_back("Sec-Fetch-Site", site);
  return head;
}

std::string MessageOf(const RequestHead& head) {
  const auto refusal = RefusalOf(head, kDoor);
  return refusal ? refusal->fault : "";
}

TEST(PageRequest, LoopbackNamesOfAnyPortAreAnswered) {
  for (const char* host : {"127.0.0.1:8080", "127.0.0.1:9000", "localhost:1", "127.0.0.1",
                           "LocalHost:65535", "[::1]:9000"})
    EXPECT_EQ(StatusOf(HeadFor(host, nullptr)), 200) << host;
}

TEST(PageRequest, AnotherHostIsRefused) {
  for (const char* host :
       {"evil.example:8080", "127.0.0.1:80801", "127.0.0.1:0", "127.0.0.1:", "127.0.0.2:8080",
        "localhost.evil.example:8080", "localhost.:8080", "127.0.0.1@evil.example:8080",
        "evil.example@127.0.0.1:8080", "127.0.0.1:8080, evil.example", "0.0.0.0:8080", "",
        "fields.example.:443", "a.fields.example"})
    EXPECT_EQ(StatusOf(HeadFor(host, nullptr)), 403) << host;
  RequestHead head = Head();
  head.headers.clear();
  EXPECT_EQ(StatusOf(head), 403);
  EXPECT_EQ(StatusWith("host", "evil.example:8080"), 403);  // this is the second Host header
}

TEST(PageRequest, AForwardedPortIsTheOriginThatTheBrowserSees) {
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:9000", "http://127.0.0.1:9000")), 200);
  EXPECT_EQ(StatusOf(HeadFor("localhost", "http://localhost")), 200);
  EXPECT_EQ(StatusOf(HeadFor("[::1]:9000", "http://[::1]:9000", "same-origin")), 200);
  // The page of another local web server has a loopback name, but not the port of the request.
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:9000", "http://127.0.0.1:9001")), 403);
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:9000", "http://127.0.0.1:9001", "same-site")), 403);
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:9000", "http://localhost:9000")), 403);
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1", "https://127.0.0.1")), 403);
}

// nginx sends the host of proxy_pass unless it is told otherwise.
TEST(PageRequest, AProxyOnThisMachineThatReplacesHostIsRecognisedByTheBrowser) {
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:8080", "http://localhost:80", "same-origin")), 200);
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:8080", "https://localhost", "same-origin")), 200);
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:8080", "http://localhost:80", "none")), 403);
  EXPECT_EQ(StatusOf(HeadFor("127.0.0.1:8080", "http://evil.example", "same-origin")), 403);
}

TEST(PageRequest, AnAllowedOriginIsAnsweredWithEitherHost) {
  for (const char* host :
       {"fields.example", "fields.example:443", "Fields.Example:8443", "127.0.0.1:8080"}) {
    EXPECT_EQ(StatusOf(HeadFor(host, "https://fields.example")), 200) << host;
    EXPECT_EQ(StatusOf(HeadFor(host, "https://fields.example:443", "same-origin")), 200) << host;
    EXPECT_EQ(StatusOf(HeadFor(host, "https://fields.example", "cross-site")), 403) << host;
    EXPECT_EQ(StatusOf(HeadFor(host, "http://fields.example")), 403) << host;
    EXPECT_EQ(StatusOf(HeadFor(host, "https://fields.example:8443")), 403) << host;
    EXPECT_EQ(StatusOf(HeadFor(host, "null")), 403) << host;
  }
}

TEST(PageRequest, RefusalsSayWhatWasFoundAndWhatIsExpected) {
  EXPECT_EQ(MessageOf(HeadFor("evil.example:81", nullptr)),
            "the page is not served to the host \"evil.example:81\": open it at 127.0.0.1 or "
            "localhost, with any port, or https://fields.example; if this is your reverse proxy, "
            "start lfvisualizer with the address that the browser shows, up to the host and port, "
            "such as --allow-origin https://evil.example:81");
  EXPECT_EQ(MessageOf(HeadFor("127.0.0.1:9000", "http://a.example:80")),
            "a page of the origin \"http://a.example:80\" may not use lfvisualizer: expected "
            "http://127.0.0.1:9000 or https://fields.example; if this is your reverse proxy, start "
            "lfvisualizer with --allow-origin http://a.example");
  EXPECT_EQ(MessageOf(HeadFor("fields.example", "null")),
            "a page of the origin \"null\" may not use lfvisualizer: expected "
            "https://fields.example");
  const std::string longest(5000, 'x');
  EXPECT_EQ(
      MessageOf(HeadFor((longest + "\xff\n @").c_str(), nullptr)),
      "the page is not served to the host \"" + longest.substr(0, 100) +
          "...\": open it at 127.0.0.1 or localhost, with any port, or https://fields.example");
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
