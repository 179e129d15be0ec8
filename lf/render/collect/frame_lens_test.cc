// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/frame_lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/collection/scatter.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

// Returns one plate per lens, with all LF images collected with the weights of the lens.
std::vector<SensorPlate> CollectedPlates(const LightField& field,
                                         const std::vector<FrameLens>& lenses, Estimator estimator,
                                         CollectBackEnd back_end, int threads, uint64_t seed) {
  ThreadPool pool(threads);
  const testing::NoiseStore store;
  std::vector<RenderCamera> cameras;
  std::vector<SensorPlate> plates;
  for (const FrameLens& lens : lenses) {
    cameras.push_back(lens.camera());
    plates.emplace_back(cameras.back().pinhole.intrinsics.width_px,
                        cameras.back().pinhole.intrinsics.height_px);
  }
  SelectOptions select;
  select.reach = ReachOf(estimator);
  const auto order = SelectImages(ImageIndex(field, seed), cameras, select, pool);
  CollectOptions options;
  options.reading.estimator = estimator;
  options.back_end = back_end;
  std::vector<CollectedFrame> frames = FramesOf(cameras, plates);
  for (size_t f = 0; f < frames.size(); ++f)
    frames[f].weights = [&lens = lenses[f]](LfImageId id) { return lens.WeightsOf(id); };
  EXPECT_TRUE(Collect(field, store, frames, order, options, pool, {}));
  return plates;
}

TEST(FrameLens, WithoutWeightsIsTheFrames) {
  ThreadPool pool(2);
  const LightField field = testing::NoiseField();
  const ImageIndex index(field);
  for (const RenderCamera& frame : testing::NoiseFrames()) {
    const FrameLens lens(index, frame, LensWeights::kNone, {}, pool);
    EXPECT_EQ(lens.camera().aperture.radius_w, frame.aperture.radius_w);
    EXPECT_EQ(lens.camera().aperture.blades, frame.aperture.blades);
    EXPECT_TRUE(lens.WeightsOf(LfImageId{3}).are_same());
    EXPECT_EQ(lens.WeightsOf(LfImageId{3}).same(), 1u);
    EXPECT_FALSE(lens.facts());
    EXPECT_TRUE(lens.EffectiveCounts().empty());
  }
}

TEST(FrameLens, PlatesAreThoseOfTheReferenceForAnyThreadsAndOrder) {
  const LightField field = testing::NoiseField();
  ThreadPool pool(2);
  for (const LensWeights kind : {LensWeights::kArea, LensWeights::kHat})
    for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear}) {
      SelectOptions select;
      select.reach = ReachOf(estimator);
      std::vector<FrameLens> lenses, of_another_order;
      for (const RenderCamera& frame : testing::NoiseFrames())
        lenses.emplace_back(ImageIndex(field), frame, kind, select, pool);
      for (const RenderCamera& frame : testing::NoiseFrames())
        of_another_order.emplace_back(ImageIndex(field, 5), frame, kind, select, pool);
      const auto plates = CollectedPlates(field, lenses, estimator, CollectBackEnd::kFast, 1, 0);
      EXPECT_EQ(CollectedPlates(field, of_another_order, estimator, CollectBackEnd::kFast, 3, 5),
                plates);
      const auto expected =
          CollectedPlates(field, lenses, estimator, CollectBackEnd::kReference, 1, 0);
      uint64_t total = 0, differing = 0;
      for (size_t f = 0; f < plates.size(); ++f)
        for (int y = 0; y < plates[f].height(); ++y)
          for (int x = 0; x < plates[f].width(); ++x) {
            const ElementSum found = plates[f].At(x, y, 1), wanted = expected[f].At(x, y, 1);
            total += wanted.count;
            differing += found.count > wanted.count ? found.count - wanted.count
                                                    : wanted.count - found.count;
          }
      EXPECT_GT(total, 100000u);
      EXPECT_LE(differing, total / 1000);
    }
}

