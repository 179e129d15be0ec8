// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/kept_pixels_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/core/random.h"
#include "lf/rebinning/kept_pixels_format.h"

namespace lf {
namespace {

namespace fs = std::filesystem;
using kept_pixels_format::FileHead;
using kept_pixels_format::ImageHead;

// Returns an LF image whose kind depends on its id: mosaic or not, opacities, trust, masks, depths,
// and a rectangle that is empty for every eighth id.
KeptImage RandomImage(uint32_t id) {
  const auto random = [id](uint64_t what, uint64_t index = 0) {
    return RandomBits(id, what, index);
  };
  KeptImage image;
  image.id = LfImageId{id};
  image.width_px = 20 + static_cast<int>(random(0) % 30);
  image.height_px = 15 + static_cast<int>(random(1) % 30);
  image.bayer = static_cast<BayerPattern>(id % 5);
  if (image.bayer == BayerPattern::kNone) image.recorded = static_cast<BayerPattern>(random(2) % 5);
  image.has_opacity = random(3) % 2 == 0;
  image.has_trust = random(4) % 2 == 0;
  image.is_sparse = random(5) % 2 == 0;
  if (id % 8 == 7) return image;
  image.rect = {static_cast<int>(random(6) % 10), static_cast<int>(random(7) % 10),
                image.width_px - static_cast<int>(random(8) % 5),
                image.height_px - static_cast<int>(random(9) % 5)};
  if (random(10) % 2 == 0) image.masked.resize(image.masked_words());
  for (uint32_t place = 0; place < image.rect.pixel_count(); ++place) {
    if (random(11, place) % 4 == 0) {
      image.places.push_back(place);
      for (size_t v = 0; v < image.value_count(); ++v) {
        const auto value = static_cast<uint16_t>(random(12 + v, place));
        const bool is_trust = image.has_trust && v + 1 == image.value_count();
        image.values.push_back(is_trust ? value % 256 : value);
      }
    } else if (!image.masked.empty() && random(20, place) % 3 == 0) {
      image.masked[place / 64] |= uint64_t{1} << (place % 64);
    }
  }
  if (random(21) % 2 == 0) {
    image.depths = {Image<uint16_t>((image.width_px + 2) / 3, (image.height_px + 2) / 3), 0.25, 4.5,
                    3};
    for (size_t i = 0; i < image.depths.numbers.pixels().size(); ++i)
      image.depths.numbers.pixels()[i] = static_cast<uint16_t>(random(22, i));
  }
  return image;
}

std::vector<KeptImage> RandomImages(uint32_t begin, uint32_t end) {
  std::vector<KeptImage> images;
  for (uint32_t id = begin; id < end; ++id) images.push_back(RandomImage(id));
  return images;
}

// Returns an LF image of 3 x 2 pixels, of which the first and the last are kept.
KeptImage SmallImage(uint32_t id = 5) {
  KeptImage image;
  image.id = LfImageId{id};
  image.width_px = 3;
  image.height_px = 2;
  image.rect = {0, 0, 3, 2};
  image.places = {0, 5};
  image.values = {1, 2, 3, 65535, 0, 7};
  image.masked = {0b010010};
  return image;
}

bool IsSame(const KeptImage& a, const KeptImage& b) {
  return a.id == b.id && a.width_px == b.width_px && a.height_px == b.height_px &&
         a.bayer == b.bayer && a.recorded == b.recorded && a.has_opacity == b.has_opacity &&
         a.has_trust == b.has_trust && a.is_sparse == b.is_sparse && a.rect == b.rect &&
         a.places == b.places && a.values == b.values && a.masked == b.masked &&
         a.depths.numbers.pixels() == b.depths.numbers.pixels() &&
         a.depths.numbers.width() == b.depths.numbers.width() && a.depths.least == b.depths.least &&
         a.depths.greatest == b.depths.greatest && a.depths.divisor == b.depths.divisor;
}

class KeptPixelsFile : public ::testing::Test {
 protected:
  static constexpr size_t kMany = 1000000;  // max_pixels that no test reaches

