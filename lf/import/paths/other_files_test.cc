// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/other_files.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/core/file.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/path_kind.h"
#include "lf/import/paths/test_paths.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

using OtherFilesTest = FolderTest;

TEST_F(OtherFilesTest, AreNamedByTheirContent) {
  using namespace std::string_literals;
  const std::pair<std::string, const char*> kContents[] = {
      {"Kaydara FBX Binary  \0"s, "an FBX scene"},
      {"; FBX 7.7.0 project file\n", "an FBX scene"},
      {"Ogawa\xFF\0\1"s, "an Alembic scene"},
      {"glTF\2\0\0\0"s, "a glTF scene"},
      {"BLENDER-v304", "a scene of Blender"},
      {"//Maya ASCII 2024 scene\n", "a scene of Maya"},
      {"\0\0\0\x20"
       "ftypisom"s,
       "a video"},
      {"\x1A\x45\xDF\xA3\1"s, "a video"},
      {"\x89PNG\r\n\x1A\n"s, "a picture"},
      {"\xFF\xD8\xFF\xE0"s, "a picture"},
      {"ply\nformat ascii 1.0\n", "a PLY file"},
      {"HIERARCHY\nROOT Hips\n", "a movement of a skeleton"},
      {"PXR-USDC\0"s, "a USD scene"},
      {"#usda 1.0\n", "a USD scene"},
      {"\x93NUMPY\1"s, "an array of NumPy"},
  };
  for (const auto& [text, name] : kContents) {
    ASSERT_TRUE(WriteFileAtomically(folder_ / "path", text));
    ExpectPathError(OpenPath(folder_ / "path", {}), (folder_ / "path").string(),
                    {name, "not read as a camera path: "});
  }
}

TEST_F(OtherFilesTest, AreNamedByTheirExtensionIfTheContentTellsNothing) {
  const std::pair<const char*, const char*> kNames[] = {{"a.nk", "'export chan file'"},
                                                        {"a.py", "a script of Python"},
                                                        {"a.CSV", "frame tx ty tz rx ry rz"},
                                                        {"a.mb", "a scene of Maya"},
                                                        {"a.hip", "another program"},
                                                        {"a.usdz", "a USD scene"},
                                                        {"a.blend", "open it in Blender"},
                                                        {"a.abc", "import it into Blender"},
                                                        {"a.mov", "COLMAP"}};
  for (const auto& [name, part] : kNames) {
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, "Frame,X,Y,Z\n1,0,0,0\n"));
    ExpectPathError(OpenPath(folder_ / name, {}), (folder_ / name).string(),
                    {part, "not read as a camera path: "});
  }
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.gltf", R"({"asset": {"version": "2.0"}})"));
  ExpectPathError(OpenPath(folder_ / "a.gltf", {}), (folder_ / "a.gltf").string(),
                  {"a glTF scene", "import it into Blender"});
}

TEST_F(OtherFilesTest, APathMayHaveAnyName) {
  EXPECT_EQ(*PathKindOf("# made by a.py\nformat: lfpath 1\n", "a.py"), PathKind::kYaml);
  EXPECT_EQ(*PathKindOf("1 0 0 0 0 0 0\n", "a.csv"), PathKind::kChan);
  EXPECT_EQ(*PathKindOf(kNerfstudioText, "a.py"), PathKind::kNerfstudio);
  EXPECT_EQ(*PathKindOf("fps: 3\n", "path"), PathKind::kYaml);
}

TEST_F(OtherFilesTest, AFileOfAColmapModelStandsForItsFolder) {
  const auto write = [&](const char* name, const std::string& text) {
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, text));
  };
  const std::string images =
      "# Image list with two lines of data per image:\n1 1 0 0 0 0 0 0 1 a.png\n\n";
  write("images.txt", images);
  ExpectPathError(FindPath(folder_ / "images.txt"), (folder_ / "images.txt").string(),
                  {"one file of a COLMAP model", "give this folder"});
  write("cameras.txt", "1 PINHOLE 80 60 70 70 40 30\n");
  for (const char* name : {"images.txt", "cameras.txt"}) {
    const Result<PathPlace> place = FindPath(folder_ / name);
    ASSERT_TRUE(place) << place.error().message;
    EXPECT_EQ(place->kind, PathKind::kColmap);
    EXPECT_EQ(place->path, folder_);
  }
  const Result<CameraPath> path = OpenPath(folder_ / "images.txt", {});
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(path->frame_count(), 1u);
  write("poses.txt", images);
  EXPECT_EQ(FindPath(folder_ / "poses.txt")->kind, PathKind::kColmap);
  std::filesystem::remove(folder_ / "cameras.txt");
  // A .chan may have the name of COLMAP's file.
  write("images.txt", "1 0 0 0 0 0 0\n");
  EXPECT_EQ(FindPath(folder_ / "images.txt")->kind, PathKind::kChan);
}

}  // namespace
}  // namespace lf
