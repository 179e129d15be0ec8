// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_demosaicker.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "lf/densify/demosaic/test_mosaics.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class JointDemosaickerTest : public FolderTest {
 protected:
  // Writes mosaics of a near and a far wall as image files.
  void SetUp() override {
    FolderTest::SetUp();
    drawn_.AddGrid({{3, INFINITY, 2}, {2, 0}});
    drawn_.field.folder = folder_;
    drawn_.field.source = folder_;
    for (size_t i = 0; i < drawn_.mosaics.size(); ++i)
      ASSERT_TRUE(
          WriteImage(folder_ / drawn_.field.image_names[i], drawn_.mosaics[i].radiance.view()));
  }

  static JointImageResult DemosaicFirst(const LightField& field, int threads = 1,
                                        size_t memory_bytes = size_t{1} << 30) {
    ThreadPool pool(threads);
    auto joint = JointDemosaicker::Make(field, pool, {memory_bytes, {}});
    EXPECT_TRUE(joint) << joint.error().message;
    std::vector<Result<JointImageResult>> results(field.size(), UsageError("not called"));
    pool.ForEach(field.size() < 6 ? field.size() : 6, [&](size_t i) {
      results[i] = (*joint)->Demosaic(LfImageId{static_cast<uint32_t>(i)});
    });
    EXPECT_TRUE(results[0]) << results[0].error().message;
    return *std::move(results[0]);
  }

  // Returns the mean squared error of white balanced colours of LF image 0.
  double ErrorOf(Image<float> rgb) const {
    for (size_t i = 0; i < rgb.pixels().size(); ++i)
      rgb.pixels()[i] *= static_cast<float>(drawn_.field.encoding.white_balance[i % 3]);
    return drawn_.ErrorOf(rgb, 0);
  }

  DrawnMosaics drawn_;
};

TEST_F(JointDemosaickerTest, ColoursAreFoundWithoutKnownDepths) {
  const JointImageResult result = DemosaicFirst(drawn_.field);
  EXPECT_LT(ErrorOf(result.rgb), drawn_.ErrorOf(drawn_.ImageOf(0).rgb, 0) / 3);
  EXPECT_LT(result.errors.kept, result.errors.single / 2);
  EXPECT_GT(result.errors.joint_block_count, result.errors.block_count / 2);
}

TEST_F(JointDemosaickerTest, ThreadsAndMemoryDoNotChangeTheBits) {
  const JointImageResult result = DemosaicFirst(drawn_.field);
  EXPECT_EQ(DemosaicFirst(drawn_.field, 4).rgb.pixels(), result.rgb.pixels());
  EXPECT_EQ(DemosaicFirst(drawn_.field, 3, 0).rgb.pixels(), result.rgb.pixels());
}

TEST_F(JointDemosaickerTest, ABrokenLfImageIsAsGoodAsNone) {
  std::ofstream(folder_ / drawn_.field.image_names[5]) << "broken";
  const JointImageResult broken = DemosaicFirst(drawn_.field);
  LightField without = drawn_.field;
  std::vector<size_t> kept;
  for (size_t i = 0; i < without.size(); ++i)
    if (i != 5) kept.push_back(i);
  KeepImages(kept, &without);
  EXPECT_EQ(DemosaicFirst(without).rgb.pixels(), broken.rgb.pixels());

  ThreadPool pool(1);
  const auto joint = JointDemosaicker::Make(drawn_.field, pool, {});
  ASSERT_TRUE(joint);
  const auto of_broken = (*joint)->Demosaic(LfImageId{5});
  ASSERT_FALSE(of_broken);
  EXPECT_EQ(of_broken.error().kind, ErrorKind::kInput);
}

TEST_F(JointDemosaickerTest, LfImagesWithWrongPosesStayAsTheyAre) {
  LightField wrong = drawn_.field;
  for (size_t i = 0; i < wrong.size(); ++i)
    wrong.cameras[i].cam_from_world.translation += Vec3(i % 5 * 0.2 - 0.4, i % 7 * 0.2 - 0.6, 0);
  const double single = drawn_.ErrorOf(drawn_.ImageOf(0).rgb, 0);
  EXPECT_LT(ErrorOf(DemosaicFirst(wrong).rgb), 1.1 * single);
}

TEST_F(JointDemosaickerTest, ASingleLfImageIsDemosaickedByItself) {
  LightField single = drawn_.field;
  KeepImages(std::vector<size_t>{0}, &single);
  const JointImageResult result = DemosaicFirst(single);
  EXPECT_EQ(result.errors.block_count, 0U);
  EXPECT_FLOAT_EQ(static_cast<float>(ErrorOf(result.rgb)),
                  static_cast<float>(drawn_.ErrorOf(drawn_.ImageOf(0).rgb, 0)));
}

TEST_F(JointDemosaickerTest, OtherLightFieldsAreRefused) {
  LightField rgb = drawn_.field;
  rgb.encoding.bayer = BayerPattern::kNone;
  EXPECT_EQ(CheckForJoint(rgb).error().kind, ErrorKind::kUsage);
  LightField brackets = drawn_.field;
  brackets.encoding.masks_clipped = true;
  EXPECT_EQ(CheckForJoint(brackets).error().kind, ErrorKind::kInput);
  LightField densified = drawn_.field;
  densified.cameras[3].is_virtual = true;
  EXPECT_EQ(CheckForJoint(densified).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace lf