// The LF cameras are in front of, behind and in the lens plane. Frames have tilted focus planes,
// near and far, and polygonal apertures. If selection left out pixels of rays with a weight, these
// rays would be missing.
TEST(FrameLens, SelectionLeavesOutNoRayWithAWeight) {
  const LightField field = testing::NoiseField();
  const testing::NoiseStore store;
  ThreadPool pool(2);
  uint64_t total = 0, all_pixels = 0, selected_pixels = 0;
  for (uint64_t seed = 0; seed < 24; ++seed) {
    const auto random = [&](uint64_t i, double low, double high) {
      return low + (high - low) * RandomUnit(3, seed, i);
    };
    RenderCamera frame = testing::NoiseFrames()[seed % 3];
    frame.pinhole.cam_from_world =
        *LookAlong({random(0, -0.02, 0.02), random(1, -0.02, 0.02), random(2, -0.1, 0.1)},
                   {random(3, -0.2, 0.2), random(4, -0.2, 0.2), 1}, {0, -1, 0});
    frame.aperture.radius_w = seed % 4 == 0 ? 0.001 : random(5, 0.005, 0.05);
    frame.focus_plane = FocusPlane(frame.pinhole, random(6, 0.3, 3), {random(7, -1, 1), 0.3});
    const LensWeights kind = seed % 2 == 0 ? LensWeights::kArea : LensWeights::kHat;
    std::vector<FrameLens> lenses;
    lenses.emplace_back(ImageIndex(field), frame, kind, SelectOptions{}, pool);
    const RenderCamera& camera = lenses[0].camera();
    SensorPlate expected(80, 60);
    const PixelRect whole{0, 0, testing::kWidth, testing::kHeight};
    for (uint32_t i = 0; i < field.size(); ++i) {
      LfPixels pixels;
      ASSERT_TRUE(store.Load({i}, whole, &pixels));
      const RayWeights weights = lenses[0].WeightsOf({i});
      if (weights.are_none()) continue;
      ScatterReference(field.Camera({i}), pixels, camera, whole, &expected, weights);
      all_pixels += static_cast<uint64_t>(whole.pixel_count());
    }
    for (const SelectedImage& image : SelectImages(ImageIndex(field), {&camera, 1}, {}, pool))
      selected_pixels += lenses[0].WeightsOf(image.id).are_none() ? 0 : image.ray_count;
    const auto plates =
        CollectedPlates(field, lenses, Estimator::kNearest, CollectBackEnd::kReference, 1, 0);
    EXPECT_EQ(plates[0], expected) << seed;
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x) total += expected.At(x, y, 1).count;
  }
  EXPECT_GT(total, 1000000u);
  EXPECT_LT(selected_pixels, all_pixels);
}

TEST(FrameLens, ImagesBesideTheLensTakePartAndThoseFarAwayDoNot) {
  ThreadPool pool(2);
  const LightField field = testing::NoiseField(15);
  RenderCamera frame = testing::NoiseFrames()[0];
  frame.aperture = {0.012, 0, 0};
  const FrameLens lens(ImageIndex(field), frame, LensWeights::kArea, {}, pool);
  EXPECT_GT(lens.camera().aperture.radius_w, 0.012);
  EXPECT_LT(lens.camera().aperture.radius_w, 0.025);
  size_t inside = 0, beside = 0, none = 0;
  for (uint32_t i = 0; i < field.size(); ++i) {
    const double distance =
        (field.cameras[i].cam_from_world.Inverse().translation - frame.pinhole.CentreWorld())
            .norm();
    const RayWeights weights = lens.WeightsOf(LfImageId{i});
    const bool takes_part = !weights.are_same() || weights.same() > 0;
    EXPECT_TRUE(takes_part || distance >= 0.01) << i;
    inside += takes_part && distance < 0.012 ? 1 : 0;
    beside += takes_part && distance > 0.0121 ? 1 : 0;
    none += takes_part ? 0 : 1;
  }
  EXPECT_GT(inside, 10u);
  EXPECT_GT(beside, 3u);
  EXPECT_GT(none, 100u);
  ASSERT_TRUE(lens.facts());
  EXPECT_EQ(lens.facts()->hat_share, 0);
  EXPECT_LT(lens.facts()->coverage.uncovered_share, 0.1);
}