  KeptPixelsFile() {
    static int count = 0;
    folder_ = fs::temp_directory_path() /
              ("lf_kept_pixels_file_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(folder_);
  }
  ~KeptPixelsFile() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::string FileOf(const KeptPixels& pixels, int threads = 2) {
    ThreadPool pool(threads);
    const fs::path path = folder_ / "a.pixels";
    EXPECT_TRUE(WriteKept(path, entries_, pixels, pool));
    return *ReadFile(path);
  }
  std::string FileOf(std::vector<KeptImage> images, uint64_t limit = UINT64_MAX) {
    KeptPixels pixels(kMany, limit);
    pixels.Add(std::move(images), pool_);
    return FileOf(pixels);
  }
  // Writes the pixels to a file and returns those that are read from it.
  KeptPixels Again(const KeptPixels& pixels, size_t max_pixels, int threads) {
    ThreadPool pool(threads);
    const fs::path path = folder_ / "again.pixels";
    EXPECT_TRUE(WriteKept(path, entries_, pixels, pool));
    Result<KeptFile> read = ReadKept(path, max_pixels, pool);
    EXPECT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->entries, entries_);
    return std::move(read->pixels);
  }
  static void ExpectSamePixels(const KeptPixels& a, const KeptPixels& b) {
    EXPECT_EQ(a.size(), b.size());
    EXPECT_EQ(a.limit(), b.limit());
    ASSERT_EQ(a.images().size(), b.images().size());
    for (const auto& [id, image] : a.images())
      EXPECT_TRUE(b.images().contains(id) && IsSame(image, b.images().at(id))) << id.value;
  }

