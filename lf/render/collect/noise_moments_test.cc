// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/noise_moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "lf/core/random.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

struct ImageSums {
  std::vector<ElementSum> images;

  ElementSum Total() const {
    ElementSum total;
    for (const ElementSum& one : images) total = {total.sum + one.sum, total.count + one.count};
    return total;
  }
  ElementMoments Moments() const {
    NoiseMoments moments(1, 1);
    for (const ElementSum& one : images) moments.AddImage(0, 0, one);
    return moments.At(0, 0);
  }
  double StandardError() const { return StandardErrorOfMean(Total(), Moments()); }
  // Computes the standard error by its definition, in two passes of double precision.
  double TwoPass() const {
    double sum = 0, count = 0, n = 0, squares = 0;
    for (const ElementSum& one : images) {
      sum += static_cast<double>(one.sum);
      count += static_cast<double>(one.count);
      n += one.count > 0 ? 1 : 0;
    }
    for (const ElementSum& one : images) {
      const double off =
          static_cast<double>(one.sum) - sum / count * static_cast<double>(one.count);
      squares += off * off;
    }
    return std::sqrt(n / (n - 1) * squares) / count;
  }
};

TEST(NoiseMoments, GiveTheStandardErrorOfTwoPasses) {
  for (const uint64_t most_count : {1u, 2u, 255u, 2040u, 1u << 20})
    for (const uint64_t spread : {1u, 40u, 65536u})
      for (uint64_t seed = 0; seed < 20; ++seed) {
        ImageSums sums;
        const uint64_t n = 2 + RandomBits(seed, 0, spread) % 800;
        for (uint64_t i = 0; i < n; ++i) {
          const uint64_t count = RandomBits(seed, 1, i) % (most_count + 1);
          const uint64_t value = 65535 - RandomBits(seed, 2, i) % spread;
          sums.images.push_back({value * count, count});
        }
        sums.images.push_back({7, 1});
        sums.images.push_back({0, 1});
        const double expected = sums.TwoPass();
        EXPECT_NEAR(sums.StandardError(), expected, 1e-7 * expected)
            << most_count << " " << spread << " " << seed;
      }
}

TEST(NoiseMoments, KnownAnswers) {
  // For two LF images of equal count, the standard error is half of the difference of their means,
  // whatever the count.
  EXPECT_EQ((ImageSums{{{100, 1}, {300, 1}}}).StandardError(), 100);
  EXPECT_EQ((ImageSums{{{25500, 255}, {76500, 255}}}).StandardError(), 100);
  // LF images with the same mean, which is not an integer here, have no noise, whatever their
  // counts.
  EXPECT_NEAR((ImageSums{{{5, 2}, {500, 200}, {50, 20}}}).StandardError(), 0, 1e-6);
  // However many rays one LF image has, they count as one sample.
  EXPECT_TRUE(std::isinf((ImageSums{{{1000, 500}}}).StandardError()));
  EXPECT_TRUE(std::isinf(StandardErrorOfMean({}, {})));
  // An LF image that adds nothing does not count.
  EXPECT_TRUE(std::isinf((ImageSums{{{1000, 500}, {0, 0}}}).StandardError()));
  EXPECT_EQ((ImageSums{{{1000, 500}, {0, 0}}}).Moments().image_count, 1u);
}

// The total of the plate has rays of virtual LF images, but the noise is that of the others.
TEST(NoiseMoments, VirtualImagesChangeNoNoise) {
  NoiseMoments moments(1, 1);
  SensorPlate plate(1, 1);
  for (int c = 0; c < SensorPlate::kChannels; ++c) {
    for (const ElementSum& recorded : {ElementSum{100, 1}, ElementSum{300, 1}}) {
      moments.AddImage(0, c, recorded);
      plate.Add(0, 0, c, recorded);
    }
    const std::string before = moments.Text();
    for (const ElementSum& of_virtual : {ElementSum{1000, 7}, ElementSum{0, 3}}) {
      moments.AddVirtual(0, c, of_virtual);
      plate.Add(0, 0, c, of_virtual);
    }
    EXPECT_EQ(StandardErrorOfMean(plate.At(0, 0, c), moments.At(0, c)), 100);
    EXPECT_EQ(moments.At(0, c).image_count, 2u);
    if (c == 0) {
      EXPECT_EQ(before.find("3e8"), std::string::npos);
    }
  }
  const Result<NoiseMoments> read = NoiseMoments::Read(moments.Text(), plate);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, moments);
  EXPECT_EQ(read->Text(), moments.Text());
  // More virtual rays than the plate has, a block of zeros, and a block that is cut off.
  EXPECT_FALSE(NoiseMoments::Read(moments.Text(), SensorPlate(1, 1)));
  const std::string text = moments.Text();
  EXPECT_FALSE(NoiseMoments::Read(text.substr(0, text.rfind(' ')), plate));
  EXPECT_FALSE(NoiseMoments::Read(text + " 0", plate));
  EXPECT_FALSE(NoiseMoments::Read(text.substr(0, text.find(" 3e8")) + " 0 0 0 0 0 0", plate));
}

