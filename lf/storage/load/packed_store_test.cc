// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/packed_store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "lf/core/file.h"
#include "lf/light_field/model/brackets.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/load/test_packed_store.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {
namespace {

TEST_F(PackedStoreTest, LoadsTheDepthsOfRecordedImagesAndTheTrustInVirtualOnes) {
  AddImages<uint8_t>(3);
  field_.cameras[1].is_virtual = field_.cameras[4].is_virtual = true;
  PackedStorePlan plan;
  plan.densified = DensifiedPlan{"settings", 0.25, 4, 2};
  const auto plane_of = [](uint32_t i) {
    Image<uint16_t> plane(kPackedWidth / 2, kPackedHeight / 2, 1, static_cast<uint16_t>(100 + i));
    plane.at(3, 5) = 0;
    return plane;
  };
  PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan).value();
  ASSERT_TRUE(writer.AddTrust({4}, Image<uint8_t>(kPackedWidth, kPackedHeight, 1, 170)));
  for (uint32_t i = 0; i < field_.size(); ++i) {
    const Result<RecordedImage> image = ReadRecordedImage(field_, {i}, kPackedWhole);
    ASSERT_TRUE(writer.Add({i}, CodeOf(*image, {.profile = CodecProfile::kLossless})));
    if (!field_.cameras[i].is_virtual && i != 5) {
      ASSERT_TRUE(writer.AddPlane({i}, PlaneKind::kDisparity, plane_of(i)));
    }
  }
  ASSERT_TRUE(writer.Finish());
  packed_ = ReadPackedStore(path_).value().light_field;
  const auto without = Opened();
  EXPECT_FALSE(without->LoadsDepths());
  EXPECT_TRUE(Loaded(*without, {0}, kPackedWhole).depths.numbers.empty());
  const auto store =
      OpenStore(packed_, Mosaics::kAsRecorded, StoreContent::kPixelsAndDepths).value();
  EXPECT_TRUE(store->LoadsDepths());
  for (uint32_t i = 0; i < kCount; ++i) {
    const LfPixels pixels = Loaded(*store, {i}, {3, 5, 17, 11});
    const LfDepths& depths = pixels.depths;
    EXPECT_EQ(pixels.trust.pixels(), Image<uint8_t>(i == 4 ? 14 : 0, 6, 1, 170).pixels());
    EXPECT_EQ(depths.numbers.empty(), field_.cameras[i].is_virtual || i == 5);
    if (depths.numbers.empty()) continue;
    EXPECT_EQ(depths.numbers.pixels(), plane_of(i).pixels());
    EXPECT_EQ(std::tuple(depths.least, depths.greatest, depths.divisor), std::tuple(0.25, 4, 2));
  }
}

TEST_F(PackedStoreTest, ColoursHaveTheBitsOfTheFolder) {
  AddImages<uint8_t>(3);
  Pack();
  ExpectTheBitsOfTheFolder();
}

TEST_F(PackedStoreTest, GreyHasTheBitsOfTheFolder) {
  AddImages<uint16_t>(1);
  Pack();
  ExpectTheBitsOfTheFolder();
}

TEST_F(PackedStoreTest, BracketsBecomeMasks) {
  AddImages<uint8_t>(3);
  field_.encoding.masks_clipped = true;
  field_.cameras[1].gain = 4;
  field_.cameras[2].gain = 16;
  EXPECT_EQ(ApplyBrackets(&field_), field_.size() - 1);
  Pack();
  EXPECT_TRUE(packed_.encoding.masks_clipped);
  for (uint32_t i = 0; i < 3; ++i)
    EXPECT_TRUE(Loaded(*Opened(), {i}, kPackedWhole).any_masked) << i;
  ExpectTheBitsOfTheFolder();
}

TEST_F(PackedStoreTest, BracketsOfMosaicsBecomeMasks) {
  AddImages<uint16_t>(1);
  field_.encoding.bayer = BayerPattern::kRggb;
  field_.encoding.masks_clipped = true;
  field_.cameras[1].gain = 4;
  ApplyBrackets(&field_);
  Pack();
  EXPECT_TRUE(Loaded(*Opened(), {0}, kPackedWhole).any_masked);
  ExpectTheBitsOfTheFolder();
  ExpectTheBitsOfTheFolder(Mosaics::kToRgb);
}

