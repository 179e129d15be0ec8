// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/packed_store_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "lf/camera/testing_scenes.h"
#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/storage/packed/code_fronts.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/sqlite/database.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

LightField TestField(uint32_t count = 40) {
  LightField field;
  field.folder = "/nowhere/images";
  field.unit_m = 0.01;
  field.depth_range = DepthRange{0.1 + 0.2, 1e3 / 3};
  field.encoding.bayer = BayerPattern::kGrbg;
  field.encoding.transfer = Transfer::kResponse;
  field.encoding.response = {0, 0.1, 1.0 / 3, 1};
  field.encoding.white_level = 4095.5;
  for (uint32_t i = 0; i < count; ++i) {
    const testing::CameraPair pair = testing::RandomDistortedPair(i);
    if (i < 10) field.intrinsics.push_back(pair.lf_camera.intrinsics);
    field.cameras.push_back(
        {pair.lf_camera.cam_from_world, i % 10, 0.5f + 0.1f * static_cast<float>(i)});
    if (i % 4 == 1) field.cameras.back().gain = {1.0f / 3, 1, 2.0f / 3};
    if (i % 3 == 1 && i < 10) field.intrinsics.back().vignetting.v = {-1e-9 / 3, 0, 0.0025};
    // The LF images are not in the order of their names.
    field.image_names.push_back("bänd/ima'ge " + std::to_string((i * 17) % count) + ".png");
    field.mask_names.push_back(i % 2 == 0 ? "" : "mask.png");
  }
  return field;
}

CodedImage CodeOfImage(uint32_t i) {
  CodedImage image;
  image.values = static_cast<StoredValues>(i % 3);
  image.rect = {static_cast<int>(i), 2, 60 + static_cast<int>(i), 41};
  for (uint64_t k = 0; k < 2000 + 10 * i; ++k) image.code += static_cast<char>(RandomBits(4, i, k));
  if (i % 4 == 1) image.mask = "mask of " + std::to_string(i);
  if (i % 4 == 3) image.front_ends = {100, 300 + i, 1900};
  image.source_bytes = 1000000000000ULL + i;
  return image;
}