// Tests the largest counts that a plate can have, with the brightest rays.
TEST(NoiseMoments, NothingWraps) {
  constexpr uint64_t kCount = uint64_t{1} << 43;
  const ImageSums sums{{{65535 * kCount, kCount}, {0, kCount}}};
  EXPECT_EQ(sums.StandardError(), 65535 / 2.0);
  const ImageSums bright{{{65535 * kCount, kCount}, {65535 * kCount - 2, kCount}}};
  EXPECT_NEAR(bright.StandardError(), 1.0 / kCount, 1e-4 / kCount);
}

TEST(NoiseMoments, MeasuresElementsAllOverThePlate) {
  for (const auto& [width, height] : {std::pair{1, 1}, {80, 60}, {33, 2000}, {1920, 1080}}) {
    const NoiseMoments moments(width, height);
    EXPECT_EQ(moments.size(), static_cast<size_t>(std::min(width, 48)) * std::min(height, 32));
    std::vector<PlateElement> elements;
    for (size_t i = 0; i < moments.size(); ++i) {
      elements.push_back(moments.ElementAt(i));
      EXPECT_TRUE(elements[i].x >= 0 && elements[i].x < width);
      EXPECT_TRUE(elements[i].y >= 0 && elements[i].y < height);
      if (i > 0) {
        EXPECT_NE(elements[i], elements[i - 1]);
      }
    }
    EXPECT_LT(elements.front().x, std::max(1, width / 90));
    EXPECT_GE(elements.back().y, height - 1 - height / 60);
    // Every measured element is in exactly one tile.
    size_t found = 0;
    const TileGrid grid = TileSums::GridOf(width, height);
    for (size_t tile = 0; tile < grid.tile_count(); ++tile)
      found += moments.IndicesIn(grid.RectOf(tile)).size();
    EXPECT_EQ(found, moments.size());
  }
  EXPECT_EQ(NoiseMoments().size(), 0u);
  EXPECT_TRUE(NoiseMoments(0, 0).IndicesIn({0, 0, 9, 9}).empty());
}

// Results of collecting a whole light field. The expected moments come from collecting one LF image
// at a time into an empty plate.
struct Collected {
  std::vector<SensorPlate> plates;
  std::vector<NoiseMoments> moments;
};

constexpr size_t kFrames = 3;

Collected CollectField(Estimator estimator, CollectBackEnd back_end, const LensWeights& weights,
                       int threads, int batch, std::span<const uint32_t> only = {}) {
  const LightField field = testing::NoiseField(5);
  const std::vector<RenderCamera> path = testing::NoiseFrames();
  const ImageIndex index(field, 3);
  testing::NoiseStore store;
  store.broken = {4, 17};
  ThreadPool pool(threads);
  std::vector<FrameLens> lenses;
  std::vector<RenderCamera> frames;
  const SelectOptions select{.reach = ReachOf(estimator)};
  for (const RenderCamera& camera : path) {
    lenses.emplace_back(index, camera, weights, select, pool);
    frames.push_back(lenses.back().camera());
  }
  std::vector<SelectedImage> order = SelectImages(index, frames, select, pool);
  if (!only.empty())
    std::erase_if(order, [&](const SelectedImage& image) {
      return std::count(only.begin(), only.end(), image.id.value) == 0;
    });
  Collected collected;
  for (size_t f = 0; f < kFrames; ++f) {
    collected.plates.emplace_back(80, 60);
    collected.moments.emplace_back(80, 60);
  }
  CollectOptions options;
  options.reading.estimator = estimator;
  options.back_end = back_end;
  options.batch_image_count = batch;
  std::vector<CollectedFrame> into = FramesOf(frames, collected.plates);
  for (size_t f = 0; f < kFrames; ++f) {
    into[f].moments = &collected.moments[f];
    if (weights != LensWeights::kNone)
      into[f].weights = [&lens = lenses[f]](LfImageId id) { return lens.WeightsOf(id); };
  }
  EXPECT_TRUE(Collect(field, store, into, order, options, pool, nullptr));
  return collected;
}

