// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_opensfm.h"

#include "lf/import/exports/test_exports.h"

namespace lf {
namespace {

// A camera that looks along the y axis of the world: it is turned by a quarter about x.
const std::string kOpenSfm = R"([{
  "cameras": {"cam": {"projection_type": "perspective", "width": 400, "height": 200,
                      "focal": 0.5, "k1": 0, "k2": 0}},
  "shots": {"a.jpg": {"rotation": [1.5707963267948966, 0, 0], "translation": [1, 2, 3],
                      "camera": "cam"}},
  "points": {"1": {"coordinates": [0, 0, 0]}}}])";

Result<ExportedCameras> ParseReconstruction(const std::string& text) {
  return ParseOpenSfm(text, "f/reconstruction.json");
}

TEST(OpenSfm, ScalesByTheLongerSide) {
  const Result<ExportedCameras> cameras = ParseReconstruction(kOpenSfm);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 1u);
  const ExportedImage& image = cameras->images[0];
  EXPECT_EQ(image.name, "a.jpg");
  EXPECT_EQ(cameras->folder, "f");
  // (X, Y, Z) becomes (X + 1, -Z + 2, Y + 3).
  ExpectNear(PixelOf(image, {0, 1, 1}), {200 + 200 * 0.25, 100 + 200 * 0.25});
}

TEST(OpenSfm, TakesTheLargestReconstruction) {
  const std::string two = Replaced(kOpenSfm, "[{", R"([{"cameras": {}, "shots": {}}, {)");
  const Result<ExportedCameras> cameras = ParseReconstruction(two);
  ASSERT_TRUE(cameras) << cameras.error().message;
  EXPECT_EQ(cameras->images.size(), 1u);
}

TEST(OpenSfm, NamesWhatIsWrong) {
  ExpectFault(ParseReconstruction("[]"), "is an empty list");
  ExpectFault(ParseReconstruction("{}"), "expected a list");
  ExpectFault(ParseReconstruction("[{\"cameras\": {}}]"), "[0] has no key \"shots\"");
  ExpectFault(ParseReconstruction(Replaced(kOpenSfm, "\"perspective\"", "\"spherical\"")),
              "[0].cameras.cam has the lens model \"spherical\", which is not supported");
  ExpectFault(ParseReconstruction(Replaced(kOpenSfm, "\"perspective\"", "\"dual\"")),
              "has the lens model \"dual\", which is not supported");
  ExpectFault(ParseReconstruction(Replaced(kOpenSfm, "0.5", "-1")),
              "[0].cameras.cam.focal is -1: expected a number from 1e-06 to 1e+06");
  ExpectFault(ParseReconstruction(Replaced(kOpenSfm, "0.5", "NaN")), "cam.focal is \"NaN\"");
  ExpectFault(ParseReconstruction(Replaced(kOpenSfm, "\"width\": 400,", "")),
              "has no key \"width\"");
  ExpectFault(ParseReconstruction(Replaced(kOpenSfm, "[1, 2, 3]", "[1e300, 2, 3]")),
              "translation is [1e+300,2");
  ExpectFault(
      ParseReconstruction(Replaced(kOpenSfm, "\"camera\": \"cam\"", "\"camera\": \"other\"")),
      "a.jpg.camera is \"other\": expected a key of \"cameras\"");
}

}  // namespace
}  // namespace lf
