// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/reference_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/storage/load/packed_store.h"
#include "lf/storage/load/test_predicted_store.h"

namespace lf {
namespace {

constexpr PixelLayout kLayoutsOfStores[] = {PixelLayout::kGrey, PixelLayout::kMosaic,
                                            PixelLayout::kRgb};

class ReferenceCacheTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    path_ = folder_ / "a.lfs";
  }
  void Write(const PredictedStoreKind& kind) {
    images_ = MakePredictedImages(kind);
    images_.Write(path_);
    light_field_ = ReadPackedStore(path_).value().light_field;
  }
  std::unique_ptr<ReferenceCache> Opened() const {
    return ReferenceCache::Open(path_, light_field_.encoding.bayer).value();
  }
  PixelRect Whole() const { return {0, 0, images_.kind.width, images_.kind.height}; }
  void Expect(ReferenceCache* cache, uint32_t id, const PixelRect& rect) const {
    DecodedPart part;
    const Result<void> decoded = cache->Decode(id, images_.coded[id].code, rect, &part);
    ASSERT_TRUE(decoded) << decoded.error().message;
    ASSERT_TRUE(HasPixelsOf(images_.decoded[id], part, Intersection(rect, Whole()))) << id;
  }
  std::filesystem::path path_;
  PredictedImages images_;
  LightField light_field_;
};

TEST_F(ReferenceCacheTest, AStoreWithoutPredictedImagesHasNone) {
  images_ = MakePredictedImages({});
  images_.WriteAlone(path_);
  const auto cache = ReferenceCache::Open(path_, BayerPattern::kNone);
  ASSERT_TRUE(cache);
  EXPECT_EQ(*cache, nullptr);
}

// All LF images in any order have the pixels of the decoder, whatever is kept.
TEST_F(ReferenceCacheTest, AllKindsInAnyOrder) {
  std::mt19937 random(1);
  for (const PixelLayout layout : kLayoutsOfStores)
    for (const StoredValues values :
         {StoredValues::kUint8, StoredValues::kUint16, StoredValues::kHalf}) {
      std::filesystem::remove(path_);
      Write({layout, values, 71, 53});
      const uint64_t one = 71 * 53 * (layout == PixelLayout::kRgb ? 3 : 1) *
                           (values == StoredValues::kUint8 ? 1 : 2);
      const std::unique_ptr<ReferenceCache> all = Opened();
      EXPECT_EQ(all->AllBytes(), 5 * one);
      for (const uint64_t limit : {uint64_t{0}, one, 3 * one, 100 * one}) {
        const std::unique_ptr<ReferenceCache> cache = Opened();
        cache->Limit(limit);
        for (int i = 0; i < 30; ++i) {
          const uint32_t id = random() % kPredictedImages;
          Expect(cache.get(), id, Whole());
          const auto whole = cache->Whole(id);
          ASSERT_TRUE(whole) << whole.error().message;
          ASSERT_TRUE(HasPixelsOf(images_.decoded[id], **whole, Whole())) << id;
        }
      }
    }
}

// Parts of images of several tiles, which enlarge the kept parts of reference images.
TEST_F(ReferenceCacheTest, PartsOfSeveralTiles) {
  std::mt19937 random(2);
  for (const PixelLayout layout : {PixelLayout::kGrey, PixelLayout::kMosaic}) {
    std::filesystem::remove(path_);
    Write({layout, StoredValues::kUint8, 2301, 33});
    for (const uint64_t limit : {0, 50000, 150000, 100000000}) {
      const std::unique_ptr<ReferenceCache> cache = Opened();
      cache->Limit(limit);
      for (int i = 0; i < 40; ++i) {
        const int x = static_cast<int>(random() % 2301), y = static_cast<int>(random() % 33);
        Expect(cache.get(), random() % kPredictedImages,
               {x, y, x + 1 + static_cast<int>(random() % 700), y + 9});
      }
    }
  }
}

TEST_F(ReferenceCacheTest, ThreadsGetTheSamePixels) {
  Write({PixelLayout::kGrey, StoredValues::kUint8, 2301, 33});
  for (const uint64_t limit : {0, 150000, 100000000})
    for (int round = 0; round < 3; ++round) {
      const std::unique_ptr<ReferenceCache> cache = Opened();
      cache->Limit(limit);
      std::vector<std::thread> threads;
      for (unsigned seed = 0; seed < 6; ++seed)
        threads.emplace_back([&, seed] {
          std::mt19937 random(seed + 100 * round);
          for (int i = 0; i < 20; ++i) {
            const int x = static_cast<int>(random() % 2301);
            const bool is_whole = random() % 3 == 0;
            Expect(cache.get(), random() % kPredictedImages,
                   is_whole ? Whole() : PixelRect{x, 0, x + 600, 33});
          }
        });
      for (std::thread& thread : threads) thread.join();
    }
}

