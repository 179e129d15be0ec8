// SPDX-License-Identifier: Apache-2.0
#include "lf/core/folder_names.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace lf {
namespace {

namespace fs = std::filesystem;

TEST(FolderNames, ListsEachFolderOnce) {
  const fs::path folder =
      fs::temp_directory_path() / ("lf_folder_names_test." + std::to_string(::getpid()));
  fs::create_directories(folder / "a");
  std::ofstream(folder / "a" / "0.png") << "x";
  fs::create_symlink("nowhere", folder / "link.png");
  FolderNames names;
  EXPECT_TRUE(names.Has(folder / "a" / "0.png"));
  EXPECT_TRUE(names.Has(folder / "link.png"));
  for (int i = 1; i < 1000; ++i) {
    const std::string name = std::to_string(i) + ".png";
    EXPECT_FALSE(names.Has(folder / "a" / name));
    EXPECT_FALSE(names.Has(folder / name));
    EXPECT_FALSE(names.Has(folder / "gone" / name));
    EXPECT_FALSE(names.Has(folder / "a" / "0.png" / name));
  }
  EXPECT_EQ(names.listed_count(), 4u);
  EXPECT_FALSE(FolderNames().Has("there_is_no_such_file"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace lf
