// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/open_light_field.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "lf/core/file.h"
#include "lf/core/shell_word.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class OpenLightFieldTest : public FolderTest {};

constexpr const char* kCalibration = R"({"fl_x": 5, "w": 6, "h": 7, "frames": [{"file_path":
  "a.png", "transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3]]}]})";

TEST_F(OpenLightFieldTest, TakesTheFileOrItsFolder) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms.json", kCalibration));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "other.json", kCalibration));
  for (const fs::path& path : {folder_, folder_ / "transforms.json", folder_ / "other.json"}) {
    const Result<LightField> light_field = OpenLightField(path);
    ASSERT_TRUE(light_field) << light_field.error().message;
    EXPECT_EQ(light_field->size(), 1u);
    EXPECT_EQ(light_field->ImagePath({0}), folder_ / "a.png");
  }
}

TEST_F(OpenLightFieldTest, PackedStoresRefuseOptionsOfImageFiles) {
  const auto error = [&](const OpenOptions& options) {
    return OpenLightField(folder_ / "a.lfs", options).error();
  };
  EXPECT_EQ(error({}).kind, ErrorKind::kInput);  // there is no such file
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.lfs", "no store"));
  EXPECT_EQ(error({}).kind, ErrorKind::kInput);
  const Error refused = error({.image_scale = {ImageScale::Kind::kFactor, 0.5}});
  EXPECT_EQ(refused.kind, ErrorKind::kUsage);
  EXPECT_NE(refused.message.find("{image_scale}"), std::string::npos) << refused.message;
}

TEST_F(OpenLightFieldTest, TakesStanfordNamesInTheFolderOrInItsImages) {
  fs::create_directories(folder_ / "images");
  const Image<uint8_t> image(4, 4, 3);
  ASSERT_TRUE(WriteImage(folder_ / "images" / "a_0_0_0.0_5.0_30_36.png", image.view()));
  for (const fs::path& path : {folder_, folder_ / "images"}) {
    const Result<LightField> light_field = OpenLightField(path);
    ASSERT_TRUE(light_field) << light_field.error().message;
    EXPECT_TRUE(fs::exists(light_field->ImagePath({0})));
  }
  EXPECT_EQ(OpenLightField(folder_, {.focal_px = 7})->intrinsics[0].fx_px, 7);
}

TEST_F(OpenLightFieldTest, TakesTheSizeOfMostImages) {
  std::string frames;
  for (int i = 0; i < 20; ++i) {
    const Image<uint8_t> image(i < 2 ? 16 : 8, i < 2 ? 12 : 6, 3);
    const std::string name = fmt::format("{:02}.png", i);
    ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
    frames += fmt::format(
        R"({}{{"file_path": "{}", "transform_matrix": [[1,0,0,{}],[0,1,0,2],[0,0,1,3]]}})",
        i > 0 ? ", " : "", name, i);
  }
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms.json",
                                  "{\"camera_angle_x\": 1, \"frames\": [" + frames + "]}"));
  const Result<LightField> light_field = OpenLightField(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->intrinsics[0].width_px, 8);
  EXPECT_EQ(light_field->intrinsics[0].height_px, 6);
}

TEST_F(OpenLightFieldTest, TakesBlendersFormWithTheSizeFromTheFirstImage) {
  fs::create_directories(folder_ / "train");
  const fs::path path = folder_ / "transforms_train.json";
  ASSERT_TRUE(WriteFileAtomically(path, R"({"camera_angle_x": 1, "frames": [{"file_path":
      "./train/r_0", "transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]})"));
  const Result<LightField> without = OpenLightField(path);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("r_0.png"), std::string::npos);
  EXPECT_NE(without.error().message.find("add \"w\" and \"h\""), std::string::npos);

  const Image<uint8_t> image(8, 6, 4);
  ASSERT_TRUE(WriteImage(folder_ / "train" / "r_0.png", image.view()));
  const Result<LightField> light_field = OpenLightField(path);
  ASSERT_TRUE(light_field) << light_field.error().message;
  const Intrinsics& k = light_field->intrinsics[0];
  EXPECT_EQ(k.width_px, 8);
  EXPECT_EQ(k.height_px, 6);
  EXPECT_NEAR(k.fx_px, 4 / std::tan(0.5), 1e-12);
}

