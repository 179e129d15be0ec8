// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/masks_beside.h"

#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;
using MaskNames = std::vector<std::string>;

class MasksBesideTest : public FolderTest {
 protected:
  void Write(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      fs::create_directories((folder_ / name).parent_path());
      ASSERT_TRUE(WriteFileAtomically(folder_ / name, "x"));
    }
  }
  LightField FieldOf(MaskNames names) const {
    LightField field;
    field.folder = folder_;
    field.cameras.resize(names.size());
    field.image_names = std::move(names);
    return field;
  }
};

TEST_F(MasksBesideTest, EachFormOfNameIsFound) {
  Write({"masks/1.jpg.png", "masks/1.png", "masks/2.png", "masks/3.jpg", "masks/images/4.png"});
  const LightField field =
      FieldOf({"images/1.jpg", "images/2.jpg", "images/3.jpg", "images/4.jpg", "images/5.jpg"});
  EXPECT_EQ(MasksIn("masks", field),
            (MaskNames{"masks/1.jpg.png", "masks/2.png", "masks/3.jpg", "masks/images/4.png", ""}));
  EXPECT_EQ(MasksIn("images", field), MaskNames{});
  EXPECT_EQ(MasksIn(folder_ / "masks", field)[1], folder_ / "masks/2.png");
}

TEST_F(MasksBesideTest, ABaseNameThatRepeatsTellsNothing) {
  Write({"masks/1.png", "masks/right/2.png"});
  const LightField field = FieldOf({"left/1.jpg", "right/1.jpg", "left/2.jpg", "right/2.jpg"});
  EXPECT_EQ(MasksIn("masks", field), (MaskNames{"", "", "", "masks/right/2.png"}));
}

TEST_F(MasksBesideTest, FoldersOfMasksAreThoseNearTheImages) {
  Write({"images_mask/1.png", "images/1.jpg", "images/Masks/1.png", "depth/1.png", "masks/7.png"});
  const LightField field = FieldOf({"images/1.jpg"});
  const fs::path folder = fs::canonical(folder_);
  EXPECT_EQ(FoldersOfMasks(field),
            (std::vector<fs::path>{folder / "images/Masks", folder / "images_mask"}));
  EXPECT_EQ(FoldersOfMasks(FieldOf({"images/2.jpg"})).size(), 0u);
}

TEST_F(MasksBesideTest, DynamicMasksAreCounted) {
  Write({"images/1.jpg", "images/dynamic_mask_1.png", "images/2.jpg"});
  EXPECT_EQ(CountDynamicMasks(FieldOf({"images/1.jpg", "images/2.jpg"})), 1u);
}

}  // namespace
}  // namespace lf
