// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/reference_table.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/sqlite/database.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

using Ids = std::vector<uint32_t>;

class ReferenceTableTest : public ::testing::Test {
 protected:
  static constexpr uint32_t kFieldImages = 60;
  ReferenceTableTest()
      : folder_(fs::temp_directory_path() /
                ("lf_reference_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())),
        path_(folder_ / "a.lfs") {
    fs::create_directories(folder_);
    Intrinsics intrinsics;
    intrinsics.width_px = 100;
    intrinsics.height_px = 80;
    intrinsics.fx_px = intrinsics.fy_px = 90;
    field_.intrinsics = {intrinsics};
    for (uint32_t i = 0; i < kFieldImages; ++i) {
      field_.cameras.emplace_back().cam_from_world.translation = Vec3(i, 0, 0);
      field_.image_names.push_back("image" + std::to_string(i) + ".png");
    }
    plan_.whole = IdentityOf(field_);
    plan_.codec = "default, predicted";
    plan_.is_predicted = true;
  }
  ~ReferenceTableTest() override { fs::remove_all(folder_); }

  static CodedImage Coded(uint32_t id, const Ids& references = {}) {
    CodedImage image;
    image.rect = {0, 0, 100, 80};
    image.code = "code of LF image " + std::to_string(id) + std::string(1000, '-');
    for (const uint32_t reference : references) image.references.push_back({reference});
    return image;
  }
  // Returns a group of five LF images from `first` on, whose first one has no reference images.
  static std::vector<GroupedImage> Group(uint32_t first) {
    return {{{first + 3}, Coded(first + 3)},
            {{first}, Coded(first, {first + 3})},
            {{first + 1}, Coded(first + 1, {first, first + 3})},
            {{first + 2}, Coded(first + 2, {first + 1, first + 3, first})},
            {{first + 4}, Coded(first + 4, {first + 2})}};
  }
  void ExpectGroup(const ReferenceTable& table, uint32_t first) const {
    for (const GroupedImage& grouped : Group(first)) {
      Ids expected;
      for (const LfImageId reference : grouped.image.references)
        expected.push_back(reference.value);
      const auto found = table.Of(grouped.id.value);
      EXPECT_EQ(Ids(found.begin(), found.end()), expected);
      EXPECT_EQ(table.IsPredicted(grouped.id.value), !expected.empty());
      EXPECT_EQ(table.IsReference(grouped.id.value), grouped.id.value != first + 4);
    }
    EXPECT_EQ(table.NeededBy(first + 4), (Ids{first + 3, first, first + 1, first + 2, first + 4}));
  }
  void Write(uint32_t groups = 1) {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
    for (uint32_t g = 0; g < groups; ++g) ASSERT_TRUE(writer.AddGroup(Group(5 * g)));
    const Result<void> finished = writer.Finish();
    ASSERT_TRUE(finished) << finished.error().message;
  }
  // Writes a store of LF images without reference images, and then a table of any.
  std::string ErrorOf(const std::vector<std::pair<int64_t, Ids>>& rows,
                      const std::string& script = "", size_t cut = 0) {
    fs::remove(path_);
    {
      PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
      for (uint32_t i = 0; i < kFieldImages - 1; ++i) EXPECT_TRUE(writer.Add({i}, Coded(i)));
      EXPECT_TRUE(writer.Finish());
    }
    {
      Database database = Database::OpenToAppend(path_, kStoreFormat).value();
      EXPECT_TRUE(database.Execute("begin"));
      Statement insert = database.Prepare("insert into predicted values (?, ?)").value();
      for (const auto& [id, references] : rows) {
        std::string text;
        for (const uint32_t reference : references)
          for (int byte = 0; byte < 4; ++byte)
            text += static_cast<char>(reference >> (8 * byte) & 255);
        insert.Bind(0, id).BindBlob(1, std::string_view(text).substr(cut));
        EXPECT_TRUE(insert.Run());
      }
      EXPECT_TRUE(database.Execute("commit"));
      EXPECT_TRUE(database.Execute(script));
    }
    const auto table = ReadReferences(path_);
    const auto facts = ReadPackedStore(path_);
    EXPECT_EQ(table.has_value(), facts.has_value());
    if (table) return "";
    EXPECT_EQ(table.error().kind, ErrorKind::kInput);
    EXPECT_EQ(table.error().message, facts.error().message);
    EXPECT_NE(table.error().message.find("a.lfs: is a damaged packed store: "), std::string::npos);
    return table.error().message;
  }

  const fs::path folder_, path_;
  LightField field_;
  PackedStorePlan plan_;
};

TEST_F(ReferenceTableTest, WrittenItIsRead) {
  for (const uint64_t shard_bytes : {0, 3000, 8000}) {
    plan_.shard_bytes = shard_bytes;
    Write(4);
    const Result<PackedStoreFacts> facts = ReadPackedStore(path_);
    ASSERT_TRUE(facts) << facts.error().message;
    EXPECT_EQ(facts->predicted_count, 16u);
    const ReferenceTable table = ReadReferences(path_).value();
    EXPECT_EQ(table.predicted_count(), 16u);
    EXPECT_TRUE(table.Of(50).empty());
    EXPECT_TRUE(table.Of(UINT32_MAX).empty());
    const std::vector<PackedCode> codes = CodesInStore(path_).value();
    PackedCodeReader reader = PackedCodeReader::Open(path_).value();
    for (uint32_t g = 0; g < 4; ++g) {
      ExpectGroup(table, 5 * g);
      for (uint32_t id = 5 * g; id < 5 * g + 5; ++id) {
        // A group is in one shard, also if it is larger than a shard should be.
        EXPECT_EQ(codes[id].shard, codes[5 * g].shard);
        EXPECT_EQ(codes[id].shard, shard_bytes > 0 ? g + 1 : 0u);
        EXPECT_EQ(reader.Read(codes[id])->code, Coded(id).code);
        EXPECT_EQ(NameInStore(path_, {id}).value(), field_.image_names[id]);
      }
    }
  }
}

TEST_F(ReferenceTableTest, OtherStoresHaveNone) {
  plan_.is_predicted = false;
  PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
  ASSERT_TRUE(writer.Add({0}, Coded(0)));
  ASSERT_TRUE(writer.Finish());
  EXPECT_TRUE(ReadReferences(path_).value().empty());
  EXPECT_EQ(ReadPackedStore(path_).value().predicted_count, 0u);
}

TEST_F(ReferenceTableTest, StoresOfPackagesAndDensifiedStoresHaveSome) {
  plan_.rects.assign(kFieldImages, {0, 0, 100, 80});
  plan_.rects[30] = {};
  Write(2);
  PackedStoreFacts facts = ReadPackedStore(path_).value();
  EXPECT_EQ(facts.left_out_count, 1u);
  EXPECT_EQ(facts.predicted_count, 8u);
  plan_.rects = {};
  plan_.densified = DensifiedPlan{"settings", 0.1, 1, 4};
  field_.cameras[40].is_virtual = true;
  Write(2);
  facts = ReadPackedStore(path_).value();
  EXPECT_TRUE(facts.densified);
  EXPECT_EQ(facts.predicted_count, 8u);
}

TEST_F(ReferenceTableTest, SingleImagesReferToThoseBefore) {
  {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
    for (const GroupedImage& grouped : Group(0)) ASSERT_TRUE(writer.Add(grouped.id, grouped.image));
    ASSERT_TRUE(writer.Commit());
  }
  PackedStoreWriter writer = PackedStoreWriter::Resume(path_, field_, plan_).value();
  ASSERT_TRUE(writer.Add({5}, Coded(5, {1, 3})));
  ASSERT_TRUE(writer.Finish());
  const ReferenceTable table = ReadReferences(path_).value();
  ExpectGroup(table, 0);
  EXPECT_EQ(table.NeededBy(5), (Ids{3, 0, 1, 5}));
}

TEST_F(ReferenceTableTest, UnfinishedItIsResumedByItsOwnPlan) {
  for (const bool is_predicted : {true, false}) {
    fs::remove(UnfinishedPath(path_));
    plan_.is_predicted = is_predicted;
    { PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value(); }
    plan_.is_predicted = !is_predicted;
    const auto other = PackedStoreWriter::Resume(path_, field_, plan_);
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().kind, ErrorKind::kUsage);
    EXPECT_NE(other.error().message.find("predicted from others"), std::string::npos)
        << other.error().message;
  }
}

TEST_F(ReferenceTableTest, WhatCannotBeDecodedIsRefused) {
  EXPECT_EQ(ErrorOf({{1, {0}}, {2, {1, 0}}}), "");
  EXPECT_NE(ErrorOf({{1, {1}}}).find("LF image 1 is predicted from itself"), std::string::npos);
  EXPECT_NE(ErrorOf({{1, {2}}, {2, {3}}, {3, {1}}}).find("LF image 1 is predicted from itself"),
            std::string::npos);
  // The cycle is behind LF image 0.
  EXPECT_NE(ErrorOf({{0, {1}}, {1, {2}}, {2, {1}}}).find("LF image 1 is predicted from itself"),
            std::string::npos);
  EXPECT_NE(ErrorOf({{1, {kFieldImages}}}).find("from LF image 60, which has no encoded"),
            std::string::npos);
  EXPECT_NE(ErrorOf({{1, {UINT32_MAX}}}).find("which has no encoded"), std::string::npos);
  // The last LF image could not be read when the store was made.
  EXPECT_NE(ErrorOf({{1, {kFieldImages - 1}}}).find("which has no encoded"), std::string::npos);
  EXPECT_NE(ErrorOf({{kFieldImages - 1, {1}}}).find("but has no encoded"), std::string::npos);
  EXPECT_NE(ErrorOf({{kFieldImages, {1}}}).find("LF image 60, which it lacks"), std::string::npos);
  EXPECT_NE(ErrorOf({{-1, {1}}}).find("LF image -1, which it lacks"), std::string::npos);
  EXPECT_NE(ErrorOf({{9, {1, 2, 3, 4, 5}}}).find("more than 4 reference images"),
            std::string::npos);
  EXPECT_NE(ErrorOf({{9, {}}}).find("none or more than 4"), std::string::npos);
  EXPECT_NE(ErrorOf({{9, {1, 2}}}, "", 3).find("none or more than 4"), std::string::npos);
  EXPECT_NE(ErrorOf({{9, {1}}}, "update codes set kind = 'file' where id = 1")
                .find("LF image 1, which has no encoded numbers"),
            std::string::npos);
  EXPECT_NE(ErrorOf({{9, {1}}}, "update codes set kind = 'file' where id = 9")
                .find("LF image 9 is predicted from others, but has no encoded numbers"),
            std::string::npos);
}

// A chain of 33 LF images is the longest.
TEST_F(ReferenceTableTest, LongChainsAreRefused) {
  std::vector<std::pair<int64_t, Ids>> rows;
  for (uint32_t id = 1; id <= kMostNeededImages; ++id) rows.push_back({id, {id - 1}});
  EXPECT_EQ(ErrorOf(rows), "");
  rows.push_back({kMostNeededImages + 1, {kMostNeededImages}});
  EXPECT_NE(ErrorOf(rows).find("LF image 33 is predicted from more than 32 LF images"),
            std::string::npos);
}

// There are about 2^50 paths from LF image 58 to LF image 0.
TEST_F(ReferenceTableTest, ManyPathsTakeNoTime) {
  std::vector<std::pair<int64_t, Ids>> rows = {{1, {0}}, {2, {1, 0}}, {3, {2, 1, 0}}};
  for (uint32_t id = 4; id < kFieldImages - 1; ++id)
    rows.push_back({id, {id - 1, id - 2, id - 3, id - 4}});
  EXPECT_NE(ErrorOf(rows).find("is predicted from more than 32 LF images"), std::string::npos);
  rows.resize(kMostNeededImages);
  EXPECT_EQ(ErrorOf(rows), "");
  const ReferenceTable table = ReadReferences(path_).value();
  EXPECT_EQ(table.NeededBy(kMostNeededImages).size(), kMostNeededImages + 1);
}

TEST_F(ReferenceTableTest, DamagedIdsAreFound) {
  Write();
  {
    Database database = Database::OpenToAppend(path_, kStoreFormat).value();
    ASSERT_TRUE(database.Execute(
        "update predicted set reference_ids = cast(x'02000000' || substr(reference_ids, 5) as "
        "blob) where id = 0"));
  }
  const auto table = ReadReferences(path_);
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().message.find("checksum"), std::string::npos) << table.error().message;
}