TEST_F(OpenLightFieldTest, ATransformsJsonNeedsNoFocalLength) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms.json", kCalibration));
  for (const OpenOptions& options : {OpenOptions{.focal_px = 7}, OpenOptions{.pitch_w = Vec2(1, 1)},
                                     OpenOptions{.plane_distance_w = 7},
                                     OpenOptions{.flip_x = true}, OpenOptions{.flip_y = true}}) {
    const Result<LightField> light_field = OpenLightField(folder_, options);
    ASSERT_FALSE(light_field);
    EXPECT_EQ(light_field.error().kind, ErrorKind::kUsage);
  }
}

TEST_F(OpenLightFieldTest, TakesMiddleburysFileOrTheFolderOfOne) {
  const Image<uint8_t> image(8, 6, 3);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", image.view()));
  const std::string text = "1\na.png 5 0 4 0 5 3 0 0 1 1 0 0 0 1 0 0 0 1 0 0 0\n";
  ASSERT_TRUE(WriteFileAtomically(folder_ / "x_par.txt", text));
  for (const fs::path& path : {folder_, folder_ / "x_par.txt"}) {
    const Result<LightField> light_field = OpenLightField(path);
    ASSERT_TRUE(light_field) << light_field.error().message;
    EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{5, 5, 4.5, 3.5, 0, 8, 6}));
  }
  EXPECT_EQ(OpenLightField(folder_, {.focal_px = 7}).error().kind, ErrorKind::kUsage);
  // The image size is found even if the image was moved and renamed.
  std::filesystem::create_directories(folder_ / "images");
  std::filesystem::rename(folder_ / "a.png", folder_ / "images" / "a.PNG");
  const Result<LightField> moved = OpenLightField(folder_);
  ASSERT_TRUE(moved) << moved.error().message;
  EXPECT_EQ(moved->ImagePath(LfImageId{0}), folder_ / "images" / "a.PNG");
  EXPECT_EQ(moved->intrinsics[0].width_px, 8);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "y_par.txt", text));
  const Result<LightField> two = OpenLightField(folder_);
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().message.find("such as x_par.txt and y_par.txt"), std::string::npos);
}

TEST_F(OpenLightFieldTest, TakesLlffsFileOrItsFolder) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "poses_bounds.npy", "x"));
  fs::create_directories(folder_ / "images");
  for (const fs::path& path : {folder_, folder_ / "poses_bounds.npy"}) {
    const Result<LightField> light_field = OpenLightField(path);
    ASSERT_FALSE(light_field);
    EXPECT_NE(light_field.error().message.find("poses_bounds.npy: is no .npy file"),
              std::string::npos);
  }
}