// Every LF image is uniform; their brightnesses differ by up to a tenth. From element to element,
// the picture must change only slightly, also where LF images begin and end.
TEST(FrameLens, BordersOfLfImagesLeaveNoSeam) {
  class EvenStore : public testing::NoiseStore {
   public:
    Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
      *pixels = LfPixels(rect, BayerPattern::kNone);
      const double brightness = 0.95 + 0.1 * RandomUnit(12, id.value, 0);
      for (int y = 0; y < rect.height(); ++y)
        for (int x = 0; x < rect.width(); ++x)
          for (int c = 0; c < 3; ++c)
            pixels->radiance.at(x, y, c) = static_cast<uint16_t>(30000 * brightness);
      return {};
    }
  };
  ThreadPool pool(2);
  LightField field = testing::NoiseField(7);
  field.intrinsics[0] = {700, 700, 320, 240, 0, 640, 480};
  RenderCamera frame = testing::NoiseFrames()[0];
  // The frame sees beyond the borders of the LF images.
  frame.pinhole.intrinsics = {560, 560, 320, 240, 0, 640, 480};
  std::vector<FrameLens> lenses;
  lenses.emplace_back(ImageIndex(field), frame, LensWeights::kArea, SelectOptions{}, pool);
  SelectOptions select;
  select.reach = ReachOf(Estimator::kBilinear);
  const RenderCamera& camera = lenses[0].camera();
  const auto order = SelectImages(ImageIndex(field), {&camera, 1}, select, pool);
  const auto largest_step = [&](bool has_feather) {
    std::vector<SensorPlate> plates;
    plates.emplace_back(640, 480);
    CollectOptions options;
    options.reading.estimator = Estimator::kBilinear;
    std::vector<CollectedFrame> frames = FramesOf({&camera, 1}, plates);
    frames[0].weights = [&](LfImageId id) {
      const RayWeights weights = lenses[0].WeightsOf(id);
      if (has_feather || weights.are_same()) return weights;
      return RayWeights(weights.blocks(),
                        [weights](int end_x, int end_y, int count, uint8_t* of_blocks) {
                          weights.OfRow(end_x - 1, end_y - 1, count, of_blocks);
                        });
    };
    EXPECT_TRUE(Collect(field, EvenStore(), frames, order, options, pool, {}));
    double most = 0;
    const auto value = [&](int x, int y) {
      const ElementSum sum = plates[0].At(x, y, 1);
      return static_cast<double>(sum.sum) / static_cast<double>(sum.count);
    };
    for (int y = 60; y < 420; ++y)
      for (int x = 60; x < 580; ++x)
        // Elements with smaller counts see only a few LF images, whose weights are rounded too
        // coarsely for a smooth transition.
        if (std::min(plates[0].At(x, y, 1).count, plates[0].At(x - 1, y, 1).count) > kMaxWeight)
          most = std::max(most, std::abs(value(x, y) / value(x - 1, y) - 1));
    return most;
  };
  const double with = largest_step(true), without = largest_step(false);
  EXPECT_LT(with, 0.005);
  EXPECT_GT(without, 2.5 * with);
}

// Compares EffectiveCounts() with (sum w)^2 / sum w^2 over the weights w of all LF images, for
// frames that lie completely within every LF image.
TEST(FrameLens, EffectiveCountsAreThoseOfTheWeights) {
  ThreadPool pool(2);
  const LightField field = testing::NoiseField(15);
  for (RenderCamera frame : testing::NoiseFrames()) {
    Intrinsics& k = frame.pinhole.intrinsics;
    const int width = k.width_px;
    // The frame sees only a small part of each LF image.
    for (double* value : {&k.fx_px, &k.fy_px}) *value *= 4;
    const FrameLens lens(ImageIndex(field), frame, LensWeights::kArea, {}, pool);
    const Image<float> counts = lens.EffectiveCounts();
    const Image<float> spread = SpreadOverPlate(counts, k);
    ASSERT_EQ(spread.width(), width);
    const int step = EffectiveStep(k);
    EXPECT_GE(counts.height(), 8);
    EXPECT_EQ(counts.width(), (width + step - 1) / step);
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < field.size(); ++i) {
      const double weight = lens.WeightsOf(LfImageId{i}).At(step / 2, step / 2);
      sum += weight;
      squares += weight * weight;
    }
    ASSERT_GT(squares, 0);
    EXPECT_NEAR(counts.at(0, 0), sum * sum / squares, 1e-3);
    EXPECT_EQ(spread.at(0, 0), counts.at(0, 0));
    EXPECT_EQ(spread.at(step / 2, step / 2), counts.at(0, 0));
    EXPECT_NEAR(spread.at(width - 1, 0), counts.at(counts.width() - 1, 0), 1);
    for (int x = 1; x < width; ++x)
      EXPECT_LE(std::abs(spread.at(x, 0) - spread.at(x - 1, 0)), 0.2F * spread.at(x, 0));
  }
}

