// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/memory_plan.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

LightField Field(int width, int height) {
  LightField field;
  field.intrinsics = {{1000, 1000, width / 2.0, height / 2.0, 0, width, height}};
  field.cameras.resize(1000);
  field.image_names.resize(1000);
  return field;
}

constexpr size_t kMiB = size_t{1} << 20;

TEST(MemoryPlan, StaysWithinTheMemory) {
  for (const size_t memory : {2048 * kMiB, 4096 * kMiB, 8192 * kMiB})
    for (const int width : {640, 4000}) {
      const MemoryPlan plan =
          *PlanMemory(memory, Field(width, width), Estimator::kNearest, 1920, 1080, 900, 2);
      const size_t images = 2 * plan.batch_image_count * plan.image_bytes + plan.plan_bytes;
      EXPECT_LE(plan.frames_per_pass * plan.plate_bytes + images, memory) << memory << " " << width;
      EXPECT_GE(plan.batch_image_count, 1u);
    }
}

TEST(MemoryPlan, TheLeastMemoryThatIsNamedSuffices) {
  for (const int width : {640, 4000}) {
    const auto plan = [&](size_t mib) {
      return PlanMemory(mib * kMiB, Field(width, width), Estimator::kBilinear, 6000, 4000, 1, 2,
                        300 * kMiB);
    };
    const std::string message = plan(1).error().message;
    const size_t least = std::stoul(message.substr(message.find("at least ") + 9));
    EXPECT_FALSE(plan(least - 1)) << message;
    for (size_t mib = least; mib < 3 * least; mib += 50)
      EXPECT_LE(plan(mib)->total_bytes, mib * kMiB) << width << " " << mib;
  }
}

TEST(MemoryPlan, MoreMemoryNeverMeansMorePasses) {
  size_t before = 0;
  for (size_t mib = 700; mib < 10000; mib += 300) {
    const size_t now =
        PlanMemory(mib * kMiB, Field(960, 640), Estimator::kNearest, 1920, 1080, 900, 2)
            ->frames_per_pass;
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_GT(before, 100u);
}

TEST(MemoryPlan, BatchesAreNoLargerThanPays) {
  const auto images = [](size_t mib, int width, int height, int threads, size_t frames = 900) {
    return PlanMemory(mib * kMiB, Field(width, height), Estimator::kNearest, 1920, 1080, frames,
                      threads)
        ->batch_image_count;
  };
  EXPECT_EQ(images(16384, 320, 240, 2), 64u);
  EXPECT_EQ(images(16384, 960, 640, 2), 8u * 1920 * 1080 / (960 * 640));
  EXPECT_EQ(images(16384, 2048, 2048, 2), 16u);
  EXPECT_EQ(images(16384, 6000, 4000, 2, 1), 2u);
  EXPECT_GT(images(16384, 6000, 4000, 2, 10), 4u);
  EXPECT_EQ(images(65536, 2048, 2048, 40), 40u);
  EXPECT_LT(images(600, 960, 640, 2), 20u);
}

// LF images of 24 megapixels: the plans of a batch's rays in one frame are about as large as the LF
// images.
TEST(MemoryPlan, LargeImagesAndManyThreadsCount) {
  const LightField field = Field(6000, 4000);
  const MemoryPlan few = *PlanMemory(4096 * kMiB, field, Estimator::kNearest, 1920, 1080, 900, 2);
  const MemoryPlan many =
      *PlanMemory(16384 * kMiB, field, Estimator::kNearest, 1920, 1080, 900, 32);
  EXPECT_LE(few.batch_image_count * 2 * few.image_bytes, 1024 * kMiB);
  EXPECT_FALSE(PlanMemory(4096 * kMiB, field, Estimator::kNearest, 1920, 1080, 900, 32));
  EXPECT_GE(many.plan_bytes, many.batch_image_count * size_t{4000} * 6000 / 256 * 32);
}

// A guarded plate has eight channels instead of three, or ten instead of four. The defocus of LF
// pixels is planned, and LF images are kept with their trust.
TEST(MemoryPlan, GuardedFramesNeedMoreMemory) {
  LightField field = Field(960, 640);
  const auto plan = [&](bool is_guarded) {
    return *PlanMemory(2048 * kMiB, field, Estimator::kBilinear, 1920, 1080, 900, 2, 0, is_guarded);
  };
  EXPECT_EQ(plan(true).plate_bytes, plan(false).plate_bytes / 3 * 8);
  EXPECT_GE(plan(true).image_bytes, plan(false).image_bytes + 960 * 640 * 8);
  EXPECT_LT(plan(true).frames_per_pass * 2, plan(false).frames_per_pass);
  EXPECT_GE(plan(true).plan_bytes, plan(true).batch_image_count * 960 * 640 * 8);
  field.encoding.alpha = AlphaMeaning::kStraight;
  field.encoding.keeps_opacity = true;
  ASSERT_TRUE(field.encoding.HasOpacity());
  EXPECT_EQ(plan(true).plate_bytes, plan(false).plate_bytes / 4 * 10);
}

TEST(MemoryPlan, NamesTheLeastMemoryThatIsEnough) {
  const Result<MemoryPlan> plan =
      PlanMemory(100 * kMiB, Field(960, 640), Estimator::kNearest, 1920, 1080, 1, 2);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().kind, ErrorKind::kOutput);
  const std::string& message = plan.error().message;
  const size_t at = message.find("at least ");
  ASSERT_NE(at, std::string::npos) << message;
  const size_t least = std::stoul(message.substr(at + 9));
  EXPECT_TRUE(PlanMemory(least * kMiB, Field(960, 640), Estimator::kNearest, 1920, 1080, 1, 2));
}

TEST(MemoryPlan, FurtherInstantsNeedPlansAndWeights) {
  const LightField field = Field(960, 640);
  const auto plan = [&](size_t instants, const RayReading& reading) {
    return *PlanMemory(1024 * kMiB, field, reading, 1920, 1080, 900, 2, 0, false, instants);
  };
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear}) {
    const MemoryPlan one = plan(1, estimator), many = plan(64, estimator);
    EXPECT_EQ(one.plan_bytes,
              PlanMemory(1024 * kMiB, field, estimator, 1920, 1080, 900, 2)->plan_bytes);
    EXPECT_LE(many.batch_image_count, one.batch_image_count);
    EXPECT_LT(many.frames_per_pass, one.frames_per_pass);
    EXPECT_GE(many.plan_bytes / many.batch_image_count,
              64 * PlanBytes(estimator, false, 960, 640, 1920, 1080));
    EXPECT_LE(many.total_bytes, 1024 * kMiB);
  }
}

}  // namespace
}  // namespace lf
