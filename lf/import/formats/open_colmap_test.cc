// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "lf/core/file.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/light_field/colmap/read_colmap.h"
#include "lf/light_field/colmap/test_colmap.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

// A model that COLMAP itself made (with tests/colmap_models/make.py): one camera of each camera
// model, with two images each.
const fs::path kTenCameras = fs::path(LF_COLMAP_MODELS) / "ten_cameras";

class ReadColmapTest : public FolderTest {
 protected:
  static void Write(const fs::path& path, std::string_view bytes = "") {
    fs::create_directories(path.parent_path());
    ASSERT_TRUE(WriteFileAtomically(path, bytes));
  }
  static void WriteModel(const fs::path& folder, const std::vector<TestImage>& images = {{}}) {
    Write(folder / "cameras.bin", CamerasBin({TestCamera()}));
    Write(folder / "images.bin", ImagesBin(images));
  }
  void Copy(const char* extension) {
    for (const char* name : {"cameras", "images", "points3D"})
      fs::copy_file(kTenCameras / (std::string(name) + extension),
                    folder_ / (std::string(name) + extension));
  }
  Result<LightField> Open(const fs::path& path) { return OpenLightField(path); }
};

void ExpectSame(const LightField& a, const LightField& b) {
  ASSERT_EQ(a.image_names, b.image_names);
  EXPECT_EQ(a.intrinsics, b.intrinsics);
  EXPECT_EQ(a.depth_range, b.depth_range);
  for (uint32_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.cameras[i].intrinsics_index, b.cameras[i].intrinsics_index);
    EXPECT_EQ(a.cameras[i].cam_from_world.rotation, b.cameras[i].cam_from_world.rotation);
    EXPECT_EQ(a.cameras[i].cam_from_world.translation, b.cameras[i].cam_from_world.translation);
  }
}

TEST_F(ReadColmapTest, BothFormsAreTheSameBitForBit) {
  Copy(".txt");
  const Result<LightField> text = ReadColmapModel(folder_, folder_);
  ASSERT_TRUE(text) << text.error().message;
  Copy(".bin");  // binary models precede text
  const Result<LightField> binary = ReadColmapModel(folder_, folder_);
  ASSERT_TRUE(binary) << binary.error().message;
  EXPECT_EQ(binary->size(), 20u);
  EXPECT_EQ(binary->intrinsics.size(), 10u);
  ExpectSame(*text, *binary);
}

// The points of the fixture were projected by independent formulas, and COLMAP's reprojection error
// for them is 1e-14 px. If our projections are equal, our cameras agree with COLMAP's, including
// the convention for pixel centres.
TEST_F(ReadColmapTest, EveryModelProjectsAsColmapDoes) {
  Copy(".txt");
  const Result<LightField> light_field = ReadColmapModel(folder_, folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  std::map<int, Vec3> points;
  std::ifstream points_file(folder_ / "points3D.txt");
  for (std::string line; std::getline(points_file, line);) {
    std::istringstream words(line);
    int id = 0;
    Vec3 point;
    if (words >> id >> point.x() >> point.y() >> point.z()) points[id] = point;
  }
  ASSERT_EQ(points.size(), 12u);
  size_t compared_count = 0;
  std::ifstream images_file(folder_ / "images.txt");
  for (std::string line; std::getline(images_file, line);) {
    if (line.starts_with('#')) continue;
    const std::string name = line.substr(line.rfind(' ') + 1);
    const auto& names = light_field->image_names;
    const auto found = std::find(names.begin(), names.end(), name);
    ASSERT_NE(found, names.end()) << name;
    const PinholeCamera camera =
        light_field->Camera({static_cast<uint32_t>(found - names.begin())});
    const Intrinsics& k = camera.intrinsics;
    std::getline(images_file, line);
    std::istringstream words(line);
    int id = 0;
    for (double x_px = 0, y_px = 0; words >> x_px >> y_px >> id; ++compared_count) {
      const std::optional<Vec2> bent =
          DistortionMap(k.distortion).Distort(camera.cam_from_world * points.at(id));
      ASSERT_TRUE(bent) << name;
      EXPECT_NEAR(k.fx_px * bent->x() + k.cx_px, x_px, 1e-9) << name;
      EXPECT_NEAR(k.fy_px * bent->y() + k.cy_px, y_px, 1e-9) << name;
    }
  }
  EXPECT_EQ(compared_count, 20u * 12u);
}

// A pose as COLMAP writes it: a quaternion w x y z and a translation.
struct ColmapPose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vec3 translation = Vec3::Zero();

  std::array<double, 7> Numbers() const {
    return {rotation.w(),    rotation.x(),    rotation.y(),   rotation.z(),
            translation.x(), translation.y(), translation.z()};
  }
  friend ColmapPose operator*(const ColmapPose& a, const ColmapPose& b) {
    return {a.rotation * b.rotation, a.rotation * b.translation + a.translation};
  }
};