// Each reference image is decoded once if there is room for all, also for many threads.
TEST_F(ReferenceCacheTest, EachReferenceIsDecodedOnce) {
  Write({PixelLayout::kRgb, StoredValues::kUint8, 400, 300});
  for (int round = 0; round < 5; ++round) {
    const std::unique_ptr<ReferenceCache> cache = Opened();
    std::vector<std::thread> threads;
    for (uint32_t first = 0; first < kPredictedImages; ++first)
      threads.emplace_back([&, first] {
        for (uint32_t i = 0; i < kPredictedImages; ++i)
          Expect(cache.get(), (first + i) % kPredictedImages, Whole());
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(cache->decoded_count(), 5u);
  }
  // Without room, a call still decodes each of those that it needs once.
  const std::unique_ptr<ReferenceCache> cache = Opened();
  cache->Limit(0);
  Expect(cache.get(), 6, Whole());
  EXPECT_EQ(cache->decoded_count(), 5u);
  Expect(cache.get(), 0, Whole());
  EXPECT_EQ(cache->decoded_count(), 5u + 3);
}

// Loads through a PackedStore give the radiance of a store of the same pixels without prediction.
TEST_F(ReferenceCacheTest, LoadsTheBitsOfAStoreWithoutPrediction) {
  for (const PixelLayout layout : kLayoutsOfStores)
    for (const StoredValues values : {StoredValues::kUint8, StoredValues::kUint16,
                                      StoredValues::kHalf, StoredValues::kDisplay16}) {
      std::filesystem::remove_all(folder_);
      std::filesystem::create_directories(folder_);
      Write({layout, values, 71, 53, values == StoredValues::kUint16 ? uint64_t{9000} : 0,
             /*has_masks=*/true});
      const std::filesystem::path alone_path = folder_ / "alone.lfs";
      images_.WriteAlone(alone_path);
      const LightField alone_field = ReadPackedStore(alone_path).value().light_field;
      for (const Mosaics mosaics : {Mosaics::kAsRecorded, Mosaics::kToRgb}) {
        const auto store = PackedStore::Open(light_field_, mosaics).value();
        const auto alone = PackedStore::Open(alone_field, mosaics).value();
        EXPECT_EQ(alone->ReferenceBytes(), 0u);
        EXPECT_GT(store->ReferenceBytes(), 0u);
        store->LimitReferences(values == StoredValues::kUint8 ? 5000 : 1000000);
        for (const PixelRect& rect : {Whole(), PixelRect{3, 5, 20, 31}, PixelRect{-4, 20, 99, 99},
                                      PixelRect{90, 90, 99, 99}})
          for (uint32_t id = 0; id < kPredictedImages; ++id) {
            LfPixels loaded, expected;
            const Result<void> load = store->Load({id}, rect, &loaded);
            ASSERT_TRUE(load) << load.error().message;
            ASSERT_TRUE(alone->Load({id}, rect, &expected));
            ASSERT_EQ(loaded.rect, expected.rect);
            ASSERT_EQ(loaded.radiance.pixels(), expected.radiance.pixels());
            ASSERT_EQ(loaded.mosaic_mask.pixels(), expected.mosaic_mask.pixels());
            ASSERT_EQ(loaded.any_masked, expected.any_masked);
          }
        // A predicted LF image is loaded whole where a smaller picture would do.
        LfPixels reduced;
        const Result<int> reduction =
            store->LoadReduced({6}, 4, light_field_.intrinsics[0], &reduced);
        ASSERT_TRUE(reduction);
        EXPECT_EQ(*reduction, 1);
        EXPECT_EQ(reduced.rect, Whole());
      }
    }
}

// A package's light field has fewer LF images, in another order: reference images are found though
// it lacks them.
TEST_F(ReferenceCacheTest, AnotherLightFieldFindsItsImages) {
  Write({});
  LightField few = light_field_;
  few.image_names = {"image6.png", "image1.png"};
  few.cameras = {light_field_.cameras[6], light_field_.cameras[1]};
  const auto store = PackedStore::Open(few, Mosaics::kAsRecorded).value();
  const auto all = PackedStore::Open(light_field_, Mosaics::kAsRecorded).value();
  for (const auto& [id, whole_id] : {std::pair{0u, 6u}, std::pair{1u, 1u}}) {
    LfPixels loaded, expected;
    ASSERT_TRUE(store->Load({id}, Whole(), &loaded));
    ASSERT_TRUE(all->Load({whole_id}, Whole(), &expected));
    EXPECT_EQ(loaded.radiance.pixels(), expected.radiance.pixels());
  }
}

// Damage of one LF image breaks those that need it, and no others.
TEST_F(ReferenceCacheTest, DamagedReferencesAreNamed) {
  const PredictedImages good = MakePredictedImages({});
  const std::string& code = good.coded[4].code;
  for (const bool is_on_disk : {true, false})
    for (const std::string& bad : {good.coded[2].code, code.substr(0, code.size() / 2)}) {
      images_ = good;
      if (!is_on_disk) images_.coded[4].code = bad;
      std::filesystem::remove(path_);
      images_.Write(path_);
      if (is_on_disk) {
        std::string file = *ReadFile(path_);
        const size_t at = file.find(code.substr(0, 200));
        ASSERT_NE(at, std::string::npos);
        file[at + 150] ^= 4;
        ASSERT_TRUE(WriteFileAtomically(path_, file));
      }
      light_field_ = ReadPackedStore(path_).value().light_field;
      const auto store = PackedStore::Open(light_field_, Mosaics::kAsRecorded).value();
      for (const uint32_t id : {0, 1, 2, 3, 4, 5, 6}) {
        LfPixels pixels;
        const Result<void> loaded = store->Load({id}, Whole(), &pixels);
        ASSERT_EQ(loaded.has_value(), id != 1 && id != 4 && id != 6) << id;
        if (loaded) continue;
        EXPECT_EQ(loaded.error().kind, ErrorKind::kInput);
        const std::string& message = loaded.error().message;
        EXPECT_NE(message.find("a.lfs/image" + std::to_string(id) + ".png: "), std::string::npos);
        EXPECT_EQ(message.find("without the reference image image4.png: ") != std::string::npos,
                  id != 4)
            << message;
        EXPECT_NE(message.find("copy or make"), std::string::npos) << message;
      }
    }
}

// Stores with intact checksums and any encoded images give pixels or errors.
TEST_F(ReferenceCacheTest, AnyEncodedImagesAreDecodedOrRefused) {
  std::mt19937 random(3);
  const PredictedImages good = MakePredictedImages({PixelLayout::kMosaic});
  size_t errors = 0;
  for (int round = 0; round < 40; ++round) {
    images_ = good;
    for (CodedImage& coded : images_.coded)
      if (random() % 2 == 0) {
        const size_t most = round % 2 == 0 ? coded.code.size() : 60;  // mostly in the head
        coded.code[random() % most] ^= static_cast<char>(1 << random() % 8);
      }
    if (round % 3 == 0) std::swap(images_.coded[1].code, images_.coded[4].code);
    std::filesystem::remove(path_);
    images_.Write(path_);
    const std::unique_ptr<ReferenceCache> cache = Opened();
    cache->Limit(random() % 20000);
    for (uint32_t id = 0; id < kPredictedImages; ++id) {
      const auto whole = cache->Whole(id);
      errors += whole ? 0 : 1;
      if (whole)
        EXPECT_EQ((*whole)->rect, Whole());
      else
        EXPECT_FALSE(whole.error().message.empty());
    }
  }
  EXPECT_GT(errors, 40u);
}

// The head of a reference image is checked before its pixels are decoded.
TEST_F(ReferenceCacheTest, AReferenceOfAnotherSizeIsDamaged) {
  images_ = MakePredictedImages({});
  images_.coded[3].rect.x_end = 60;
  images_.Write(path_);
  light_field_ = ReadPackedStore(path_).value().light_field;
  const auto store = PackedStore::Open(light_field_, Mosaics::kAsRecorded).value();
  LfPixels pixels;
  const Result<void> loaded = store->Load({0}, Whole(), &pixels);
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().message.find("image3.png: is damaged in the packed store: its encoded "
                                        "image has 70 x 50 pixels, but the table of the store says "
                                        "60 x 50"),
            std::string::npos)
      << loaded.error().message;
}

}  // namespace
}  // namespace lf
