// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "lf/core/file.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class DepthCacheTest : public testing::Test {
 protected:
  DepthCacheTest() : folder_(fs::path(testing::TempDir()) / NameOfFolder()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "images");
    for (const char* name : {"a.png", "b.png", "c.png"}) {
      std::ofstream(folder_ / "images" / name) << name;
      LfCamera camera;
      camera.cam_from_world.translation = Vec3(static_cast<double>(field_.size()), 0, 0);
      field_.cameras.push_back(camera);
      field_.image_names.push_back(std::string("images/") + name);
    }
    field_.intrinsics.push_back({100, 100, 8, 6, 0, 16, 12, {}, {}});
    field_.folder = folder_;
  }
  ~DepthCacheTest() override { fs::remove_all(folder_); }
  static std::string NameOfFolder() { return "depth_cache_" + std::to_string(::getpid()); }

  DepthCache::Entry PlaneOf(uint32_t id, InverseDepths range = {0, 1}, int planes = 9,
                            int divisor = 1) const {
    const uint32_t others[] = {id == 0 ? 1u : 0u};
    return LfImageKeys(field_, 1).PlaneOf(id, others, range, planes, divisor);
  }
  // The only file of the cache.
  fs::path File() const { return fs::directory_iterator(folder_ / "kept")->path(); }

  const fs::path folder_;
  LightField field_;
};

bool AreSame(const DepthCache::Entry& a, const DepthCache::Entry& b) {
  return a.name == b.name && a.key == b.key;
}

TEST_F(DepthCacheTest, FindsWhatItKept) {
  DepthCache cache(folder_ / "kept");
  DepthPlane plane(16, 12);
  for (size_t i = 0; i < plane.pixels().size(); ++i)
    plane.pixels()[i] = static_cast<uint16_t>(331 * i);
  EXPECT_FALSE(cache.FindPlane(PlaneOf(0), 16, 12));
  ASSERT_TRUE(cache.KeepPlane(PlaneOf(0), plane));
  const auto found = DepthCache(folder_ / "kept").FindPlane(PlaneOf(0), 16, 12);
  ASSERT_TRUE(found);
  EXPECT_TRUE(std::equal(found->pixels().begin(), found->pixels().end(), plane.pixels().begin()));
  EXPECT_FALSE(cache.FindPlane(PlaneOf(1), 16, 12));
  EXPECT_FALSE(cache.FindPlane(PlaneOf(0), 12, 16));  // of another size: damaged
}

TEST_F(DepthCacheTest, FindsTheSameNumbers) {
  DepthCache cache(folder_ / "kept");
  const LfImageKeys keys(field_, 1);
  const std::vector<double> numbers = {1.0 / 3, -2e300, 5};
  EXPECT_FALSE(cache.FindNumbers(keys.OfAll("range", "a")));
  ASSERT_TRUE(cache.KeepNumbers(keys.OfAll("range", "a"), numbers));
  EXPECT_EQ(cache.FindNumbers(keys.OfAll("range", "a")), numbers);
  EXPECT_FALSE(cache.FindNumbers(keys.OfAll("range", "b")));
  EXPECT_FALSE(cache.FindNumbers(LfImageKeys(field_, 2).OfAll("range", "a")));
}

TEST_F(DepthCacheTest, KeepsNothingWithoutAFolder) {
  DepthCache cache({});
  EXPECT_FALSE(cache.Keep(PlaneOf(0), "content"));
  EXPECT_FALSE(cache.Find(PlaneOf(0)));
}

TEST_F(DepthCacheTest, AnyChangeOfTheInputMakesAnotherEntry) {
  const DepthCache::Entry entry = PlaneOf(0);
  EXPECT_TRUE(AreSame(entry, PlaneOf(0)));
  EXPECT_FALSE(AreSame(entry, PlaneOf(0, {0, 1.5})));
  EXPECT_FALSE(AreSame(entry, PlaneOf(0, {0, 1}, 10)));
  EXPECT_FALSE(AreSame(entry, PlaneOf(0, {0, 1}, 9, 2)));
  const LightField before = field_;
  const auto changes = [&](const auto& change) {
    field_ = before;
    change(&field_);
    return !AreSame(entry, PlaneOf(0));
  };
  EXPECT_TRUE(changes([](LightField* f) { f->cameras[0].cam_from_world.translation.x() += 1e-9; }));
  EXPECT_TRUE(changes([](LightField* f) { f->cameras[1].cam_from_world.translation.x() += 1e-9; }));
  EXPECT_FALSE(changes([](LightField* f) { f->cameras[2].cam_from_world.translation.x() += 1; }));
  EXPECT_TRUE(changes([](LightField* f) { f->cameras[0].gain = 2; }));
  EXPECT_TRUE(changes([](LightField* f) { f->intrinsics[0].fx_px += 1; }));
  EXPECT_TRUE(changes([](LightField* f) { f->encoding.transfer = Transfer::kLinear; }));
  EXPECT_TRUE(changes([](LightField* f) { f->encoding.alpha = AlphaMeaning::kStraight; }));
  EXPECT_TRUE(changes([](LightField* f) { f->encoding.white_level = 200; }));
  field_ = before;
  // The new content has the name of the old one, which it replaces.
  std::ofstream(folder_ / "images" / "b.png") << "another picture";
  EXPECT_EQ(entry.name, PlaneOf(0).name);
  EXPECT_NE(entry.key, PlaneOf(0).key);
}

TEST_F(DepthCacheTest, ADamagedEntryIsNotFound) {
  DepthCache cache(folder_ / "kept");
  ASSERT_TRUE(cache.Keep(PlaneOf(0), "content"));
  ASSERT_EQ(cache.Find(PlaneOf(0)), "content");
  const std::string right = *ReadFile(File());
  for (size_t i = 0; i < right.size(); ++i) {
    std::string damaged = right;
    damaged[i] ^= 1;
    ASSERT_TRUE(WriteFileAtomically(File(), damaged));
    EXPECT_FALSE(cache.Find(PlaneOf(0))) << i;
    ASSERT_TRUE(WriteFileAtomically(File(), right.substr(0, i)));
    EXPECT_FALSE(cache.Find(PlaneOf(0))) << i;
  }
  ASSERT_TRUE(cache.Keep(PlaneOf(0), "content"));
  EXPECT_EQ(cache.Find(PlaneOf(0)), "content");
}

TEST_F(DepthCacheTest, GivesUpWhereNothingCanBeWritten) {
  std::ofstream(folder_ / "kept") << "a file";
  DepthCache cache(folder_ / "kept");
  EXPECT_FALSE(cache.Keep(PlaneOf(0), "content"));
  fs::remove(folder_ / "kept");
  EXPECT_FALSE(cache.Keep(PlaneOf(0), "content"));
}

TEST_F(DepthCacheTest, LiesBesideTheLightField) {
  EXPECT_EQ(DepthCacheBeside(field_).parent_path(), fs::canonical(folder_).parent_path());
  EXPECT_EQ(DepthCacheBeside(field_).filename(), folder_.filename().string() + ".depths");
  field_.folder = "/proc";  // the folder around it belongs to root
  if (::geteuid() != 0) {
    EXPECT_TRUE(DepthCacheBeside(field_).empty());
  }
  field_.folder = "";
  EXPECT_TRUE(DepthCacheBeside(field_).empty());
}

}  // namespace
}  // namespace lf