TEST_F(ReferenceTableTest, KilledItHasWholeGroups) {
  plan_.shard_bytes = 20000;
  size_t killed_with_some = 0;
  for (uint64_t round = 0;; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      Result<PackedStoreWriter> writer = PackedStoreWriter::Resume(path_, field_, plan_);
      if (!writer) ::_exit(1);
      bool good = true;
      const auto add = [&](uint32_t first) {
        for (uint32_t g = first; g < kFieldImages / 5; g += 2) {
          if (writer->Has({5 * g})) continue;
          good = good && writer->AddGroup(Group(5 * g)) && writer->Commit();
          ::usleep(500);
        }
      };
      std::thread other(add, 0);
      add(1);
      other.join();
      ::_exit(good && writer->Finish() ? 0 : 2);
    }
    ::usleep(static_cast<useconds_t>(3000 + 3000 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (WIFEXITED(status)) {
      ASSERT_EQ(WEXITSTATUS(status), 0);
      break;
    }
    const PackedStoreWriter writer = PackedStoreWriter::Resume(path_, field_, plan_).value();
    for (uint32_t g = 0; g < kFieldImages / 5; ++g) {
      for (uint32_t id = 5 * g; id < 5 * g + 5; ++id)
        ASSERT_EQ(writer.Has({id}), writer.Has({5 * g})) << id;
      killed_with_some += writer.Has({5 * g}) ? 1 : 0;
    }
  }
  EXPECT_GT(killed_with_some, 0u);
  const ReferenceTable table = ReadReferences(path_).value();
  for (uint32_t g = 0; g < kFieldImages / 5; ++g) ExpectGroup(table, 5 * g);
  const std::vector<PackedCode> codes = CodesInStore(path_).value();
  PackedCodeReader reader = PackedCodeReader::Open(path_).value();
  for (uint32_t id = 0; id < kFieldImages; ++id)
    EXPECT_EQ(reader.Read(codes[id])->code, Coded(id).code);
}

TEST_F(ReferenceTableTest, ImpossibleReferencesEndTheProgram) {
  PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
  ASSERT_TRUE(writer.Add({0}, Coded(0)));
  const auto add = [&](uint32_t id, const Ids& references) {
    (void)writer.Add({id}, Coded(id, references)).has_value();
  };
  EXPECT_EXIT(add(1, {2}), ::testing::ExitedWithCode(1), "IsAddable");
  EXPECT_EXIT(add(1, {1}), ::testing::ExitedWithCode(1), "IsAddable");
  EXPECT_EXIT(add(1, {kFieldImages}), ::testing::ExitedWithCode(1), "IsAddable");
  EXPECT_EXIT(add(1, {0, 0, 0, 0, 0}), ::testing::ExitedWithCode(1), "IsAddable");
  for (uint32_t id = 1; id <= kMostNeededImages; ++id) add(id, {id - 1});
  EXPECT_EXIT(add(40, {kMostNeededImages}), ::testing::ExitedWithCode(1), "IsAddable");
}

}  // namespace
}  // namespace lf
