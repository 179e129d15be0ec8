// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/group_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>

#include "lf/core/random.h"
#include "lf/selection/reference_groups.h"

namespace lf {
namespace {

LightField GridOfImages(int columns, int rows) {
  LightField field;
  field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      field.cameras.emplace_back();
      field.cameras.back().cam_from_world.translation = -Vec3(0.1 * x, 0.1 * y, 0);
    }
  field.image_names.resize(field.cameras.size());
  return field;
}

std::vector<CameraToGroup> CamerasToGroup(const LightField& field) {
  std::vector<CameraToGroup> cameras;
  for (const LfCamera& camera : field.cameras) {
    const RigidTransform& pose = camera.cam_from_world;
    cameras.push_back({pose.Inverse().translation, pose.rotation.row(2).transpose(), 0});
  }
  return cameras;
}

Vec3 MeanPosition(const LightField& field, std::span<const uint32_t> ids) {
  Vec3 sum = Vec3::Zero();
  for (const uint32_t id : ids) sum += field.cameras[id].cam_from_world.Inverse().translation;
  return sum / static_cast<double>(ids.size());
}

// Every group of GroupCameras() is a part of the order, member for member.
TEST(GroupOrder, TakesTheMembersOfAGroupInTheOrderOfDecoding) {
  const LightField field = GridOfImages(30, 20);
  const std::vector<uint32_t> order = OrderByGroups(field, 1);
  ASSERT_EQ(order.size(), 600u);
  const ReferenceGroups groups = GroupCameras(CamerasToGroup(field));
  for (size_t g = 0; g < groups.size(); ++g) {
    const auto members = groups.Group(g);
    const auto first = std::find(order.begin(), order.end(), members[0].id.value);
    ASSERT_GE(order.end() - first, static_cast<ptrdiff_t>(members.size()));
    for (size_t i = 0; i < members.size(); ++i)
      EXPECT_EQ(first[static_cast<ptrdiff_t>(i)], members[i].id.value) << g << " " << i;
  }
}

TEST(GroupOrder, HasEachImageOnceForEachSeed) {
  const LightField field = GridOfImages(17, 11);
  const std::vector<uint32_t> one = OrderByGroups(field, 1), other = OrderByGroups(field, 2);
  EXPECT_NE(one, other);
  EXPECT_EQ(one, OrderByGroups(field, 1));
  for (std::vector<uint32_t> order : {one, other}) {
    std::sort(order.begin(), order.end());
    for (uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
  }
  EXPECT_TRUE(OrderByGroups(LightField(), 1).empty());
}

// The first quarter of the LF images of a grid of 64 x 64 has about a quarter of each quadrant.
TEST(GroupOrder, SpreadsTheGroups) {
  const LightField field = GridOfImages(64, 64);
  for (const uint64_t seed : {1, 2, 3}) {
    const std::vector<uint32_t> order = OrderByGroups(field, seed);
    const auto quarter = std::span(order).first(1024);
    std::array<int, 4> counts = {};
    for (const uint32_t id : quarter) ++counts[(id % 64 < 32 ? 0 : 1) + (id / 64 < 32 ? 0 : 2)];
    for (const int count : counts) EXPECT_NEAR(count, 256, 48) << seed;
    // Members of a group are neighbours: the first 16 are nearer to their mean than most.
    const Vec3 mean = MeanPosition(field, quarter.first(16));
    for (const uint32_t id : quarter.first(16))
      EXPECT_LT((field.cameras[id].cam_from_world.Inverse().translation - mean).norm(), 1.6);
  }
}

// Ids change with the order in which a calibration lists LF images, and positions do not.
TEST(GroupOrder, DependsOnPositionsAlone) {
  const LightField field = GridOfImages(12, 9);
  std::vector<uint32_t> moved(field.size());  // [id in `field`] id in `other`
  std::iota(moved.begin(), moved.end(), 0U);
  std::sort(moved.begin(), moved.end(),
            [](uint32_t a, uint32_t b) { return RandomBits(5, 0, a) < RandomBits(5, 0, b); });
  LightField other = field;
  for (uint32_t id = 0; id < moved.size(); ++id) other.cameras[moved[id]] = field.cameras[id];
  std::vector<uint32_t> order = OrderByGroups(field, 4);
  for (uint32_t& id : order) id = moved[id];
  EXPECT_EQ(order, OrderByGroups(other, 4));
}

TEST(GroupOrder, VirtualImagesDoNotChangeTheOrderOfRecordedOnes) {
  const LightField recorded = GridOfImages(16, 16);
  LightField densified = recorded;
  for (const LfCamera& camera : GridOfImages(31, 31).cameras) {
    densified.cameras.push_back(camera);
    densified.cameras.back().is_virtual = true;
    densified.cameras.back().cam_from_world.translation *= 0.5;
  }
  densified.image_names.resize(densified.size());
  const std::vector<uint32_t> order = OrderByGroups(densified, 3);
  std::vector<uint32_t> left;
  std::copy_if(order.begin(), order.end(), std::back_inserter(left),
               [](uint32_t id) { return id < 256; });
  EXPECT_EQ(left, OrderByGroups(recorded, 3));
  // Half of all has half of the recorded ones, but for the groups in the middle.
  const auto in_half = std::count_if(order.begin(), order.begin() + (256 + 961) / 2,
                                     [](uint32_t id) { return id < 256; });
  EXPECT_NEAR(in_half, 128, 24);
}

// The groups of a light field video hold LF images of one time, and those of a rig with two kinds
// of cameras LF images of one size; those of brackets one exposure.
TEST(GroupOrder, GroupsHaveOneTimeOneSizeAndOneExposure) {
  LightField video = GridOfImages(8, 4);
  const LightField once = video;
  video.cameras.insert(video.cameras.end(), once.cameras.begin(), once.cameras.end());
  video.image_names.resize(64);
  for (uint32_t id = 0; id < 64; ++id) video.times.push_back(id < 32 ? 0 : 1);
  LightField sizes = video;
  sizes.times.clear();
  sizes.intrinsics.push_back({100, 100, 50, 40, 0, 100, 80});
  for (uint32_t id = 32; id < 64; ++id) sizes.cameras[id].intrinsics_index = 1;
  LightField brackets = video;
  brackets.times.clear();
  for (uint32_t id = 32; id < 64; ++id) brackets.cameras[id].gain = 4;
  for (const LightField& field : {video, sizes, brackets}) {
    const std::vector<uint32_t> order = OrderByGroups(field, 1);
    size_t changes = 0;
    for (size_t i = 1; i < order.size(); ++i) changes += order[i] / 32 != order[i - 1] / 32;
    EXPECT_LE(changes, 3u);  // four groups
  }
}

}  // namespace
}  // namespace lf