TEST_F(PackedStoreTest, AlphaAndMaskFilesBecomeMasks) {
  AddImages<uint8_t>(4);
  MaskRow7OfImage2();
  Pack();
  EXPECT_TRUE(packed_.mask_names.empty());
  ExpectTheBitsOfTheFolder();
  EXPECT_TRUE(Loaded(*Opened(), {2}, kPackedWhole).IsMasked(4, 7));
}

TEST_F(PackedStoreTest, MasksOfAPartLieWhereThePartDoes) {
  const PixelRect part = {5, 3, 33, 27};
  for (const int channels : {4, 3}) {  // with alpha and a mask file; with a mask file alone
    AddImages<uint8_t>(channels);
    MaskRow7OfImage2();
    Pack(part);
    ExpectTheBitsOfTheFolder(Mosaics::kAsRecorded, {part, {8, 5, 20, 11}, {32, 3, 33, 27}});
    const LfPixels pixels = Loaded(*Opened(), {2}, part);
    for (int x = 0; x < part.width(); ++x) EXPECT_TRUE(pixels.IsMasked(x, 7 - 3)) << x;
    EXPECT_TRUE(channels == 4 || !pixels.IsMasked(0, 7 - 3 + 1));
    field_.mask_names.clear();
    field_.image_names.clear();
    field_.cameras.clear();
  }
}

TEST_F(PackedStoreTest, AlphaThatIsLightHasTheBitsOfTheFolder) {
  for (const AlphaMeaning alpha : {AlphaMeaning::kStraight, AlphaMeaning::kPremultiplied}) {
    field_.encoding.alpha = alpha;
    field_.encoding.background = {0.5, 0.25, 1};
    AddImages<uint16_t>(4);
    MaskRow7OfImage2();
    Pack();
    EXPECT_EQ(packed_.encoding.alpha, alpha);
    EXPECT_EQ(packed_.encoding.background, field_.encoding.background);
    ExpectTheBitsOfTheFolder();
    EXPECT_TRUE(Loaded(*Opened(), {2}, kPackedWhole).IsMasked(4, 7));
    // The background is applied when images are loaded, not when they are encoded.
    field_.encoding.background = packed_.encoding.background = {0, 0, 0};
    ExpectTheBitsOfTheFolder();
    field_.mask_names.clear();
    field_.image_names.clear();
    field_.cameras.clear();
  }
}

TEST_F(PackedStoreTest, OpacitiesHaveTheBitsOfTheFolderAlsoOfImagesWithoutAlpha) {
  for (const int channels : {4, 3}) {
    field_.encoding.alpha = AlphaMeaning::kStraight;
    field_.encoding.background = {0, 0, 0};
    field_.encoding.keeps_opacity = true;
    AddImages<uint8_t>(channels);
    MaskRow7OfImage2();
    Pack();
    EXPECT_TRUE(packed_.encoding.HasOpacity());
    ExpectTheBitsOfTheFolder();
    const FolderStore folder(field_);
    for (const uint32_t i : {0u, 2u}) {
      const LfPixels packed = Loaded(*Opened(), {i}, kPackedWhole);
      EXPECT_EQ(packed.IsMasked(4, 7), i == 2);
      EXPECT_FALSE(packed.opacity.empty());
      EXPECT_EQ(packed.opacity.pixels(), Loaded(folder, {i}, kPackedWhole).opacity.pixels());
    }
    field_.mask_names.clear();
    field_.image_names.clear();
    field_.cameras.clear();
  }
}

TEST_F(PackedStoreTest, AlphaIsNotTakenForWhatItWasNotCodedAs) {
  AddImages<uint8_t>(4);
  Pack();
  packed_.encoding.alpha = AlphaMeaning::kStraight;
  EXPECT_NE(ErrorOf(*Opened(), {0}).find("stored in the packed store as a mask, but needed as"),
            std::string::npos);
  field_.encoding.alpha = AlphaMeaning::kStraight;
  Pack();
  packed_.encoding.alpha = AlphaMeaning::kMask;
  EXPECT_NE(ErrorOf(*Opened(), {0}).find("stored in the packed store as opacity, but needed as"),
            std::string::npos);
}

