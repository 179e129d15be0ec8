// SPDX-License-Identifier: Apache-2.0
// Tests stores that leave out LF images on purpose, because packages do not need them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/sqlite/database.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr PixelRect kPart = {10, 5, 60, 40};

class LeftOutTest : public ::testing::Test {
 protected:
  LeftOutTest()
      : folder_(fs::temp_directory_path() / ("lf_left_out_test." + std::to_string(::getpid()))),
        path_(folder_ / "a.lfs") {
    fs::create_directories(folder_);
    Intrinsics intrinsics;
    intrinsics.width_px = 100;
    intrinsics.height_px = 80;
    intrinsics.fx_px = intrinsics.fy_px = 90;
    field_.intrinsics = {intrinsics};
    for (uint32_t i = 0; i < 6; ++i) {
      field_.cameras.emplace_back().cam_from_world.translation = Vec3(i, 0, 0);
      field_.image_names.push_back("image" + std::to_string(i) + ".png");
    }
    plan_.whole = IdentityOf(field_);
    plan_.codec = "lossless, levels 3";
    plan_.rects.assign(field_.size(), kPart);
    plan_.rects[1] = plan_.rects[4] = {};
  }
  ~LeftOutTest() override { fs::remove_all(folder_); }

  // Writes a store in which LF image 2 could not be read.
  void Write() {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
    for (const uint32_t i : {0, 3, 5}) {
      CodedImage image;
      image.rect = kPart;
      image.code = "code";
      ASSERT_TRUE(writer.Add({i}, image));
    }
    ASSERT_TRUE(writer.Finish());
  }
  // Runs a script on the file, and returns the error of opening the store again; "": none.
  std::string ErrorAfter(const std::string& script) {
    fs::remove(path_);
    Write();
    {
      Database database = Database::OpenToAppend(path_, kStoreFormat).value();
      EXPECT_TRUE(database.Execute(script));
    }
    const auto codes = FindCodes(path_, field_);
    return codes ? "" : codes.error().message;
  }

  const fs::path folder_, path_;
  LightField field_;
  PackedStorePlan plan_;
};

TEST_F(LeftOutTest, AllLfCamerasStayAndTheMarksTellWhy) {
  for (const uint64_t shard_bytes : {0, 10}) {
    plan_.shard_bytes = shard_bytes;
    fs::remove(path_);
    Write();
    const Result<PackedStoreFacts> facts = ReadPackedStore(path_);
    ASSERT_TRUE(facts) << facts.error().message;
    EXPECT_EQ(facts->light_field.size(), 6u);
    EXPECT_EQ(facts->left_out_count, 2u);
    EXPECT_FALSE(facts->LacksCameras());
    EXPECT_EQ(IdentityOf(facts->light_field).calibration, plan_.whole.calibration);
    const std::vector<PackedCode> codes = FindCodes(path_, field_).value();
    for (uint32_t i = 0; i < codes.size(); ++i) {
      EXPECT_TRUE(codes[i].is_listed());
      EXPECT_EQ(codes[i].is_left_out, i == 1 || i == 4) << i;
      EXPECT_EQ(codes[i].bytes > 0, i == 0 || i == 3 || i == 5) << i;
    }
  }
}

TEST_F(LeftOutTest, OnlyPixelsThatWereAskedForAreKept) {
  Write();
  const std::vector<PackedCode> codes = FindCodes(path_, field_).value();
  EXPECT_TRUE(codes[0].Keeps({10, 5, 20, 20}));
  EXPECT_FALSE(codes[0].Keeps({9, 5, 20, 20}));
  EXPECT_FALSE(codes[1].Keeps({10, 5, 20, 20}));
  EXPECT_TRUE(codes[1].Keeps({}));
  EXPECT_TRUE(codes[2].Keeps({0, 0, 100, 80}));  // could not be read, and is skipped
  EXPECT_FALSE(PackedCode().Keeps({}));
}

TEST_F(LeftOutTest, AStoreOfAllHasNoMarks) {
  plan_.rects.assign(field_.size(), {0, 0, 100, 80});
  Write();
  EXPECT_EQ(ReadPackedStore(path_)->left_out_count, 0u);
  const std::vector<PackedCode> codes = FindCodes(path_, field_).value();
  for (const PackedCode& code : codes) EXPECT_FALSE(code.is_left_out);
  // Older programs, which do not know the table, read the store.
  Database database = OpenStoreDatabase(path_).value();
  EXPECT_FALSE(HasTable(&database, "left_out").value());
}

TEST_F(LeftOutTest, ImpossibleMarksAreErrors) {
  EXPECT_EQ(ErrorAfter(""), "");
  EXPECT_NE(ErrorAfter("insert into left_out values (6)").find("a.lfs"), std::string::npos);
  EXPECT_NE(ErrorAfter("insert into left_out values (-1)").find("a.lfs"), std::string::npos);
  EXPECT_NE(
      ErrorAfter("insert into left_out values (3)").find("LF image 3 is both encoded and left out"),
      std::string::npos);
}

TEST_F(LeftOutTest, AStoreThatLacksLfCamerasIsKnown) {
  plan_.whole.image_count = 9;
  Write();
  EXPECT_TRUE(ReadPackedStore(path_)->LacksCameras());
}

TEST_F(LeftOutTest, ItIsResumedWithTheSameOnly) {
  PackedStoreWriter::Create(path_, field_, plan_).value();
  PackedStorePlan other = plan_;
  other.rects[1] = kPart;
  const auto resumed = PackedStoreWriter::Resume(path_, field_, other);
  ASSERT_FALSE(resumed);
  EXPECT_NE(resumed.error().message.find("other parts of the LF images' pixels"),
            std::string::npos);
  EXPECT_TRUE(PackedStoreWriter::Resume(path_, field_, plan_));
}

TEST_F(LeftOutTest, AStoreThatStatesNoFootprintMatches) {
  Write();
  field_.encoding.footprint = PixelFootprint::kArea;
  EXPECT_TRUE(CheckIsOfPlan(path_, field_, plan_, false));
  fs::remove(path_);
  Write();
  field_.encoding.footprint = PixelFootprint::kPoint;
  const auto checked = CheckIsOfPlan(path_, field_, plan_, false);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("footprint"), std::string::npos);
}

}  // namespace
}  // namespace lf
