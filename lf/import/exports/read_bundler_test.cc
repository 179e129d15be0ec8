// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_bundler.h"

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

const std::string kBundle = R"(# Bundle file v0.3
2 0
100 0.1 0
1 0 0
0 1 0
0 0 1
1 2 3
0 0 0
0 0 0
0 0 0
0 0 0
0 0 0
)";

Result<ExportedCameras> ParseBundle(const std::string& text,
                                    const std::string& list = "./a b.jpg\n./c.jpg 0 660.8\n") {
  return ParseBundler(text, "f/bundle.out", list, "f/list.txt");
}

TEST(Bundler, LooksAlongTheNegativeAxisFromTheMiddle) {
  const Result<ExportedCameras> cameras = ParseBundle(kBundle);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 1u);  // the focal length of the other is 0
  EXPECT_EQ(cameras->images[0].name, "./a b.jpg");
  EXPECT_TRUE(cameras->counts_from_middle);
  EXPECT_EQ(cameras->sizes_from, SizesFrom::kEachImage);
  // Camera coordinates of Bundler: (0, 2.5, -5); p = (0, 0.5), y up.
  ExpectNear(PixelOf(cameras->images[0], {-1, 0.5, -8}), {0, -100 * 0.5 * (1 + 0.1 * 0.25)});
}

TEST(Bundler, ReadsNamesWithAFocalLengthBehindThem) {
  const Result<ExportedCameras> cameras = ParseBundle(
      Replaced(kBundle, "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0", "90 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0"));
  ASSERT_TRUE(cameras) << cameras.error().message;
  EXPECT_EQ(cameras->images[1].name, "./c.jpg");
}

TEST(Bundler, NamesWhatIsWrong) {
  ExpectFault(ParseBundle(Replaced(kBundle, "v0.3", "v0.4")), "is no bundle file of version 0.3");
  ExpectFault(ParseBundle(kBundle, "./a.jpg\n"),
              "f/list.txt: names 1 images, but f/bundle.out has 2");
  ExpectFault(ParseBundle(Replaced(kBundle, "2 0", "1e7 0"), ""), "f/list.txt: names 0 images");
  ExpectFault(ParseBundle(Replaced(kBundle, "2 0", "1.5 0")), "the number of cameras is 1.5");
  ExpectFault(ParseBundle(Replaced(kBundle, "1 2 3", "1 nan 3")), "the translation");
  ExpectFault(ParseBundle(Replaced(kBundle, "1 2 3", "1 1e300 3")), "the translation is 1e+300");
  ExpectFault(ParseBundle(Replaced(kBundle, "1 0 0", "-1 0 0")), "is mirrored");
  ExpectFault(ParseBundle(kBundle.substr(0, 40)), "the file ends before the rotation");
}

using BundlerFiles = FolderTest;

TEST_F(BundlerFiles, NeedAListOfImages) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "scan.out", kBundle));
  const Result<LightField> without = ReadBundler(folder_ / "scan.out", {});
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("scan.list.txt or list.txt"), std::string::npos)
      << without.error().message;
  ASSERT_TRUE(WriteFileAtomically(folder_ / "scan.list.txt", "a.jpg\nc.jpg\n"));
  const ExportOptions options = {.image_size = [&](const std::filesystem::path& path) {
    EXPECT_EQ(path, folder_ / "a.jpg");
    return Result(std::array{400, 200});
  }};
  const Result<LightField> light_field = ReadBundler(folder_ / "scan.out", options);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->intrinsics[0].cx_px, 200);
}

}  // namespace
}  // namespace lf