  // Returns the message of the error that reading these bytes returns; empty if there is none.
  std::string FaultIn(const std::string& bytes, size_t max_pixels = kMany) {
    const Result<KeptFile> read = ReadKeptOfBytes(bytes, "a.pixels", max_pixels, pool_);
    if (read) return {};
    EXPECT_EQ(read.error().kind, ErrorKind::kInput);
    return read.error().message;
  }
  void ExpectFault(const std::string& bytes, const std::string& words) {
    const std::string message = FaultIn(bytes);
    EXPECT_EQ(message.find("a.pixels: "), 0u) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
  // Returns the size of the head, the text and their checksum.
  static size_t FrontBytes(const std::string& bytes) {
    FileHead head;
    std::memcpy(&head, bytes.data(), sizeof(head));
    return sizeof(head) + head.text_bytes + sizeof(uint64_t);
  }
  // Returns the bytes with a changed head and a correct checksum.
  static std::string WithFileHead(std::string bytes, const std::function<void(FileHead*)>& change) {
    FileHead head;
    std::memcpy(&head, bytes.data(), sizeof(head));
    const size_t front_bytes = FrontBytes(bytes) - sizeof(uint64_t);
    change(&head);
    std::memcpy(bytes.data(), &head, sizeof(head));
    const uint64_t hash = HashBytes(std::string_view(bytes).substr(0, front_bytes));
    std::memcpy(bytes.data() + front_bytes, &hash, sizeof(hash));
    return bytes;
  }
  // Returns the bytes of a file of one LF image with a changed head of this LF image, and a correct
  // checksum.
  static std::string WithImageHead(std::string bytes,
                                   const std::function<void(ImageHead*)>& change) {
    const size_t at = FrontBytes(bytes);
    ImageHead head;
    std::memcpy(&head, bytes.data() + at, sizeof(head));
    change(&head);
    std::memcpy(bytes.data() + at, &head, sizeof(head));
    const uint64_t hash = HashBytes(std::string_view(bytes).substr(at + sizeof(head.hash)));
    std::memcpy(bytes.data() + at, &hash, sizeof(hash));
    return bytes;
  }

  const PlateEntries entries_ = {{"scene", "a field of light"}, {"images_done", "128"}};
  ThreadPool pool_{2};
  fs::path folder_;
};

TEST_F(KeptPixelsFile, GoesOnAsThePixelsThatWereWritten) {
  for (const size_t max_pixels : {1, 500, 5000, 1000000}) {
    for (const int threads : {1, 2, 3}) {
      ThreadPool pool(threads);
      KeptPixels whole(max_pixels), stopped(max_pixels);
      for (uint32_t batch = 0; batch < 8; ++batch) {
        for (KeptPixels* pixels : {&whole, &stopped})
          pixels->Add(RandomImages(6 * batch, 6 * batch + 6), pool);
        stopped = Again(stopped, max_pixels, threads);
        ExpectSamePixels(stopped, whole);
      }
      EXPECT_LE(whole.size(), max_pixels);
      EXPECT_EQ(whole.limit() < UINT64_MAX, max_pixels < 1000000);
      EXPECT_EQ(whole.images().size(), 48u);
      EXPECT_EQ(FileOf(stopped), FileOf(whole));
    }
  }
}

TEST_F(KeptPixelsFile, LoadsTheSamePixels) {
  KeptPixels pixels(3000);
  pixels.Add(RandomImages(0, 24), pool_);
  const KeptPixels read = Again(pixels, 3000, 2);
  for (const auto& [id, image] : pixels.images()) {
    LfPixels before, after;
    pixels.Load(id, image.rect, &before);
    read.Load(id, image.rect, &after);
    EXPECT_EQ(after.radiance.pixels(), before.radiance.pixels());
    EXPECT_EQ(after.mosaic_mask.pixels(), before.mosaic_mask.pixels());
    EXPECT_EQ(after.opacity.pixels(), before.opacity.pixels());
    EXPECT_EQ(after.trust.pixels(), before.trust.pixels());
    EXPECT_EQ(after.depths.numbers.pixels(), before.depths.numbers.pixels());
    EXPECT_EQ(after.any_masked, before.any_masked);
  }
}

TEST_F(KeptPixelsFile, TheBytesDependOnThePixelsAlone) {
  std::vector<KeptImage> images = RandomImages(0, 40);
  const std::string bytes = FileOf(images);
  std::reverse(images.begin(), images.end());
  KeptPixels one_by_one(kMany - 1);
  for (const KeptImage& image : images) one_by_one.Add({image}, pool_);
  EXPECT_EQ(FileOf(one_by_one, 1), bytes);
  EXPECT_EQ(FileOf(one_by_one, 7), bytes);
  images[3].values[5] ^= 1;
  EXPECT_NE(FileOf(images), bytes);
}

// Blocks are hashed and checked in groups of about 8 MiB.
TEST_F(KeptPixelsFile, ManyBytesAreThereAgain) {
  std::vector<KeptImage> images;
  for (uint32_t id = 0; id < 5; ++id) {
    KeptImage image;
    image.id = LfImageId{id};
    image.width_px = 800;
    image.height_px = id == 2 ? 2000 : 600;
    image.rect = {0, 0, image.width_px, image.height_px};
    for (uint32_t place = 0; place < image.rect.pixel_count(); ++place) {
      image.places.push_back(place);
      for (uint32_t v = 0; v < 3; ++v)
        image.values.push_back(static_cast<uint16_t>(place * v + id));
    }
    images.push_back(std::move(image));
  }
  KeptPixels pixels(5000000);
  pixels.Add(images, pool_);
  const KeptPixels read = Again(pixels, 5000000, 2);
  ExpectSamePixels(read, pixels);
  EXPECT_LE(read.size_bytes(), pixels.size_bytes());
}

TEST_F(KeptPixelsFile, NoLfImageIsAFileToo) {
  const KeptPixels none(10);
  ExpectSamePixels(Again(none, 10, 2), none);
  ASSERT_TRUE(WriteKept(folder_ / "none.pixels", {}, none, pool_));
  EXPECT_EQ(fs::file_size(folder_ / "none.pixels"), 56u);
}

// Compares with the example of doc/formats/kept_pixels.md.
TEST_F(KeptPixelsFile, TheExampleOfThePageIsWritten) {
  KeptPixels pixels(10);
  pixels.Add({SmallImage()}, pool_);
  ASSERT_TRUE(WriteKept(folder_ / "small.pixels", {}, pixels, pool_));
  const std::string bytes = *ReadFile(folder_ / "small.pixels");
  EXPECT_EQ(bytes.size(), 164u);
  EXPECT_EQ(HashBytes(bytes), 9035164047009983347u);
}

TEST_F(KeptPixelsFile, MorePixelsThanAllowedAreRefused) {
  const std::string bytes = FileOf({SmallImage(1), SmallImage(2)});
  EXPECT_EQ(FaultIn(bytes, 4), "");
  EXPECT_NE(FaultIn(bytes, 3).find(
                "a.pixels: contains 4 pixels, but {max_rays} and {memory} allow only 3, because"),
            std::string::npos)
      << FaultIn(bytes, 3);
}

TEST_F(KeptPixelsFile, TruncatedAnywhereItIsRefused) {
  const std::string bytes = FileOf(RandomImages(0, 3));
  EXPECT_EQ(FaultIn(bytes), "");
  for (size_t size = 0; size < bytes.size(); size += size < 200 ? 1 : 97)
    ExpectFault(bytes.substr(0, size), size < 48 ? "is not a file of kept pixels" : "is truncated");
  ExpectFault(bytes.substr(0, bytes.size() - 1), "is truncated");
  ExpectFault(bytes + "x", "1 bytes follow its end");
}

TEST_F(KeptPixelsFile, ABitFlippedAnywhereIsSeen) {
  const std::string bytes = FileOf({SmallImage(1), RandomImage(2), SmallImage(3)});
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    EXPECT_NE(FaultIn(damaged), "") << i;
  }
}

TEST_F(KeptPixelsFile, WhatItSaysIsCheckedBeforeAnythingIsAllocated) {
  const std::string bytes = FileOf({SmallImage()});
  ExpectFault(WithFileHead(bytes, [](FileHead* head) { head->version = 7; }), "version 7");
  ExpectFault(WithFileHead(bytes, [](FileHead* head) { head->block_bytes += 1; }),
              "108 bytes follow its head, expected 109");
  ExpectFault(WithFileHead(bytes, [](FileHead* head) { head->block_bytes = UINT64_MAX; }),
              "is truncated");
  ExpectFault(WithFileHead(bytes, [](FileHead* head) { head->block_bytes -= 2; }),
              "2 bytes follow its end");
  for (const uint64_t count : {uint64_t{2}, UINT64_MAX})
    ExpectFault(WithFileHead(bytes, [&](FileHead* head) { head->image_count = count; }),
                "need more than its 108 bytes");
  for (const uint64_t count : {uint64_t{19}, UINT64_MAX})
    ExpectFault(WithFileHead(bytes, [&](FileHead* head) { head->pixel_count = count; }),
                "need more than its 108 bytes");
  std::string long_text = bytes;
  const uint32_t text_bytes = 1u << 31;
  std::memcpy(long_text.data() + 12, &text_bytes, sizeof(text_bytes));
  ExpectFault(long_text, "bytes of text");
  ExpectFault("no pixels at all, but long enough for them to be some",
              "does not begin with \"LFPIXEL\"");
  const auto with = [&](const std::function<void(ImageHead*)>& change) {
    return WithImageHead(bytes, change);
  };
  constexpr const char* kTooLarge = "at most 2 pixels and 28 bytes were expected";
  ExpectFault(with([](ImageHead* head) { head->pixel_count = UINT32_MAX; }), kTooLarge);
  ExpectFault(with([](ImageHead* head) { head->mask_words = UINT32_MAX; }), kTooLarge);
  ExpectFault(with([](ImageHead* head) { head->mask_words = 2; }), kTooLarge);
  ExpectFault(with([](ImageHead* head) { head->flags |= ImageHead::kTrust; }), kTooLarge);
  ExpectFault(with([](ImageHead* head) { head->depth_width = head->depth_height = UINT32_MAX; }),
              kTooLarge);
  ExpectFault(with([](ImageHead* head) { head->depth_width = head->depth_height = 1; }), kTooLarge);
}

TEST_F(KeptPixelsFile, LfImagesHoldAsManyPixelsAsTheHeadSays) {
  const std::string bytes = FileOf({SmallImage()});
  ExpectFault(WithFileHead(bytes, [](FileHead* head) { head->pixel_count = 1; }),
              "LF image 5: 2 pixels in 28 bytes, at most 1 pixels and 28 bytes were expected");
  ExpectFault(WithFileHead(bytes, [](FileHead* head) { head->pixel_count = 3; }),
              "lack 1 of 3 pixels, and 0 bytes are left");
  ExpectFault(WithFileHead(bytes, [](FileHead* head) { head->image_count = 0; }),
              "lack 2 of 2 pixels, and 108 bytes are left");
  const std::string two = FileOf({SmallImage(1), SmallImage(2)});
  ExpectFault(WithFileHead(two, [](FileHead* head) { head->image_count = 1; }),
              "lack 2 of 4 pixels, and 108 bytes are left");
}

TEST_F(KeptPixelsFile, IdsAscend) {
  const std::string bytes = FileOf({SmallImage(1), SmallImage(2)});
  const size_t front = FrontBytes(bytes);
  const std::string first = bytes.substr(front, 108), second = bytes.substr(front + 108);
  EXPECT_EQ(FaultIn(bytes.substr(0, front) + first + second), "");
  ExpectFault(bytes.substr(0, front) + second + first, "LF image 1 follows LF image 2, but ids");
  ExpectFault(bytes.substr(0, front) + first + first, "LF image 1 follows LF image 1, but ids");
}

TEST_F(KeptPixelsFile, HeadsThatNoLfImageHasAreRefused) {
  const std::string bytes = FileOf({SmallImage()});
  EXPECT_EQ(FaultIn(WithImageHead(bytes, [](ImageHead*) {})), "");
  const auto expect = [&](const std::string& words, const std::function<void(ImageHead*)>& change) {
    ExpectFault(WithImageHead(bytes, change), "LF image 5: " + words);
  };
  expect("a size of 0 x 2", [](ImageHead* head) { head->width_px = 0; });
  expect("a size of 3 x 0", [](ImageHead* head) { head->height_px = 0; });
  expect("a size of 2147483648 x 2", [](ImageHead* head) { head->width_px = 1u << 31; });
  expect("a size of 65536 x 65536",
         [](ImageHead* head) { head->width_px = head->height_px = 65536; });
  expect("the pixels [0, 4) x [0, 2)", [](ImageHead* head) { head->rect[2] = 4; });
  expect("the pixels [0, 3) x [0, 3)", [](ImageHead* head) { head->rect[3] = 3; });
  expect("the pixels [0, 3) x [3, 2)", [](ImageHead* head) { head->rect[1] = 3; });
  expect("the pixels [4294967295, 3)", [](ImageHead* head) { head->rect[0] = UINT32_MAX; });
  expect("the mosaic 0, recorded as 5", [](ImageHead* head) { head->recorded = 5; });
  expect("the flags 8", [](ImageHead* head) { head->flags = 8; });
  expect("depths from 0 to 0 with the divisor 0", [](ImageHead* head) { head->depth_divisor = 0; });
  expect("depths from nan",
         [](ImageHead* head) { head->depth_least = std::numeric_limits<double>::quiet_NaN(); });
  expect("depths from 0 to inf",
         [](ImageHead* head) { head->depth_greatest = std::numeric_limits<double>::infinity(); });
  expect("0 x 1 depths, expected 3 x 2", [](ImageHead* head) { head->depth_height = 1; });
  // The four bytes of values that a mosaic of two pixels needs less are the numbers of two depths.
  const auto with_depths = [](ImageHead* head, uint32_t width, uint32_t height, uint32_t divisor) {
    head->bayer = 1;
    head->flags = ImageHead::kOpacity;
    head->depth_width = width;
    head->depth_height = height;
    head->depth_divisor = divisor;
  };
  expect("1 x 2 depths, expected 2 x 1", [&](ImageHead* head) { with_depths(head, 1, 2, 2); });
  EXPECT_EQ(FaultIn(WithImageHead(bytes, [&](ImageHead* head) { with_depths(head, 2, 1, 2); })),
            "");
  expect("the mosaic 5", [](ImageHead* head) {
    head->bayer = 5;
    head->flags = ImageHead::kOpacity | ImageHead::kSparse;
    head->depth_width = 2;
    head->depth_height = 1;
    head->depth_divisor = 2;
  });
}

TEST_F(KeptPixelsFile, PixelsThatAreNotKeptAreRefused) {
  const auto expect = [&](const std::string& words, const std::function<void(KeptImage*)>& change) {
    KeptImage image = SmallImage();
    change(&image);
    ExpectFault(FileOf({image}), "LF image 5: " + words);
  };
  EXPECT_EQ(FaultIn(FileOf({SmallImage()})), "");
  expect("a pixel at place 6 of 6", [](KeptImage* image) { image->places[1] = 6; });
  expect("place 0 follows place 0", [](KeptImage* image) { image->places[1] = 0; });
  expect("place 0 follows place 5", [](KeptImage* image) { image->places = {5, 0}; });
  expect("place 5 is masked, but is kept", [](KeptImage* image) { image->masked[0] = 1 << 5; });
  expect("pixels beyond the last one", [](KeptImage* image) { image->masked[0] = 1 << 6; });
  expect("2 words of masked pixels, expected 1", [](KeptImage* image) { image->masked = {0, 0}; });
  expect("the trust 256 at place 5, expected at most 255", [](KeptImage* image) {
    image->has_trust = true;
    image->values = {65535, 0, 0, 255, 0, 0, 0, 256};
  });
  expect("a pixel at place 0 of 0", [](KeptImage* image) {
    image->rect = {};
    image->masked.clear();
  });
}

TEST_F(KeptPixelsFile, PixelsAtTheLimitAreRefused) {
  const std::string bytes = FileOf({SmallImage()});
  const uint64_t hashes[] = {KeptPixels::HashOf(LfImageId{5}, 0),
                             KeptPixels::HashOf(LfImageId{5}, 5)};
  const uint64_t largest = std::max(hashes[0], hashes[1]);
  const auto with_limit = [&](uint64_t limit) {
    return WithFileHead(bytes, [&](FileHead* head) { head->limit = limit; });
  };
  EXPECT_EQ(FaultIn(with_limit(largest + 1)), "");
  ExpectFault(with_limit(largest), "is not below the limit");
  ExpectFault(with_limit(0), "of place 0 is not below the limit 0000000000000000");
  // The number of a pixel is the one in the whole LF image.
  KeptImage part = SmallImage();
  part.rect = {1, 1, 3, 2};
  part.places = {1};
  part.values = {1, 2, 3};
  part.masked.clear();
  EXPECT_EQ(FaultIn(FileOf({part}, hashes[1] + 1)), "");
  ExpectFault(
      WithFileHead(FileOf({part}, hashes[1] + 1), [&](FileHead* head) { head->limit = hashes[1]; }),
      "of place 1 is not below the limit");
}

TEST_F(KeptPixelsFile, EntriesAreCheckedBeforePixelsAreRead) {
  std::string bytes = FileOf({SmallImage()});
  bytes.back() ^= 1;
  const fs::path path = folder_ / "b.pixels";
  ASSERT_TRUE(WriteFileAtomically(path, bytes));
  const auto refused = ReadKept(path, kMany, pool_, [&](const PlateEntries& entries) {
    EXPECT_EQ(entries, entries_);
    return Result<void>(UsageError("other inputs"));
  });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "other inputs");
  EXPECT_NE(ReadKept(path, kMany, pool_).error().message.find("LF image 5: its checksum differs"),
            std::string::npos);
}

TEST_F(KeptPixelsFile, FilesThatAreNoneAreErrors) {
  EXPECT_EQ(ReadKept(folder_ / "none", 10, pool_).error().kind, ErrorKind::kInput);
  EXPECT_NE(ReadKept(folder_, 10, pool_).error().message.find("expected a file"),
            std::string::npos);
  EXPECT_EQ(WriteKept(folder_ / "no" / "x", {}, KeptPixels(1), pool_).error().kind,
            ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
