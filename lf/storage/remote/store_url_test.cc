// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/store_url.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(StoreUrl, IsToldFromAPath) {
  for (const char* const url : {"http://h/a.lfs", "HTTPS://h", "s3://b/a.lfs", "file:///a"})
    EXPECT_TRUE(IsUrl(url)) << url;
  for (const char* const path : {"a.lfs", "/a/b", "./http://h/a.lfs", "c:/a", "://a", "1a://b", ""})
    EXPECT_FALSE(IsUrl(path)) << path;
}

TEST(StoreUrl, IsRefusedUnlessAStoreMayBeThere) {
  EXPECT_TRUE(CheckStoreUrl("https://host:8443/a/field.lfs?token=x#y").has_value());
  for (const char* const url :
       {"ftp://h/a.lfs", "file:///a.lfs", "http://h/a.zip", "http://h/.lfs", "http:///a.lfs",
        "http://h/a b.lfs", "http://h/a.lfs\r\nX: y", "http://h", "http://h/transforms.json"})
    EXPECT_FALSE(CheckStoreUrl(url).has_value()) << url;
}

TEST(StoreUrl, ShowsNoSecrets) {
  const Result<void> refused = CheckStoreUrl("https://me:pass@host/field.lfs?token=secret");
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(refused.error().message.find("pass@"), std::string::npos);
  EXPECT_EQ(refused.error().message.find("secret"), std::string::npos);
  EXPECT_EQ(ShownUrl("https://me:pa/ss@host/a.lfs?t=1"), "https://host/a.lfs");
  EXPECT_EQ(ShownUrl("https://host/a.lfs"), "https://host/a.lfs");
}

TEST(StoreUrl, NamesPartsBesideIt) {
  EXPECT_EQ(PartUrl("https://h/d/field.lfs", 2), "https://h/d/field-r2.lfs");
  EXPECT_EQ(PartUrl("https://h/field.lfs?token=x", 0), "https://h/field-r0.lfs?token=x");
}

TEST(StoreUrl, NamesAFolderOfTheCache) {
  EXPECT_EQ(StemOfUrl("https://h/d/field.lfs"), "field");
  EXPECT_EQ(StemOfUrl("https://h/..lfs"), "_.");
  EXPECT_EQ(StemOfUrl("https://h/a;b.lfs"), "a_b");
  EXPECT_EQ(FolderNameOfUrl("https://h/field.lfs?token=x"),
            FolderNameOfUrl("https://h/field.lfs?token=y"));
  EXPECT_NE(FolderNameOfUrl("https://h/field.lfs"), FolderNameOfUrl("https://g/field.lfs"));
}

TEST(ContentRange, IsReadStrictly) {
  const std::optional<ContentRange> range = ParseContentRange("bytes 5-9/100");
  ASSERT_TRUE(range.has_value());
  EXPECT_EQ(range->begin, 5u);
  EXPECT_EQ(range->end, 10u);
  EXPECT_EQ(range->size, 100u);
  EXPECT_FALSE(ParseContentRange("bytes 5-9/*")->size.has_value());
  for (const char* const text :
       {"", "bytes", "bytes 9-5/100", "bytes 5-9/9", "bytes 5-9/10 ", "bytes 5-9", "bytes -5-9/10",
        "bytes 5 -9/10", "bytes */100", "items 5-9/10", "bytes 5-99999999999999999999/*"})
    EXPECT_FALSE(ParseContentRange(text).has_value()) << text;
}

}  // namespace
}  // namespace lf