// A model of COLMAP 3.12 or later. Rig 7 has the cameras 1 and 4 and an IMU (sensor type 1) with an
// unknown pose. It took two frames: images of all its cameras at one moment. In the files, frame 5
// comes first although its images have the larger ids. The functions return the content of a .bin
// file if `is_binary` is true, otherwise of a .txt file, with the layout of COLMAP's
// reconstruction_io_*.cc.
class RigModel {
 public:
  RigModel() {
    const auto turn = [](double x, double y, double z) {
      return Eigen::Quaterniond(1, x, y, z).normalized();
    };
    sensor_from_rig_ = {turn(0.02, 0.3, -0.05), Vec3(-0.4, 0.03, 0.01)};
    rig_from_world_ = {ColmapPose{turn(0.1, -0.2, 0.3), Vec3(1, 2, 3)},
                       ColmapPose{turn(-0.3, 0.1, 0.2), Vec3(-2, 0.5, 4)}};
  }

  static constexpr const char* kNames[2][2] = {{"left/1.png", "right/1.png"},
                                               {"left/0.png", "right/0.png"}};
  ColmapPose CamFromWorld(int frame, int camera) const {
    return camera == 0 ? rig_from_world_[frame] : sensor_from_rig_ * rig_from_world_[frame];
  }

  std::string Cameras(bool is_binary) const {
    return is_binary ? CamerasBin({{.id = 1}, {.id = 4, .parameters = {12, 13, 4, 3}}})
                     : "1 PINHOLE 8 6 10 11 4 3\n4 PINHOLE 8 6 12 13 4 3\n";
  }
  std::string Images(bool is_binary) const {
    std::vector<TestImage> images;
    std::string text = "# Number of images: 4, mean observations per image: 0\n";
    for (int frame = 0; frame < 2; ++frame)
      for (int camera = 0; camera < 2; ++camera) {
        const std::array<double, 7> pose = CamFromWorld(frame, camera).Numbers();
        const uint32_t id = ImageId(frame, camera), camera_id = camera == 0 ? 1 : 4;
        images.push_back({.id = id,
                          .quaternion = {pose[0], pose[1], pose[2], pose[3]},
                          .translation = {pose[4], pose[5], pose[6]},
                          .camera_id = camera_id,
                          .name = kNames[frame][camera]});
        text += fmt::format("{} {} {} {}\n\n", id, fmt::join(pose, " "), camera_id,
                            kNames[frame][camera]);
      }
    return is_binary ? ImagesBin(images) : text;
  }
  std::string Rigs(bool is_binary) const {
    const std::array<double, 7> pose = sensor_from_rig_.Numbers();
    if (!is_binary)
      return fmt::format("# Number of rigs: 1\n7 3 CAMERA 1 CAMERA 4 1 {} IMU 2 0\n",
                         fmt::join(pose, " "));
    PackedBytes file;
    file.Put(uint64_t{1}).Put(7u).Put(3u).Put(0).Put(1u);
    file.Put(0).Put(4u).Put(uint8_t{1}).Put(pose);
    return file.Put(1).Put(2u).Put(uint8_t{0}).bytes();
  }
  std::string Frames(bool is_binary) const {
    PackedBytes file;
    file.Put(uint64_t{2});
    std::string text = "# Number of frames: 2\n";
    for (int frame = 0; frame < 2; ++frame) {
      const uint32_t frame_id = frame == 0 ? 5 : 6;
      const std::array<double, 7> pose = rig_from_world_[frame].Numbers();
      const uint64_t left = ImageId(frame, 0), right = ImageId(frame, 1);
      file.Put(frame_id).Put(7u).Put(pose).Put(2u);
      file.Put(0).Put(1u).Put(left).Put(0).Put(4u).Put(right);
      text += fmt::format("{} 7 {} 2 CAMERA 1 {} CAMERA 4 {}\n", frame_id, fmt::join(pose, " "),
                          left, right);
    }
    return is_binary ? file.bytes() : text;
  }

