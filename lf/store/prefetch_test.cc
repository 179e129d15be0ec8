#include "lf/store/prefetch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

// The image of `id`: 1 pixel high, its radiance says whose it is.
LfPixels PixelsOf(LfImageId id, int width = 8) {
  LfPixels pixels;
  pixels.radiance = Image<uint16_t>(width, 1, 1, static_cast<uint16_t>(id.value));
  pixels.rect = {0, 0, width, 1};
  return pixels;
}
constexpr size_t kImageBytes = 8 * sizeof(uint16_t);

std::vector<LoadRequest> Requests(uint32_t count) {
  std::vector<LoadRequest> requests;
  for (uint32_t i = 0; i < count; ++i)
    requests.push_back({{i}, {0, 0, static_cast<int>(i) + 1, 1}});
  return requests;
}

// Counts the loads that have begun, and lets a test decide what each does.
class FakeStore : public LfImageStore {
 public:
  using Behaviour = std::function<Result<LfPixels>(LfImageId)>;
  explicit FakeStore(Behaviour behaviour) : behaviour_(std::move(behaviour)) {}

  Result<LfPixels> Load(LfImageId id, const PixelRect& rect) const override {
    EXPECT_EQ(rect.x_end, static_cast<int>(id.value) + 1);
    ++begun_;
    return behaviour_(id);
  }
  int begun() const { return begun_; }

 private:
  Behaviour behaviour_;
  mutable std::atomic<int> begun_ = 0;
};

void SleepMicroseconds(uint64_t count) {
  std::this_thread::sleep_for(std::chrono::microseconds(count));
}

TEST(Prefetch, DeliversAllImagesInTheirOrder) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> {
    SleepMicroseconds(RandomBits(1, 2, id.value) % 300);
    return PixelsOf(id);
  });
  for (const int thread_count : {0, 1, 2, 7})
    for (const size_t queue_images : {1, 2, 100}) {
      Prefetcher prefetcher(store, Requests(60),
                            {thread_count, queue_images * kImageBytes, kImageBytes});
      for (uint32_t i = 0; i < 60; ++i) {
        const std::optional<LoadedImage> image = prefetcher.Next();
        ASSERT_TRUE(image);
        EXPECT_EQ(image->id.value, i);
        ASSERT_TRUE(image->pixels);
        EXPECT_EQ(image->pixels->radiance.at(0, 0), i);
      }
      EXPECT_FALSE(prefetcher.Next());
      EXPECT_FALSE(prefetcher.Next());
    }
}

TEST(Prefetch, NothingRequestedIsTheEnd) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> { return PixelsOf(id); });
  Prefetcher prefetcher(store, {}, {});
  EXPECT_FALSE(prefetcher.Next());
}

TEST(Prefetch, ABrokenImageIsAnAnswerLikeOthers) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> {
    if (id.value % 3 == 0) return InputError("image " + std::to_string(id.value) + " is broken");
    return PixelsOf(id);
  });
  Prefetcher prefetcher(store, Requests(30), {2, 4 * kImageBytes, 0});
  for (uint32_t i = 0; i < 30; ++i) {
    const std::optional<LoadedImage> image = prefetcher.Next();
    ASSERT_TRUE(image);
    EXPECT_EQ(image->id.value, i);
    EXPECT_EQ(image->pixels.has_value(), i % 3 != 0);
    if (!image->pixels) {
      EXPECT_NE(image->pixels.error().message.find("is broken"), std::string::npos);
    }
  }
}

