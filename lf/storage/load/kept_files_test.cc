// SPDX-License-Identifier: Apache-2.0
// Tests image files that packed stores keep as they are.
#include <gtest/gtest.h>

#include <string>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/test_packed_store.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

using KeptFilesTest = PackedStoreTest;

// Image files in a store give the bits of the folder: JPEG, colours, grey, floats beyond half
// floats, mosaics, alpha as a mask and as opacity, mask files, and in shards.
TEST_F(KeptFilesTest, FilesGiveTheBitsOfTheFolder) {
  const auto check = [&](Mosaics mosaics = Mosaics::kAsRecorded, uint64_t shard_bytes = 0) {
    Pack(kPackedWhole, shard_bytes, true);
    EXPECT_EQ(FindCodes(path_, packed_.image_names).value()[0].values, StoredValues::kFile);
    ExpectTheBitsOfTheFolder(mosaics);
    field_.image_names.clear();
    field_.cameras.clear();
    field_.mask_names.clear();
    field_.encoding = {};
  };
  AddImages<uint8_t>(3, ".jpg");
  check();
  AddImages<uint16_t>(1);
  check(Mosaics::kAsRecorded, 3000);
  AddImages<uint8_t>(4);  // with alpha
  MaskRow7OfImage2();
  check();
  AddImages<uint8_t>(4);
  field_.encoding.alpha = AlphaMeaning::kStraight;
  field_.encoding.background = std::array{0.2, 0.5, 1.};
  check();
  AddImages<uint16_t>(1);
  field_.encoding.bayer = BayerPattern::kGrbg;
  field_.encoding.transfer = Transfer::kLinear;
  check(Mosaics::kToRgb);
  // Half floats would round these.
  is_rounded_ = true;
  Image<float> bright(kPackedWidth, kPackedHeight, 3);
  for (size_t i = 0; i < bright.pixels().size(); ++i)
    bright.pixels()[i] = 1.00001F + static_cast<float>(i) * 0.01F;
  ASSERT_TRUE(
      WriteImage(folder_ / "bright.exr", bright.view(), {"R", "G", "B"}, PixelType::kFloat));
  AddImage("bright.exr");
  field_.encoding.max_radiance = 50;
  check();
}

// A JPEG file in a store is loaded at a reduced size as one in a folder is.
TEST_F(KeptFilesTest, FilesAreReducedAsThoseOfTheFolder) {
  AddImages<uint8_t>(3, ".jpg");
  Pack(kPackedWhole, 0, true);
  const FolderStore files(field_);
  for (uint32_t i = 0; i < kCount; ++i)
    for (const int divisor : {2, 3, 4, 8}) {
      LfPixels of_store, of_folder;
      const Intrinsics& k = field_.intrinsics[0];
      const Result<int> reduction = Opened()->LoadReduced({i}, divisor, k, &of_store);
      ASSERT_TRUE(reduction);
      EXPECT_EQ(*reduction, divisor == 3 ? 1 : divisor);
      EXPECT_EQ(*reduction, *files.LoadReduced({i}, divisor, k, &of_folder));
      ExpectSame(of_store, of_folder);
    }
}

// A file in a store may be damaged like one in a folder; its checksum may be right.
TEST_F(KeptFilesTest, ADamagedFileIsAnErrorOfItsImage) {
  AddImages<uint8_t>(3);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "image3.png", "no picture"));
  PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, {}).value();
  CodedImage coded;
  coded.values = StoredValues::kFile;
  coded.rect = kPackedWhole;
  coded.code = "no picture";
  ASSERT_TRUE(writer.Add({3}, coded));
  ASSERT_TRUE(writer.Finish());
  packed_ = ReadPackedStore(path_).value().light_field;
  EXPECT_TRUE(ErrorOf(*Opened(), {3}).starts_with(packed_.ImagePath({3}).string() + ": "));
}

}  // namespace
}  // namespace lf
