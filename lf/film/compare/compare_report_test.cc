// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/compare_report.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

// Returns a pair of 100 pixels whose values differ by `difference`.
ComparedPair Compared(const std::string& name, double difference) {
  ComparedPair one;
  one.pair = {name, "a/" + name + ".exr", "b/" + name + ".exr"};
  one.width = one.height = 10;
  one.difference.pixel_count = 100;
  one.difference.display_squares = one.difference.linear_squares = 300 * difference * difference;
  one.difference.ssim_sum = 100 * (1 - difference);
  one.difference.flip_sum = 100 * difference;
  return one;
}

TEST(CompareReport, TheTableEndsWithAllOfThem) {
  EXPECT_EQ(CompareTable({Compared("frame_0001", 0.1), Compared("x", 0.01)}),
            "picture      PSNR dB  linear dB     SSIM     FLIP\n"
            "frame_0001     20.00     20.00   0.9000   0.1000\n"
            "x              40.00     40.00   0.9900   0.0100\n"
            "all            22.97     22.97   0.9450   0.0550\n");
  ComparedPair undefined = Compared("x", 0.1);
  undefined.difference.undefined_count = 3;
  EXPECT_NE(CompareTable({undefined}).find("3 pixels are left out"), std::string::npos);
  EXPECT_EQ(CompareTable({undefined}).find("all"), std::string::npos);
}

TEST(CompareReport, JsonHasNoPsnrOfEqualPictures) {
  const std::string json = CompareJson({Compared("same", 0), Compared("other", 0.1)});
  for (const char* part : {"\"psnr_db\": null", "\"resolution\": [", "\"psnr\": \"other\"",
                           "\"ssim\": \"other\"", "\"flip\": \"other\""})
    EXPECT_NE(json.find(part), std::string::npos) << part << "\nis not in\n" << json;
  EXPECT_EQ(json.find("\"picture\""), std::string::npos);
}

TEST(CompareReport, LimitsNameTheWorstPair) {
  const std::vector<ComparedPair> compared = {Compared("good", 0.01), Compared("bad", 0.1)};
  EXPECT_TRUE(CheckLimits(compared, {}));
  EXPECT_TRUE(CheckLimits(compared, {.min_psnr_db = 19, .min_ssim = 0.8, .max_flip = 0.2}));
  const auto broken = CheckLimits(compared, {.min_psnr_db = 30, .min_ssim = {}, .max_flip = 0.05});
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().kind, ErrorKind::kBelowRequired);
  EXPECT_NE(broken.error().message.find("1 of 2 pictures have a PSNR below"), std::string::npos);
  EXPECT_NE(broken.error().message.find("the worst, b/bad.exr, has 20; 1 of 2 pictures"),
            std::string::npos)
      << broken.error().message;
}

}  // namespace
}  // namespace lf
