// SPDX-License-Identifier: Apache-2.0
// The defocus of LF pixels with known depths, and guarded plates.
#include "lf/render/collect/defocus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/camera/render_camera.h"
#include "lf/camera/testing_scenes.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/opacity_and_trust.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/selection/image_index.h"

namespace lf {
namespace {

constexpr double kLeastDepth = 0.1, kGreatestDepth = 2;
constexpr int kImageWidth = 24, kImageHeight = 16;
constexpr PixelRect kWhole = {0, 0, kImageWidth, kImageHeight};

uint16_t DepthNumberOf(double inverse_depth) {
  return static_cast<uint16_t>(1.5 + (inverse_depth - kLeastDepth) /
                                         (kGreatestDepth - kLeastDepth) * 65534);
}

LfDepths DepthsOf(double inverse_depth, int divisor = 1) {
  return {Image<uint16_t>((kImageWidth + divisor - 1) / divisor,
                          (kImageHeight + divisor - 1) / divisor, 1, DepthNumberOf(inverse_depth)),
          kLeastDepth, kGreatestDepth, divisor};
}

PinholeCamera CameraAt(const Vec3& centre_world, const Vec3& forward_world) {
  return {{50, 50, kImageWidth / 2.0, kImageHeight / 2.0, 0, kImageWidth, kImageHeight},
          *LookAlong(centre_world, forward_world, {0, -1, 0})};
}

double ShareAt(const LfPixels& defocus, int x, int y) {
  EXPECT_EQ(defocus.radiance.at(x, y, 0), defocus.radiance.at(x, y, 2));
  EXPECT_EQ(defocus.radiance.at(x, y, LfPixels::kRayLane), 1);
  return (defocus.radiance.at(x, y, 1) - LfPixels::kTransparent) /
         static_cast<double>(LfPixels::kOpaque - LfPixels::kTransparent);
}

// Neighbouring LF cameras 0.1 apart see a point at the inverse depth 1 + d at a distance of
// 50 * 0.1 * d LF pixels from the point behind it at depth 1.
TEST(Defocus, GrowsWithTheDistanceOfNeighbouringPictures) {
  const PinholeCamera camera = CameraAt({0.3, 0.2, 0}, {0, 0, 1});
  const Plane focus = {{0, 0, 1}, 1};
  for (const int divisor : {1, 3})
    for (const auto& [distance_px, share] :
         {std::pair(0.0, 0.0), {0.5, 0.0}, {0.75, 0.25}, {0.9, 0.5}, {1.3, 1.0}, {4.0, 1.0}})
      for (const double side : {-1, 1}) {
        const NearbyDepths nearby = NearbyDepthsOf(DepthsOf(1 + side * distance_px / 5, divisor));
        const LfPixels defocus = DefocusOf(nearby, camera, focus, 0.1, 1, kWhole);
        for (const int x : {0, 11, kImageWidth - 1})
          EXPECT_NEAR(ShareAt(defocus, x, 7), share, 1e-3) << distance_px;
      }
}

TEST(Defocus, IsMeasuredInElementsOrPixelsOfVirtualImagesIfTheseAreLarger) {
  const PinholeCamera camera = CameraAt({0, 0, 0}, {0, 0, 1});
  const NearbyDepths nearby = NearbyDepthsOf(DepthsOf(1.36));  // 1.8 LF pixels
  const Plane focus = {{0, 0, 1}, 1};
  EXPECT_NEAR(ShareAt(DefocusOf(nearby, camera, focus, 0.1, 1, kWhole), 3, 3), 1, 1e-3);
  EXPECT_NEAR(ShareAt(DefocusOf(nearby, camera, focus, 0.1, 2, kWhole), 3, 3), 0.5, 1e-3);
  Intrinsics frame = camera.intrinsics;
  EXPECT_EQ(DefocusUnitPx(1, camera.intrinsics, frame), 1);
  EXPECT_EQ(DefocusUnitPx(3, camera.intrinsics, frame), 3);
  frame.fx_px = frame.fy_px = 12.5;
  EXPECT_EQ(DefocusUnitPx(3, camera.intrinsics, frame), 4);
  frame.fx_px = frame.fy_px = 200;
  EXPECT_EQ(DefocusUnitPx(1, camera.intrinsics, frame), 1);
}

TEST(Defocus, IsThatOfTheWorstPixelAround) {
  const PinholeCamera camera = CameraAt({0, 0, 0}, {0, 0, 1});
  LfDepths depths = DepthsOf(1);
  depths.numbers.at(5, 5) = DepthNumberOf(1.5);
  depths.numbers.at(15, 9) = LfDepths::kUnknown;
  const LfPixels defocus =
      DefocusOf(NearbyDepthsOf(depths), camera, {{0, 0, 1}, 1}, 0.1, 1, {2, 3, 20, 14});
  for (int y = 3; y < 14; ++y)
    for (int x = 2; x < 20; ++x) {
      const bool is_near = (std::abs(x - 5) <= 1 && std::abs(y - 5) <= 1) ||
                           (std::abs(x - 15) <= 1 && std::abs(y - 9) <= 1);
      EXPECT_NEAR(ShareAt(defocus, x - 2, y - 3), is_near ? 1 : 0, 1e-3) << x << " " << y;
    }
  const LfPixels unknown = DefocusOf({}, camera, {{0, 0, 1}, 1}, 0.1, 1, kWhole);
  EXPECT_EQ(ShareAt(unknown, 3, 4), 1);
}

// A point on the focus plane is in focus from every LF camera, however the plane is tilted, the LF
// camera turned or its lens distorted.
TEST(Defocus, IsNoneOnATiltedFocusPlane) {
  for (const bool is_distorted : {false, true}) {
    PinholeCamera camera = CameraAt({0.1, -0.2, 0.05}, {0.2, 0.1, 1});
    if (is_distorted)
      camera.intrinsics.distortion = {DistortionModel::kRadialTangential, {0.1, -0.02, 0.01}};
    const Plane focus = {Vec3(0.3, -0.4, 1).normalized(), 1.2};
    const RayThrough through(camera, Vec3::UnitZ());
    LfDepths depths = DepthsOf(1);
    const DistortionMap map(camera.intrinsics.distortion);
    for (int y = 0; y < kImageHeight; ++y)
      for (int x = 0; x < kImageWidth; ++x) {
        const Vec3 ideal =
            IdealPosition(camera.intrinsics, map, x + 0.5, y + 0.5).value_or(Vec3::Zero());
        PinholeCamera without = camera;
        without.intrinsics.distortion = {};
        const Ray ray = RayOfPixel(without, ideal.x() / ideal.z(), ideal.y() / ideal.z());
        const double depth_w = (focus.offset_w - focus.normal.dot(ray.At(0))) /
                               focus.normal.dot(ray.At(1) - ray.At(0));
        depths.numbers.at(x, y) = DepthNumberOf(1 / depth_w);
      }
    const LfPixels defocus = DefocusOf(NearbyDepthsOf(depths), camera, focus, 0.1, 1, kWhole);
    for (int y = 0; y < kImageHeight; ++y)
      for (int x = 0; x < kImageWidth; ++x) EXPECT_EQ(ShareAt(defocus, x, y), 0) << x << " " << y;
    // The depths differ from those of a plane that is not tilted.
    const LfPixels untilted =
        DefocusOf(NearbyDepthsOf(depths), camera, {{0, 0, 1}, 1.2}, 3, 1, kWhole);
    const auto& values = untilted.radiance.pixels();
    EXPECT_EQ(*std::max_element(values.begin(), values.end()), LfPixels::kOpaque);
  }
}

// Two of three LF images are virtual, and have trust of noise. The recorded ones have depths of
// noise. Some pixels are masked.
class DepthStore : public testing::NoiseStore {
 public:
  explicit DepthStore(const LightField& field, bool has_opacity = false)
      : field_(field), has_opacity_(has_opacity) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    LF_RETURN_IF_ERROR(NoiseStore::Load(id, rect, pixels));
    const auto noise = [&](uint64_t seed, int x, int y) {
      return RandomBits(seed, id.value,
                        static_cast<uint64_t>((y + rect.y_begin) * 1000 + x + rect.x_begin));
    };
    if (has_opacity_) pixels->opacity = Image<uint16_t>(rect.width(), rect.height(), 4, 1);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        for (int c = 0; has_opacity_ && c < 3; ++c)
          pixels->opacity.at(x, y, c) =
              static_cast<uint16_t>(LfPixels::kTransparent +
                                    noise(6, x, y) % (LfPixels::kOpaque - LfPixels::kTransparent));
        if (noise(7, x, y) % 50 == 0) pixels->Mask(x, y);
      }
    if (field_.cameras[id.value].is_virtual) {
      pixels->trust = Image<uint8_t>(rect.width(), rect.height());
      for (int y = 0; y < rect.height(); ++y)
        for (int x = 0; x < rect.width(); ++x)
          pixels->trust.at(x, y) = static_cast<uint8_t>(noise(8, x, y));
      return {};
    }
    pixels->depths = {Image<uint16_t>(testing::kWidth, testing::kHeight), kLeastDepth,
                      kGreatestDepth, 1};
    for (size_t i = 0; i < pixels->depths.numbers.pixels().size(); ++i)
      pixels->depths.numbers.pixels()[i] =
          static_cast<uint16_t>(i / 300 % 3 == 0 ? 30000 : RandomBits(5, id.value, i));
    return {};
  }

