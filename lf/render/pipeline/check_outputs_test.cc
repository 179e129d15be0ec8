// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/check_outputs.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

class CheckOutputsTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    fs::create_directories(folder_ / "field" / "images");
    package_.frames = {{FrameId{1}, 1, 1}, {FrameId{7}, 1, 1}};
    package_.light_field.folder = folder_ / "field";
    options_.folder.output_folder = folder_ / "film";
    options_.folder.format = FrameFormat::kPng8;
  }
  // Writes a file with this name, and adds it to the light field as an LF image.
  void AddImage(const std::string& name) {
    std::ofstream(folder_ / "field" / name) << name;
    package_.light_field.image_names.push_back(name);
  }
  std::string Refusal() const {
    const Result<void> checked = CheckOutputs(package_, options_);
    if (checked) return "";
    EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
    return checked.error().message;
  }
  Package package_;
  RenderOptions options_;
};

TEST_F(CheckOutputsTest, OtherFoldersAndOtherNamesAreFree) {
  AddImage("frame_0001.png");
  AddImage("images/frame_0007.png");
  EXPECT_EQ(Refusal(), "");
  options_.folder.output_folder = folder_ / "field";
  options_.folder.format = FrameFormat::kExrHalf;
  EXPECT_EQ(Refusal(), "");
  options_.folder.format = FrameFormat::kPng8;
  options_.frames = {FrameId{7}};
  EXPECT_EQ(Refusal(), "");
}

TEST_F(CheckOutputsTest, LfImagesStay) {
  AddImage("images/a.png");
  AddImage("images/frame_0007.png");
  for (const char* const folder : {"field/images", "field/../field/images/."}) {
    options_.folder.output_folder = folder_ / folder;
    EXPECT_NE(Refusal().find("frame_0007.png: would be replaced, but is an LF image"),
              std::string::npos)
        << Refusal();
  }
}

TEST_F(CheckOutputsTest, LinksAreFollowed) {
  AddImage("frame_0001.png");
  fs::create_directory_symlink(folder_ / "field", folder_ / "link");
  options_.folder.output_folder = folder_ / "link";
  EXPECT_NE(Refusal(), "");
  // First, an earlier frame is a link to an LF image; then, an LF image is a link to a frame.
  options_.folder.output_folder = folder_ / "film";
  fs::create_directories(folder_ / "film");
  fs::create_symlink(folder_ / "field" / "frame_0001.png", folder_ / "film" / "frame_0001.png");
  EXPECT_NE(Refusal(), "");
  fs::remove(folder_ / "film" / "frame_0001.png");
  EXPECT_EQ(Refusal(), "");
  std::ofstream(folder_ / "film" / "frame_0001.png") << "frame";
  fs::create_symlink(folder_ / "film" / "frame_0001.png", folder_ / "field" / "b.png");
  package_.light_field.image_names.emplace_back("b.png");
  EXPECT_NE(Refusal(), "");
}

TEST_F(CheckOutputsTest, MasksContactSheetsAndFilesThatAreReadStay) {
  options_.folder.output_folder = folder_ / "field";
  AddImage("a.png");
  std::ofstream(folder_ / "field" / "contact_sheet.png") << "mask";
  package_.light_field.mask_names = {"contact_sheet.png"};
  EXPECT_NE(Refusal().find("is a mask of an LF image"), std::string::npos) << Refusal();
  package_.light_field.mask_names.clear();
  EXPECT_EQ(Refusal(), "");
  options_.folder.inputs = {folder_ / "nowhere", folder_ / "field" / "report.json"};
  EXPECT_EQ(Refusal(), "");
  std::ofstream(folder_ / "field" / "report.json") << "path";
  EXPECT_NE(Refusal().find("is an input file"), std::string::npos) << Refusal();
}

TEST_F(CheckOutputsTest, AVideoIsNoOtherFileOfTheRender) {
  for (const char* const name :
       {"frame_0007.png", "contact_sheet.png", "report.json", "planes.json", "frame_0001.plate",
        "partial/frame_0001.png", "partial/film.mp4", "cluster/film.mp4"}) {
    options_.folder.keep_plates = true;
    options_.folder.more_outputs = {folder_ / "film" / "planes.json"};
    options_.folder.video = folder_ / "film" / name;
    EXPECT_NE(Refusal().find("give another {video}"), std::string::npos) << name << Refusal();
  }
  options_.folder.video = folder_ / "film" / "film.mp4";
  EXPECT_EQ(Refusal(), "");
}

TEST_F(CheckOutputsTest, FilesThatAreReadStayInTheStateOfAShard) {
  const auto expect_stays = [&](const std::string& name) {
    const fs::path input = options_.folder.output_folder / name;
    fs::create_directories(input.parent_path());
    std::ofstream(input) << "path";
    options_.folder.inputs = {input};
    EXPECT_NE(Refusal().find("is an input file"), std::string::npos) << name;
  };
  options_.film.shard = Shard{2, 3};
  expect_stays("partial/shard_2_of_3/run.json");
  expect_stays("report-shard_2_of_3.json");
  package_.name = "package-0004";
  expect_stays("partial/package-0004.shard_2_of_3/frame_0007.json");
  EXPECT_NE(Refusal(), "");
  options_.film.shard = Shard{1, 3};
  EXPECT_EQ(Refusal(), "");
}

}  // namespace
}  // namespace lf
