// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "lf/focus/example_path.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

// Counts the calls of Load(). Only the LF image `good` can be loaded.
class CountingStore : public LfImageStore {
 public:
  Result<void> Load(LfImageId id, const PixelRect&, LfPixels*) const override {
    ++load_count;
    return id == good ? Result<void>() : InputError("broken");
  }
  LfImageId good{UINT32_MAX};
  mutable int load_count = 0;
};

class FirstCameraTest : public ::testing::Test {
 protected:
  FirstCameraTest() {
    field_.folder =
        fs::temp_directory_path() / ("lf_first_camera_test." + std::to_string(::getpid()));
    fs::create_directories(field_.folder);
    field_.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
    for (uint32_t i = 0; i < 2001; ++i) {
      LfCamera camera;
      camera.cam_from_world.translation.x() = -static_cast<double>(i);
      field_.cameras.push_back(camera);
      field_.image_names.push_back("images/" + std::to_string(i) + ".png");
    }
  }
  ~FirstCameraTest() override { fs::remove_all(field_.folder); }
  void Write(uint32_t id) {
    fs::create_directories(field_.folder / "images");
    std::ofstream(field_.ImagePath(LfImageId{id})) << "x";
  }

  LightField field_;
  CountingStore store_;
};

TEST_F(FirstCameraTest, MissingImagesAreNotOpenedOneByOne) {
  const Result<LfImageId> found = FirstCamera(field_, store_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->value, 1000u);  // in the middle
  EXPECT_LE(store_.load_count, 2);
}

TEST_F(FirstCameraTest, TheNearestImageThatCanBeReadIsFound) {
  Write(950);
  Write(1400);
  Write(1990);
  store_.good = {1400};
  const Result<LfImageId> found = FirstCamera(field_, store_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->value, 1400u);
  EXPECT_LE(store_.load_count, 4);
}

}  // namespace
}  // namespace lf
