// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/web_origin.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

std::string Reread(const std::string& text) {
  const auto origin = ParseWebOrigin(text);
  return origin ? OriginText(*origin) : "none";
}

TEST(WebOrigin, AHostHasANameAndPerhapsAPort) {
  EXPECT_EQ(ParseWebHost("127.0.0.1:8080"), (WebHost{"127.0.0.1", 8080}));
  EXPECT_EQ(ParseWebHost("LocalHost"), (WebHost{"localhost", 0}));
  EXPECT_EQ(ParseWebHost("[::1]:9000"), (WebHost{"[::1]", 9000}));
  EXPECT_EQ(ParseWebHost("[::1]"), (WebHost{"[::1]", 0}));
}

TEST(WebOrigin, OtherTextsAreNoHosts) {
  for (const char* text : {"",
                           ":80",
                           "localhost:",
                           "localhost:0",
                           "localhost:65536",
                           "localhost:+80",
                           "localhost:8 0",
                           "localhost:99999999999999999999",
                           "user@localhost",
                           "localhost@evil.example:80",
                           "localhost/x",
                           " localhost",
                           "localhost ",
                           "::1",
                           "[::1",
                           "[]",
                           "[::1]x",
                           "b\xc3\xbc"
                           "cher.example",
                           "a,b",
                           "localhost:80:80"})
    EXPECT_FALSE(ParseWebHost(text)) << text;
}

TEST(WebOrigin, AnOriginLeavesTheUsualPortOut) {
  EXPECT_EQ(Reread("https://Fields.example"), "https://fields.example");
  EXPECT_EQ(Reread("https://fields.example:443"), "https://fields.example");
  EXPECT_EQ(Reread("http://fields.example:443"), "http://fields.example:443");
  EXPECT_EQ(Reread("http://[::1]:80"), "http://[::1]");
  EXPECT_EQ(ParseWebOrigin("http://localhost"), ParseWebOrigin("HTTP://LOCALHOST:80"));
}

TEST(WebOrigin, OtherTextsAreNoOrigins) {
  for (const char* text :
       {"", "null", "*", "fields.example", "//fields.example", "ftp://fields.example", "https://",
        "https://fields.example/", "https://fields.example/lf", "https://user@fields.example",
        "https://*.example", "file://", "https://fields.example:0"})
    EXPECT_EQ(Reread(text), "none") << text;
}

TEST(WebOrigin, FewNamesLeadToThisMachineForSure) {
  for (const char* name : {"localhost", "127.0.0.1", "[::1]"})
    EXPECT_TRUE(IsLoopbackName(name)) << name;
  for (const char* name : {"", "localhost.", "127.0.0.1.", "127.0.0.2", "0.0.0.0", "x.localhost",
                           "localhost.evil.example", "[::]", "::1", "127.1"})
    EXPECT_FALSE(IsLoopbackName(name)) << name;
}

}  // namespace
}  // namespace lf
