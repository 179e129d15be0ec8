// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_meshroom.h"

#include "lf/import/exports/test_exports.h"

namespace lf {
namespace {

// A camera at (1, 2, 3) that is turned by a quarter about its axis: its right is the world's y.
const std::string kMeshroom = R"({"version": ["1", "2", "8"], "featuresFolders": "",
  "views": [{"viewId": "7", "poseId": "8", "intrinsicId": "9", "path": "/gone/a.jpg"},
            {"viewId": "70", "poseId": "80", "intrinsicId": "9", "path": "/gone/b.jpg"}],
  "intrinsics": [{"intrinsicId": "9", "width": "400", "height": "200", "sensorWidth": "36",
    "type": "pinhole", "focalLength": "18", "pixelRatio": "1", "principalPoint": ["3", "-4"],
    "distortionType": "none", "undistortionType": "none", "distortionParams": ""}],
  "poses": [{"poseId": "8", "pose": {"transform": {
    "rotation": ["0", "-1", "0", "1", "0", "0", "0", "0", "1"], "center": ["1", "2", "3"]}}}]})";

Result<ExportedCameras> ParseMeshroomScene(const std::string& text) {
  return ParseMeshroom(text, "f/cameras.sfm");
}

TEST(Meshroom, CountsPixelCentresByWholeNumbersFromTheMiddle) {
  const Result<ExportedCameras> cameras = ParseMeshroomScene(kMeshroom);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 1u);  // the other view has no pose
  EXPECT_EQ(cameras->images[0].name, "/gone/a.jpg");
  ExpectNear(PixelOf(cameras->images[0], {1, 3, 5}), {200 + 3 + 0.5 + 200 * 0.5, 100 - 4 + 0.5});
}

TEST(Meshroom, ReadsBothConventionsOfTheFocalLength) {
  std::string old = Replaced(kMeshroom, R"("1", "2", "8")", R"("1", "1", "0")");
  old = Replaced(old, R"("focalLength": "18")", R"("pxFocalLength": "100")");
  const Result<ExportedCameras> cameras = ParseMeshroomScene(old);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ExpectNear(PixelOf(cameras->images[0], {1, 3, 5}), {3 + 0.5 + 100 * 0.5, -4 + 0.5});
}

TEST(Meshroom, NamesWhatIsWrong) {
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "[\"1\"", "[\"2\"")), "version is [\"2\"");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"none\", \"und", "\"twisted\", \"und")),
              "intrinsics[0] has the lens model \"twisted\", which is not supported");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"undistortionType\": \"none\"",
                                          "\"undistortionType\": \"3deanamorphic4\"")),
              "has the lens model \"3deanamorphic4\"");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"pinhole\"", "\"equidistant\"")),
              "has the lens model \"equidistant\"");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"18\"", "\"nan\"")),
              "intrinsics[0].focalLength is \"nan\": expected a number");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"400\"", "\"4e9\"")), "width is \"4e9\"");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"0\", \"-1\"", "\"0\", \"1\"")),
              "poses[0].pose.transform.rotation is mirrored");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"center\"", "\"centre\"")),
              "has no key \"center\"");
  ExpectFault(ParseMeshroomScene(Replaced(kMeshroom, "\"intrinsicId\": \"9\", \"p",
                                          "\"intrinsicId\": \"6\", \"p")),
              "views[0].intrinsicId is \"6\": expected the intrinsicId of an entry");
}

}  // namespace
}  // namespace lf
