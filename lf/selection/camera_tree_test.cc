// SPDX-License-Identifier: Apache-2.0
// Compares the octree and SeenRegion with a test of every single LF camera.
#include "lf/selection/camera_tree.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "lf/camera/testing_scenes.h"
#include "lf/core/random.h"
#include "lf/selection/image_index.h"
#include "lf/selection/overlap.h"
#include "lf/selection/select.h"
#include "lf/selection/test_rays.h"

namespace lf {
namespace {

// Returns LF cameras with random poses and intrinsics; usually many more than a leaf can contain.
LightField RandomField(size_t count, bool is_distorted) {
  LightField field;
  for (uint64_t seed = 0; seed < count; ++seed) {
    const testing::CameraPair pair =
        is_distorted ? testing::RandomDistortedPair(seed) : testing::RandomCameraPair(seed);
    field.intrinsics.push_back(pair.lf_camera.intrinsics);
    field.cameras.push_back({pair.lf_camera.cam_from_world, static_cast<uint32_t>(seed), 1});
    field.image_names.push_back("x.png");
  }
  return field;
}

// Returns side x side LF cameras, about in a plane. All look along z, or all look at one point.
LightField Wall(int side, bool look_at_one_point) {
  LightField field;
  field.intrinsics = {{100, 100, 25, 17.5, 0, 50, 35, {}}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const Vec3 centre(x - 0.5 * side, y - 0.5 * side, 0.3 * RandomUnit(1, x, y));
      const Vec3 forward = look_at_one_point ? Vec3(Vec3(0, 0, 30) - centre) : Vec3(Vec3::UnitZ());
      field.cameras.push_back({*LookAlong(centre, forward, -Vec3::UnitY()), 0, 1});
      field.image_names.push_back("x.png");
    }
  return field;
}

std::vector<RenderCamera> RandomFrames(size_t count) {
  std::vector<RenderCamera> frames;
  for (uint64_t seed = 0; seed < count; ++seed)
    frames.push_back(testing::RandomCameraPair(1000 + seed).render_camera);
  return frames;
}

TEST(CameraTree, HoldsEveryCameraOnce) {
  for (const size_t count : {0, 1, 2, 33, 700}) {
    const LightField field = RandomField(count, false);
    const CameraTree tree(field);
    std::set<uint32_t> found;
    for (size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
      EXPECT_FALSE(tree.Leaf(leaf).empty());
      EXPECT_LE(tree.Leaf(leaf).size(), 32u);
      for (const LfImageId id : tree.Leaf(leaf)) EXPECT_TRUE(found.insert(id.value).second);
    }
    EXPECT_EQ(found.size(), count);
  }
}

// The index of recorded LF images finds the leaves that it would find without virtual ones, which
// makes lens weights the same to the bit.
TEST(ImageIndex, OfRecordedImagesIsThatOfALightFieldWithoutVirtualOnes) {
  LightField field = RandomField(700, false), recorded = field;
  recorded.cameras.clear();
  recorded.image_names.clear();
  std::vector<uint32_t> ids;  // ids of the recorded LF images in `field`
  for (uint32_t i = 0; i < field.size(); ++i) {
    field.cameras[i].is_virtual = i % 7 > 2;
    if (field.cameras[i].is_virtual) continue;
    ids.push_back(i);
    recorded.cameras.push_back(field.cameras[i]);
    recorded.image_names.push_back(field.image_names[i]);
  }
  const ImageIndex all(field), alone(recorded);
  EXPECT_EQ(&alone.recorded(), &alone);
  EXPECT_FALSE(all.is_of_recorded());
  EXPECT_TRUE(all.recorded().is_of_recorded());
  EXPECT_EQ(all.recorded().RankOf(LfImageId{7}), all.RankOf(LfImageId{7}));
  const CameraTree &tree = all.recorded().tree(), &expected = alone.tree();
  ASSERT_EQ(tree.leaf_count(), expected.leaf_count());
  for (size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    ASSERT_EQ(tree.Leaf(leaf).size(), expected.Leaf(leaf).size());
    for (size_t i = 0; i < tree.Leaf(leaf).size(); ++i)
      EXPECT_EQ(tree.Leaf(leaf)[i].value, ids[expected.Leaf(leaf)[i].value]);
  }
}

TEST(CameraTree, CamerasAtOnePlaceShareALeaf) {
  LightField field;
  field.intrinsics = {{100, 100, 25, 17.5, 0, 50, 35, {}}};
  field.cameras.resize(1000);
  const CameraTree tree(field);
  ASSERT_EQ(tree.leaf_count(), 1u);
  EXPECT_EQ(tree.Leaf(0).size(), 1000u);
}

TEST(CameraTree, LeavesOutNoCameraThatContributes) {
  const std::vector<RenderCamera> frames = RandomFrames(500);
  for (const bool is_distorted : {false, true}) {
    const LightField field = RandomField(400, is_distorted);
    const CameraTree tree(field);
    std::vector<std::vector<IdealCell>> cells;
    for (const Intrinsics& k : field.intrinsics)
      cells.push_back(k.has_distortion() ? MakeIdealCells(k) : std::vector<IdealCell>());
    size_t contributing = 0, visited = 0, inside = 0;
    for (const RenderCamera& frame : frames) {
      const SeenRegion region(frame);
      std::set<uint32_t> found;
      tree.ForEachLeaf(region, [&](size_t leaf, bool all_inside) {
        for (const LfImageId id : tree.Leaf(leaf)) {
          found.insert(id.value);
          inside += all_inside;
          EXPECT_FALSE(all_inside && region.Misses(field.Camera(id).CentreWorld()));
        }
      });
      visited += found.size();
      for (uint32_t i = 0; i < field.size(); ++i) {
        const PinholeCamera camera = field.Camera({i});
        // For distorted LF images, ContributingRect() is coarser than the region, and is tested
        // only if the region does not miss.
        if (is_distorted && region.Misses(camera.CentreWorld())) continue;
        if (ContributingRect(camera, frame, cells[i]).empty()) continue;
        ++contributing;
        EXPECT_FALSE(region.Misses(camera.CentreWorld()));
        EXPECT_TRUE(found.contains(i));
      }
    }
    EXPECT_GT(contributing, 1000u);
    EXPECT_GT(inside, 1000u);
    EXPECT_LT(visited, frames.size() * field.size() * 9 / 10);
  }
}

// Tests single rays with the ray model, also for distorted LF images, because their rectangles are
// too coarse for a test.
TEST(SeenRegion, HoldsTheCameraOfEveryAcceptedRay) {
  size_t accepted = 0, missed_cameras = 0;
  for (uint64_t seed = 0; seed < 600; ++seed) {
    const testing::CameraPair pair =
        seed % 2 == 0 ? testing::RandomCameraPair(seed) : testing::RandomDistortedPair(seed);
    const Intrinsics& k = pair.lf_camera.intrinsics;
    const DistortionMap map(k.distortion);
    const SeenRegion region(pair.render_camera);
    const bool misses = region.Misses(pair.lf_camera.CentreWorld());
    missed_cameras += misses;
    for (int y = 0; y < k.height_px; y += 3)
      for (int x = 0; x < k.width_px; x += 3) {
        if (!testing::Contributes(pair.lf_camera, map, pair.render_camera, x, y)) continue;
        ++accepted;
        EXPECT_FALSE(misses) << seed;
      }
  }
  EXPECT_GT(accepted, 20000u);
  EXPECT_GT(missed_cameras, 30u);
}

TEST(CameraTree, AsksFewOfAWall) {
  const LightField field = Wall(100, false);
  const CameraTree tree(field);
  RenderCamera frame;
  frame.pinhole.intrinsics = {100, 100, 25, 17.5, 0, 50, 35, {}};
  frame.aperture.radius_w = 5;
  frame.focus_plane = {Vec3::UnitZ(), 40};
  size_t visited = 0, inside = 0;
  tree.ForEachLeaf(SeenRegion(frame), [&](size_t leaf, bool all_inside) {
    visited += tree.Leaf(leaf).size();
    inside += all_inside ? tree.Leaf(leaf).size() : 0;
  });
  EXPECT_GE(visited, 80u);  // about 10 x 10
  EXPECT_LE(visited, 400u);
  EXPECT_GT(inside, 0u);
  // LF cameras in front of the frame that look at it have no ray for it.
  frame.pinhole.cam_from_world = *LookAlong({0, 0, 30}, -Vec3::UnitZ(), -Vec3::UnitY());
  frame.focus_plane = {Vec3::UnitZ(), 20};
  visited = 0;
  tree.ForEachLeaf(SeenRegion(frame), [&](size_t /*leaf*/, bool /*all_inside*/) { ++visited; });
  EXPECT_EQ(visited, 0u);
}

// Uses more frames than SelectImages() processes together, and a range of places for each frame.
// SelectedImage::frame_count must count all frames that take the LF image.
TEST(Select, FindsWhatEveryCameraAskedAloneSays) {
  const LightField field = RandomField(300, false);
  std::vector<TakingFrame> frames;
  for (const RenderCamera& camera : RandomFrames(150)) {
    const auto f = static_cast<uint32_t>(frames.size());
    frames.push_back({camera, {f % 7, f % 3 == 0 ? 200 : UINT32_MAX}});
  }
  const ImageIndex index(field, 4);
  ThreadPool pool(2);
  std::map<uint32_t, SelectedImage> expected;
  for (uint32_t i = 0; i < field.size(); ++i)
    for (const TakingFrame& frame : frames) {
      const uint32_t place = index.RankOf({i});
      const PixelRect rect = ContributingRect(field.Camera({i}), frame.camera);
      if (rect.empty() || !frame.ranks.Holds(place)) continue;
      SelectedImage& image = expected[place];
      image.id = {i};
      image.rect = Bounds(image.rect, rect);
      image.frame_count += 1;
      image.ray_count += static_cast<uint64_t>(rect.pixel_count());
    }
  const std::vector<SelectedImage> found = SelectImages(index, frames, {}, pool);
  ASSERT_EQ(found.size(), expected.size());
  auto wanted = expected.begin();
  for (const SelectedImage& image : found) {
    EXPECT_EQ(image.rank, wanted->first);
    EXPECT_EQ(image.id, wanted->second.id);
    EXPECT_EQ(image.rect, wanted->second.rect);
    EXPECT_EQ(image.frame_count, wanted->second.frame_count);
    EXPECT_EQ(image.ray_count, wanted->second.ray_count);
    ++wanted;
  }
  EXPECT_GT(found.size(), 100u);
}

}  // namespace
}  // namespace lf
