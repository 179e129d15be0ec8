// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/image_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr size_t kImages = 2000, kFrames = 20;

// Returns, for each frame of a film whose lens opens, the LF images that it takes: a range of ids,
// wider for later frames. No frame takes images 0 .. 99.
std::vector<std::vector<ImageRays>> Film() {
  std::vector<std::vector<ImageRays>> frames(kFrames);
  for (uint32_t f = 0; f < kFrames; ++f) {
    const uint32_t begin = 100 + 60 * f, count = 100 + 30 * f;
    for (uint32_t i = begin; i < begin + count; ++i)
      frames[f].push_back({LfImageId{i}, 100 + RandomBits(7, f, i) % 200});
  }
  return frames;
}

// Returns as many LF cameras in a row.
LightField Row() {
  LightField field;
  field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
  field.cameras.resize(kImages);
  for (size_t i = 0; i < kImages; ++i)
    field.cameras[i].cam_from_world.translation.x() = static_cast<double>(i);
  return field;
}

std::vector<uint32_t> Ids(const ImageRanks& ranks) {
  std::vector<uint32_t> ids(ranks.of_images.size(), UINT32_MAX);
  for (uint32_t id = 0; id < ranks.of_images.size(); ++id) ids[ranks.of_images[id]] = id;
  return ids;
}

// Counts the rays that each frame gets from the first tenth of the LF images that any frame takes.
// Returns the standard deviation of these counts divided by their mean.
double SpreadAfterATenth(const ImageRanks& ranks,
                         const std::vector<std::vector<ImageRays>>& frames) {
  std::vector<uint32_t> taken;
  for (const auto& frame : frames)
    for (const ImageRays& image : frame) taken.push_back(ranks.of_images[image.id.value]);
  std::sort(taken.begin(), taken.end());
  taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
  const uint32_t tenth = taken[taken.size() / 10];
  double sum = 0, squares = 0;
  for (const auto& frame : frames) {
    double rays = 0;
    for (const ImageRays& image : frame)
      if (ranks.of_images[image.id.value] < tenth) rays += static_cast<double>(image.ray_count);
    sum += rays;
    squares += rays * rays;
  }
  const double mean = sum / kFrames;
  return std::sqrt(squares / kFrames - mean * mean) / mean;
}

TEST(ImageOrder, EveryOrderHasEachImageOnce) {
  for (const ImageOrder order : {ImageOrder::kSpread, ImageOrder::kShuffle, ImageOrder::kRoundRobin,
                                 ImageOrder::kArea, ImageOrder::kGroups}) {
    const ImageRanks ranks =
        DependsOnFrames(order) ? RanksInOrder(order, kImages, 3, Film()) : RanksOf(order, Row(), 3);
    EXPECT_EQ(ranks.end, kImages);
    std::vector<uint32_t> ids = Ids(ranks);
    if (DependsOnFrames(order)) {
      // The LF images at the end are those that no frame takes.
      std::vector<uint32_t> last(ids.end() - 100, ids.end());
      for (const uint32_t id : last) EXPECT_TRUE(id < 100 || id >= 100 + 60 * 19 + 670) << id;
    }
    std::sort(ids.begin(), ids.end());
    for (uint32_t i = 0; i < kImages; ++i) EXPECT_EQ(ids[i], i);
    EXPECT_EQ(ImageOrderOf(NameOf(order)), order);
  }
  EXPECT_EQ(ImageOrderOf("size"), std::nullopt);
}

TEST(ImageOrder, TheShuffleDependsOnTheSeedAlone) {
  EXPECT_EQ(RanksOf(ImageOrder::kShuffle, Row(), 5).of_images, ShuffledRanks(kImages, 5).of_images);
  EXPECT_NE(ShuffledRanks(kImages, 6).of_images, ShuffledRanks(kImages, 5).of_images);
}

TEST(ImageOrder, RoundRobinFillsFramesEqually) {
  const double shuffled = SpreadAfterATenth(ShuffledRanks(kImages, 3), Film());
  const double in_turn =
      SpreadAfterATenth(RanksInOrder(ImageOrder::kRoundRobin, kImages, 3, Film()), Film());
  EXPECT_GT(shuffled, 0.3);  // later frames have wider lenses, and get more rays
  EXPECT_LT(in_turn, 0.1);
}

// Among the frames that still need LF images, one with the fewest rays must be among those that
// take the next LF image. The test counts the rays itself.
TEST(ImageOrder, RoundRobinServesTheFrameWithTheFewestRays) {
  const auto frames = Film();
  const std::vector<uint32_t> ids = Ids(RanksInOrder(ImageOrder::kRoundRobin, kImages, 3, frames));
  std::vector<uint64_t> rays(kFrames, 0);
  std::vector<size_t> waiting(kFrames);
  for (size_t f = 0; f < kFrames; ++f) waiting[f] = frames[f].size();
  size_t taken = 0;
  for (const uint32_t id : ids) {
    uint64_t fewest = UINT64_MAX, fewest_of_takers = UINT64_MAX;
    for (size_t f = 0; f < kFrames; ++f)
      if (waiting[f] > 0) fewest = std::min(fewest, rays[f]);
    for (size_t f = 0; f < kFrames; ++f)
      for (const ImageRays& image : frames[f])
        if (image.id.value == id) {
          fewest_of_takers = std::min(fewest_of_takers, rays[f]);
          --waiting[f];
        }
    if (fewest == UINT64_MAX) break;  // only LF images that no frame takes are left
    ASSERT_EQ(fewest_of_takers, fewest) << "image " << id << " at rank " << taken;
    for (size_t f = 0; f < kFrames; ++f)
      for (const ImageRays& image : frames[f])
        if (image.id.value == id) rays[f] += image.ray_count;
    ++taken;
  }
  EXPECT_GT(taken, kImages / 2);
}

// The two frames take 30 + 40 rays of image 3, 60 + 0 rays of image 0, 0 + 50 rays of image 2, and
// no rays of image 1.
TEST(ImageOrder, AreaCountsTheRaysOfAllFramesTogether) {
  const std::vector<std::vector<ImageRays>> frames = {{{LfImageId{3}, 30}, {LfImageId{0}, 60}},
                                                      {{LfImageId{2}, 50}, {LfImageId{3}, 40}}};
  EXPECT_EQ(Ids(RanksInOrder(ImageOrder::kArea, 4, 3, frames)),
            (std::vector<uint32_t>{3, 0, 2, 1}));
}

TEST(ImageOrder, AreaTakesTheLargestFirst) {
  const auto frames = Film();
  std::vector<uint64_t> rays(kImages, 0);
  for (const auto& frame : frames)
    for (const ImageRays& image : frame) rays[image.id.value] += image.ray_count;
  const std::vector<uint32_t> ids = Ids(RanksInOrder(ImageOrder::kArea, kImages, 3, frames));
  for (size_t i = 1; i < ids.size(); ++i) EXPECT_GE(rays[ids[i - 1]], rays[ids[i]]);
}

}  // namespace
}  // namespace lf