std::vector<NoiseMoments> MomentsOneByOne(Estimator estimator, LensWeights weights) {
  std::vector<NoiseMoments> moments(kFrames, NoiseMoments(80, 60));
  for (uint32_t image = 0; image < 25; ++image) {
    const std::vector<uint32_t> only = {image};
    const Collected one = CollectField(estimator, CollectBackEnd::kFast, weights, 1, 1, only);
    for (size_t f = 0; f < kFrames; ++f)
      for (size_t i = 0; i < moments[f].size(); ++i)
        for (int c = 0; c < 3; ++c) {
          const PlateElement at = moments[f].ElementAt(i);
          moments[f].AddImage(i, c, one.plates[f].At(at.x, at.y, c));
        }
  }
  return moments;
}

TEST(NoiseMoments, AreThoseOfEveryLfImageAloneForAnyThreadsAndBatches) {
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear})
    for (const LensWeights weights : {LensWeights::kNone, LensWeights::kArea}) {
      const std::vector<NoiseMoments> expected = MomentsOneByOne(estimator, weights);
      uint32_t most = 0;
      for (size_t i = 0; i < expected[0].size(); ++i)
        most = std::max(most, expected[0].At(i, 1).image_count);
      EXPECT_GT(most, 5u);
      for (const int threads : {1, 3})
        for (const int batch : {1, 7, 64}) {
          const Collected all =
              CollectField(estimator, CollectBackEnd::kFast, weights, threads, batch);
          EXPECT_EQ(all.moments, expected) << NameOf(estimator) << " " << threads << " " << batch;
        }
      // The moments of the reference back end match its plate.
      const Collected judge = CollectField(estimator, CollectBackEnd::kReference, weights, 2, 7);
      for (size_t f = 0; f < kFrames; ++f)
        EXPECT_TRUE(NoiseMoments::Read(judge.moments[f].Text(), judge.plates[f]));
    }
}

TEST(NoiseMoments, AreReadAsTheyWereWritten) {
  const Collected all =
      CollectField(Estimator::kBilinear, CollectBackEnd::kFast, LensWeights::kArea, 2, 8);
  const std::string text = all.moments[1].Text();
  const Result<NoiseMoments> read = NoiseMoments::Read(text, all.plates[1]);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, all.moments[1]);
  EXPECT_TRUE(text.starts_with("30 20 "));
  // Read() notices a wrong number only if it cannot be a moment of the plate.
  EXPECT_FALSE(NoiseMoments::Read(text, all.plates[0]));
  EXPECT_FALSE(NoiseMoments::Read(text.substr(0, text.size() / 2), all.plates[1]));
  EXPECT_FALSE(NoiseMoments::Read(text + " 0", all.plates[1]));
  EXPECT_FALSE(NoiseMoments::Read("", all.plates[1]));
  const auto one = [](const std::string& moments) {
    SensorPlate plate(1, 1);
    plate.Add(0, 0, 0, {300, 3});
    const Result<NoiseMoments> of_one = NoiseMoments::Read("1 1" + moments, plate);
    return of_one ? std::string("good") : of_one.error().message;
  };
  const std::string rest = " 0 0 0 0 0 0 0 0";  // channels without a ray
  // Two LF images with S = 100, 200 and W = 1, 2 have the moments 50000, 500, 5 and 2.
  EXPECT_EQ(one(" c350 1f4 5 2" + rest), "good");
  EXPECT_NE(one(" c350 1f4 5 2"), "good");
  EXPECT_NE(one(" c350  1f4 5 2" + rest).find("number 4"), std::string::npos);
  for (const char* wrong :
       {" C350 1f4 5 2", " 0c350 1f4 5 2", " c350 1f4 5 4", " c350 1f4 5 1", " c350 1f4 a 2",
        " c350 1f4 2 2", " c350 385 5 2", " 15f91 1f4 5 2", " 0 1f4 5 2", " c350 0 5 2", " 0 0 0 0",
        " c350 1f4 5 100000002", " c350 1f4 5 -2", " c350 1f4 5 0x2",
        " 1000000000000000000000000000000 1f4 5 2"})
    EXPECT_NE(one(wrong + rest), "good") << wrong;
  EXPECT_NE(one(" c350 1f4 5 2 1 0 0 0 0 0 0 0"), "good");
}

}  // namespace
}  // namespace lf