TEST_F(OpenLightFieldTest, TakesPosesOfAirborneOpticalSectioningByContent) {
  const std::string text = R"({"images": [{"imagefile": "a.png", "M3x4":
      [[1,0,0,1], [0,1,0,2], [0,0,1,3]]}]})";
  ASSERT_TRUE(WriteFileAtomically(folder_ / "poses.json", text));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "other.json", text));
  const Image<uint8_t> image(8, 8, 3);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", image.view()));
  for (const fs::path& path : {folder_, folder_ / "poses.json", folder_ / "other.json"}) {
    const Result<LightField> light_field = OpenLightField(path, {.fov_deg = 90});
    ASSERT_TRUE(light_field) << light_field.error().message;
    EXPECT_NEAR(light_field->intrinsics[0].fx_px, 4, 1e-12);
    const Result<LightField> without = OpenLightField(path);
    ASSERT_FALSE(without);
    EXPECT_NE(without.error().message.find("{fov_deg}"), std::string::npos);
  }
  EXPECT_EQ(OpenLightField(folder_, {.focal_px = 7}).error().kind, ErrorKind::kUsage);
  fs::create_directories(folder_ / "elsewhere");
  ASSERT_TRUE(WriteImage(folder_ / "elsewhere" / "a.png", Image<uint8_t>(6, 6, 3).view()));
  const Result<LightField> elsewhere =
      OpenLightField(folder_, {.fov_deg = 90, .images_folder = folder_ / "elsewhere"});
  ASSERT_TRUE(elsewhere) << elsewhere.error().message;
  EXPECT_EQ(elsewhere->intrinsics[0].width_px, 6);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms.json", kCalibration));
  EXPECT_EQ(OpenLightField(folder_, {.fov_deg = 90}).error().kind, ErrorKind::kUsage);
}

constexpr const char* kSplatCameras = R"([{"img_name": "a", "width": 8, "height": 6,
    "position": [1, 2, 3], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "fx": 5, "fy": 5}])";

TEST_F(OpenLightFieldTest, TakesExportsOfOtherProgramsAfterItsOwnForms) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "cameras.json", kSplatCameras));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "other.json", kSplatCameras));
  EXPECT_TRUE(HoldsLightField(folder_));
  for (const fs::path& path : {folder_, folder_ / "cameras.json", folder_ / "other.json"}) {
    const Result<LightField> light_field = OpenLightField(path);
    ASSERT_TRUE(light_field) << light_field.error().message;
    EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{5, 5, 4, 3, 0, 8, 6}));
    EXPECT_EQ(OpenLightField(path, {.focal_px = 7}).error().kind, ErrorKind::kUsage);
    EXPECT_EQ(OpenLightField(path, {.fov_deg = 7}).error().kind, ErrorKind::kUsage);
  }
  // An export of a program that comes earlier in the table is taken first.
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.nvm", "NVM_V3\n\n1\na.png 5 1 0 0 0 0 0 0 0 0\n"));
  const Image<uint8_t> image(10, 4, 3);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", image.view()));
  const Result<LightField> nvm = OpenLightField(folder_);
  ASSERT_TRUE(nvm) << nvm.error().message;
  EXPECT_EQ(nvm->intrinsics[0].width_px, 10);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "b.nvm", "NVM_V3\n"));
  const Result<LightField> two = OpenLightField(folder_);
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().message.find("several calibrations, such as a.nvm and b.nvm"),
            std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms.json", kCalibration));
  const Result<LightField> own = OpenLightField(folder_);
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_EQ(own->image_names[0], "a.png");
  EXPECT_NE(own->intrinsics[0].width_px, 10);
}

TEST_F(OpenLightFieldTest, TakesAnExportBesideAnIncompleteModelOfColmap) {
  fs::create_directories(folder_ / "sparse" / "0");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "sparse" / "0" / "cameras.bin", ""));
  EXPECT_FALSE(OpenLightField(folder_));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "cameras.json", kSplatCameras));
  const Result<LightField> light_field = OpenLightField(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, std::vector<std::string>{"a"});
}

TEST_F(OpenLightFieldTest, TakesAnExportIfNamesLackTheCalibration) {
  const Image<uint8_t> image(8, 6, 3);
  for (const char* const name : {"x_00_00.png", "x_00_01.png", "x_01_00.png", "x_01_01.png"})
    ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
  EXPECT_FALSE(OpenLightField(folder_));
  std::string cameras = kSplatCameras;
  cameras.replace(cameras.find("\"a\""), 3, "\"x_01_00\"");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "cameras.json", cameras));
  const Result<LightField> light_field = OpenLightField(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, std::vector<std::string>{"x_01_00.png"});
  const Result<LightField> grid = OpenLightField(folder_, {.focal_px = 7, .pitch_w = Vec2(1, 1)});
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(grid->size(), 4u);
}