// Virtual LF images get weights, but are not counted.
TEST(FrameLens, EffectiveCountsAreThoseOfRecordedImages) {
  ThreadPool pool(2);
  LightField field = testing::NoiseField(15);
  RenderCamera frame = testing::NoiseFrames().front();
  for (double* value : {&frame.pinhole.intrinsics.fx_px, &frame.pinhole.intrinsics.fy_px})
    *value *= 4;
  for (uint32_t i = 0; i < field.size(); ++i) field.cameras[i].is_virtual = i % 3 != 0;
  const FrameLens lens(ImageIndex(field), frame, LensWeights::kArea, {}, pool);
  const int middle = EffectiveStep(frame.pinhole.intrinsics) / 2;
  double sum = 0, squares = 0;
  size_t virtual_count = 0;
  for (uint32_t i = 0; i < field.size(); ++i) {
    const double weight = lens.WeightsOf(LfImageId{i}).At(middle, middle);
    if (field.cameras[i].is_virtual) virtual_count += weight > 0 ? 1 : 0;
    if (field.cameras[i].is_virtual) continue;
    sum += weight;
    squares += weight * weight;
  }
  ASSERT_GT(squares, 0);
  EXPECT_GT(virtual_count, 0u);
  EXPECT_NEAR(lens.EffectiveCounts().at(0, 0), sum * sum / squares, 1e-3);
  for (LfCamera& camera : field.cameras) camera.is_virtual = true;
  EXPECT_EQ(lens.EffectiveCounts().at(0, 0), 0);
}

// Rays then need both a weight and the opening of the lens.
// A pinhole beside an LF camera has one weight of 255, and one between four LF cameras four of
// them: without a common unit, the second would count four times as much.
TEST(FrameLens, InstantsOfAFrameCountEqually) {
  const LightField field = testing::NoiseField();
  const ImageIndex index(field);
  ThreadPool pool(2);
  std::vector<RenderCamera> instants;
  const auto centre = [&](uint32_t id) { return field.Camera({id}).CentreWorld(); };
  const Vec3 beside = centre(24);
  const Vec3 between = (centre(24) + centre(25) + centre(31) + centre(32)) / 4;
  for (const double share : {0.0, 0.5, 1.0}) {
    RenderCamera camera = testing::NoiseFrames()[0];
    camera.pinhole.cam_from_world =
        *LookAlong(beside + share * (between - beside), {0, 0, 1}, {0, -1, 0});
    camera.aperture = {};
    camera.focus_plane = FocusPlane(camera.pinhole, 1, {});
    instants.push_back(camera);
  }
  instants.push_back(instants.front());
  instants.back().aperture.radius_w = 0.015;
  const std::vector<FrameLens> lenses = LensesOf(index, instants, LensWeights::kAuto, {}, pool);
  double least = 1e9, most = 0, most_alone = 0;
  for (const FrameLens& lens : lenses) {
    least = std::min(least, lens.weights()->SumOfWeights());
    most = std::max(most, lens.weights()->SumOfWeights());
    const FrameLens alone(index, instants[&lens - lenses.data()], LensWeights::kAuto, {}, pool);
    most_alone = std::max(most_alone, alone.weights()->SumOfWeights());
    EXPECT_LE(lens.weights()->SumOfWeights(), alone.weights()->SumOfWeights());
    double sum = 0;
    for (uint32_t i = 0; i < field.size(); ++i) sum += lens.WeightsOf({i}).At(40, 30);
    EXPECT_NEAR(sum, lens.weights()->SumOfWeights(), 0.06 * sum);
  }
  EXPECT_GT(most_alone, 2 * most);
  EXPECT_NEAR(least, most, 1e-9 * most);
  const FrameLens::Facts facts = *FactsOf(lenses);
  EXPECT_GT(facts.hat_share, 0.7);
  EXPECT_LT(facts.hat_share, 0.8);
  // One instant is not changed.
  const FrameLens alone(index, instants[3], LensWeights::kAuto, {}, pool);
  const std::vector<FrameLens> one =
      LensesOf(index, std::span(instants).last(1), LensWeights::kAuto, {}, pool);
  EXPECT_EQ(one[0].weights()->SumOfWeights(), alone.weights()->SumOfWeights());
}