 private:
  const LightField& field_;
  const bool has_opacity_;
};

// Shows the opacity or the trust in place of the colours.
class ShownStore : public DepthStore {
 public:
  ShownStore(const LightField& field, bool shows_trust)
      : DepthStore(field, true), shows_trust_(shows_trust) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    LF_RETURN_IF_ERROR(DepthStore::Load(id, rect, pixels));
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        if (pixels->IsMasked(x, y)) continue;
        const double trust = pixels->trust.empty() ? 1 : ShownTrust(pixels->trust.at(x, y));
        const auto value = static_cast<uint16_t>(std::lround(16384 + trust * 32768));
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x, y, c) = shows_trust_ ? value : pixels->opacity.at(x, y, c);
      }
    return {};
  }

 private:
  const bool shows_trust_;
};

// Shows the defocus of frame 0 in place of the colours.
class DefocusStore : public DepthStore {
 public:
  DefocusStore(const LightField& field, const Plane& focus)
      : DepthStore(field), field_(field), focus_(focus) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    LF_RETURN_IF_ERROR(DepthStore::Load(id, rect, pixels));
    *pixels = DefocusOf(NearbyDepthsOf(pixels->depths), field_.Camera(id), focus_, 0.01, 1, rect);
    return {};
  }

 private:
  const LightField& field_;
  Plane focus_;
};