TEST_F(PackedStoreTest, MosaicsHaveTheBitsOfTheFolderAsRecordedAndAsRgb) {
  field_.encoding.bayer = BayerPattern::kGbrg;
  field_.encoding.transfer = Transfer::kLinear;
  field_.encoding.black_level = 64;
  field_.encoding.pedestal = 1024;
  field_.encoding.white_balance = {2, 1, 1.5};
  AddImages<uint16_t>(1);
  field_.mask_names.resize(field_.size());
  field_.mask_names[1] = "mask.png";
  Image<uint8_t> mask(kPackedWidth, kPackedHeight, 1, 255);
  mask.at(9, 9) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "mask.png", mask.view()));
  Pack();
  ExpectTheBitsOfTheFolder();
  ExpectTheBitsOfTheFolder(Mosaics::kToRgb);
}

TEST_F(PackedStoreTest, APartServesWhatItWasRecordedFor) {
  field_.encoding.bayer = BayerPattern::kRggb;
  AddImages<uint8_t>(1);
  const PixelRect needed = {14, 14, 20, 16};
  const PixelRect recorded = RectToRecord(field_, {0}, needed);
  EXPECT_EQ(recorded, (PixelRect{1, 1, 33, 29}));
  Pack(recorded);
  ExpectTheBitsOfTheFolder(Mosaics::kToRgb, {needed});
  ExpectTheBitsOfTheFolder(Mosaics::kAsRecorded, {needed, recorded});
  const auto as_rgb = PackedStore::Open(packed_, Mosaics::kToRgb).value();
  EXPECT_TRUE(as_rgb->IsPartial());
  EXPECT_TRUE(as_rgb->Keeps({1}, needed));
  for (const PixelRect& more :
       {PixelRect{13, 14, 20, 16}, {14, 13, 20, 16}, {14, 14, 21, 16}, {14, 14, 20, 17}})
    EXPECT_FALSE(as_rgb->Keeps({1}, more)) << more.x_begin << " " << more.y_begin;
  const std::string fault = ErrorOf(*Opened(), {1}, {0, 14, 20, 16});
  EXPECT_NE(fault.find("store.lfs/image1.png: its pixels [0, 20) x [14, 16) (x, y) are needed, but "
                       "only [1, 33) x [1"),
            std::string::npos)
      << fault;
}

TEST_F(PackedStoreTest, HalfFloatsHaveTheBitsOfTheFolder) {
  field_.encoding.max_radiance = 16;
  for (uint32_t i = 0; i < 3; ++i) {
    Image<float> image(kPackedWidth, kPackedHeight, 4);
    for (size_t k = 0; k < image.pixels().size(); ++k)
      image.pixels()[k] = static_cast<float>(RandomUnit(1, i, k) * 20 - 1);
    image.at(3, 3, 0) = std::numeric_limits<float>::quiet_NaN();
    image.at(4, 3, 0) = std::numeric_limits<float>::infinity();
    const std::string name = "image" + std::to_string(i) + ".exr";
    ASSERT_TRUE(WriteImage(folder_ / name, image.view(), {"R", "G", "B", "A"}, PixelType::kHalf));
    AddImage(name, i == 1 ? 2.5f : 1.f);
  }
  Pack();
  ExpectTheBitsOfTheFolder();
}

TEST_F(PackedStoreTest, FloatsAreRoundedToHalf) {
  Image<float> image(kPackedWidth, kPackedHeight, 3, 0.1f);
  ASSERT_TRUE(WriteImage(folder_ / "a.exr", image.view(), {"R", "G", "B"}, PixelType::kFloat));
  AddImage("a.exr");
  is_rounded_ = true;
  Pack();
  const LfPixels exact = Loaded(FolderStore(field_), {0}, kPackedWhole);
  const LfPixels packed = Loaded(*Opened(), {0}, kPackedWhole);
  EXPECT_NEAR(packed.radiance.at(0, 0, 0), exact.radiance.at(0, 0, 0), 6554.0 / 2048);
}