 private:
  static uint32_t ImageId(int frame, int camera) { return frame == 0 ? 12 - camera : 3 - camera; }

  ColmapPose sensor_from_rig_;
  std::array<ColmapPose, 2> rig_from_world_;
};

// COLMAP writes cam_from_world of every registered image, which is sensor_from_rig times
// rig_from_world, even if the model has rigs.
TEST_F(ReadColmapTest, AnImageOfARigStandsWhereRigAndFramePutIt) {
  const RigModel model;
  for (const bool is_binary : {false, true}) {
    const std::string extension = is_binary ? ".bin" : ".txt";
    Write(folder_ / ("cameras" + extension), model.Cameras(is_binary));
    Write(folder_ / ("images" + extension), model.Images(is_binary));
    Write(folder_ / ("rigs" + extension), model.Rigs(is_binary));
    Write(folder_ / ("frames" + extension), model.Frames(is_binary));
    const Result<LightField> light_field = ReadColmapModel(folder_, folder_);
    ASSERT_TRUE(light_field) << light_field.error().message;
    ASSERT_EQ(light_field->size(), 4u);
    for (int frame = 0; frame < 2; ++frame)
      for (int camera = 0; camera < 2; ++camera) {
        const auto& names = light_field->image_names;
        const auto found = std::find(names.begin(), names.end(), RigModel::kNames[frame][camera]);
        ASSERT_NE(found, names.end());
        const PinholeCamera read =
            light_field->Camera({static_cast<uint32_t>(found - names.begin())});
        const ColmapPose expected = model.CamFromWorld(frame, camera);
        EXPECT_LE((read.cam_from_world.rotation - expected.rotation.toRotationMatrix()).norm(),
                  1e-14);
        EXPECT_LE((read.cam_from_world.translation - expected.translation).norm(), 1e-14);
        EXPECT_EQ(read.intrinsics.fx_px, camera == 0 ? 10 : 12);
      }
  }
}

TEST_F(ReadColmapTest, WithoutItsRigsAndFramesAModelIsTheSame) {
  const RigModel model;
  for (const bool is_binary : {false, true}) {
    const std::string extension = is_binary ? ".bin" : ".txt";
    Write(folder_ / ("cameras" + extension), model.Cameras(is_binary));
    Write(folder_ / ("images" + extension), model.Images(is_binary));
    const Result<LightField> without = ReadColmapModel(folder_, folder_);
    ASSERT_TRUE(without) << without.error().message;
    Write(folder_ / ("rigs" + extension), model.Rigs(is_binary));
    Write(folder_ / ("frames" + extension), model.Frames(is_binary));
    const Result<LightField> with = ReadColmapModel(folder_, folder_);
    ASSERT_TRUE(with) << with.error().message;
    ExpectSame(*with, *without);
  }
}

