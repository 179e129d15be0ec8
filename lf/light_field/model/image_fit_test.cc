// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/image_fit.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

Result<ImageFit> Fit(int width, int height, int orientation, bool is_mosaic = false) {
  ImageFileInfo info;
  info.width = width;
  info.height = height;
  info.orientation = orientation;
  Intrinsics k;
  k.width_px = 1920;
  k.height_px = 1080;
  return FitToCalibration(info, is_mosaic, k, "a.jpg");
}

void ExpectAdvice(const Result<ImageFit>& fit, const std::string& advice) {
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().kind, ErrorKind::kInput);
  EXPECT_NE(fit.error().message.find("a.jpg: has "), std::string::npos);
  EXPECT_NE(fit.error().message.find("calibration says 1920 x 1080"), std::string::npos);
  EXPECT_NE(fit.error().message.find(advice), std::string::npos) << fit.error().message;
}

TEST(ImageFit, TheCalibratedSizeIsTakenAsStored) {
  for (int orientation = 1; orientation <= 8; ++orientation)
    EXPECT_EQ(*Fit(1920, 1080, orientation), ImageFit::kAsStored) << orientation;
}

TEST(ImageFit, ExchangedSidesAreTurnedIfTheTagSaysSo) {
  for (int orientation = 5; orientation <= 8; ++orientation) {
    EXPECT_EQ(*Fit(1080, 1920, orientation), ImageFit::kTurned) << orientation;
    ExpectAdvice(Fit(1080, 1920, orientation, true), "mosaics cannot be rotated");
  }
  for (int orientation = 1; orientation <= 4; ++orientation)
    ExpectAdvice(Fit(1080, 1920, orientation), "without an orientation tag");
}

TEST(ImageFit, OtherSizesAreErrorsThatSayWhatToDo) {
  ExpectAdvice(Fit(960, 540, 1), "by 0.5");
  ExpectAdvice(Fit(640, 361, 1), "by 0.3333");  // rounded up
  ExpectAdvice(Fit(1920, 1078, 1), "cropped");
}

TEST(ImageFit, CropsOfUndistortionAreNotCalledResized) {
  ImageFileInfo info;
  info.width = 988;
  info.height = 741;
  const Intrinsics calibrated = {900, 900, 500, 375, 0, 1000, 750};
  const Result<ImageFit> fit = FitToCalibration(info, false, calibrated, "a.png");
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("12 columns and 9 rows are missing: it is cropped"),
            std::string::npos)
      << fit.error().message;
}

}  // namespace
}  // namespace lf
