// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/store_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <system_error>

#include "lf/storage/remote/cache_folders.h"
#include "lf/storage/remote/store_note.h"
#include "lf/storage/remote/store_url.h"
#include "lf/storage/remote/test_web_server.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

std::string TextIn(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class StoreCacheTest : public ::testing::Test {
 protected:
  StoreCacheTest() {
    std::string name = (fs::temp_directory_path() / "lf_store_cache_XXXXXX").string();
    LF_CHECK(::mkdtemp(name.data()) != nullptr);
    cache_ = name;
    options_.folder = cache_;
    options_.remote = {
        .connect_s = 2, .stall_s = 1, .most_attempts = 2, .first_wait_s = 0.01, .total_s = 20};
  }
  ~StoreCacheTest() override {
    std::error_code ignored;
    fs::remove_all(cache_, ignored);
  }

  fs::path Open(const std::string& url) const {
    const Result<fs::path> store = OpenRemoteStore(url, options_);
    EXPECT_TRUE(store.has_value()) << store.error().message;
    return store ? *store : fs::path();
  }

  fs::path cache_;
  StoreCacheOptions options_;
};

TEST_F(StoreCacheTest, CopiesTablesOnce) {
  std::string content(20 << 20, 'x');
  content[12 << 20] = 'y';
  const TestWebServer server([&](TestRequest request) { request.Answer(content); });
  const std::string url = server.Url("/a/field.lfs?token=1");
  const fs::path store = Open(url);
  EXPECT_EQ(store.filename(), "field.lfs");
  EXPECT_EQ(TextIn(store), content);
  EXPECT_EQ(server.request_count(), 4);
  EXPECT_EQ(*UrlOfStore(store), url);
  EXPECT_EQ(fs::status(store.parent_path()).permissions(), fs::perms::owner_all);
  // A signed URL has another signature each time.
  const std::string later = server.Url("/a/field.lfs?token=2");
  EXPECT_EQ(Open(later), store);
  EXPECT_EQ(server.request_count(), 5);
  EXPECT_EQ(*UrlOfStore(store), later);
  EXPECT_FALSE(*UrlOfStore(cache_ / "other.lfs"));
}

TEST_F(StoreCacheTest, ForgetsAStoreThatHasChanged) {
  std::string content = "first", tag = "ETag: \"1\"\r\n";
  std::mutex mutex;
  const TestWebServer server([&](TestRequest request) {
    const std::lock_guard lock(mutex);
    request.Answer(content, tag);
  });
  const fs::path store = Open(server.Url());
  std::ofstream(store.parent_path() / "field-r0.lfs") << "range";
  EXPECT_EQ(Open(server.Url()), store);
  EXPECT_TRUE(fs::exists(store.parent_path() / "field-r0.lfs"));
  {
    const std::lock_guard lock(mutex);
    content = "other";
    tag = "ETag: \"2\"\r\n";
  }
  EXPECT_EQ(Open(server.Url()), store);
  EXPECT_EQ(TextIn(store), "other");
  EXPECT_FALSE(fs::exists(store.parent_path() / "field-r0.lfs"));
}

TEST_F(StoreCacheTest, UsesItsCopyIfTheServerIsAway) {
  TestWebServer server([&](TestRequest request) { request.Answer("tables"); });
  const std::string url = server.Url();
  const fs::path store = Open(url);
  server.Stop();
  EXPECT_EQ(Open(url), store);
  fs::remove(NotePath(store));
  const Result<fs::path> without = OpenRemoteStore(url, options_);
  ASSERT_FALSE(without.has_value());
  EXPECT_EQ(without.error().kind, ErrorKind::kOutput);
}

TEST_F(StoreCacheTest, ContinuesADownload) {
  const std::string content(20 << 20, 'x');
  std::atomic<bool> is_cut = true;
  std::atomic<uint64_t> sent = 0;
  const TestWebServer server([&](TestRequest request) {
    if (is_cut && request.begin >= (8 << 20)) return request.AnswerStatus("503 Busy");
    sent += request.end - request.begin;
    request.Answer(content);
  });
  ASSERT_FALSE(OpenRemoteStore(server.Url(), options_).has_value());
  is_cut = false;
  sent = 0;
  EXPECT_EQ(TextIn(Open(server.Url())), content);
  EXPECT_EQ(sent, (12u << 20) + 1);
}

TEST_F(StoreCacheTest, RefusesALargeFileBeforeItIsCopied) {
  std::atomic<uint64_t> sent = 0;
  const TestWebServer server([&](TestRequest request) {
    sent += request.end - request.begin;
    request.Send(
        "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes 0-0/1000000000000\r\n"
        "Content-Length: 1\r\nConnection: close\r\n\r\nx");
  });
  const Result<fs::path> store = OpenRemoteStore(server.Url(), options_);
  ASSERT_FALSE(store.has_value());
  EXPECT_EQ(store.error().kind, ErrorKind::kInput);
  EXPECT_NE(store.error().message.find("1 TB"), std::string::npos) << store.error().message;
  EXPECT_EQ(sent, 1u);
}

TEST_F(StoreCacheTest, AsksEachTimeIfTheServerStatesNoVersion) {
  const TestWebServer server([&](TestRequest request) { request.Answer("tables", ""); });
  const fs::path store = Open(server.Url());
  EXPECT_EQ(Open(server.Url()), store);
  EXPECT_EQ(TextIn(store), "tables");
  EXPECT_EQ(server.request_count(), 4);
}

TEST_F(StoreCacheTest, WorksWithoutACache) {
  const TestWebServer server([&](TestRequest request) { request.Answer("tables"); });
  std::ofstream(cache_ / "file") << "x";
  options_.folder = cache_ / "file";
  const fs::path store = Open(server.Url());
  EXPECT_EQ(TextIn(store), "tables");
  EXPECT_EQ(*UrlOfStore(store), server.Url());
}

TEST_F(StoreCacheTest, RemovesWhatWasNotUsedForLong) {
  const auto now = fs::file_time_type::clock::now();
  const auto make = [&](const std::string& name, int days) {
    fs::create_directory(cache_ / name);
    std::ofstream(cache_ / name / "field.lfs") << std::string(100'000, 'x');
    std::ofstream(cache_ / name / "in_use") << "";
    fs::last_write_time(cache_ / name / "in_use", now - std::chrono::hours(24 * days + 1));
  };
  make("a", 3), make("b", 2), make("c", 1), make("new", 0);
  fs::create_directory(cache_ / "foreign");
  std::ofstream(cache_ / "foreign" / "file") << std::string(100'000, 'x');
  ASSERT_TRUE(UseCacheFolder(cache_ / "a").has_value());
  fs::last_write_time(cache_ / "a" / "in_use", now - std::chrono::hours(100));
  RemoveOldStores(cache_, 310'000);
  EXPECT_TRUE(fs::exists(cache_ / "a")) << "is in use";
  EXPECT_FALSE(fs::exists(cache_ / "b"));
  EXPECT_TRUE(fs::exists(cache_ / "c"));
  RemoveOldStores(cache_, 0);
  EXPECT_FALSE(fs::exists(cache_ / "c"));
  EXPECT_TRUE(fs::exists(cache_ / "new"));
  EXPECT_TRUE(fs::exists(cache_ / "foreign"));
}

TEST(DefaultCacheFolder, IsThatOfTheUser) {
  const std::string home = "/home/me";
  ::setenv("HOME", home.c_str(), 1);
  ::unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(*DefaultCacheFolder(), "/home/me/.cache/lfrendertools/stores");
  ::setenv("XDG_CACHE_HOME", "/var/cache/me", 1);
  EXPECT_EQ(*DefaultCacheFolder(), "/var/cache/me/lfrendertools/stores");
  ::setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(*DefaultCacheFolder(), "/home/me/.cache/lfrendertools/stores");
}

TEST(StoreNote, IsReadStrictly) {
  const StoreNote note = {"https://h/field.lfs?a", "W/\"x y\"", 17};
  const std::optional<StoreNote> read = ParseStoreNote(TextOf(note));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->url, note.url);
  EXPECT_EQ(read->validator, note.validator);
  EXPECT_EQ(read->size_bytes, 17u);
  for (const char* const text :
       {"", "url https://h/field.lfs\n", "url file:///a.lfs\nvalidator \nsize 1\n",
        "url https://h/a.lfs\nvalidator \nsize -1\n", "url https://h/a.lfs\nvalidator \nsize 1\nx"})
    EXPECT_FALSE(ParseStoreNote(text).has_value()) << text;
}

}  // namespace
}  // namespace lf