struct GuardTest {
  explicit GuardTest(double focal_px = 80) {
    frame.pinhole.intrinsics.fx_px = frame.pinhole.intrinsics.fy_px = focal_px;
    for (uint32_t i = 0; i < field.size(); ++i) field.cameras[i].is_virtual = i % 3 != 0;
    images = SelectImages(ImageIndex(field, 3), {&frame, 1}, {.reach = PixelReach::kElement}, pool);
  }
  RayWeights WeightOf(LfImageId id, bool is_recorded) const {
    if (is_recorded) return field.cameras[id.value].is_virtual ? 0 : 1 + id.value % 5;
    return 1 + id.value % 7;
  }
  ImageWeights Weights(bool is_recorded) const {
    return [this, is_recorded](LfImageId id) { return WeightOf(id, is_recorded); };
  }
  // Collects the light of all LF images, or of the recorded ones, into a plate of three colours.
  SensorPlate PlateOf(const LfImageStore& store, bool is_recorded) {
    SensorPlate plate(80, 60);
    std::vector<CollectedFrame> frames(1);
    frames[0] = {.camera = frame, .plate = &plate, .weights = Weights(is_recorded)};
    std::vector<SelectedImage> needed = images;
    if (is_recorded)
      std::erase_if(needed, [&](const SelectedImage& image) {
        return field.cameras[image.id.value].is_virtual;
      });
    EXPECT_TRUE(Collect(field, store, frames, needed, options, pool, {}));
    return plate;
  }
  std::vector<CollectedFrame> Guarded(SensorPlate* plate) const {
    std::vector<CollectedFrame> frames(1);
    frames[0] = {.camera = frame,
                 .plate = plate,
                 .weights = Weights(true),
                 .guard = FrameGuard{frame, Weights(false), 0.01}};
    return frames;
  }

  LightField field = testing::NoiseField();
  RenderCamera frame = testing::NoiseFrames().front();
  ThreadPool pool{2};
  std::vector<SelectedImage> images;
  CollectOptions options;
};

