// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_forms.h"

#include <gtest/gtest.h>

#include <set>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

void WriteExport(const fs::path& file, std::string_view text) {
  ASSERT_TRUE(CreateFolder(file.parent_path()));
  ASSERT_TRUE(WriteFileAtomically(file, text));
}

TEST(ExportForms, EveryRowIsReadOrAdvised) {
  std::set<std::string_view> names;
  bool reads = true;
  for (const ExportForm& form : ExportForms()) {
    EXPECT_TRUE(names.insert(form.name).second) << form.name;
    EXPECT_EQ(form.read == nullptr, !form.advice.empty()) << form.name;
    EXPECT_EQ(form.read == nullptr, form.listed.empty()) << form.name;
    EXPECT_FALSE(form.places.empty()) << form.name;
    // Forms that are read come first.
    EXPECT_TRUE(reads || form.read == nullptr) << form.name;
    reads = form.read != nullptr;
  }
}

using ExportFolder = FolderTest;

TEST_F(ExportFolder, HoldsFilesThatAreRecognisedByNameAndWords) {
  WriteExport(folder_ / "Photo.LFP", "\x89LFP\r\n\x1A\n...");
  WriteExport(folder_ / "package.lfp", "SQLite format 3");
  const std::optional<Result<LightField>> opened = OpenExportFile(folder_ / "Photo.LFP", {});
  ASSERT_TRUE(opened.has_value());
  ASSERT_FALSE(*opened);
  const std::string& message = opened->error().message;
  EXPECT_NE(message.find("Photo.LFP: is not a light field, but a raw photograph of a Lytro camera"),
            std::string::npos);
  EXPECT_NE(message.find("plenopticam"), std::string::npos) << message;
  EXPECT_NE(message.find("LFToolbox"), std::string::npos) << message;
  EXPECT_EQ(ExportFormOf(folder_ / "package.lfp"), nullptr);
  EXPECT_EQ(ExportFormOf(folder_ / "none.psx"), ExportFormOf("project.psx"));
  EXPECT_NE(ExportFormOf("project.psx"), nullptr);
}

// A camera path or a transforms.json of another name must not be taken for an export.
TEST_F(ExportFolder, HoldsJsonThatIsNoExport) {
  WriteExport(folder_ / "other.json",
              R"({"frames": [{"file_path": "a.png", "position": [1, 2]}]})");
  EXPECT_EQ(ExportFormOf(folder_ / "other.json"), nullptr);
  WriteExport(folder_ / "keyframes" / "cameras" / "1.json", R"({"t_00": 1, "t_23": 2})");
  const ExportForm* const form = ExportFormOf(folder_ / "keyframes" / "cameras" / "1.json");
  ASSERT_NE(form, nullptr);
  EXPECT_NE(form->name.find("Polycam"), std::string_view::npos);
  EXPECT_EQ(ExportsIn(folder_, true)[0].form, form);
}

TEST_F(ExportFolder, HoldsFilesThatAreFoundByThePatternsOfTheirPaths) {
  EXPECT_TRUE(ExportsIn(folder_, false).empty());
  WriteExport(folder_ / "b.ply", "ply");
  WriteExport(folder_ / "a.ply", "ply");
  WriteExport(folder_ / ".hidden.ply", "ply");
  WriteExport(folder_ / "scan.psx", "");
  WriteExport(folder_ / "MeshroomCache" / "StructureFromMotion" / "0ab" / "sfm.abc", "");
  const std::vector<FoundExport> found = ExportsIn(folder_, false);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].files, (std::vector<fs::path>{folder_ / "scan.psx"}));
  const ExportAdvice advice = AdviceOnExportsIn(folder_);
  EXPECT_TRUE(advice.has_poses);
  EXPECT_TRUE(advice.text.starts_with("; " + (folder_ / "scan.psx").string() + " is a project of "))
      << advice.text;
  EXPECT_EQ(found[1].files[0].filename(), "sfm.abc");
  EXPECT_EQ(found[2].files, (std::vector<fs::path>{folder_ / "a.ply", folder_ / "b.ply"}));
}

}  // namespace
}  // namespace lf