TEST_F(ReadColmapTest, TheModelIsFoundInAndBelowTheFolder) {
  for (const char* place : {".", "sparse", "sparse/0", "colmap/sparse/0", "colmap/sparse", "0"}) {
    const fs::path root = folder_ / fmt::format("root_{}", std::hash<std::string_view>()(place));
    WriteModel(root / place);
    Write(root / "images" / "a.png");
    for (const fs::path& path : {root, root / place}) {
      const Result<LightField> light_field = Open(path);
      ASSERT_TRUE(light_field) << place << ": " << light_field.error().message;
      EXPECT_EQ(light_field->folder.lexically_normal(), root / "images") << place;
      EXPECT_TRUE(fs::exists(light_field->ImagePath({0})));
    }
  }
}

TEST_F(ReadColmapTest, OfSeveralModelsTheLargestIsTaken) {
  Write(folder_ / "images" / "a.png");
  WriteModel(folder_ / "sparse/0");
  WriteModel(folder_ / "sparse/2", {{.id = 1}, {.id = 2, .name = "b.png"}});
  Write(folder_ / "sparse/10/cameras.txt", "1 PINHOLE 8 6 10 11 4 3\n");
  Write(folder_ / "sparse/10/images.txt", "1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 0 0 0 1 b.png\n\n");
  fs::create_directories(folder_ / "sparse/1");
  testing::internal::CaptureStderr();
  const Result<LightField> light_field = Open(folder_);
  const std::string messages = testing::internal::GetCapturedStderr();
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->size(), 2u);
  EXPECT_HAS(messages, "holds 3 COLMAP models: using 2, with 2 of 5 images");
  EXPECT_EQ(Open(folder_ / "sparse/0")->size(), 1u);
}

TEST_F(ReadColmapTest, AModelThatIsIncompleteIsAnError) {
  Write(folder_ / "sparse/0/cameras.bin", CamerasBin({TestCamera()}));
  Write(folder_ / "sparse/0/images.txt", "");
  EXPECT_HAS(ErrorOf(Open(folder_)), "sparse/0/cameras.bin: exists, but the images.bin of");
  fs::remove(folder_ / "sparse/0/cameras.bin");
  EXPECT_HAS(ErrorOf(Open(folder_)), "sparse/0/images.txt: exists, but the cameras.txt of");
  EXPECT_HAS(ErrorOf(ReadColmapModel(folder_)), "holds no COLMAP model");
}

TEST_F(ReadColmapTest, ATextOfThatNameAloneIsNoModel) {
  Write(folder_ / "images.txt", "a list of something");
  EXPECT_HAS(ErrorOf(Open(folder_)), "holds no light field");
  Write(folder_ / "cameras.bin");
  EXPECT_HAS(ErrorOf(Open(folder_)), "cameras.bin: exists, but the images.bin");
}

TEST_F(ReadColmapTest, ImagesAreLookedForAndThePlacesAreListed) {
  WriteModel(folder_ / "sparse/0", {{.name = "sub/a b.png"}});
  const std::string error = ErrorOf(Open(folder_));
  EXPECT_HAS(error, "its image sub/a b.png is not found");
  for (const fs::path& tried : {folder_ / "sparse/0/images", folder_ / "sparse/images",
                                folder_ / "images", folder_ / "sparse/0", folder_ / "sparse"})
    EXPECT_HAS(error, tried.string());
  EXPECT_HAS(error, "({images})");
  Write(folder_ / "sub/a b.png");  // the project folder itself is searched
  EXPECT_EQ(Open(folder_)->folder, folder_);
  Write(folder_ / "sparse/0/images/sub/a b.png");  // this folder is nearer to the model
  EXPECT_EQ(Open(folder_)->folder, folder_ / "sparse/0/images");
}