TEST_F(OpenLightFieldTest, AdvisesHowToExportWhatIsNotRead) {
  const Image<uint8_t> image(8, 6, 3);
  fs::create_directories(folder_ / "images");
  for (const char* const name : {"a.png", "b.png"})
    ASSERT_TRUE(WriteImage(folder_ / "images" / name, image.view()));
  const auto error = [](const fs::path& path) {
    const Result<LightField> light_field = OpenLightField(path);
    return light_field ? "" : light_field.error().message;
  };
  EXPECT_NE(error(folder_).find("reconstruct the poses first"), std::string::npos);
  // An archive of anything does not tell that the poses are there.
  ASSERT_TRUE(WriteFileAtomically(folder_ / "backup.zip", ""));
  EXPECT_NE(error(folder_).find("backup.zip is an archive"), std::string::npos);
  EXPECT_NE(error(folder_).find("reconstruct the poses first"), std::string::npos);
  EXPECT_NE(error(folder_).find("reconstruction.json (OpenSfM, OpenDroneMap)"), std::string::npos);
  // The poses lie there, so that nobody is told to reconstruct them.
  ASSERT_TRUE(WriteFileAtomically(folder_ / "scan.psx", ""));
  EXPECT_EQ(error(folder_).find("reconstruct the poses first"), std::string::npos);
  EXPECT_NE(error(folder_).find("scan.psx is a project of Metashape"), std::string::npos);
  EXPECT_NE(error(folder_ / "scan.psx").find("File > Export > Export Cameras"), std::string::npos);
}

TEST_F(OpenLightFieldTest, SaysWhatItLookedFor) {
  const auto error = [](const fs::path& path) {
    const Result<LightField> light_field = OpenLightField(path);
    return light_field ? "" : light_field.error().message;
  };
  EXPECT_NE(error(folder_ / "none").find("none: no such file or folder"), std::string::npos);
  EXPECT_NE(error(folder_).find("looked for transforms.json"), std::string::npos);
  EXPECT_NE(error(folder_).find("NAME_par.txt"), std::string::npos);
  EXPECT_NE(error(folder_).find("poses_bounds.npy"), std::string::npos);
  EXPECT_NE(error(folder_).find("poses.json (AOS)"), std::string::npos);
  EXPECT_NE(error(folder_).find("NAME_ROW_COL_Y_X"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms_old.json", kCalibration));
  EXPECT_NE(error(folder_).find("it holds transforms_old.json"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.blend", ""));
  EXPECT_NE(error(folder_ / "a.blend").find("a.blend: is not a light field"), std::string::npos);
}

TEST_F(OpenLightFieldTest, PointsToAFolderBelow) {
  fs::create_directories(folder_ / "inner");
  fs::create_directories(folder_ / "other");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "inner" / "transforms.json", kCalibration));
  const Result<LightField> light_field = OpenLightField(folder_);
  ASSERT_FALSE(light_field);
  const std::string& message = light_field.error().message;
  const std::string advice = "; but there is a light field in inner/: " +
                             ShellCommand({"lfimport", (folder_ / "inner").string()});
  EXPECT_TRUE(message.ends_with(advice)) << message;
}

// Tests with real light fields. They are skipped if the light fields are not on this machine.
class RealLightFieldTest : public testing::Test {
 protected:
  static fs::path TestData() {
    const char* folder = std::getenv("LF_TEST_DATA");
    return folder ? folder : LF_TEST_DATA_DEFAULT;
  }
  // Opens a folder of the test data. The test must have called LF_SKIP_WITHOUT() for it.
  static Result<LightField> Open(const fs::path& folder) {
    return OpenLightField(TestData() / folder);
  }
};

#define LF_SKIP_WITHOUT(folder)                                          \
  if (!fs::exists(TestData() / (folder)))                                \
  GTEST_SKIP() << "skipped: no test data at " << (TestData() / (folder)) \
               << " (set LF_TEST_DATA to the folder that holds it)"

TEST_F(RealLightFieldTest, GroundTruthGridIsParallelAndPitchedDown) {
  LF_SKIP_WITHOUT("groundtruth/data/planar");
  const Result<LightField> light_field = Open("groundtruth/data/planar");
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 361u);
  ASSERT_EQ(light_field->intrinsics.size(), 1u);
  EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{440, 440, 160, 120, 0, 320, 240}));
  const Vec3 step = light_field->Camera({1}).CentreWorld() - light_field->Camera({0}).CentreWorld();
  EXPECT_NEAR((step - Vec3(0.0005, 0, 0)).norm(), 0, 1e-15);
  for (uint32_t i = 0; i < light_field->size(); ++i) {
    const PinholeCamera camera = light_field->Camera({i});
    EXPECT_NEAR(camera.ForwardWorld().y(), -std::sin(RadiansFromDegrees(9)), 1e-12);
    EXPECT_NEAR(camera.RightWorld().x(), 1, 1e-12);
    EXPECT_TRUE(fs::exists(light_field->ImagePath({i})));
  }
}