TEST(Prefetch, WantOfMemoryAndOtherExceptionsAreErrors) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> {
    if (id.value == 1) throw std::bad_alloc();
    if (id.value == 2) throw std::runtime_error("a library's");
    return PixelsOf(id);
  });
  for (const int thread_count : {0, 2}) {
    Prefetcher prefetcher(store, Requests(4), {thread_count, 1 << 20, kImageBytes});
    EXPECT_TRUE(prefetcher.Next()->pixels);
    const std::optional<LoadedImage> without_memory = prefetcher.Next();
    EXPECT_EQ(without_memory->pixels.error().kind, ErrorKind::kOutput);
    EXPECT_NE(without_memory->pixels.error().message.find("LF image 1: no memory"),
              std::string::npos);
    EXPECT_NE(prefetcher.Next()->pixels.error().message.find("a library's"), std::string::npos);
    EXPECT_TRUE(prefetcher.Next()->pixels);
  }
}

// Waits until the store has begun `count` loads, and some time more for one too many.
void ExpectBegun(const FakeStore& store, int count) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (store.begun() < count && std::chrono::steady_clock::now() < end) SleepMicroseconds(100);
  SleepMicroseconds(3000);
  EXPECT_EQ(store.begun(), count);
}

TEST(Prefetch, LoadsAsFarAheadAsTheQueueHolds) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> { return PixelsOf(id); });
  Prefetcher prefetcher(store, Requests(20), {3, 5 * kImageBytes, kImageBytes});
  ExpectBegun(store, 5);
  prefetcher.Next();
  ExpectBegun(store, 6);
  prefetcher.Next();
  prefetcher.Next();
  ExpectBegun(store, 8);
}

TEST(Prefetch, ImagesBeyondTheQueueComeOneByOne) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> { return PixelsOf(id); });
  Prefetcher prefetcher(store, Requests(3), {2, 1, kImageBytes});
  for (int i = 1; i <= 3; ++i) {
    ExpectBegun(store, i);
    EXPECT_TRUE(prefetcher.Next()->pixels);
  }
  EXPECT_FALSE(prefetcher.Next());
}

TEST(Prefetch, LearnsTheSizeFromTheFirstImage) {
  std::mutex mutex;
  std::condition_variable may_end;
  bool first_may_end = false;
  const FakeStore store([&](LfImageId id) -> Result<LfPixels> {
    std::unique_lock lock(mutex);
    if (id.value == 0) may_end.wait(lock, [&] { return first_may_end; });
    return PixelsOf(id);
  });
  Prefetcher prefetcher(store, Requests(20), {4, 4 * kImageBytes, 0});
  ExpectBegun(store, 1);  // alone
  {
    const std::lock_guard lock(mutex);
    first_may_end = true;
  }
  may_end.notify_all();
  ExpectBegun(store, 4);
}

TEST(Prefetch, LargerImagesThanEstimatedFillTheQueueSooner) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> { return PixelsOf(id, 32); });
  // Room for 8 estimated images; the first shows that it is for two.
  Prefetcher prefetcher(store, Requests(20), {1, 8 * kImageBytes, kImageBytes});
  ExpectBegun(store, 2);
}

TEST(Prefetch, StopsInTheMiddle) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> {
    SleepMicroseconds(200);
    return PixelsOf(id);
  });
  for (int taken = 0; taken < 20; ++taken) {
    Prefetcher prefetcher(store, Requests(1000), {3, 10 * kImageBytes, kImageBytes});
    for (int i = 0; i < taken; ++i) EXPECT_TRUE(prefetcher.Next());
  }
  EXPECT_LT(store.begun(), 20 * (20 + 10 + 3));
}

TEST(Prefetch, CountsTheTimeOfLoading) {
  const FakeStore store([](LfImageId id) -> Result<LfPixels> {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
    while (std::chrono::steady_clock::now() < end) continue;
    return PixelsOf(id);
  });
  for (const int thread_count : {0, 1}) {
    Prefetcher prefetcher(store, Requests(4), {thread_count, 1 << 20, kImageBytes});
    while (prefetcher.Next()) continue;
    EXPECT_GT(prefetcher.load_seconds(), 0);
    EXPECT_LT(prefetcher.load_seconds(), 0.5);
  }
}

}  // namespace
}  // namespace lf
