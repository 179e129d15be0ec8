// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_polycam.h"

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

// A camera at (1, 2, 3), whose right, up and backwards are y, -x and z of the world.
const std::string kPolycam = R"({"fx": 100, "fy": 90, "cx": 203, "cy": 96, "width": 400,
  "height": 200, "blur_score": 80.5, "timestamp": 7, "t_00": 0, "t_01": -1, "t_02": 0, "t_03": 1,
  "t_10": 1, "t_11": 0, "t_12": 0, "t_13": 2, "t_20": 0, "t_21": 0, "t_22": 1, "t_23": 3})";

Result<ExportedImage> ParseCameraOfPolycam(const std::string& text) {
  return ParsePolycamCamera(text, "f/7.json");
}

TEST(Polycam, PosesAreThoseOfOpenGlFromTheCameraToTheWorld) {
  const Result<ExportedImage> image = ParseCameraOfPolycam(kPolycam);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->name, "7.jpg");
  EXPECT_EQ(image->intrinsics.width_px, 400);
  // The point lies 2 ahead, 0.5 to the right and 0.25 below the camera.
  ExpectNear(PixelOf(*image, {1.25, 2.5, 1}), {203 + 100 * 0.25, 96 + 90 * 0.125});
}

TEST(Polycam, NamesWhatIsWrong) {
  ExpectFault(ParseCameraOfPolycam("[]"), "expected an object");
  ExpectFault(ParseCameraOfPolycam(Replaced(kPolycam, "\"t_23\": 3", "\"t_24\": 3")),
              "has no key \"t_23\"");
  ExpectFault(ParseCameraOfPolycam(Replaced(kPolycam, "\"fx\": 100", "\"fx\": NaN")),
              "fx is \"NaN\"");
  ExpectFault(ParseCameraOfPolycam(Replaced(kPolycam, "\"width\": 400", "\"width\": 0")),
              "width is 0");
  ExpectFault(ParseCameraOfPolycam(Replaced(kPolycam, "\"t_22\": 1", "\"t_22\": -1")),
              "t_00 to t_22 is mirrored");
  ExpectFault(ParseCameraOfPolycam(Replaced(kPolycam, "\"t_03\": 1", "\"t_03\": 1e99")),
              "t_03 is 1e+99");
}

class PolycamFolder : public FolderTest {
 protected:
  void Write(const fs::path& name, const std::string& text) const {
    ASSERT_TRUE(CreateFolder((folder_ / name).parent_path()));
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, text));
  }
};

TEST_F(PolycamFolder, CorrectedCamerasBelongToCorrectedImages) {
  for (const std::string& kind : {std::string(), std::string("corrected_")}) {
    Write("keyframes/" + kind + "cameras/7.json", kPolycam);
    Write("keyframes/" + kind + "images/7.jpg", "x");
  }
  const fs::path keyframes = folder_ / "keyframes";
  testing::internal::CaptureStderr();
  Result<LightField> light_field = ReadPolycam(keyframes / "corrected_cameras" / "7.json", {});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->ImagePath({0}), keyframes / "corrected_images" / "7.jpg");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  light_field = ReadPolycam(keyframes / "cameras" / "7.json", {});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->ImagePath({0}), keyframes / "images" / "7.jpg");
  EXPECT_NE(testing::internal::GetCapturedStderr().find("as the phone recorded them"),
            std::string::npos);
}

}  // namespace
}  // namespace lf