TEST_F(RealLightFieldTest, GroundTruthBandLooksAtOnePointFortyCentimetresAhead) {
  LF_SKIP_WITHOUT("groundtruth/data/band");
  const Result<LightField> light_field = Open("groundtruth/data/band");
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 48u * 6u);
  const auto point_ahead = [&](uint32_t i) -> Vec3 {
    const PinholeCamera camera = light_field->Camera({i});
    return camera.CentreWorld() + 0.4 * camera.ForwardWorld();
  };
  Vec3 target = Vec3::Zero();
  for (uint32_t i = 0; i < light_field->size(); ++i)
    target += point_ahead(i) / static_cast<double>(light_field->size());
  for (uint32_t i = 0; i < light_field->size(); ++i)  // poses are off by 0.2 mm and 0.05 degrees
    EXPECT_LT((point_ahead(i) - target).norm(), 0.001) << i;
}

TEST_F(RealLightFieldTest, TheCardsAreARectifiedSlab) {
  LF_SKIP_WITHOUT("data/stanford-cards-9x9");
  const fs::path folder = TestData() / "data/stanford-cards-9x9";
  const Result<LightField> without = OpenLightField(folder);
  ASSERT_FALSE(without);
  EXPECT_TRUE(without.error().message.ends_with(fmt::format(
      "lfimport {0} -o {0} --pitch 1 --focal-px 768 --plane-distance 100", folder.string())))
      << without.error().message;
  const Result<LightField> light_field =
      OpenLightField(folder, {.focal_px = 768, .pitch_w = Vec2(1, 1), .plane_distance_w = 100});
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 81u);
  ASSERT_EQ(light_field->intrinsics.size(), 81u);
  // The images are every second row and column of 17; the last camera is 8 pitches off the middle.
  const PinholeCamera last = light_field->Camera({80});
  EXPECT_EQ(last.CentreWorld(), Vec3(8, 8, 0));
  EXPECT_EQ(last.intrinsics, (Intrinsics{768, 768, 384 + 61.44, 384 + 61.44, 0, 768, 768}));
}

TEST_F(RealLightFieldTest, TheShopIsAGridOf729Cameras) {
  LF_SKIP_WITHOUT("data/blender-shop");
  const Result<LightField> light_field = Open("data/blender-shop");
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 729u);
  ASSERT_EQ(light_field->intrinsics.size(), 1u);
  EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{800, 800, 480, 320, 0, 960, 640}));
  constexpr double kPitch_m = 0.8 / 26;
  for (uint32_t i = 0; i < 729; ++i) {
    // Row 00 is the lowest camera, column 00 the rightmost; y is down.
    const Vec3 expected(0.4 - kPitch_m * (i % 27), 0.4 - kPitch_m * (i / 27), 0);
    EXPECT_LT((light_field->Camera({i}).CentreWorld() - expected).norm(), 1e-8) << i;
    EXPECT_EQ(light_field->Camera({i}).ForwardWorld(), Vec3(0, 0, 1));
    EXPECT_TRUE(fs::exists(light_field->ImagePath({i})));
  }
}