TEST_F(PackedStoreTest, LightThatHalfFloatsCannotHoldIsRefused) {
  Image<float> image(kPackedWidth, kPackedHeight, 3, 0.1f);
  image.at(7, 5, 1) = 1e5f;
  image.at(8, 5, 1) = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(WriteImage(folder_ / "a.exr", image.view(), {"R", "G", "B"}, PixelType::kFloat));
  AddImage("a.exr");
  field_.encoding.max_radiance = 16;
  const auto error = [&](float gain) {
    field_.cameras[0].gain = gain;
    const Result<RecordedImage> recorded = ReadRecordedImage(field_, {0}, kPackedWhole);
    return recorded ? std::string() : recorded.error().message;
  };
  EXPECT_EQ(error(1), "");  // such light is clipped in any case
  EXPECT_NE(error(1e-4f).find("a.exr: has the value 100000, but packed stores hold floats up to "),
            std::string::npos);
  EXPECT_EQ(error(4000), "");
  EXPECT_NE(error(5000).find("a.exr: lf_gain multiplies its values by up to 5000"),
            std::string::npos);
}

TEST_F(PackedStoreTest, LightFieldsOfOtherOrderFindTheirImages) {
  AddImages<uint8_t>(3);
  Pack();
  LightField part = field_;
  part.folder = path_;
  part.image_names = {"image5.png", "other.png", "image2.png"};
  part.cameras = {field_.cameras[5], field_.cameras[0], field_.cameras[2]};
  const auto store = OpenStore(part, Mosaics::kAsRecorded).value();
  const FolderStore files(field_);
  ExpectSame(Loaded(*store, {0}, kPackedWhole), Loaded(files, {5}, kPackedWhole));
  ExpectSame(Loaded(*store, {2}, kPackedWhole), Loaded(files, {2}, kPackedWhole));
  EXPECT_TRUE(store->IsThere({2}));
  EXPECT_FALSE(store->IsThere({1}));
  EXPECT_GT(store->StoredBytes({2}), 0u);
  EXPECT_EQ(store->StoredBytes({1}), 0u);
  EXPECT_NE(ErrorOf(*store, {1}).find("store.lfs/other.png: is not in the packed store"),
            std::string::npos);
}

TEST_F(PackedStoreTest, ADamagedCodeIsAnErrorOfItsImageAlone) {
  AddImages<uint8_t>(3);
  Pack();
  // The bytes of one encoded image are located in the file by their content.
  std::string file = *ReadFile(path_);
  PackedCodeReader reader = PackedCodeReader::Open(path_).value();
  const PackedCode code = FindCodes(path_, field_.image_names).value()[3];
  const std::string bytes(reader.Read(code)->code);
  const size_t at = file.find(bytes.substr(bytes.size() / 2, 40));
  ASSERT_NE(at, std::string::npos);
  file[at] = static_cast<char>(file[at] ^ 1);
  ASSERT_TRUE(WriteFileAtomically(path_, file));
  const auto store = Opened();
  EXPECT_NE(ErrorOf(*store, {3}).find("store.lfs/image3.png: "), std::string::npos);
  EXPECT_NE(ErrorOf(*store, {3}).find("checksum"), std::string::npos);
  ExpectSame(Loaded(*store, {4}, kPackedWhole), Loaded(FolderStore(field_), {4}, kPackedWhole));
}