TEST_F(ReadColmapTest, WhatLiesNearImagesThatAreNotFoundIsTold) {
  WriteModel(folder_ / "sparse/0", {{.name = "img 7.png"}});
  Write(folder_ / "images/other.jpg");
  EXPECT_HAS(ErrorOf(Open(folder_)),
             "images: its folder holds 1 files, such as other.jpg; put the");
  Write(folder_ / "images/IMG_07.JPG");
  EXPECT_HAS(ErrorOf(Open(folder_)),
             "; similar in " + (folder_ / "images").string() + ": IMG_07.JPG; put the images");
}

TEST_F(ReadColmapTest, ANamedFolderOfImagesIsNotChecked) {
  WriteModel(folder_ / "sparse/0");
  const OpenOptions options = {.images_folder = "nowhere"};
  const Result<LightField> light_field = OpenLightField(folder_, options);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->ImagePath({0}), "nowhere/a.png");
}

TEST_F(ReadColmapTest, OptionsOfOtherKindsAreUsageErrors) {
  WriteModel(folder_ / "sparse/0");
  OpenOptions options;
  options.focal_px = 7;
  EXPECT_EQ(OpenLightField(folder_, options).error().kind, ErrorKind::kUsage);
}

TEST_F(ReadColmapTest, ImagesUnderOtherSuffixesAreFoundInTheProject) {
  WriteModel(folder_ / "sparse/0");
  Write(folder_ / "photos/half/A.JPG");
  const Result<LightField> light_field = Open(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->ImagePath({0}), folder_ / "photos/half/A.JPG");
}

TEST_F(ReadColmapTest, ATransformsJsonGoesFirst) {
  WriteModel(folder_ / "sparse/0");
  Write(folder_ / "transforms.json", "{}");
  EXPECT_HAS(ErrorOf(Open(folder_)), "transforms.json");
}

TEST_F(ReadColmapTest, RelativePathsReachTheFoldersAbove) {
  Write(folder_ / "images/a.png");
  WriteModel(folder_ / "sparse/0");
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "sparse/0");
  for (const char* path : {".", "./", "../0", "../../sparse/0/", "..", "../.."}) {
    const Result<LightField> light_field = Open(path);
    ASSERT_TRUE(light_field) << path << ": " << light_field.error().message;
    EXPECT_TRUE(fs::exists(light_field->ImagePath({0}))) << path;
  }
  fs::current_path(before);
}

TEST_F(ReadColmapTest, MasksStandBesideTheImages) {
  WriteModel(folder_ / "sparse/0", {{.id = 1}, {.id = 2, .name = "s/b.jpg"}});
  Write(folder_ / "images/a.png");
  fs::create_directories(folder_ / "masks");
  EXPECT_TRUE(Open(folder_)->mask_names.empty());
  Write(folder_ / "masks/s/b.jpg.png");
  Result<LightField> light_field = Open(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->mask_names, (std::vector<std::string>{"", "../masks/s/b.jpg.png"}));
  EXPECT_TRUE(fs::exists(light_field->folder / light_field->mask_names[1]));

  // After a symbolic link, `..` is the parent of the folder that the link points to.
  fs::create_directories(folder_ / "elsewhere");
  fs::rename(folder_ / "images", folder_ / "elsewhere/images");
  fs::create_directory_symlink("elsewhere/images", folder_ / "images");
  light_field = Open(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->mask_names.size(), 2u);
  EXPECT_TRUE(fs::exists(light_field->folder / light_field->mask_names[1]));
}

TEST_F(ReadColmapTest, BrokenPointsAreAnError) {
  Copy(".bin");
  Write(folder_ / "points3D.bin", "short");
  EXPECT_HAS(ErrorOf(ReadColmapModel(folder_, folder_)), "points3D.bin: has 5 bytes");
  fs::remove(folder_ / "points3D.bin");
  EXPECT_EQ(ReadColmapModel(folder_, folder_)->depth_range, std::nullopt);
  fs::create_directory(folder_ / "points3D.bin");
  EXPECT_HAS(ErrorOf(ReadColmapModel(folder_, folder_)), "expected a file");
}

}  // namespace
}  // namespace lf
