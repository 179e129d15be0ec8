// SPDX-License-Identifier: Apache-2.0
// Tests PackedStore::LoadReduced().
#include <gtest/gtest.h>

#include <string>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/test_packed_store.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

using ReducedStoreTest = PackedStoreTest;

// Returns a picture that changes slowly, so that means of squares are known well.
template <class T>
Image<T> SlowImage(int channels, int i) {
  Image<T> image(kPackedWidth, kPackedHeight, channels);
  for (int y = 0; y < kPackedHeight; ++y)
    for (int x = 0; x < kPackedWidth; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y, c) =
            static_cast<T>((60 + 2 * x + y + 15 * c + i) * (sizeof(T) == 1 ? 1 : 256));
  return image;
}

// Reduced loads of stores are the means of squares of whole loads, in light. Only the last column
// and row may be half a sample off.
TEST_F(ReducedStoreTest, ReducedLoadsAreMeansOfSquares) {
  const auto check = [&](BayerPattern bayer, auto type, int channels) {
    using T = decltype(type);
    field_.image_names.clear();
    field_.cameras.clear();
    field_.encoding.bayer = bayer;
    for (int i = 0; i < 3; ++i) {
      const std::string name = "slow" + std::to_string(i) + ".png";
      ASSERT_TRUE(WriteImage(folder_ / name, SlowImage<T>(channels, i).view()));
      AddImage(name, i == 2 ? 0.75F : 1.F);
    }
    Pack(kPackedWhole, channels == 3 ? 0 : 4000);
    const auto store = Opened(Mosaics::kToRgb);
    for (uint32_t i = 0; i < 3; ++i)
      for (const int divisor : {2, 4, 6, 8}) {
        LfPixels reduced;
        const Result<int> reduction =
            store->LoadReduced({i}, divisor, packed_.intrinsics[0], &reduced);
        ASSERT_TRUE(reduction) << reduction.error().message;
        // The first halving of a mosaic saves no bytes, and is not worth a path of its own.
        const bool is_whole = bayer != BayerPattern::kNone && divisor % 4 != 0;
        ASSERT_EQ(*reduction, is_whole ? 1 : divisor == 6 ? 2 : divisor);
        LfPixels shrunken, whole = Loaded(*store, {i}, kPackedWhole);
        ASSERT_EQ(reduced.rect,
                  (PixelRect{0, 0, kPackedWidth / *reduction, kPackedHeight / *reduction}));
        ASSERT_EQ(reduced.bayer, BayerPattern::kNone);
        for (int y = 0; y < reduced.rect.height() - 1; ++y)
          for (int x = 0; x < reduced.rect.width() - 1; ++x)
            for (int c = 0; c < 3; ++c) {
              double mean = 0;
              for (int v = 0; v < *reduction; ++v)
                for (int u = 0; u < *reduction; ++u)
                  mean += whole.radiance.at(x * *reduction + u, y * *reduction + v, c);
              mean /= *reduction * *reduction;
              ASSERT_NEAR(reduced.radiance.at(x, y, c), mean, 0.03 * mean + 250)
                  << divisor << " " << x << " " << y << " " << c << " bayer " << int(bayer);
            }
      }
  };
  check(BayerPattern::kNone, uint8_t{}, 3);
  check(BayerPattern::kNone, uint16_t{}, 3);
  check(BayerPattern::kNone, uint8_t{}, 1);
  check(BayerPattern::kRggb, uint8_t{}, 1);
  check(BayerPattern::kGbrg, uint16_t{}, 1);
}

// LF images with masks, and divisors without a power of two, are loaded whole. A part is an error.
TEST_F(ReducedStoreTest, WhatCannotBeReducedIsLoadedWhole) {
  AddImages<uint8_t>(3);
  MaskRow7OfImage2();
  Pack();
  const auto reduction_of = [&](uint32_t i, int divisor = 4) {
    LfPixels pixels;
    const Result<int> reduction =
        Opened()->LoadReduced({i}, divisor, packed_.intrinsics[0], &pixels);
    EXPECT_TRUE(reduction);
    if (!reduction) return 0;
    const int side = *reduction;
    EXPECT_EQ(pixels.rect, (PixelRect{0, 0, kPackedWidth / side, kPackedHeight / side}));
    return side;
  };
  EXPECT_EQ(reduction_of(1), 4);
  EXPECT_EQ(reduction_of(1, 3), 1);
  EXPECT_EQ(reduction_of(2), 1);
  Pack({2, 2, kPackedWidth, kPackedHeight});
  LfPixels pixels;
  EXPECT_FALSE(Opened()->LoadReduced({1}, 4, packed_.intrinsics[0], &pixels));
}

// The checksum of a front covers its bytes alone.
TEST_F(ReducedStoreTest, DamageIsFoundInTheFrontThatIsRead) {
  AddImages<uint8_t>(3);
  Pack();
  PackedCodeReader reader = PackedCodeReader::Open(path_).value();
  const PackedCode entry = FindCodes(path_, packed_.image_names).value()[3];
  const auto front = reader.ReadFront(entry, 2);
  ASSERT_TRUE(front && *front);
  const std::string front_bytes((*front)->code);
  const std::string bytes(reader.Read(entry)->code);
  ASSERT_LT(front_bytes.size() + 40, bytes.size());
  EXPECT_TRUE(bytes.starts_with(front_bytes));
  const std::string original = *ReadFile(path_);
  const auto reduced_after_damage = [&](size_t byte_of_code) {
    std::string file = original;
    const size_t at = file.find(bytes.substr(0, 200));
    EXPECT_NE(at, std::string::npos);
    file[at + byte_of_code] = static_cast<char>(file[at + byte_of_code] ^ 1);
    EXPECT_TRUE(WriteFileAtomically(path_, file));
    LfPixels pixels;
    const Result<int> reduction = Opened()->LoadReduced({3}, 4, packed_.intrinsics[0], &pixels);
    return reduction ? std::to_string(*reduction) : reduction.error().message;
  };
  EXPECT_EQ(reduced_after_damage(front_bytes.size() + 3), "4");
  EXPECT_NE(reduced_after_damage(front_bytes.size() - 3).find("store.lfs/image3.png: "),
            std::string::npos);
  EXPECT_NE(reduced_after_damage(front_bytes.size() - 3).find("checksum"), std::string::npos);
}

}  // namespace
}  // namespace lf
