// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_record3d.h"

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

// Two cameras, the second turned by 90 degrees about z: its right, up and backwards are y, -x and z
// of the world.
const std::string kRecord3d = R"({"w": 400, "h": 200, "fps": 30, "dw": 40,
  "K": [100, 0, 0, 0, 90, 0, 203, 96, 1], "frameTimestamps": [0, 1],
  "poses": [[0, 0, 0, 1, 0, 0, 0],
            [0, 0, 0.70710678118654757, 0.70710678118654757, 1, 2, 3]]})";

Result<ExportedCameras> ParseRecording(const std::string& text) {
  return ParseRecord3d(text, "f/metadata");
}

TEST(Record3d, PosesAreQuaternionsOfOpenGlFromTheCameraToTheWorld) {
  const Result<ExportedCameras> cameras = ParseRecording(kRecord3d);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 2u);
  EXPECT_EQ(cameras->folder, "f");
  EXPECT_EQ(cameras->images[1].name, "rgbd/1.jpg");
  ExpectNear(PixelOf(cameras->images[0], {0.5, -0.25, -2}), {203 + 25, 96 + 90 * 0.125});
  ExpectNear(PixelOf(cameras->images[1], {1.25, 2.5, 1}), {203 + 25, 96 + 90 * 0.125});
}

TEST(Record3d, EveryImageMayHaveItsOwnIntrinsics) {
  const Result<ExportedCameras> cameras = ParseRecording(
      Replaced(kRecord3d, "\"fps\"",
               "\"perFrameIntrinsicCoeffs\": [[100, 90, 203, 96], [110, 95, 204, 97]], \"fps\""));
  ASSERT_TRUE(cameras) << cameras.error().message;
  EXPECT_EQ(cameras->images[1].intrinsics.fx_px, 110);
  EXPECT_EQ(cameras->images[1].intrinsics.fy_px, 95);
  EXPECT_EQ(cameras->images[1].intrinsics.cy_px, 97);
  const Result<ExportedCameras> none =
      ParseRecording(Replaced(kRecord3d, "\"fps\"", "\"perFrameIntrinsicCoeffs\": [], \"fps\""));
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_EQ(none->images[1].intrinsics.fx_px, 100);
}

TEST(Record3d, AMatrixThatIsWrittenRowByRowIsAnError) {
  ExpectFault(ParseRecording(Replaced(kRecord3d, "[100, 0, 0, 0, 90, 0, 203, 96, 1]",
                                      "[100, 0, 203, 0, 90, 96, 0, 0, 1]")),
              "K is a list of 9: expected a calibration matrix, column by column");
}

TEST(Record3d, WrongNumbersAreNamed) {
  ExpectFault(ParseRecording("{}"), "has no key \"w\"");
  ExpectFault(ParseRecording(Replaced(kRecord3d, "[0, 0, 0, 1, 0, 0, 0]", "[0, 0, 0, 1, 0, 0]")),
              "poses[0] is a list of 6: expected a list of 7 numbers");
  ExpectFault(ParseRecording(Replaced(kRecord3d, "[0, 0, 0, 1, 0, 0, 0]", "[0, 0, 0, 2, 0, 0, 0]")),
              "poses[0] (2, 0, 0, 0) has the length 2");
  ExpectFault(ParseRecording(Replaced(kRecord3d, "[0, 0, 0, 1, 0", "[0, 0, 0, 1, 1e99")),
              "poses[0] is a list of 7");
  ExpectFault(ParseRecording(Replaced(kRecord3d, "\"fps\"",
                                      "\"perFrameIntrinsicCoeffs\": [[1, 1, 1, 1]], \"fps\"")),
              "has 1 entries, but there are 2 poses");
}

class Record3dFolder : public FolderTest {
 protected:
  void Write(const fs::path& name, const std::string& text) const {
    ASSERT_TRUE(CreateFolder((folder_ / name).parent_path()));
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, text));
  }
  std::vector<std::string> Names() const {
    const Result<LightField> light_field = ReadRecord3d(folder_ / "metadata", {});
    EXPECT_TRUE(light_field) << light_field.error().message;
    return light_field ? light_field->image_names : std::vector<std::string>();
  }
  void SetUp() override {
    FolderTest::SetUp();
    Write("metadata", kRecord3d);
  }
};

TEST_F(Record3dFolder, ImagesAreFoundByTheirNumbers) {
  EXPECT_EQ(Names(), (std::vector<std::string>{"rgbd/0.jpg", "rgbd/1.jpg"}));
  Write("rgb/00001.png", "x");
  EXPECT_EQ(Names(), (std::vector<std::string>{"rgbd/0.jpg", "rgb/00001.png"}));
  Write("rgb/00000.png", "x");
  EXPECT_EQ(Names(), (std::vector<std::string>{"rgb/00000.png", "rgb/00001.png"}));
}

TEST_F(Record3dFolder, OtherNumbersCountInTheirOrder) {
  Write("rgbd/9.jpg", "x");
  Write("rgbd/10.jpg", "x");
  EXPECT_EQ(Names(), (std::vector<std::string>{"rgbd/9.jpg", "rgbd/10.jpg"}));
  Write("rgbd/11.jpg", "x");  // three images do not tell which of them belong to the two poses
  EXPECT_EQ(Names(), (std::vector<std::string>{"rgbd/0.jpg", "rgbd/1.jpg"}));
}

}  // namespace
}  // namespace lf
