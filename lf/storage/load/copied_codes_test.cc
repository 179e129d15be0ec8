// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/copied_codes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "lf/pixels/files/test_folder.h"
#include "lf/storage/load/packed_store.h"
#include "lf/storage/load/test_predicted_store.h"

namespace lf {
namespace {

class CopiedCodesTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    path_ = folder_ / "a.lfs";
    images_.Write(path_);
    field_ = ReadPackedStore(path_).value().light_field;
  }
  // Returns the light field of some LF images of the store.
  LightField Part(const std::vector<uint32_t>& ids) const {
    LightField part = field_;
    part.image_names.clear();
    part.cameras.clear();
    for (const uint32_t id : ids) {
      part.image_names.push_back(field_.image_names[id]);
      part.cameras.push_back(field_.cameras[id]);
    }
    return part;
  }
  static std::vector<uint32_t> Values(const std::vector<LfImageId>& ids) {
    std::vector<uint32_t> values;
    for (const LfImageId id : ids) values.push_back(id.value);
    return values;
  }

  const PredictedImages images_ = MakePredictedImages({});
  std::filesystem::path path_;
  LightField field_;
};

TEST_F(CopiedCodesTest, AllKeepTheirReferences) {
  const auto copied = CopiedCodes::Open(field_).value();
  EXPECT_TRUE(copied->ArePredicted());
  PackedStorePlan plan;
  copied->Describe(&plan);
  EXPECT_TRUE(plan.is_predicted);
  for (uint32_t id = 0; id < kPredictedImages; ++id) {
    const CodedImage image = copied->Of({id}).value();
    EXPECT_EQ(image.code, images_.coded[id].code);
    EXPECT_EQ(Values(image.references), kReferencesOfImages[id]);
    EXPECT_EQ(image.front_ends.empty(), !image.references.empty());
  }
  EXPECT_EQ(Values(copied->NeededBy({6})), (std::vector<uint32_t>{3, 5, 0, 4, 1, 6}));
}

// The copy of a part of the light field has ids of its own. LF images whose reference images it
// lacks are encoded alone, with the same pixels.
TEST_F(CopiedCodesTest, PartsKeepWhatTheyCan) {
  const LightField part = Part({6, 5, 4, 1, 3, 0});
  {
    const auto copied = CopiedCodes::Open(part).value();
    EXPECT_EQ(Values(copied->ReferencesOf({3})), (std::vector<uint32_t>{2, 4, 1, 5}));
    EXPECT_EQ(Values(copied->NeededBy({0})), (std::vector<uint32_t>{4, 1, 5, 2, 3, 0}));
  }
  const LightField less = Part({6, 5, 4, 1, 0});  // LF image 3 is missing
  const auto copied = CopiedCodes::Open(less).value();
  EXPECT_EQ(Values(copied->NeededBy({0})), (std::vector<uint32_t>{3, 0}));
  EXPECT_EQ(Values(copied->NeededBy({2})), (std::vector<uint32_t>{4, 2}));
  PackedStorePlan plan;
  plan.whole = IdentityOf(less);
  copied->Describe(&plan);
  const std::filesystem::path to = folder_ / "to.lfs";
  PackedStoreWriter writer = PackedStoreWriter::Create(to, less, plan).value();
  for (const uint32_t id : {3, 0, 1, 4, 2}) {
    const CodedImage image = copied->Of({id}).value();
    EXPECT_EQ(image.references.empty(), id == 1 || id == 3 || id == 4) << id;
    ASSERT_TRUE(writer.Add({id}, image));
  }
  ASSERT_TRUE(writer.Finish());
  const LightField read = ReadPackedStore(to).value().light_field;
  const auto store = PackedStore::Open(read, Mosaics::kAsRecorded).value();
  const auto original = PackedStore::Open(less, Mosaics::kAsRecorded).value();
  const PixelRect rect = {0, 0, images_.kind.width, images_.kind.height};
  for (uint32_t id = 0; id < less.size(); ++id) {
    LfPixels loaded, expected;
    ASSERT_TRUE(store->Load({id}, rect, &loaded));
    ASSERT_TRUE(original->Load({id}, rect, &expected));
    EXPECT_EQ(loaded.radiance.pixels(), expected.radiance.pixels());
  }
}

TEST_F(CopiedCodesTest, OtherStoresAreNotPredicted) {
  const std::filesystem::path alone = folder_ / "alone.lfs";
  images_.WriteAlone(alone);
  const LightField field = ReadPackedStore(alone).value().light_field;
  const auto copied = CopiedCodes::Open(field).value();
  EXPECT_FALSE(copied->ArePredicted());
  EXPECT_EQ(Values(copied->NeededBy({4})), std::vector<uint32_t>{4});
}

}  // namespace
}  // namespace lf
