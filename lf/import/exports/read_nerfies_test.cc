// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_nerfies.h"

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

const std::string kNerfies = R"({"orientation": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
  "position": [1, 2, 3], "focal_length": 100, "principal_point": [203, 96], "skew": 0,
  "pixel_aspect_ratio": 0.9, "radial_distortion": [0.1, 0, 0], "tangential": [0, 0],
  "image_size": [400, 200]})";

Result<ExportedImage> ParseNerfiesView(const std::string& text) {
  return ParseNerfiesCamera(text, "f/camera/a.json");
}

TEST(Nerfies, TurnsFromWorldToCamera) {
  const Result<ExportedImage> image = ParseNerfiesView(kNerfies);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->name, "a.png");
  EXPECT_EQ(image->intrinsics.fy_px, 90);
  ExpectNear(PixelOf(*image, {1, 3, 5}), {203 + 100 * 0.5 * (1 + 0.1 * 0.25), 96});
}

TEST(Nerfies, NamesWhatIsWrong) {
  ExpectFault(ParseNerfiesView(Replaced(kNerfies, "[400, 200]", "[400]")), "image_size is [400]");
  ExpectFault(ParseNerfiesView(Replaced(kNerfies, "100", "0")), "focal_length is 0");
  ExpectFault(ParseNerfiesView(Replaced(kNerfies, "[0, 1, 0]", "[0, 1]")),
              "orientation is [[0,1],");
  ExpectFault(ParseNerfiesView(Replaced(kNerfies, "[1, 2, 3]", "[1, 2, Infinity]")),
              "position is [1,2");
  ExpectFault(ParseNerfiesView("[]"), "expected an object with the key");
}

using NerfiesFolder = FolderTest;

TEST_F(NerfiesFolder, HoldsTheCamerasOfItsList) {
  for (const char* const name : {"a", "b", "c"}) {
    ASSERT_TRUE(CreateFolder(folder_ / "camera"));
    ASSERT_TRUE(WriteFileAtomically(folder_ / "camera" / (std::string(name) + ".json"), kNerfies));
  }
  Result<LightField> light_field = ReadNerfies(folder_ / "camera" / "a.json", {});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->size(), 3u);
  EXPECT_FALSE(light_field->depth_range);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "dataset.json", R"({"ids": ["a", "c"]})"));
  ASSERT_TRUE(
      WriteFileAtomically(folder_ / "scene.json", R"({"scale": 0.5, "near": 1, "far": 4})"));
  light_field = ReadNerfies(folder_ / "camera" / "b.json", {});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, (std::vector<std::string>{"a.png", "c.png"}));
  EXPECT_EQ(light_field->depth_range, (DepthRange{2, 8}));
}

}  // namespace
}  // namespace lf
