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

constexpr ReferenceNeed References(size_t mib, bool in_groups = false) {
  return {uint64_t{mib} * kMiB, in_groups};
}

Result<MemoryPlan> PlanWith(size_t memory_mib, const ReferenceNeed& references, size_t frames = 900,
                            int threads = 2) {
  return PlanMemory(memory_mib * kMiB, Field(960, 640), Estimator::kNearest, 1920, 1080, frames,
                    threads, 0, false, 1, nullptr, references);
}

TEST(MemoryPlan, ReferenceImagesGetAtMostAThirdOfFreeMemory) {
  const MemoryPlan without = *PlanWith(4096, {});
  EXPECT_EQ(without.reference_bytes, 0u);
  EXPECT_EQ(without.enough_bytes, 0u);
  const MemoryPlan all = *PlanWith(4096, References(100));
  EXPECT_EQ(all.reference_bytes, 100 * kMiB);
  EXPECT_LE(all.enough_bytes, 4096 * kMiB);
  const MemoryPlan some = *PlanWith(4096, References(3000));
  EXPECT_GT(some.reference_bytes, 1200 * kMiB);
  EXPECT_LT(some.reference_bytes, 4096 * kMiB / 3);
  EXPECT_LT(some.frames_per_pass, without.frames_per_pass);
  EXPECT_GT(some.frames_per_pass, without.frames_per_pass / 2);
}

TEST(MemoryPlan, ReferenceImagesLeaveRoomForAPlateAndTwoBatches) {
  size_t before = 0, passes_before = 0;
  for (size_t mib = 180; mib < 6000; mib += 20) {
    const Result<MemoryPlan> plan = PlanWith(mib, References(900));
    if (!plan) {
      EXPECT_EQ(before, 0u) << mib;
      continue;
    }
    EXPECT_LE(plan->total_bytes, mib * kMiB);
    EXPECT_GE(plan->batch_image_count, 1u);
    EXPECT_GE(plan->reference_bytes, before) << mib;
    EXPECT_GE(plan->frames_per_pass, passes_before) << mib;
    before = plan->reference_bytes;
    passes_before = plan->frames_per_pass;
  }
  EXPECT_EQ(before, 900 * kMiB);
}

// Large LF images and many threads: a third of the free memory would be too much.
TEST(MemoryPlan, ReferenceImagesLeaveTwoBatchesAnImageForEachThread) {
  size_t tried = 0;
  for (size_t mib = 10000; mib < 40000; mib += 500) {
    const Result<MemoryPlan> plan =
        PlanMemory(mib * kMiB, Field(6000, 4000), Estimator::kNearest, 240, 160, 1, 16, 0, false, 1,
                   nullptr, References(20000));
    if (!plan) continue;
    const size_t least = size_t{16} * 16 * (20000 * kMiB / 1000);  // of a group for each thread
    EXPECT_GE(plan->reference_bytes, least - kMiB) << mib;
    if (plan->reference_bytes < least + kMiB) continue;
    ++tried;
    EXPECT_GE(mib * kMiB - plan->reference_bytes, plan->plate_bytes + 2 * 16 * plan->image_bytes);
  }
  EXPECT_GT(tried, 10u);
}

TEST(MemoryPlan, NamesTheMemoryThatKeepsAllReferenceImages) {
  for (const bool in_groups : {false, true})
    for (const size_t mib : {50, 900, 20000}) {
      const ReferenceNeed references = References(mib, in_groups);
      const size_t enough = PlanWith(2048, references)->enough_bytes / kMiB + 1;
      const MemoryPlan plan = *PlanWith(enough, references);
      const size_t wanted = in_groups ? plan.reference_bytes : references.all_bytes;
      EXPECT_EQ(plan.reference_bytes, wanted) << mib;
      EXPECT_EQ(PlanWith(2 * enough, references)->reference_bytes, wanted) << mib;
      EXPECT_LT(PlanWith(enough - 2, references)->reference_bytes, wanted) << mib;
    }
}

// In the order of groups, the reference images of two groups for each thread suffice: those of 64
// of 1000 LF images.
TEST(MemoryPlan, GroupsNeedFewReferenceImages) {
  const MemoryPlan plan = *PlanWith(4096, References(2000, true));
  EXPECT_NEAR(static_cast<double>(plan.reference_bytes), 64 * 2.0 * kMiB, kMiB);
  EXPECT_GT(plan.frames_per_pass, PlanWith(4096, References(2000))->frames_per_pass);
}

TEST(MemoryPlan, TheLeastMemoryCountsReferenceImages) {
  const Result<MemoryPlan> plan = PlanWith(100, References(3000), 1);
  ASSERT_FALSE(plan);
  const std::string& message = plan.error().message;
  EXPECT_NE(message.find("reference images"), std::string::npos) << message;
  const size_t least = std::stoul(message.substr(message.find("at least ") + 9));
  EXPECT_FALSE(PlanWith(least - 1, References(3000), 1));
  ASSERT_TRUE(PlanWith(least, References(3000), 1));
  // The reference images of 32 of 1000 LF images are kept, 16 for each thread.
  EXPECT_NEAR(static_cast<double>(PlanWith(least, References(3000), 1)->reference_bytes),
              32 * 3.0 * kMiB, kMiB);
  EXPECT_TRUE(PlanWith(least - 90, {}, 1));
}

}  // namespace
}  // namespace lf
