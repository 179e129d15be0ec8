// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/check_images.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/storage/load/test_predicted_store.h"

namespace lf {
namespace {

class CheckImagesTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    field_.folder = folder_;
    field_.intrinsics = {{50, 50, 18, 10, 0, 36, 20}};
  }
  void AddCamera(const std::string& name, const std::string& mask = "") {
    field_.cameras.emplace_back();
    field_.image_names.push_back(name);
    field_.mask_names.push_back(mask);
  }
  void AddImage(const std::string& name, int width = 36) {
    const Image<uint8_t> image = NoiseImage<uint8_t>(width, 20, 3);
    ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
  }
  ImageFaults Check(ImageCheck check) {
    CheckOptions options;
    options.check = check;
    Result<ImageFaults> faults = CheckImages(field_, options, pool_);
    EXPECT_TRUE(faults);
    return *faults;
  }
  LightField field_;
  ThreadPool pool_{2};
};

TEST_F(CheckImagesTest, TellMissingFromBrokenAndCountMasks) {
  AddImage("good.png");
  AddImage("wide.png", 37);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "text.png", "no picture"));
  AddCamera("good.png");
  AddCamera("none.png");
  AddCamera("wide.png");
  AddCamera("text.png");
  AddCamera("good.png", "good.png");
  AddCamera("good.png", "none.png");
  AddCamera("good.png", "wide.png");
  const ImageFaults faults = Check(ImageCheck::kHeaders);
  ASSERT_EQ(faults.missing.size(), 2u);
  EXPECT_EQ(faults.missing[0].id.value, 1u);
  EXPECT_EQ(faults.missing[1].id.value, 5u);
  EXPECT_NE(faults.missing[0].reason.find("none.png"), std::string::npos);
  ASSERT_EQ(faults.broken.size(), 3u);
  EXPECT_EQ(faults.broken[0].id.value, 2u);
  EXPECT_NE(faults.broken[0].reason.find("has 37 x 20 pixels, but the calibration says 36 x 20"),
            std::string::npos);
  EXPECT_EQ(faults.broken[1].id.value, 3u);
  EXPECT_EQ(faults.broken[2].id.value, 6u);
}

TEST_F(CheckImagesTest, OnlyThePixelsShowATruncatedFile) {
  AddImage("a.png");
  const std::string bytes = *ReadFile(folder_ / "a.png");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "cut.png", bytes.substr(0, bytes.size() / 2)));
  AddCamera("a.png");
  AddCamera("cut.png");
  EXPECT_TRUE(Check(ImageCheck::kHeaders).broken.empty());
  const ImageFaults faults = Check(ImageCheck::kPixels);
  ASSERT_EQ(faults.broken.size(), 1u);
  EXPECT_EQ(faults.broken[0].id.value, 1u);
}

// Predicted LF images are decoded with their reference images. One that is damaged breaks others.
TEST_F(CheckImagesTest, PredictedImagesAreDecoded) {
  PredictedImages images = MakePredictedImages({});
  const std::filesystem::path path = folder_ / "a.lfs";
  images.Write(path);
  field_ = ReadPackedStore(path)->light_field;
  ImageFaults faults = Check(ImageCheck::kPixels);
  EXPECT_TRUE(faults.missing.empty() && faults.broken.empty());

  images.coded[4].code.resize(images.coded[4].code.size() / 2);
  std::filesystem::remove(path);
  images.Write(path);
  EXPECT_TRUE(Check(ImageCheck::kHeaders).broken.empty());
  faults = Check(ImageCheck::kPixels);
  ASSERT_EQ(faults.broken.size(), 3u);
  EXPECT_EQ(faults.broken[0].id.value, 1u);
  EXPECT_NE(faults.broken[0].reason.find("a.lfs/image1.png: cannot be decoded without the "
                                         "reference image image4.png: "),
            std::string::npos)
      << faults.broken[0].reason;
  EXPECT_EQ(faults.broken[1].id.value, 4u);
  EXPECT_EQ(faults.broken[2].id.value, 6u);
}

TEST_F(CheckImagesTest, ManyImagesAreCountedToTheEnd) {
  AddImage("a.png");
  for (int i = 0; i < 1300; ++i) AddCamera(i % 13 == 5 ? "none.png" : "a.png");
  CheckOptions options;
  std::vector<size_t> seen;
  options.progress = [&](size_t done, size_t total) {
    EXPECT_EQ(total, 1300u);
    seen.push_back(done);
  };
  EXPECT_EQ(CheckImages(field_, options, pool_)->missing.size(), 100u);
  EXPECT_EQ(seen.back(), 1300u);

  const std::atomic<bool> interrupted = true;
  options.interrupted = &interrupted;
  EXPECT_EQ(CheckImages(field_, options, pool_).error().kind, ErrorKind::kInterrupted);
}

}  // namespace
}  // namespace lf