TEST(FrameLens, EffectiveCountsOfInstantsAreThoseOfTheirSums) {
  const LightField field = testing::NoiseField();
  const ImageIndex index(field);
  ThreadPool pool(2);
  RenderCamera frame = testing::NoiseFrames()[0];
  frame.aperture = {0.01, 0, 0};
  const std::vector<RenderCamera> same = {frame, frame, frame};
  const std::vector<FrameLens> lenses = LensesOf(index, same, LensWeights::kArea, {}, pool);
  const FrameLens alone(index, frame, LensWeights::kArea, {}, pool);
  EXPECT_EQ(EffectiveCountsOf(lenses).pixels(), alone.EffectiveCounts().pixels());
  // A camera that moves sees other LF images.
  std::vector<RenderCamera> moving = {frame, frame};
  moving[0].pinhole.cam_from_world.translation.x() -= 0.015;
  moving[1].pinhole.cam_from_world.translation.x() += 0.015;
  const double of_one = alone.EffectiveCounts().at(4, 4);
  const double of_both =
      EffectiveCountsOf(LensesOf(index, moving, LensWeights::kArea, {}, pool)).at(4, 4);
  EXPECT_GT(of_both, 1.5 * of_one);
  EXPECT_LT(of_both, 2.5 * of_one);
  EXPECT_TRUE(EffectiveCountsOf(LensesOf(index, moving, LensWeights::kNone, {}, pool)).empty());
}

TEST(FrameLens, KeepsTheOpeningIfVeryManyLfImagesShareIt) {
  ThreadPool pool(2);
  const LightField field = testing::NoiseField(70);
  RenderCamera frame;
  frame.pinhole.intrinsics = {2500, 2500, 500, 500, 0, 1000, 1000};
  frame.pinhole.cam_from_world = *LookAlong({0, 0, -0.06}, {0, 0, 1}, {0, -1, 0});
  frame.aperture = {0.03, 5, 0.1};
  frame.focus_plane = FocusPlane(frame.pinhole, 1, {0, 0});
  const FrameLens lens(ImageIndex(field), frame, LensWeights::kArea, {}, pool);
  ASSERT_TRUE(lens.tests_opening());
  EXPECT_EQ(lens.camera().aperture.radius_w, frame.aperture.radius_w);
  EXPECT_EQ(lens.camera().aperture.blades, 5);
  const Image<float> counts = lens.EffectiveCounts();
  const int step = EffectiveStep(frame.pinhole.intrinsics);
  const Vec3 focus = *FocusPointOfElement(frame, step / 2 + 0.5, step / 2 + 0.5);
  const ApertureTest opening(frame.aperture);
  double in_opening = 0;
  for (uint32_t i = 0; i < field.size(); ++i) {
    const Vec3 centre = field.Camera(LfImageId{i}).CentreWorld();
    in_opening += opening.Contains(LensPointOfLine(frame, centre, focus)) ? 1 : 0;
  }
  EXPECT_GT(in_opening, 1024);
  EXPECT_LT(counts.at(0, 0), in_opening);
  EXPECT_GT(counts.at(0, 0), 0.5 * in_opening);
}

}  // namespace
}  // namespace lf
