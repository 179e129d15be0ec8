// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_google_models.h"

#include <cmath>

#include "lf/import/exports/test_exports.h"

namespace lf {
namespace {

// A camera at (1, 2, 3). The axis is z of camera and world, by 90 degrees: x of the world becomes y
// of the camera.
const std::string kGoogle = R"({"relative_path": "cam_00/image_000.JPG", "width": 400.0,
  "height": 200, "focal_length": 100, "pixel_aspect_ratio": 0.9, "principal_point": [203, 96],
  "position": [1, 2, 3], "orientation": [0, 0, 1.5707963267948966]})";
const std::string kImmersive = R"({"name": "camera_0001", "width": 400, "height": 200,
  "focal_length": 100, "principal_point": [203, 96], "position": [0, 0, 0],
  "orientation": [0, 0, 0], "projection_type": "fisheye", "radial_distortion": [0.1, 0.02, 0]})";

Result<ExportedCameras> ParseModels(const std::string& text) {
  return ParseGoogleModels(text, "f/models.json");
}

TEST(GoogleModels, OrientationsTurnFromTheWorldToTheCamera) {
  const Result<ExportedCameras> cameras = ParseModels("[[" + kGoogle + "]]");
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 1u);
  EXPECT_EQ(cameras->images[0].name, "cam_00/image_000.JPG");
  EXPECT_EQ(cameras->images[0].intrinsics.width_px, 400);
  // 0.5 along x of the world is 0.5 down, and 0.25 along y is 0.25 to the left.
  ExpectNear(PixelOf(cameras->images[0], {1.5, 2.25, 5}), {203 - 100 * 0.125, 96 + 90 * 0.25});
}

TEST(GoogleModels, PlacesOfTheRigMayBeListsOrNot) {
  const std::string second = Replaced(kGoogle, "cam_00", "cam_01");
  EXPECT_EQ(ParseModels("[[" + kGoogle + "], [" + second + "]]")->images.size(), 2u);
  EXPECT_EQ(ParseModels("[" + kGoogle + ", " + second + "]")->images.size(), 2u);
}

TEST(GoogleModels, FishEyesHaveTwoCoefficients) {
  const Result<ExportedCameras> cameras = ParseModels("[" + kImmersive + "]");
  ASSERT_TRUE(cameras) << cameras.error().message;
  EXPECT_EQ(cameras->images[0].name, "camera_0001");
  const double theta = 1.2;
  const double rd = theta * (1 + 0.1 * theta * theta + 0.02 * std::pow(theta, 4));
  ExpectNear(PixelOf(cameras->images[0], {std::sin(theta), 0, std::cos(theta)}),
             {203 + 100 * rd, 96});
}

TEST(GoogleModels, NamesWhatIsWrong) {
  ExpectFault(ParseModels("{}"), "the file is an object: expected a list");
  ExpectFault(ParseModels("[[7]]"), "[0][0] is 7");
  ExpectFault(ParseModels("[[" + Replaced(kGoogle, "relative_path", "path") + "]]"),
              "has no key \"name\"");
  ExpectFault(ParseModels("[[" + Replaced(kGoogle, "400.0", "400.5") + "]]"), "width is 400.5");
  ExpectFault(ParseModels("[[" + Replaced(kGoogle, "[1, 2, 3]", "[1, 2, NaN]") + "]]"),
              "position is");
  ExpectFault(ParseModels("[[" + Replaced(kGoogle, "[0, 0, 1.5707963267948966]", "[0, 1]") + "]]"),
              "orientation is [0,1]");
  ExpectFault(ParseModels("[" + Replaced(kImmersive, "0.02, 0]", "0.02, 0.1]") + "]"),
              "expected 0 as third number");
  ExpectFault(ParseModels("[" + Replaced(kImmersive, "fisheye", "perspective") + "]"),
              "radial_distortion is [0.1,0.02,0]: expected zeros");
}

}  // namespace
}  // namespace lf
