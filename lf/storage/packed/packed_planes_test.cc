// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/packed_planes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/packed/plane_table.h"

namespace lf {
namespace {

namespace fs = std::filesystem;
using enum PlaneKind;

constexpr uint32_t kRecorded = 4, kAll = 7;  // the last three LF images are virtual

LightField DensifiedField() {
  LightField field;
  field.folder = "/nowhere";
  field.intrinsics = {{50, 50, 21, 12, 0, 42, 25, {}}};
  for (uint32_t i = 0; i < kAll; ++i) {
    field.cameras.emplace_back().cam_from_world.translation.x() = i;
    field.cameras.back().is_virtual = i >= kRecorded;
    field.image_names.push_back((i < kRecorded ? "images/" : "virtual/") + std::to_string(i));
  }
  return field;
}

CodedImage TestCode(uint32_t i) {
  CodedImage image;
  image.rect = {0, 0, 42, 25};
  image.code = "encoded image " + std::to_string(i);
  return image;
}

Image<uint16_t> TestPlane(uint32_t i, PlaneKind kind) {
  Image<uint16_t> plane(21, 13);
  for (size_t k = 0; k < plane.pixels().size(); ++k)
    plane.pixels()[k] = static_cast<uint16_t>(
        i == 1 ? 500 + k : RandomBits(6, i, k + 1000 * static_cast<size_t>(kind)));
  return plane;
}

// Trust has one number for each pixel, whatever the divisor of the other planes is.
Image<uint8_t> TestTrust(uint32_t i) {
  Image<uint8_t> trust(42, 25);
  for (size_t k = 0; k < trust.pixels().size(); ++k)
    trust.pixels()[k] = static_cast<uint8_t>(i == 4 ? k / 8 : RandomBits(8, i, k));
  return trust;
}

class PackedPlanesTest : public ::testing::Test {
 protected:
  PackedPlanesTest()
      : folder_(fs::temp_directory_path() /
                ("lf_planes_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())),
        path_(folder_ / "dense.lfs") {
    fs::create_directories(folder_);
    plan_.whole = {4, "0123456789abcdef", "fedcba9876543210"};
    plan_.codec = "lossless, levels 4";
    plan_.densified = DensifiedPlan{"steps 5, seed 3", 0.1 + 0.2, 1e3 / 3, 2};
  }
  ~PackedPlanesTest() override { fs::remove_all(folder_); }

  PackedStoreWriter Writer() {
    Result<PackedStoreWriter> writer = PackedStoreWriter::Resume(path_, field_, plan_);
    EXPECT_TRUE(writer) << (writer ? "" : writer.error().message);
    return *std::move(writer);
  }
  // Adds what the store lacks, and completes it.
  void Finish(PackedStoreWriter writer) {
    for (uint32_t i = 0; i < field_.size(); ++i) {
      if (!writer.Has({i})) {
        ASSERT_TRUE(writer.Add({i}, TestCode(i)));
      }
      if (!plan_.densified || i >= kRecorded || i == 3 || writer.HasPlane({i}, kDisparity))
        continue;
      ASSERT_TRUE(writer.AddPlane({i}, kDisparity, TestPlane(i, kDisparity)));
    }
    ASSERT_TRUE(writer.Finish());
  }
  // Fails unless the store has disparities of the first three LF images, and no other plane.
  void ExpectPlanes() {
    PackedPlaneReader reader = PackedPlaneReader::Open(path_).value();
    for (uint32_t i = 0; i < kAll; ++i) {
      EXPECT_EQ(reader.Has({i}, kDisparity).value(), i < 3) << i;
      EXPECT_FALSE(reader.Has({i}, kSwept).value()) << i;
      const auto plane = reader.Read({i}, kDisparity);
      EXPECT_EQ(plane.has_value(), i < 3) << i;
      if (plane) {
        EXPECT_TRUE(std::ranges::equal(plane->pixels(), TestPlane(i, kDisparity).pixels())) << i;
      } else {
        EXPECT_NE(plane.error().message.find("lacks the plane disparity of LF image"),
                  std::string::npos);
      }
    }
  }
  std::string FirstDifferenceTo(const LightField& field, const PackedStorePlan& plan) const {
    const auto writer = PackedStoreWriter::Resume(path_, field, plan);
    if (writer) return "";
    EXPECT_EQ(writer.error().kind, ErrorKind::kUsage);
    return writer.error().message;
  }
  void Execute(const std::string& sql) const {
    const auto done = Database::OpenToAppend(path_, kStoreFormat).value().Execute(sql);
    ASSERT_TRUE(done) << done.error().message;
  }
  std::string Fault() const {
    const auto facts = ReadPackedStore(path_);
    return facts ? "" : facts.error().message;
  }

  fs::path folder_, path_;
  LightField field_ = DensifiedField();
  PackedStorePlan plan_;
};

TEST_F(PackedPlanesTest, MarksAndPlanesAreReadToTheBit) {
  for (const uint64_t shard_bytes : {0, 40}) {
    plan_.shard_bytes = shard_bytes;
    Finish(Writer());
    const PackedStoreFacts facts = ReadPackedStore(path_).value();
    EXPECT_EQ(facts.densified, plan_.densified);
    EXPECT_EQ(facts.shard_count > 0, shard_bytes > 0);
    EXPECT_EQ(facts.whole, plan_.whole);
    for (uint32_t i = 0; i < kAll; ++i) {
      EXPECT_EQ(facts.light_field.cameras[i].is_virtual, i >= kRecorded);
      EXPECT_EQ(facts.whole_ids[i], i < kRecorded ? i : kNoWholeId);
    }
    EXPECT_EQ(IdentityOf(facts.light_field), IdentityOf(field_));
    ExpectPlanes();
  }
}

TEST_F(PackedPlanesTest, TrustOfVirtualImagesIsReadAsItWasRounded) {
  {
    PackedStoreWriter writer = Writer();
    ASSERT_TRUE(writer.AddTrust({4}, TestTrust(4)));
    ASSERT_TRUE(writer.Commit());
    ASSERT_TRUE(writer.AddTrust({5}, TestTrust(5)));  // not committed
  }
  PackedStoreWriter writer = Writer();
  EXPECT_TRUE(writer.HasPlane({4}, kTrust));
  EXPECT_FALSE(writer.HasPlane({5}, kTrust));
  ASSERT_TRUE(writer.AddTrust({6}, TestTrust(6)));
  ASSERT_TRUE(writer.DropPlanes(kSwept));
  Finish(std::move(writer));
  ExpectPlanes();
  PackedPlaneReader reader = PackedPlaneReader::Open(path_).value();
  for (uint32_t i = 0; i < kAll; ++i) {
    EXPECT_EQ(reader.Has({i}, kTrust).value(), i == 4 || i == 6) << i;
    const auto whole = reader.ReadTrust({i}, {0, 0, 42, 25});
    const auto part = reader.ReadTrust({i}, {3, 5, 40, 24});
    ASSERT_EQ(whole.has_value(), i == 4 || i == 6);
    if (!whole) {
      EXPECT_NE(whole.error().message.find("lacks the plane trust of LF image"), std::string::npos);
      continue;
    }
    for (size_t k = 0; k < whole->pixels().size(); ++k) {
      const int trust = TestTrust(i).pixels()[k], read = whole->pixels()[k];
      ASSERT_EQ(read % 17, 0);
      ASSERT_LE(std::abs(read - trust), 8);
    }
    ASSERT_EQ(std::pair(part->width(), part->height()), std::pair(37, 19));
    for (int y = 0; y < 19; ++y)
      for (int x = 0; x < 37; ++x) ASSERT_EQ(part->at(x, y), whole->at(x + 3, y + 5));
    const auto beyond = reader.ReadTrust({i}, {0, 0, 43, 25});
    ASSERT_FALSE(beyond);
    EXPECT_NE(beyond.error().message.find("plane trust of LF image"), std::string::npos);
  }
}

TEST_F(PackedPlanesTest, DamagedTrustIsAnError) {
  PackedStoreWriter writer = Writer();
  ASSERT_TRUE(writer.AddTrust({4}, TestTrust(4)));
  Finish(std::move(writer));
  const std::string good = EncodeTrust(TestTrust(4));
  std::string flipped = good;
  flipped.back() = static_cast<char>(flipped.back() ^ 1);
  for (const std::string& code :
       {flipped, good.substr(0, good.size() / 2), EncodeTrust(Image<uint8_t>(42, 24)),
        EncodePlane(Image<uint16_t>(42, 25)), std::string("no encoded image"),
        EncodeImage(Image<uint8_t>(42, 25, 1, 16), PixelLayout::kGrey,
                    {.profile = CodecProfile::kLossless})}) {
    {
      Database database = Database::OpenToAppend(path_, kStoreFormat).value();
      Statement update = database.Prepare("update planes set plane = ?1 where id = 4").value();
      update.BindBlob(0, code);
      ASSERT_TRUE(update.Run());
    }
    const auto trust = PackedPlaneReader::Open(path_).value().ReadTrust({4}, {0, 0, 42, 25});
    ASSERT_FALSE(trust);
    EXPECT_EQ(trust.error().kind, ErrorKind::kInput);
    EXPECT_TRUE(trust.error().message.starts_with(path_.string() + ": plane trust of LF image 4"))
        << trust.error().message;
  }
}

TEST_F(PackedPlanesTest, AStoreMayBeDensifiedByNoVirtualImage) {
  for (LfCamera& camera : field_.cameras) camera.is_virtual = false;
  Finish(Writer());
  EXPECT_EQ(ReadPackedStore(path_)->densified, plan_.densified);
  EXPECT_FALSE(HasVirtual(ReadPackedStore(path_)->light_field));
  ExpectPlanes();
}

// Programs that know no densified stores accept only the tables of ordinary ones.
TEST_F(PackedPlanesTest, OnlyADensifiedStoreHasFurtherTables) {
  const std::string ordinary =
      std::string(kSettingsTable) + kIntrinsicsTable + kStoreTables + kBlobsTable + kFrontsTable;
  Finish(Writer());
  const auto refused = Database::Open(path_, kStoreFormat, {ordinary});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("made by another program: its tables are not those of a "
                                         "packed store"),
            std::string::npos);

  plan_.densified.reset();
  for (LfCamera& camera : field_.cameras) camera.is_virtual = false;
  Finish(Writer());
  EXPECT_TRUE(Database::Open(path_, kStoreFormat, {ordinary}));
  EXPECT_FALSE(ReadPackedStore(path_)->densified);
  const auto reader = PackedPlaneReader::Open(path_);
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().kind, ErrorKind::kInput);
  EXPECT_NE(reader.error().message.find("dense.lfs: is not densified"), std::string::npos);
}

TEST_F(PackedPlanesTest, AResumedStoreHasThePlanesOfCommittedBatches) {
  for (const uint64_t shard_bytes : {0, 40}) {
    plan_.shard_bytes = shard_bytes;
    {
      PackedStoreWriter writer = Writer();
      for (uint32_t i = 0; i < kRecorded; ++i)
        ASSERT_TRUE(writer.AddPlane({i}, kSwept, TestPlane(i, kSwept)));
      ASSERT_TRUE(writer.Add({1}, TestCode(1)));
      ASSERT_TRUE(writer.AddPlane({2}, kDisparity, TestPlane(2, kDisparity)));
      ASSERT_TRUE(writer.Commit());
      ASSERT_TRUE(writer.AddPlane({0}, kDisparity, TestPlane(0, kDisparity)));  // not committed
      EXPECT_TRUE(writer.HasPlane({0}, kDisparity));
      EXPECT_TRUE(std::ranges::equal(writer.ReadPlane({0}, kDisparity)->pixels(),
                                     TestPlane(0, kDisparity).pixels()));
    }
    PackedStoreWriter writer = Writer();
    for (uint32_t i = 0; i < kRecorded; ++i) {
      EXPECT_EQ(writer.HasPlane({i}, kDisparity), i == 2);
      ASSERT_TRUE(writer.HasPlane({i}, kSwept));
      EXPECT_TRUE(std::ranges::equal(writer.ReadPlane({i}, kSwept)->pixels(),
                                     TestPlane(i, kSwept).pixels()));
    }
    ASSERT_TRUE(writer.DropPlanes(kSwept));
    EXPECT_FALSE(writer.HasPlane({2}, kSwept));
    EXPECT_TRUE(writer.HasPlane({2}, kDisparity));
    Finish(std::move(writer));
    ExpectPlanes();
  }
}

TEST_F(PackedPlanesTest, SpaceOfDroppedPlanesIsUsedAgain) {
  field_.intrinsics[0].width_px = 600;
  field_.intrinsics[0].height_px = 400;
  Image<uint16_t> plane(300, 200);
  for (size_t k = 0; k < plane.pixels().size(); ++k)
    plane.pixels()[k] = static_cast<uint16_t>(RandomBits(9, 1, k));
  PackedStoreWriter writer = Writer();
  uintmax_t first_bytes = 0;
  for (int round = 0; round < 4; ++round) {
    for (uint32_t i = 0; i < kRecorded; ++i) ASSERT_TRUE(writer.AddPlane({i}, kSwept, plane));
    ASSERT_TRUE(writer.Commit());
    const uintmax_t bytes = fs::file_size(UnfinishedPath(path_));
    if (round == 0) first_bytes = bytes;
    EXPECT_EQ(bytes, first_bytes);
    ASSERT_TRUE(writer.DropPlanes(kSwept));
  }
  EXPECT_GT(first_bytes, 4 * plane.size_bytes());
}

TEST_F(PackedPlanesTest, OnlyAnEqualPlanResumes) {
  { Writer(); }
  EXPECT_EQ(FirstDifferenceTo(field_, plan_), "");
  PackedStorePlan plan = plan_;
  plan.densified->settings = "steps 6";
  EXPECT_NE(FirstDifferenceTo(field_, plan)
                .find("settings of the densifier of steps 5, seed 3, but now it is steps 6"),
            std::string::npos);
  plan = plan_;
  plan.densified->plane_least = 0.3;  // the stored one is 0.1 + 0.2
  EXPECT_NE(FirstDifferenceTo(field_, plan).find("planes.least 0.30000000000000004"),
            std::string::npos);
  plan = plan_;
  plan.densified->plane_divisor = 3;
  EXPECT_NE(FirstDifferenceTo(field_, plan).find("planes.divisor 2, but now it is 3"),
            std::string::npos);
  LightField field = field_;
  field.cameras[5].is_virtual = false;
  EXPECT_NE(FirstDifferenceTo(field, plan_).find("virtual LF images)"), std::string::npos);
  for (LfCamera& camera : field.cameras) camera.is_virtual = false;
  plan = plan_;
  plan.densified.reset();
  const std::string to_ordinary = FirstDifferenceTo(field, plan);
  EXPECT_NE(to_ordinary.find("seed 3, but now it is (none)"), std::string::npos) << to_ordinary;
  // An ordinary store is not densified by resuming it.
  {
    FileLock lock = PackedStoreWriter::Lock(path_).value();
    PackedStoreWriter::RemoveUnfinished(path_, lock);
    lock.Remove();
  }
  { ASSERT_TRUE(PackedStoreWriter::Create(path_, field, plan)); }
  EXPECT_NE(FirstDifferenceTo(field_, plan_).find("densifier of (none), but now it is steps 5"),
            std::string::npos);
}

TEST_F(PackedPlanesTest, AVirtualImageIsNeverTakenForARecordedOne) {
  Finish(Writer());
  // A light field whose recorded image has the name of a virtual one.
  LightField other = field_;
  for (LfCamera& camera : other.cameras) camera.is_virtual = false;
  const auto by_other = FindCodes(path_, other).value();
  const auto by_own = FindCodes(path_, field_).value();
  for (uint32_t i = 0; i < kAll; ++i) {
    EXPECT_EQ(by_other[i].is_listed(), i < kRecorded) << i;
    EXPECT_TRUE(by_own[i].is_listed());
    EXPECT_EQ(by_own[i].is_virtual, i >= kRecorded);
  }
  for (const uint32_t recorded_or_virtual : {0u, 5u}) {
    LightField twice = field_;
    twice.image_names[6] = twice.image_names[recorded_or_virtual];
    const auto writer = PackedStoreWriter::Create(folder_ / "other.lfs", twice, plan_);
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().kind, ErrorKind::kUsage);
    EXPECT_NE(writer.error().message.find(twice.image_names[6]), std::string::npos);
  }
}

TEST_F(PackedPlanesTest, ManyThreadsAddAndReadPlanes) {
  PackedStoreWriter writer = Writer();
  const auto work = [&](uint32_t i) {
    for (const PlaneKind kind : {kSwept, kDisparity}) {
      EXPECT_TRUE(writer.AddPlane({i}, kind, TestPlane(i, kind)));
      EXPECT_TRUE(
          std::ranges::equal(writer.ReadPlane({i}, kind)->pixels(), TestPlane(i, kind).pixels()));
    }
    EXPECT_TRUE(writer.Add({i}, TestCode(i)));
  };
  {
    std::vector<std::jthread> threads;
    for (uint32_t i = 0; i < 3; ++i) threads.emplace_back(work, i);
  }
  ASSERT_TRUE(writer.DropPlanes(kSwept));
  Finish(std::move(writer));
  ExpectPlanes();
}

TEST_F(PackedPlanesTest, WrongMarksAndSettingsAreDamage) {
  Finish(Writer());
  const std::string whole = *ReadFile(path_);
  for (const auto& [sql, words] : {
           std::pair("delete from virtual_images where id = 5", "recorded and virtual"),
           std::pair("insert into virtual_images values (0)", "recorded and virtual"),
           std::pair("insert into virtual_images values (7)", "7"),
           std::pair("insert into virtual_images values (-1)", "-1"),
           std::pair("update lf_images set whole_id = null where id = 2", "recorded and virtual"),
           std::pair("update virtual_images set id = 3 where id = 4; update lf_images set whole_id "
                     "= null where id = 3; update lf_images set whole_id = 3 where id = 4",
                     "differ from the recorded checksum"),
           std::pair("delete from settings where key = 'densified'", "setting densified"),
           std::pair("update settings set value = '-1e13' where key = 'planes.least'",
                     "setting planes.least"),
           std::pair("update settings set value = '0.1' where key = 'planes.greatest'",
                     "setting planes.greatest"),
           std::pair("update settings set value = '0' where key = 'planes.divisor'",
                     "setting planes.divisor"),
           std::pair("update settings set value = '1025' where key = 'planes.divisor'",
                     "setting planes.divisor"),
           std::pair("drop table planes", "its tables are not those"),
       }) {
    ASSERT_TRUE(WriteFileAtomically(path_, whole));
    Execute(sql);
    EXPECT_NE(Fault().find(words), std::string::npos) << sql << ": " << Fault();
    EXPECT_TRUE(Fault().starts_with(path_.string())) << Fault();
  }
}

TEST_F(PackedPlanesTest, APlaneOfAnotherKindIsDamage) {
  Finish(Writer());
  const Image<uint16_t> small(20, 13), colours(21, 13, 3);
  const Image<uint8_t> bytes(21, 13);
  const std::string codes[] = {
      EncodePlane(small),
      EncodeImage(bytes, PixelLayout::kGrey, {.profile = CodecProfile::kLossless}),
      EncodeImage(colours, PixelLayout::kRgb, {.profile = CodecProfile::kLossless}),
      EncodeImage(TestPlane(1, kSwept), PixelLayout::kGrey, {.profile = CodecProfile::kDefault}),
      "no encoded image",
      EncodePlane(TestPlane(0, kSwept)).substr(0, 60)};
  for (const std::string& code : codes) {
    {
      Database database = Database::OpenToAppend(path_, kStoreFormat).value();
      Statement update = database.Prepare("update planes set plane = ?1 where id = 1").value();
      update.BindBlob(0, code);
      ASSERT_TRUE(update.Run());
    }
    const auto plane = PackedPlaneReader::Open(path_).value().Read({1}, kDisparity);
    ASSERT_FALSE(plane);
    EXPECT_EQ(plane.error().kind, ErrorKind::kInput);
    EXPECT_TRUE(
        plane.error().message.starts_with(path_.string() + ": plane disparity of LF image 1"))
        << plane.error().message;
  }
}

TEST_F(PackedPlanesTest, AnImpossiblePlaneOfAnUnfinishedStoreIsAnError) {
  for (const char* const row : {"(4, 'swept', x'')", "(7, 'swept', x'')", "(-1, 'swept', x'')",
                                "(0, 'other', x'')", "(0, 'trust', x'')"}) {
    { Writer(); }
    const fs::path unfinished = UnfinishedPath(path_);
    ASSERT_TRUE(Database::OpenToAppend(unfinished, kStoreFormat)
                    .value()
                    .Execute(std::string("insert into planes values ") + row));
    const auto writer = PackedStoreWriter::Resume(path_, field_, plan_);
    ASSERT_FALSE(writer) << row;
    EXPECT_EQ(writer.error().kind, ErrorKind::kInput);
    EXPECT_NE(writer.error().message.find("which cannot exist"), std::string::npos);
    fs::remove(unfinished);
  }
}

TEST_F(PackedPlanesTest, AFlippedBitOfAPlaneIsAnError) {
  Finish(Writer());
  const std::string whole = *ReadFile(path_);
  const std::string code = EncodePlane(TestPlane(0, kDisparity));
  const size_t begin = whole.find(code);
  ASSERT_NE(begin, std::string::npos);
  for (uint64_t round = 0; round < 50; ++round) {
    std::string damaged = whole;
    char& byte = damaged[begin + RandomBits(3, round, 0) % code.size()];
    byte = static_cast<char>(byte ^ (1 << (round % 8)));
    ASSERT_TRUE(WriteFileAtomically(path_, damaged));
    const auto plane = PackedPlaneReader::Open(path_).value().Read({0}, kDisparity);
    ASSERT_FALSE(plane);
    EXPECT_NE(plane.error().message.find("dense.lfs"), std::string::npos);
  }
}

}  // namespace
}  // namespace lf