class PackedStoreFileTest : public ::testing::Test {
 protected:
  PackedStoreFileTest()
      : folder_(fs::temp_directory_path() /
                ("lf_packed_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())),
        path_(folder_ / "a store.lfs"),
        field_(TestField()) {
    fs::create_directories(folder_);
    plan_.whole = {1000, "0123456789abcdef", "fedcba9876543210"};
    for (uint32_t i = 0; i < field_.size(); ++i) plan_.whole_ids.push_back(25 * i);
    plan_.codec = "lossless, levels 3";
    plan_.source = "../field";
    plan_.version = "1.2.3";
  }
  ~PackedStoreFileTest() override { fs::remove_all(folder_); }

  PackedStoreWriter Writer() {
    Result<PackedStoreWriter> writer = PackedStoreWriter::Create(path_, field_, plan_);
    EXPECT_TRUE(writer) << (writer ? "" : writer.error().message);
    return *std::move(writer);
  }
  void Write(uint32_t skipped = UINT32_MAX) {
    PackedStoreWriter writer = Writer();
    for (uint32_t i = 0; i < field_.size(); ++i) {
      if (i == skipped) continue;
      EXPECT_TRUE(writer.Add({i}, CodeOfImage(i)));
    }
    const Result<void> finished = writer.Finish();
    ASSERT_TRUE(finished) << finished.error().message;
  }
  void ExpectHolds(uint32_t i, const PackedCode& code, PackedCodeReader* reader) {
    const CodedImage expected = CodeOfImage(i);
    EXPECT_EQ(code.id, i);
    EXPECT_EQ(code.values, expected.values);
    EXPECT_EQ(code.rect, expected.rect);
    EXPECT_EQ(code.bytes, expected.code.size() + expected.mask.size());
    const auto bytes = reader->Read(code);
    ASSERT_TRUE(bytes) << bytes.error().message;
    EXPECT_EQ(bytes->code, expected.code);
    EXPECT_EQ(bytes->mask, expected.mask);
    // Asked for 1, 2, 3, 4 fronts less, it has the longest first, and the shortest twice.
    std::vector<uint64_t> ends = expected.front_ends;
    if (!has_fronts_) ends.clear();
    for (size_t left_out = 1; left_out <= 4; ++left_out) {
      const auto front = reader->ReadFront(code, left_out);
      ASSERT_TRUE(front) << front.error().message;
      ASSERT_EQ(front->has_value(), !ends.empty());
      if (ends.empty()) continue;
      EXPECT_EQ((*front)->left_out, std::min<size_t>(left_out, 3));
      EXPECT_EQ((*front)->code, expected.code.substr(0, ends[ends.size() - (*front)->left_out]));
    }
  }
  void ExpectHoldsAll() {
    const auto codes = FindCodes(path_, field_.image_names);
    ASSERT_TRUE(codes) << codes.error().message;
    PackedCodeReader reader = PackedCodeReader::Open(path_).value();
    for (uint32_t i = 0; i < field_.size(); ++i) ExpectHolds(i, (*codes)[i], &reader);
  }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  std::string Fault() const {
    const auto facts = ReadPackedStore(path_);
    if (facts) return "";
    EXPECT_EQ(facts.error().kind, ErrorKind::kInput);
    EXPECT_NE(facts.error().message.find("a store"), std::string::npos);
    return facts.error().message;
  }

  fs::path folder_, path_;
  LightField field_;
  PackedStorePlan plan_;
  bool has_fronts_ = true;  // false if the store lacks the fronts of its images
};

TEST_F(PackedStoreFileTest, ReadsWhatWasWrittenToTheBit) {
  Write();
  EXPECT_EQ(Files(), std::vector<std::string>{"a store.lfs"});
  EXPECT_TRUE(IsPackedStore(path_));
  EXPECT_EQ(PackedStoresIn(folder_), std::vector<fs::path>{path_});
  const Result<PackedStoreFacts> facts = ReadPackedStore(path_);
  ASSERT_TRUE(facts) << facts.error().message;
  EXPECT_EQ(facts->whole, plan_.whole);
  EXPECT_EQ(*ReadWholeIdentity(path_), plan_.whole);
  EXPECT_EQ(facts->whole_ids, plan_.whole_ids);
  EXPECT_EQ(facts->source, "../field");
  EXPECT_EQ(facts->codec, plan_.codec);
  EXPECT_EQ(facts->shard_count, 0u);
  const LightField& read = facts->light_field;
  EXPECT_EQ(read.folder, path_);
  EXPECT_TRUE(read.mask_names.empty());
  EXPECT_EQ(read.image_names, field_.image_names);
  EXPECT_EQ(IdentityOf(read).calibration, IdentityOf(field_).calibration);
  EXPECT_EQ(read.unit_m, field_.unit_m);
  EXPECT_EQ(read.depth_range, field_.depth_range);
  EXPECT_EQ(read.encoding.bayer, field_.encoding.bayer);
  EXPECT_EQ(read.encoding.response, field_.encoding.response);
  EXPECT_EQ(read.encoding.white_level, field_.encoding.white_level);
  ExpectHoldsAll();
}

TEST_F(PackedStoreFileTest, ImagesAreFoundByNameInAnyOrder) {
  field_.image_names[7] = field_.image_names[30];
  Write(5);
  const std::vector<std::string> names = {field_.image_names[30], "other", field_.image_names[39],
                                          field_.image_names[0],  "",      field_.image_names[30],
                                          field_.image_names[5]};
  const std::vector<PackedCode> codes = FindCodes(path_, names).value();
  ASSERT_EQ(codes.size(), names.size());
  PackedCodeReader reader = PackedCodeReader::Open(path_).value();
  ExpectHolds(7, codes[0], &reader);
  EXPECT_FALSE(codes[1].is_listed());
  ExpectHolds(39, codes[2], &reader);
  ExpectHolds(0, codes[3], &reader);
  EXPECT_FALSE(codes[4].is_listed());
  ExpectHolds(30, codes[5], &reader);
  EXPECT_TRUE(codes[6].is_listed());
  EXPECT_EQ(codes[6].bytes, 0u);
}

TEST_F(PackedStoreFileTest, ManyNamesThatItLacksHideNoneThatItHas) {
  Write();
  std::vector<std::string> names;
  // In ascending order, these names come before all names of the store.
  for (int i = 0; i < 100; ++i) names.push_back(std::to_string(i));
  names.insert(names.end(), field_.image_names.begin(), field_.image_names.end());
  for (int i = 0; i < 100; ++i) names.push_back("last " + std::to_string(i));
  const std::vector<PackedCode> codes = FindCodes(path_, names).value();
  PackedCodeReader reader = PackedCodeReader::Open(path_).value();
  for (size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(codes[i].is_listed(), i >= 100 && i < 140) << names[i];
    if (codes[i].is_listed()) ExpectHolds(static_cast<uint32_t>(i) - 100, codes[i], &reader);
  }
}

TEST_F(PackedStoreFileTest, ShardsHoldTheCodes) {
  plan_.shard_bytes = 10000;
  Write();
  const size_t count = ReadPackedStore(path_).value().shard_count;
  EXPECT_GE(count, 8u);  // at least as many as a reader keeps open
  EXPECT_EQ(Files().size(), count + 1);
  ExpectHoldsAll();
  EXPECT_EQ(PackedStoresIn(folder_), std::vector<fs::path>{path_});
  // A shard may be neither replaced by another one nor missing.
  const std::vector<PackedCode> codes = FindCodes(path_, field_.image_names).value();
  const fs::path first = folder_ / "a store-0001.lfs", second = folder_ / "a store-0002.lfs";
  fs::copy_file(second, first, fs::copy_options::overwrite_existing);
  const auto fault = [&] {
    const auto bytes = PackedCodeReader::Open(path_).value().Read(codes[0]);
    EXPECT_FALSE(bytes);
    return bytes ? "" : bytes.error().message;
  };
  EXPECT_NE(fault().find("a store-0001.lfs: is not shard 1 of the packed store"),
            std::string::npos);
  fs::remove(first);
  EXPECT_NE(fault().find("a store-0001.lfs: no such file"), std::string::npos);
  // A store without shards replaces the store with shards. The old shards behind the missing first
  // one stay, because the search for shards to remove ends at a missing one.
  plan_.shard_bytes = 0;
  Write();
  ExpectHoldsAll();
  EXPECT_EQ(Files().size(), count);  // the store and count - 1 shards
}

TEST_F(PackedStoreFileTest, AnUnfinishedStoreGoesOn) {
  for (const uint64_t shard_bytes : {0, 30000}) {
    plan_.shard_bytes = shard_bytes;
    {
      PackedStoreWriter writer = Writer();
      for (uint32_t i = 10; i < 20; ++i) ASSERT_TRUE(writer.Add({i}, CodeOfImage(i)));
      ASSERT_TRUE(writer.Commit());
      ASSERT_TRUE(writer.Add({20}, CodeOfImage(20)));  // not committed
    }
    EXPECT_TRUE(PackedStoreWriter::IsUnfinished(path_));
    const Result<PackedStoreWriter> anew = PackedStoreWriter::Create(path_, field_, plan_);
    ASSERT_FALSE(anew);
    EXPECT_EQ(anew.error().kind, ErrorKind::kUsage);
    {
      PackedStoreWriter writer = PackedStoreWriter::Resume(path_, field_, plan_).value();
      for (uint32_t i = 0; i < field_.size(); ++i) {
        EXPECT_EQ(writer.Has({i}), i >= 10 && i < 20);
        if (!writer.Has({i})) {
          ASSERT_TRUE(writer.Add({i}, CodeOfImage(i)));
        }
      }
      ASSERT_TRUE(writer.Finish());
    }
    EXPECT_FALSE(PackedStoreWriter::IsUnfinished(path_));
    ExpectHoldsAll();
  }
}

TEST_F(PackedStoreFileTest, ItGoesOnWithTheSameOnly) {
  { PackedStoreWriter writer = Writer(); }
  const auto difference = [&](const LightField& field, const PackedStorePlan& plan) {
    const Result<PackedStoreWriter> writer = PackedStoreWriter::Resume(path_, field, plan);
    if (writer) return std::string();
    EXPECT_EQ(writer.error().kind, ErrorKind::kUsage);
    return writer.error().message;
  };
  PackedStorePlan plan = plan_;
  plan.version = "9";
  plan.source = "elsewhere";
  EXPECT_EQ(difference(field_, plan), "");
  plan.codec = "levels 4";
  EXPECT_NE(difference(field_, plan).find("codec lossless, levels 3, but now it is levels 4"),
            std::string::npos);
  plan = plan_;
  plan.whole.names = "f";
  EXPECT_NE(difference(field_, plan).find("begun with LF images or masks of other names: "),
            std::string::npos);
  plan = plan_;
  plan.whole_ids[3] = 7;
  EXPECT_NE(difference(field_, plan).find("another part of the light field's LF images: "),
            std::string::npos);
  plan = plan_;
  plan.shard_bytes = 7;
  EXPECT_NE(difference(field_, plan).find("a {shard_size}, in bytes, of 0, but now it is 7: "),
            std::string::npos);
  LightField field = field_;
  field.image_names[3] = "b";
  EXPECT_NE(difference(field, plan_).find("begun with LF images of other names: "),
            std::string::npos);
  field = field_;
  field.cameras[5].cam_from_world.translation.x() += 1e-9;
  EXPECT_NE(difference(field, plan_).find("another calibration (poses"), std::string::npos);
  field = field_;
  field.encoding.pedestal = 5;
  EXPECT_NE(difference(field, plan_).find("pedestal"), std::string::npos);
  EXPECT_EQ(difference(field_, plan_), "");
  plan = plan_;
  plan.rects.assign(field_.size(), {0, 0, 3, 3});
  EXPECT_NE(difference(field_, plan).find("other parts of the LF images' pixels: "),
            std::string::npos);
  FileLock lock = PackedStoreWriter::Lock(path_).value();
  PackedStoreWriter::RemoveUnfinished(path_, lock);
  lock.Remove();
  EXPECT_TRUE(Files().empty());
}

TEST_F(PackedStoreFileTest, AnImpossibleEntryOfAnUnfinishedStoreIsAnError) {
  {
    PackedStoreWriter writer = Writer();
    ASSERT_TRUE(writer.Add({3}, CodeOfImage(3)));
    ASSERT_TRUE(writer.Commit());
  }
  for (const char* const entry : {"id = 40", "shard = 1", "shard = -1", "bytes = -1", "bytes = 0",
                                  "source_bytes = -1", "source_bytes = 'ten'"}) {
    const fs::path unfinished = path_.string() + ".unfinished";
    const std::string before = *ReadFile(unfinished);
    ASSERT_TRUE(Database::OpenToAppend(unfinished, kStoreFormat)
                    .value()
                    .Execute(std::string("update codes set ") + entry));
    const Result<PackedStoreWriter> writer = PackedStoreWriter::Resume(path_, field_, plan_);
    ASSERT_FALSE(writer) << entry;
    for (const char* const words : {"a store.lfs.unfinished: is ", "damaged"})
      EXPECT_NE(writer.error().message.find(words), std::string::npos)
          << entry << ": " << writer.error().message;
    ASSERT_TRUE(WriteFileAtomically(unfinished, before));
  }
  EXPECT_TRUE(PackedStoreWriter::Resume(path_, field_, plan_));
}

// Earlier builds wrote no fronts. An unfinished store of theirs gets the table when it is resumed.
TEST_F(PackedStoreFileTest, StoresWithoutFrontsAreRead) {
  Write();
  const auto drop_fronts = [&](const fs::path& path) {
    Database database = Database::OpenToAppend(path, kStoreFormat).value();
    ASSERT_TRUE(database.Execute("drop table fronts"));
  };
  drop_fronts(path_);
  has_fronts_ = false;
  ExpectHoldsAll();
  fs::remove(path_);
  {
    PackedStoreWriter writer = Writer();
    ASSERT_TRUE(writer.Add({0}, CodeOfImage(0)));
    ASSERT_TRUE(writer.Commit());
  }
  drop_fronts(UnfinishedPath(path_));
  {
    PackedStoreWriter writer = PackedStoreWriter::Resume(path_, field_, plan_).value();
    for (uint32_t i = 1; i < field_.size(); ++i) ASSERT_TRUE(writer.Add({i}, CodeOfImage(i)));
    ASSERT_TRUE(writer.Finish());
  }
  has_fronts_ = true;
  ExpectHoldsAll();
}

// The checksum of a front, and its length, must fit its bytes.
TEST_F(PackedStoreFileTest, DamagedFrontsAreErrors) {
  Write();
  const auto message_for = [&](const std::string& fronts) {
    {
      Database database = Database::OpenToAppend(path_, kStoreFormat).value();
      Statement update = database.Prepare("update fronts set fronts = ? where id = 7").value();
      EXPECT_TRUE(update.BindBlob(0, fronts).Run());
    }
    PackedCodeReader reader = PackedCodeReader::Open(path_).value();
    const auto front = reader.ReadFront((*FindCodes(path_, field_.image_names))[7], 1);
    return front ? "" : front.error().message;
  };
  const std::string code = CodeOfImage(7).code;
  const std::vector<uint64_t> ends = {500};
  EXPECT_EQ(message_for(CodeOfFronts(code, ends)), "");
  std::string other = code;
  other[3] ^= 1;
  EXPECT_NE(message_for(CodeOfFronts(other, ends)).find("checksum"), std::string::npos);
  EXPECT_NE(message_for("1234").find("impossible lengths"), std::string::npos);
  EXPECT_NE(message_for(CodeOfFronts(code, std::vector<uint64_t>{500, 400})).find("impossible"),
            std::string::npos);
  EXPECT_NE(message_for(CodeOfFronts(code + code, std::vector<uint64_t>{3000})).find("impossible"),
            std::string::npos);
}

TEST_F(PackedStoreFileTest, OneWriterAtATime) {
  PackedStoreWriter writer = Writer();
  const Result<PackedStoreWriter> other = PackedStoreWriter::Resume(path_, field_, plan_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::kOutput);
  EXPECT_FALSE(PackedStoreWriter::Lock(path_));
}

TEST_F(PackedStoreFileTest, ShardsOfOtherStoresStayAsTheyAre) {
  plan_.shard_bytes = 30000;
  Write();
  const size_t files = Files().size();
  ASSERT_GT(files, 3u);
  // The owner renamed the store, but not its shards.
  const fs::path moved = folder_ / "moved.lfs";
  fs::rename(path_, moved);
  const Result<PackedStoreWriter> in_the_way = PackedStoreWriter::Create(path_, field_, plan_);
  ASSERT_FALSE(in_the_way);
  EXPECT_EQ(in_the_way.error().kind, ErrorKind::kUsage);
  EXPECT_NE(in_the_way.error().message.find("a store-0001.lfs"), std::string::npos);
  plan_.shard_bytes = 0;
  Write();  // beside the old shards
  EXPECT_EQ(Files().size(), files + 1);
  fs::rename(moved, path_);
  ExpectHoldsAll();
}

TEST_F(PackedStoreFileTest, WhatItReplacesIsGone) {
  plan_.shard_bytes = 20000;
  Write();
  const size_t files = Files().size();
  plan_.shard_bytes = 40000;
  Write();
  EXPECT_LT(Files().size(), files);
  ExpectHoldsAll();
  // Simulates a writer that was killed while it renamed its shards.
  {
    PackedStoreWriter writer = Writer();
    for (uint32_t i = 0; i < field_.size(); ++i) ASSERT_TRUE(writer.Add({i}, CodeOfImage(i)));
    ASSERT_TRUE(writer.Commit());
  }
  fs::rename(folder_ / "a store-0001.lfs.unfinished", folder_ / "a store-0001.lfs");
  EXPECT_NE(Fault().find("is not shard 1 of the packed store"), std::string::npos);
  FileLock lock = PackedStoreWriter::Lock(path_).value();
  PackedStoreWriter::RemoveUnfinished(path_, lock);
  lock.Remove();
  for (const std::string& name : Files()) EXPECT_EQ(name.find("unfinished"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "a store-0001.lfs"));
  Write();
  ExpectHoldsAll();
}

TEST_F(PackedStoreFileTest, AbandonedItIsGone) {
  plan_.shard_bytes = 30000;
  PackedStoreWriter writer = Writer();
  ASSERT_TRUE(writer.Add({0}, CodeOfImage(0)));
  writer.Abandon();
  EXPECT_TRUE(Files().empty());
}

TEST_F(PackedStoreFileTest, APartOfItIsAnError) {
  plan_.shard_bytes = 30000;
  Write();
  const auto lacks = [&](const fs::path& file, uintmax_t bytes) {
    const fs::path whole = folder_ / "whole";
    fs::copy_file(file, whole);
    fs::resize_file(file, fs::file_size(file) - bytes);
    EXPECT_NE(Fault().find("copied in part"), std::string::npos) << Fault();
    fs::rename(whole, file);
  };
  for (const uintmax_t bytes : {1, 5000, 16384}) {
    lacks(path_, bytes);
    lacks(folder_ / "a store-0002.lfs", bytes);
  }
  fs::remove(folder_ / "a store-0002.lfs");
  EXPECT_NE(Fault().find("a store-0002.lfs: no such file"), std::string::npos) << Fault();
}

TEST_F(PackedStoreFileTest, IsOfItsPlan) {
  Write();
  EXPECT_TRUE(CheckIsOfPlan(path_, field_, plan_, false));
  PackedStorePlan plan = plan_;
  plan.shard_bytes = 9;
  EXPECT_TRUE(CheckIsOfPlan(path_, field_, plan, true));
  EXPECT_FALSE(CheckIsOfPlan(path_, field_, plan, false));
  LightField field = field_;
  field.encoding.white_level = 4000;
  const Result<void> other = CheckIsOfPlan(path_, field, plan_, true);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("white level"), std::string::npos);
}

TEST_F(PackedStoreFileTest, ManyThreadsAddAndMayBeKilled) {
  plan_.shard_bytes = 60000;
  for (uint64_t round = 0;; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      Result<PackedStoreWriter> writer = PackedStoreWriter::Resume(path_, field_, plan_);
      if (!writer) ::_exit(1);
      bool good = true;
      const auto add = [&](uint32_t first) {
        for (uint32_t i = first; i < 40; i += 2) {
          if (writer->Has({i})) continue;
          good = good && writer->Add({i}, CodeOfImage(i)) && (i % 5 != 0 || writer->Commit());
          ::usleep(1000);
        }
      };
      std::thread other(add, 0);
      add(1);
      other.join();
      ::_exit(good && writer->Finish() ? 0 : 2);
    }
    ::usleep(static_cast<useconds_t>(10000 + 20000 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (WIFEXITED(status)) {
      ASSERT_EQ(WEXITSTATUS(status), 0);
      break;
    }
  }
  ExpectHoldsAll();
  for (const std::string& name : Files()) EXPECT_TRUE(name.ends_with(".lfs")) << name;
}

TEST_F(PackedStoreFileTest, OthersAreErrors) {
  EXPECT_NE(Fault().find("no such file"), std::string::npos);
  EXPECT_FALSE(IsPackedStore(path_));
  ASSERT_TRUE(WriteFileAtomically(path_, "no store"));
  EXPECT_NE(Fault(), "");
  EXPECT_FALSE(IsPackedStore(path_));
  { PackedStoreWriter writer = Writer(); }
  fs::rename(path_.string() + ".unfinished", path_);
  EXPECT_NE(Fault().find("is an unfinished packed store"), std::string::npos);
  EXPECT_NE(FindCodes(path_, field_.image_names).error().message.find("unfinished"),
            std::string::npos);
}

// A flipped bit gives an error or another number in a table, but never wrong encoded bytes.
TEST_F(PackedStoreFileTest, DamageIsAnErrorOrLeavesTheCodes) {
  Write();
  const std::string whole = *ReadFile(path_);
  size_t errors = 0;
  for (uint64_t round = 0; round < 300; ++round) {
    std::string damaged = whole;
    const uint64_t at = RandomBits(2, round, 0) % whole.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (round % 8)));
    ASSERT_TRUE(WriteFileAtomically(path_, damaged));
    const auto facts = ReadPackedStore(path_);
    const auto codes = FindCodes(path_, field_.image_names);
    auto reader = PackedCodeReader::Open(path_);
    errors += !facts || !codes || !reader;
    if (!codes || !reader) continue;
    for (uint32_t i = 0; i < field_.size(); ++i) {
      if ((*codes)[i].bytes == 0) continue;
      const auto bytes = reader->Read((*codes)[i]);
      errors += !bytes;
      if (bytes && (*codes)[i].id == i) {
        EXPECT_EQ(bytes->code, CodeOfImage(i).code) << at;
      }
    }
  }
  EXPECT_GT(errors, 20u);
  for (const size_t size : {whole.size() / 2, whole.size() - 16384, size_t{100}, size_t{17}}) {
    ASSERT_TRUE(WriteFileAtomically(path_, whole.substr(0, size)));
    EXPECT_NE(Fault(), "") << size;
  }
}

}  // namespace
}  // namespace lf
