// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_splat_cameras.h"

#include "lf/import/exports/test_exports.h"

namespace lf {
namespace {

const std::string kSplats = R"([{"id": 0, "img_name": "a", "width": 400, "height": 200,
  "position": [1, 2, 3], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "fx": 100, "fy": 90}])";

Result<ExportedCameras> ParseSplats(const std::string& text) {
  return ParseSplatLightField(text, "f/cameras.json");
}

TEST(SplatLightField, TurnsFromCameraToWorld) {
  const Result<ExportedCameras> cameras = ParseSplats(kSplats);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 1u);
  EXPECT_EQ(cameras->images[0].name, "a");
  // The camera's right is the world's y, its down is the world's -x.
  ExpectNear(PixelOf(cameras->images[0], {0, 3, 5}), {200 + 50, 100 + 45});
}

TEST(SplatLightField, NamesWhatIsWrong) {
  ExpectFault(ParseSplats("{}"), "the file is an object: expected a list");
  ExpectFault(ParseSplats(Replaced(kSplats, "400", "400.5")), "[0].width is 400.5");
  ExpectFault(ParseSplats(Replaced(kSplats, "[0, -1, 0]", "[0, 1, 0]")),
              "[0].rotation is mirrored");
  ExpectFault(ParseSplats(Replaced(kSplats, "[1, 2, 3]", "[1, 2]")), "[0].position is [1,2]");
  ExpectFault(ParseSplats(Replaced(kSplats, "\"fx\": 100, ", "")), "[0] has no key \"fx\"");
}

}  // namespace
}  // namespace lf
