// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/package_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

// Returns a package of one frame and one LF image.
Package SmallPackage() {
  Package package;
  package.choices.has_neighbours = false;
  package.whole = {1, "0123456789abcdef", "fedcba9876543210"};
  package.ranks.end = 1;
  package.ranks.of_images = {0};
  package.light_field = testing::NoiseField(1);
  package.images = {{0, 1, {0, 0, 1, 1}, 1, 1}};
  package.path.cameras = {testing::NoiseFrames().front()};
  package.frames = {{FrameId{1}, 1, 1}};
  return package;
}

class PackageFolderTest : public ::testing::Test {
 protected:
  PackageFolderTest()
      : folder_(fs::temp_directory_path() /
                ("lf_package_folder_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {}
  ~PackageFolderTest() override { fs::remove_all(folder_); }

  Result<PackageFolder> Open(bool overwrite = false, const std::string& part = "") const {
    return PackageFolder::Open(folder_, part, overwrite);
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  const fs::path folder_;
};

TEST_F(PackageFolderTest, PackagesAppearTogether) {
  {
    PackageFolder folder = *Open();
    for (const char* const name : {"package-0000", "package-0001"}) {
      const Result<void> added = folder.Add(name, SmallPackage(), {"1", "here"});
      ASSERT_TRUE(added) << added.error().message;
      for (const std::string& there : Names()) EXPECT_TRUE(there.starts_with('.')) << there;
    }
    ASSERT_TRUE(folder.Publish());
  }
  EXPECT_EQ(Names(), (std::vector<std::string>{"package-0000.lfp", "package-0001.lfp"}));
  const Result<Package> package = ReadPackage(folder_ / "package-0001.lfp");
  EXPECT_TRUE(package) << package.error().message;
}

TEST_F(PackageFolderTest, NothingIsLeftOfWhatIsNotPublished) {
  {
    PackageFolder folder = *Open();
    ASSERT_TRUE(folder.Add("package-0000", SmallPackage(), {}));
  }
  EXPECT_TRUE(Names().empty());
}

TEST_F(PackageFolderTest, OneProgramAtATime) {
  const PackageFolder first = *Open();
  const Result<PackageFolder> second = Open();
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::kOutput);
  EXPECT_NE(second.error().message.find("process " + std::to_string(::getpid())),
            std::string::npos);
}

TEST_F(PackageFolderTest, PackagesOfBeforeStayUntilOthersAreWhole) {
  fs::create_directories(folder_);
  for (const char* const name :
       {"package-0000.lfp", "package-0007.lfp", "mine.lfp", ".package-0001.12-0123abcd.tmp.lfp",
        "package-0000-of-frames-2.lfp"})
    std::ofstream(folder_ / name) << "old";
  EXPECT_EQ(Open().error().kind, ErrorKind::kUsage);
  {
    PackageFolder folder = *Open(true);
    ASSERT_TRUE(folder.Add("package-0000", SmallPackage(), {}));
    EXPECT_EQ(fs::file_size(folder_ / "package-0000.lfp"), 3u);
    EXPECT_TRUE(fs::exists(folder_ / "package-0007.lfp"));
    ASSERT_TRUE(folder.Publish());
  }
  EXPECT_EQ(Names(), (std::vector<std::string>{"mine.lfp", "package-0000.lfp"}));
  EXPECT_GT(fs::file_size(folder_ / "package-0000.lfp"), 3u);
}

TEST_F(PackageFolderTest, PartsOfAFilmShareTheFolder) {
  fs::create_directories(folder_);
  for (const char* const name : {"package-0000.lfp", "package-0000-of-frames-2.lfp"})
    std::ofstream(folder_ / name) << "old";
  EXPECT_FALSE(Open(false, "-of-frames-2"));
  {
    PackageFolder folder = *Open(false, "-of-frames-3");
    ASSERT_TRUE(folder.Add("package-0000-of-frames-3", SmallPackage(), {}));
    ASSERT_TRUE(folder.Publish());
  }
  EXPECT_EQ(Names().size(), 3u);
}

}  // namespace
}  // namespace lf