TEST_F(PackedStoreTest, CodesOfSomethingElseAreErrors) {
  AddImages<uint8_t>(3);
  const auto code_of = [&](const CodecPixels& pixels, PixelLayout layout) {
    CodedImage coded;
    coded.rect = kPackedWhole;
    coded.code = EncodeImage(pixels, layout, {.profile = CodecProfile::kLossless});
    return coded;
  };
  const Image<uint8_t> rgb = NoiseImage<uint8_t>(kPackedWidth, kPackedHeight, 3);
  std::vector<CodedImage> codes(6);
  codes[0] = code_of(NoiseImage<uint8_t>(kPackedWidth, kPackedHeight + 1, 3), PixelLayout::kRgb);
  codes[1] = code_of(NoiseImage<uint16_t>(kPackedWidth, kPackedHeight, 3), PixelLayout::kRgb);
  codes[2] = code_of(NoiseImage<uint8_t>(kPackedWidth, kPackedHeight, 1), PixelLayout::kMosaic);
  codes[3] = code_of(rgb, PixelLayout::kRgb);
  codes[3].code = "no code";
  codes[4] = code_of(rgb, PixelLayout::kRgb);
  codes[4].mask = codes[4].code;
  codes[5] = code_of(rgb, PixelLayout::kRgb);
  codes[5].rect = {0, 1, kPackedWidth, kPackedHeight + 1};
  PackedStorePlan plan;
  {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan).value();
    for (uint32_t i = 0; i < 6; ++i) ASSERT_TRUE(writer.Add({i}, codes[i]));
    ASSERT_TRUE(writer.Finish());
  }
  packed_ = ReadPackedStore(path_).value().light_field;
  const auto store = Opened();
  for (uint32_t i = 0; i < 6; ++i)
    EXPECT_TRUE(ErrorOf(*store, {i}).starts_with(packed_.ImagePath({i}).string() + ": ")) << i;
}

TEST_F(PackedStoreTest, ImagesWithoutACodeAreTold) {
  AddImages<uint8_t>(3);
  {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, {}).value();
    ASSERT_TRUE(writer.Finish());
  }
  packed_ = ReadPackedStore(path_).value().light_field;
  const auto store = Opened();
  EXPECT_FALSE(store->IsThere({2}));
  EXPECT_NE(ErrorOf(*store, {2}).find("image2.png: is not in the packed store"), std::string::npos);
}

TEST_F(PackedStoreTest, ImagesThatWereLeftOutAreNotKept) {
  AddImages<uint8_t>(3);
  {
    PackedStorePlan plan;
    plan.rects.assign(field_.size(), kPackedWhole);
    plan.rects[2] = {};
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan).value();
    ASSERT_TRUE(writer.Finish());
  }
  packed_ = ReadPackedStore(path_).value().light_field;
  const auto store = Opened();
  EXPECT_TRUE(store->IsPartial());
  EXPECT_FALSE(store->IsThere({2}));
  EXPECT_FALSE(store->Keeps({2}, {0, 0, 1, 1}));
  EXPECT_TRUE(store->Keeps({2}, {50, 50, 60, 60}));  // beyond the image
  EXPECT_TRUE(store->Keeps({1}, kPackedWhole));      // could not be read, and is skipped
  EXPECT_NE(ErrorOf(*store, {2}).find("no package needed it"), std::string::npos);
}

TEST_F(PackedStoreTest, LevelsBeyondTheBitsAreAnError) {
  AddImages<uint8_t>(3);
  Pack();
  packed_.encoding.white_level = 4095;
  EXPECT_NE(ErrorOf(*Opened(), {0}).find("contains values of 8 bits"), std::string::npos);
}

TEST_F(PackedStoreTest, ManyReadAtOnce) {
  AddImages<uint8_t>(4);
  Pack(kPackedWhole, 9000);
  const auto store = Opened();
  const FolderStore files(field_);
  std::vector<LfPixels> expected;
  for (uint32_t i = 0; i < kCount; ++i) expected.push_back(Loaded(files, {i}, kPackedWhole));
  std::atomic<int> faults = 0;
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      LfPixels pixels;
      for (uint32_t round = 0; round < 60; ++round) {
        const uint32_t i = (round * (t + 1) + t) % kCount;
        if (!store->Load({i}, kPackedWhole, &pixels) ||
            pixels.radiance.pixels() != expected[i].radiance.pixels())
          ++faults;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(faults, 0);
}

TEST_F(PackedStoreTest, NoStoreIsAnError) {
  AddImage("a.png");
  field_.folder = path_;
  EXPECT_NE(OpenStore(field_, Mosaics::kAsRecorded).error().message.find("no such file"),
            std::string::npos);
}

}  // namespace
}  // namespace lf
