// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_mvsnet.h"

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

const std::string kMvsnet = R"(extrinsic
0 1 0 -2
-1 0 0 1
0 0 1 -3
0 0 0 1

intrinsic
100 2 50
0 90 25
0 0 1

1.5 0.5 11
)";

Result<MvsnetCamera> ParseMvsnetView(const std::string& text) {
  return ParseMvsnetCamera(text, "f/cams/00000007_cam.txt");
}

TEST(Mvsnet, ReadsPoseMatrixAndDepths) {
  const Result<MvsnetCamera> camera = ParseMvsnetView(kMvsnet);
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->image.name, "00000007.jpg");
  EXPECT_EQ(camera->depth_range, (DepthRange{1.5, 6.5}));
  ExpectNear(PixelOf(camera->image, {0, 3, 5}), {50 + 100 * 0.5 + 2 * 0.5, 25 + 90 * 0.5});
  EXPECT_EQ(ParseMvsnetView(Replaced(kMvsnet, "1.5 0.5 11", "1.5 0.5 11 9"))->depth_range,
            (DepthRange{1.5, 9}));
  EXPECT_FALSE(ParseMvsnetView(Replaced(kMvsnet, "1.5 0.5 11", "1.5 0.5"))->depth_range);
}

TEST(Mvsnet, NamesWhatIsWrong) {
  ExpectFault(ParseMvsnetView(Replaced(kMvsnet, "intrinsic", "depths")),
              "expected the word intrinsic");
  ExpectFault(ParseMvsnetView(Replaced(kMvsnet, "0 0 0 1", "0 0 0 2")),
              "expected the last row 0 0 0 1");
  ExpectFault(ParseMvsnetView(Replaced(kMvsnet, "0 1 0 -2", "0 1 0 1e300")), "is 1e+300");
  ExpectFault(ParseMvsnetView(Replaced(kMvsnet, "0 90 25", "1 90 25")), "the matrix above is no K");
  ExpectFault(ParseMvsnetView(Replaced(kMvsnet, "0 1 0 -2", "0 2 0 -2")), "sheared or scaled");
  ExpectFault(ParseMvsnetView("extrinsic\n1 0"),
              "the file ends before the matrix of 4 x 4 numbers");
}

using MvsnetFolder = FolderTest;

TEST_F(MvsnetFolder, EnlargesIntrinsicsOfAQuarter) {
  ASSERT_TRUE(CreateFolder(folder_ / "cams"));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "cams" / "00000007_cam.txt", kMvsnet));
  const auto cx_of = [&](int width_px, int height_px) {
    const ExportOptions options = {.image_size = [=](const std::filesystem::path&) {
      return Result(std::array{width_px, height_px});
    }};
    const Result<LightField> light_field =
        ReadMvsnet(folder_ / "cams" / "00000007_cam.txt", options);
    EXPECT_TRUE(light_field);
    return light_field ? light_field->intrinsics[0].cx_px : 0;
  };
  EXPECT_EQ(cx_of(100, 50), 50);
  EXPECT_EQ(cx_of(400, 200), 200);
  EXPECT_EQ(cx_of(800, 400), 50);
}

}  // namespace
}  // namespace lf
