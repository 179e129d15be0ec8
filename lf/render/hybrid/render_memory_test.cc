// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/render_memory.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/render/hybrid/frame_pixels.h"
#include "lf/render/hybrid/rebinned_rays.h"

namespace lf {
namespace {

constexpr size_t kMiB = size_t{1} << 20;

LightField FieldOfThousand() {
  LightField field;
  field.intrinsics = {{1000, 1000, 480, 320, 0, 960, 640}};
  field.cameras.resize(1000);
  field.image_names.resize(1000);
  return field;
}

RenderMemoryNeed NeedOf(const LightField& field, RenderMode mode, RayInterpolation interpolation,
                        size_t max_cells, const RayReading& reading) {
  return {.mode = mode,
          .interpolation = interpolation,
          .max_cells = max_cells,
          .light_field = field,
          .reading = reading,
          .plate_width = 480,
          .plate_height = 320,
          .frame_count = 10,
          .thread_count = 2};
}

Result<RenderMemory> PlanOf(size_t memory_mib, RenderMode mode, size_t max_cells,
                            uint64_t reference_mib,
                            RayInterpolation interpolation = RayInterpolation::kCells) {
  const LightField field = FieldOfThousand();
  const RayReading reading = Estimator::kNearest;
  RenderMemoryNeed need = NeedOf(field, mode, interpolation, max_cells, reading);
  need.references = {reference_mib * kMiB, false};
  return PlanRenderMemory(memory_mib * kMiB, need);
}

// The memory that a message names suffices at once, and a MiB less does not.
TEST(RenderMemory, NamesTheLeastMemoryThatSuffices) {
  const LightField field = FieldOfThousand();
  const RayReading reading = Estimator::kBilinear;
  size_t count = 0;
  for (const RenderMode mode : {RenderMode::kHybrid, RenderMode::kRebin})
    for (const RayInterpolation interpolation :
         {RayInterpolation::kPixels, RayInterpolation::kCells})
      for (const size_t max_cells : {size_t{0}, size_t{1000}, size_t{20'000'000}})
        for (const int width : {48, 1920, 16000})
          for (const size_t measured_bytes : {size_t{0}, size_t{1} << 24})
            for (const bool is_guarded : {false, true}) {
              RenderMemoryNeed need = NeedOf(field, mode, interpolation, max_cells, reading);
              need.plate_width = width;
              need.plate_height = width / 2;
              need.measured_bytes = measured_bytes;
              need.is_guarded = is_guarded;
              const Result<RenderMemory> none = PlanRenderMemory(kMiB, need);
              ASSERT_FALSE(none);
              const std::string& message = none.error().message;
              const size_t at = message.find("give {memory ");
              ASSERT_NE(at, std::string::npos) << message;
              EXPECT_EQ(message.find("0 B"), std::string::npos) << message;
              const size_t mib = std::stoul(message.substr(at + 13));
              const Result<RenderMemory> enough = PlanRenderMemory(mib * kMiB, need);
              ASSERT_TRUE(enough) << message << ": " << enough.error().message;
              EXPECT_EQ(enough->least_bytes, mib * kMiB);
              EXPECT_LE(enough->plan.total_bytes + enough->rebin_bytes, mib * kMiB);
              EXPECT_GE(enough->max_cells, RebinSettings::kLeastCells);
              EXPECT_FALSE(PlanRenderMemory((mib - 1) * kMiB, need)) << message;
              ++count;
            }
  EXPECT_EQ(count, 144u);
}

// Fewer rays fit into the memory in which many do not.
TEST(RenderMemory, FewerRaysAreAdvisedOnlyIfTheyFit) {
  for (const RayInterpolation interpolation :
       {RayInterpolation::kPixels, RayInterpolation::kCells}) {
    const Result<RenderMemory> many = PlanOf(300, RenderMode::kRebin, 90'000'000, 0, interpolation);
    ASSERT_FALSE(many);
    EXPECT_NE(many.error().message.find("or reduce {max_rays}"), std::string::npos);
    EXPECT_TRUE(PlanOf(300, RenderMode::kRebin, RebinSettings::kLeastCells, 0, interpolation));
    const Result<RenderMemory> none = PlanOf(2, RenderMode::kRebin, 90'000'000, 0, interpolation);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message.find("{max_rays}"), std::string::npos);
  }
}

TEST(RenderMemory, KeptPixelsTakeTheirPlaceAndTheirValues) {
  RadianceEncoding encoding;
  EXPECT_EQ(FramePixels::BytesPerPixel(encoding, Estimator::kBilinear, false), 10u);
  EXPECT_EQ(FramePixels::BytesPerPixel(encoding, Estimator::kBilinear, true), 12u);
  encoding.bayer = BayerPattern::kRggb;
  EXPECT_EQ(FramePixels::BytesPerPixel(encoding, Estimator::kBilinear, false), 10u);
  EXPECT_EQ(FramePixels::BytesPerPixel(encoding, Estimator::kNearest, false), 6u);
  encoding = {};
  encoding.alpha = AlphaMeaning::kStraight;
  encoding.keeps_opacity = true;
  ASSERT_TRUE(encoding.HasOpacity());
  EXPECT_EQ(FramePixels::BytesPerPixel(encoding, Estimator::kBilinear, false), 12u);
}

// Pixels that fill their part take nothing but their own bytes.
TEST(RenderMemory, MostOfThePartOfPixelsIsForPixels) {
  const RenderMemory memory =
      PlanOf(4000, RenderMode::kRebin, 0, 0, RayInterpolation::kPixels).value();
  EXPECT_LE(memory.rebin_bytes, memory.max_cells * 10 * 1.1);
  EXPECT_GE(memory.rebin_bytes, 1900 * kMiB);
}

// The memory that is named keeps all reference images beside the rebinned rays, and less does not.
TEST(RenderMemory, NamesTheMemoryThatKeepsAllReferenceImages) {
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kHybrid, RenderMode::kRebin})
    for (const size_t max_cells : {size_t{0}, RebinnedRays::kLeastCells}) {
      const RenderMemory few = PlanOf(1500, mode, max_cells, 900).value();
      EXPECT_LT(few.plan.reference_bytes, 900 * kMiB) << NameOf(mode);
      const size_t enough_mib = few.enough_bytes / kMiB + 1;
      EXPECT_EQ(PlanOf(enough_mib, mode, max_cells, 900)->plan.reference_bytes, 900 * kMiB)
          << NameOf(mode) << " " << max_cells;
      EXPECT_LT(PlanOf(enough_mib - 5, mode, max_cells, 900)->plan.reference_bytes, 900 * kMiB)
          << NameOf(mode) << " " << max_cells;
    }
  EXPECT_EQ(PlanOf(1500, RenderMode::kHybrid, 0, 0)->enough_bytes, 0u);
}

// Rebinned rays have the same share with and without reference images, because which rays are kept
// depends on it.
TEST(RenderMemory, ReferenceImagesTakeNothingFromRebinnedRays) {
  for (const RenderMode mode : {RenderMode::kHybrid, RenderMode::kRebin})
    for (const RayInterpolation interpolation :
         {RayInterpolation::kPixels, RayInterpolation::kCells})
      EXPECT_EQ(PlanOf(1500, mode, 0, 900, interpolation)->max_cells,
                PlanOf(1500, mode, 0, 0, interpolation)->max_cells);
}

}  // namespace
}  // namespace lf