// The expected numbers come from an independent reader in numpy, with which the model's points are
// reprojected within 0.85 px on average.
TEST_F(RealLightFieldTest, TheBeerIsAsAnotherReaderSeesIt) {
  LF_SKIP_WITHOUT("data/beer-colmap");
  const Result<LightField> light_field = Open("data/beer-colmap");
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 71u);
  EXPECT_EQ(light_field->intrinsics.size(), 71u);
  Vec3 centres = Vec3::Zero();
  double focal_px = 0, k = 0;
  for (uint32_t i = 0; i < 71; ++i) {
    const PinholeCamera camera = light_field->Camera({i});
    centres += camera.CentreWorld();
    focal_px += camera.intrinsics.fx_px;
    k += camera.intrinsics.distortion.parameters[0];
    EXPECT_EQ(camera.intrinsics.fx_px, camera.intrinsics.fy_px);
    EXPECT_EQ(camera.intrinsics.cx_px, 360);
    EXPECT_EQ(camera.intrinsics.cy_px, 640);
    EXPECT_EQ(camera.intrinsics.distortion.model, DistortionModel::kRadialTangential);
    EXPECT_TRUE(fs::exists(light_field->ImagePath({i})));
  }
  const auto expect_near = [](const Vec3& a, const Vec3& b) { EXPECT_LT((a - b).norm(), 1e-12); };
  expect_near(centres, Vec3(8.920645297302766, -2.953269514667041, 21.6690109176599));
  expect_near(light_field->Camera({0}).CentreWorld(),
              Vec3(0.2708125657388623, 1.6597579474636932, -1.3957008584801027));
  expect_near(light_field->Camera({70}).CentreWorld(),
              Vec3(0.9913895011719277, 0.6920423869829948, -0.5186137561778914));
  EXPECT_NEAR(focal_px, 79378.37862488278, 1e-9);
  EXPECT_NEAR(k, 2.708013943761758, 1e-13);
  ASSERT_TRUE(light_field->depth_range);
  EXPECT_NEAR(light_field->depth_range->near_w, 3.5492805666715666, 1e-12);
  EXPECT_NEAR(light_field->depth_range->far_w, 20.428267777661354, 1e-12);
}

TEST_F(RealLightFieldTest, TheTempleIsProjectedAsItsFileSays) {
  LF_SKIP_WITHOUT("data/middlebury-templeRing");
  const Result<LightField> light_field = Open("data/middlebury-templeRing/templeRing");
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 47u);
  ASSERT_EQ(light_field->intrinsics.size(), 1u);
  // The middle of the bounding box that the data set states. P = K [R t] of the first line projects
  // it to (362.0134555, 247.2674371), measured from the centre of the upper left pixel.
  const Vec3 middle(0.0277525, 0.0418135, -0.0546675);
  const std::optional<Vec2> first = Project(light_field->Camera({0}), middle);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->x(), 362.01345550900254 + 0.5, 1e-6);
  EXPECT_NEAR(first->y(), 247.26743707775952 + 0.5, 1e-6);
  for (uint32_t i = 0; i < 47; ++i) {
    const PinholeCamera camera = light_field->Camera({i});
    EXPECT_NEAR((camera.CentreWorld() - middle).norm(), 0.565, 0.02) << i;
    EXPECT_LT((*Project(camera, middle) - Vec2(320, 240)).norm(), 80) << i;
    EXPECT_TRUE(fs::exists(light_field->ImagePath({i})));
  }
}

}  // namespace
}  // namespace lf
