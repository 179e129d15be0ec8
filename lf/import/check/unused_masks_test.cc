// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/unused_masks.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class UnusedMasksTest : public FolderTest {
 protected:
  void Write(const fs::path& name) const {
    fs::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, "x"));
  }
  std::optional<CaptureWarning> Warning(std::vector<std::string> masks = {}) const {
    LightField field;
    field.folder = folder_;
    field.cameras.resize(2);
    field.image_names = {"images/1.jpg", "images/2.jpg"};
    field.mask_names = std::move(masks);
    return WarnOfUnusedMasks(field, [](const std::vector<std::string>& added) {
      return ShellCommand({"lfimport", "x", added[0], added[1]});
    });
  }
};

TEST_F(UnusedMasksTest, TheCallThatUsesThemIsNamed) {
  Write("images/1.jpg");
  EXPECT_EQ(Warning(), std::nullopt);
  Write("images_mask/2.png");
  const auto warning = Warning();
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->kind, "unused-masks");
  EXPECT_EQ(warning->image_count, 1u);
  EXPECT_EQ(warning->names, std::vector<std::string>{"images/2.jpg"});
  const std::string folder = fs::canonical(folder_ / "images_mask").string();
  EXPECT_TRUE(warning->message.ends_with(": lfimport x --masks " + folder)) << warning->message;
  EXPECT_EQ(Warning({"", "images_mask/2.png"}), std::nullopt);
  EXPECT_TRUE(Warning({"images_mask/1.png", ""}));
}

TEST_F(UnusedMasksTest, MasksOfTheOppositeMeaningAreNamed) {
  Write("images/dynamic_mask_1.png");
  const auto warning = Warning();
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->message.find("white where pixels are to be left out"), std::string::npos);
}

}  // namespace
}  // namespace lf