// Runs body(test, kind) for both kinds of guarded plates, both back ends, and readings with and
// without a prefilter.
void ForEachReading(const std::function<void(GuardTest* test, PlateKind kind)>& body) {
  for (const PlateKind kind : {PlateKind::kGuarded, PlateKind::kGuardedOpacity})
    for (const CollectBackEnd back_end : {CollectBackEnd::kFast, CollectBackEnd::kReference})
      for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear})
        for (const PixelFilter filter : {PixelFilter::kBilinear, PixelFilter::kPrefiltered}) {
          // Elements of the second frame are twice as large as LF pixels.
          GuardTest test(filter == PixelFilter::kBilinear ? 80 : 35);
          test.options.reading.estimator = estimator;
          test.options.reading.filter = filter;
          test.options.back_end = back_end;
          test.options.batch_image_count = 5;
          body(&test, kind);
        }
}

TEST(GuardedPlate, HoldsTheOpacityAndTheTrustOfItsRays) {
  ForEachReading([](GuardTest* test, PlateKind kind) {
    SensorPlate plate(80, 60, kind);
    const DepthStore store(test->field, plate.has_opacity());
    ASSERT_TRUE(Collect(test->field, store, test->Guarded(&plate), test->images, test->options,
                        test->pool, {}));
    const SensorPlate trust = test->PlateOf(ShownStore(test->field, true), false);
    const SensorPlate all = test->PlateOf(ShownStore(test->field, false), false);
    const SensorPlate recorded = test->PlateOf(ShownStore(test->field, false), true);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x) {
        ASSERT_EQ(plate.At(x, y, plate.trust_channel()), trust.At(x, y, 0));
        ASSERT_EQ(plate.At(x, y, plate.trust_channel()).count,
                  plate.At(x, y, plate.all_rays_channel()).count);
        if (!plate.has_opacity()) continue;
        ASSERT_EQ(plate.At(x, y, SensorPlate::kOpacityChannel), recorded.At(x, y, 0));
        ASSERT_EQ(plate.At(x, y, plate.all_opacity_channel()), all.At(x, y, 0));
      }
  });
}

TEST(GuardedPlate, HoldsTheRecordedRaysTheirDefocusAndAllRays) {
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear})
    for (const CollectBackEnd back_end : {CollectBackEnd::kFast, CollectBackEnd::kReference}) {
      GuardTest test;
      test.options.reading.estimator = estimator;
      test.options.back_end = back_end;
      test.options.batch_image_count = 5;
      const DepthStore store(test.field);
      SensorPlate plate(80, 60, PlateKind::kGuarded);
      const auto statistics = Collect(test.field, store, test.Guarded(&plate), test.images,
                                      test.options, test.pool, {});
      ASSERT_TRUE(statistics);
      const SensorPlate recorded = test.PlateOf(store, true), all = test.PlateOf(store, false);
      const SensorPlate defocus =
          test.PlateOf(DefocusStore(test.field, test.frame.focus_plane), true);
      uint64_t sum = 0;
      for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 80; ++x) {
          ASSERT_EQ(plate.At(x, y, plate.defocus_channel()), defocus.At(x, y, 0));
          sum += defocus.At(x, y, 0).count;
          for (int c = 0; c < 3; ++c) {
            ASSERT_EQ(plate.At(x, y, c), recorded.At(x, y, c));
            ASSERT_EQ(plate.At(x, y, plate.all_rays_channel() + c), all.At(x, y, c));
          }
        }
      EXPECT_GT(sum, 1000u);
      EXPECT_LE(statistics->frames[0].image_count, RecordedCount(test.field));
      EXPECT_GT(statistics->frames[0].virtual_count, 0u);
      EXPECT_LE(statistics->frames[0].virtual_count, test.field.size() - RecordedCount(test.field));
    }
}

TEST(GuardedPlate, HasTheSameBitsHoweverOftenItIsInterrupted) {
  GuardTest test;
  test.options.reading = Estimator::kBilinear;
  const DepthStore store(test.field);
  SensorPlate whole(80, 60, PlateKind::kGuarded), cut(80, 60, PlateKind::kGuarded);
  ASSERT_TRUE(
      Collect(test.field, store, test.Guarded(&whole), test.images, test.options, test.pool, {}));
  std::atomic<bool> interrupted = false;
  test.options.interrupted = &interrupted;
  test.options.batch_image_count = 3;
  FrameCollector collector(test.field, store, test.Guarded(&cut), test.images, test.options,
                           test.pool);
  for (bool is_going_on = true; is_going_on; interrupted = !interrupted) {
    const Result<bool> step = collector.Step();
    is_going_on = !step || *step;
  }
  EXPECT_EQ(cut, whole);
}

}  // namespace
}  // namespace lf
