// SPDX-License-Identifier: Apache-2.0
// A light field in image files and in a packed store, for the tests of packed stores. Internal to
// this folder.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "lf/light_field/model/light_field.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

inline constexpr int kPackedWidth = 40, kPackedHeight = 30;
inline constexpr uint32_t kCount = 6;
inline constexpr PixelRect kPackedWhole = {0, 0, kPackedWidth, kPackedHeight};

class PackedStoreTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    field_.intrinsics = {{30, 30, 20, 15, 0, kPackedWidth, kPackedHeight}};
    field_.folder = folder_;
    path_ = folder_ / "store.lfs";
  }
  void AddImage(const std::string& name, float gain = 1) {
    field_.image_names.push_back(name);
    LfCamera camera;
    camera.gain = gain;
    field_.cameras.push_back(camera);
  }
  // Adds different pictures, some of them with a gain.
  template <class T>
  void AddImages(int channels, const std::string& extension = ".png") {
    for (uint32_t i = 0; i < kCount; ++i) {
      Image<T> image = NoiseImage<T>(kPackedWidth, kPackedHeight, channels);
      for (T& value : image.pixels()) value = static_cast<T>(value * (i + 1));
      const std::string name = "image" + std::to_string(i) + extension;
      ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
      AddImage(name, i % 3 == 2 ? 0.75f : 1.f);
    }
  }
  void MaskRow7OfImage2() {
    field_.mask_names.resize(field_.size());
    field_.mask_names[2] = "mask.png";
    Image<uint8_t> mask(kPackedWidth, kPackedHeight, 1, 255);
    for (int x = 0; x < kPackedWidth; ++x) mask.at(x, 7) = 0;
    ASSERT_TRUE(WriteImage(folder_ / "mask.png", mask.view()));
  }
  // Packs the pixels `rect` of all images without loss, or their files.
  void Pack(const PixelRect& rect = kPackedWhole, uint64_t shard_bytes = 0, bool files = false,
            size_t part_count = 0) {
    PackedStorePlan plan;
    plan.whole = IdentityOf(field_);
    plan.shard_bytes = shard_bytes;
    plan.part_count = part_count;
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan).value();
    CodecSettings settings;
    settings.profile = CodecProfile::kLossless;
    for (uint32_t i = 0; i < field_.size(); ++i) {
      const Result<RecordedImage> image = ReadRecordedImage(field_, {i}, rect);
      ASSERT_TRUE(image) << image.error().message;
      EXPECT_EQ(image->is_rounded, is_rounded_);
      ASSERT_TRUE(
          writer.Add({i}, files ? **FileAsCode(field_, {i}, *image) : CodeOf(*image, settings)));
    }
    ASSERT_TRUE(writer.Finish());
    packed_ = ReadPackedStore(path_).value().light_field;
  }
  std::unique_ptr<LfImageStore> Opened(Mosaics mosaics = Mosaics::kAsRecorded) const {
    return OpenStore(packed_, mosaics).value();
  }
  static LfPixels Loaded(const LfImageStore& store, LfImageId id, const PixelRect& rect) {
    LfPixels pixels;
    const Result<void> loaded = store.Load(id, rect, &pixels);
    EXPECT_TRUE(loaded) << loaded.error().message;
    return pixels;
  }
  static std::string ErrorOf(const LfImageStore& store, LfImageId id,
                             const PixelRect& rect = kPackedWhole) {
    LfPixels pixels;
    const Result<void> loaded = store.Load(id, rect, &pixels);
    EXPECT_FALSE(loaded);
    if (loaded) return "";
    EXPECT_EQ(loaded.error().kind, ErrorKind::kInput);
    return loaded.error().message;
  }
  static void ExpectSame(const LfPixels& a, const LfPixels& b) {
    EXPECT_EQ(a.rect, b.rect);
    EXPECT_EQ(a.bayer, b.bayer);
    EXPECT_EQ(a.any_masked, b.any_masked);
    EXPECT_EQ(a.radiance.pixels(), b.radiance.pixels());
    EXPECT_EQ(a.mosaic_mask.pixels(), b.mosaic_mask.pixels());
  }
  void ExpectTheBitsOfTheFolder(Mosaics mosaics = Mosaics::kAsRecorded,
                                const std::vector<PixelRect>& rects = {kPackedWhole,
                                                                       {3, 5, 17, 11},
                                                                       {-4, 20, 99, 99},
                                                                       {50, 50, 60, 60}}) {
    const FolderStore files(field_, mosaics);
    const auto store = Opened(mosaics);
    for (uint32_t i = 0; i < field_.size(); ++i)
      for (const PixelRect& rect : rects)
        ExpectSame(Loaded(*store, {i}, rect), Loaded(files, {i}, rect));
  }

  LightField field_, packed_;
  std::filesystem::path path_;
  bool is_rounded_ = false;
};

}  // namespace lf
