// SPDX-License-Identifier: Apache-2.0
// tests/programs/light_field_video_test.py opens videos and frames with pixels.
#include "lf/import/formats/open_video.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace lf {
namespace fs = std::filesystem;
namespace {

class OpenVideoTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "open_videoXXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const fs::path& name, const std::string& text = "x") const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  // Writes a poses_bounds.npy with this number of rows.
  void WritePoses(size_t count) const {
    std::string head =
        "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(count) + ", 17), }";
    head += std::string(117 - head.size(), ' ') + "\n";
    std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(head.size()) + '\0';
    bytes += head;
    for (size_t i = 0; i < count; ++i)
      for (const double value : {0., 1., 0., 0.1 * static_cast<double>(i), 6., 1., 0., 0., 0., 8.,
                                 0., 0., -1., 0., 9., 1., 5.}) {
        char raw[8];
        std::memcpy(raw, &value, 8);
        bytes.append(raw, 8);
      }
    Write("poses_bounds.npy", bytes);
  }

  // Writes image files of 8 x 6 pixels.
  void WriteFrames(const fs::path& place, int count) const {
    for (int i = 0; i < count; ++i)
      Write(place / ("000" + std::to_string(i) + ".ppm"), "P6 8 6 255\n" + std::string(144, 'a'));
  }

  fs::path folder_;
};

TEST_F(OpenVideoTest, VideosAreSortedByTheirNames) {
  EXPECT_FALSE(FindVideoFolder(folder_));
  for (const char* const name : {"cam10.mp4", "cam02.MP4", "cam01.mp4", "notes.txt"}) Write(name);
  EXPECT_FALSE(FindVideoFolder(folder_));  // no poses
  WritePoses(3);
  const auto found = FindVideoFolder(folder_);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->cameras.size(), 3u);
  EXPECT_EQ(found->cameras[1].name, "cam02");
  EXPECT_EQ(found->cameras[2].video, folder_ / "cam10.mp4");
  EXPECT_FALSE(found->holds_stills);
  for (const char* const name : {"images/a.png", "images/b.png", "images/c.png"}) Write(name);
  EXPECT_TRUE(FindVideoFolder(folder_)->holds_stills);
}

TEST_F(OpenVideoTest, FoldersOfFramesAreFoundInTwoForms) {
  WritePoses(3);
  WriteFrames("cam0", 2);
  WriteFrames("cam1/images", 2);
  WriteFrames("cam2/images", 2);
  const auto found = FindVideoFolder(folder_);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->cameras.size(), 3u);
  EXPECT_EQ(found->cameras[0].frames, (std::vector<std::string>{"cam0/0000.ppm", "cam0/0001.ppm"}));
  EXPECT_EQ(found->cameras[2].frames[1], "cam2/images/0001.ppm");
}

TEST_F(OpenVideoTest, OneFolderOfPhotographsIsNoVideo) {
  WritePoses(3);
  WriteFrames("photos", 3);
  WriteFrames("previews", 3);
  EXPECT_FALSE(FindVideoFolder(folder_));
  fs::remove_all(folder_ / "previews");
  WriteFrames("masks", 3);
  EXPECT_FALSE(FindVideoFolder(folder_));
}

TEST_F(OpenVideoTest, EachTimeHasTheFramesOfItsNumber) {
  WritePoses(3);
  for (const char* const camera : {"cam0", "cam1", "cam2"}) WriteFrames(camera, 4);
  fs::remove(folder_ / "cam1/0002.ppm");
  const auto found = FindVideoFolder(folder_);
  ASSERT_TRUE(found);
  OpenOptions options;
  options.recorded_fps = 2;
  options.time = 0.9;
  Result<LightField> field = OpenVideoFolder(*found, options, folder_);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->image_names[0], "cam0/0002.ppm");
  EXPECT_EQ(field->image_names[1], "cam1/missing-000000.ppm");
  EXPECT_EQ(field->slice_times, (std::vector<double>{1}));
  EXPECT_EQ(field->video->slice_count, 4u);
  EXPECT_EQ(field->video->camera_count, 3u);
  EXPECT_EQ(*field->video->rate, 2);
  EXPECT_FALSE(field->video->is_of_path);
  options.time.reset();
  options.path_times = {0, 0.1, 1.5, 0.6};
  field = OpenVideoFolder(*found, options, folder_);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->size(), 9u);
  EXPECT_EQ(field->slice_times, (std::vector<double>{0, 0.5, 1.5}));
  EXPECT_EQ(field->times[4], 0.5);
  EXPECT_EQ(field->image_names[8], "cam2/0003.ppm");
  EXPECT_TRUE(field->video->is_of_path);
}

TEST_F(OpenVideoTest, WithoutATimeTheQuestionHasTheCall) {
  WritePoses(2);
  WriteFrames("cam0", 3);
  WriteFrames("cam1", 3);
  OpenOptions options;
  const auto found = FindVideoFolder(folder_);
  ASSERT_TRUE(found);
  Result<LightField> field = OpenVideoFolder(*found, options, "scene");
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(field.error().message,
            "scene: is a light field video of 2 cameras, from 0 to 0.066667 s (3 times, 30 per "
            "second): say which time is shown, such as {time 0.0333333}");
  options.call_again = [](const std::vector<std::string>& added) {
    return "lfimport scene " + added[0] + " " + added[1];
  };
  field = OpenVideoFolder(*found, options, "scene");
  EXPECT_TRUE(field.error().message.ends_with("by: lfimport scene --time 0.0333333"));
  options.time = 0.2;
  EXPECT_NE(OpenVideoFolder(*found, options, "scene").error().message.find("from 0 to 0.066667 s"),
            std::string::npos);
}

LightField FieldWithTimes(std::vector<double> times) {
  LightField field;
  field.cameras.resize(times.size());
  for (size_t i = 0; i < times.size(); ++i) field.image_names.push_back(std::to_string(i));
  field.times = std::move(times);
  return field;
}

TEST(ChooseTimes, ImagesOfOneOfSeveralTimesAreKept) {
  LightField field = FieldWithTimes({0, 0, 0.5, 0.5, 1, 1});
  EXPECT_EQ(ChooseTimes({}, "a", &field).error().kind, ErrorKind::kUsage);
  ASSERT_TRUE(ChooseTimes({.time = 0.7}, "a", &field));
  EXPECT_EQ(field.image_names, (std::vector<std::string>{"2", "3"}));
  EXPECT_FALSE(field.video->is_in_seconds);
  LightField several = FieldWithTimes({0, 1, 0, 1, 2, 2});
  ASSERT_TRUE(ChooseTimes({.path_times = {0, 2}}, "a", &several));
  EXPECT_EQ(several.image_names, (std::vector<std::string>{"0", "2", "4", "5"}));
  EXPECT_EQ(several.times, (std::vector<double>{0, 0, 2, 2}));
}

TEST(ChooseTimes, OtherLightFieldsStayWhole) {
  for (const std::vector<double>& times : {std::vector<double>{}, {3, 3, 3}, {0, 0.5, 1}}) {
    LightField field = FieldWithTimes(times);
    field.cameras.resize(3);
    field.image_names.resize(3);
    ASSERT_TRUE(ChooseTimes({}, "a", &field));
    EXPECT_EQ(field.size(), 3u);
    EXPECT_FALSE(field.video);
    EXPECT_EQ(ChooseTimes({.time = 0}, "a", &field).error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace lf
