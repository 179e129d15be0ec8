#include "lf/render/pipeline/render_packages.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/pixels/files/test_folder.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/render/package/package_file.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

// Packages of one film of three frames; each package has other frames.
class OpenPackagesTest : public FolderTest {
 protected:
  // Writes the package of one frame, after `change` has changed it. Returns the path of the file.
  template <class Change>
  fs::path Packed(uint32_t frame, const Change& change) {
    CameraPath film;
    film.cameras = testing::NoiseFrames();
    Package package = PackageOfAll(testing::NoiseField(2), film, 3);
    package.light_field.folder = folder_;
    package.number = frame;
    package.count = 3;
    package.frames = {{.id = FrameId{frame}}};
    package.choices.has_neighbours = false;
    for (uint32_t i = 0; i < package.light_field.size(); ++i) {
      package.images.emplace_back();
      package.images.back().id = i;
    }
    change(&package);
    const fs::path path = folder_ / ("package-" + std::to_string(frame) + ".lfp");
    const Result<void> written = WritePackage(path, package, {"1", "here"});
    EXPECT_TRUE(written) << written.error().message;
    return path;
  }
  fs::path Packed(uint32_t frame) {
    return Packed(frame, [](Package* /*package*/) {});
  }
  // Opens the package of frame 1 together with the changed package of frame 2. Returns the error
  // message; empty if there is no error.
  template <class Change>
  std::string ErrorOf(const Change& change) {
    const Result<PackagedFilm> film = OpenPackages({Packed(1), Packed(2, change)}, {});
    return film ? "" : film.error().message;
  }
};

TEST_F(OpenPackagesTest, PackagesOfOneFilmAreJoined) {
  const Result<PackagedFilm> film = OpenPackages({Packed(1), Packed(3)}, {});
  ASSERT_TRUE(film) << film.error().message;
  ASSERT_EQ(film->parts.size(), 2u);
  EXPECT_EQ(film->parts[1].frames, (std::vector<FrameId>{FrameId{3}}));
  EXPECT_EQ(film->film_count, 3u);
}

TEST_F(OpenPackagesTest, EveryChoiceOfTheFilmIsCompared) {
  const auto expect = [&](const auto& change, const std::string& words) {
    const std::string message = ErrorOf(change);
    EXPECT_NE(message.find("package-2.lfp: was made for " + words), std::string::npos) << message;
  };
  expect([](Package* p) { p->choices.max_angle_rad = 0.5; }, "another --max-angle");
  expect([](Package* p) { p->choices.max_image_count = 2; }, "another --max-images");
  expect([](Package* p) { p->choices.seed = 4; }, "another order");
  expect([](Package* p) { p->choices.order = ImageOrder::kArea; }, "another order");
  expect([](Package* p) { p->path.cameras[2].aperture.blades = 7; }, "another camera path");
  expect([](Package* p) { p->whole.image_count = 5; }, "another light field");
}

TEST_F(OpenPackagesTest, FramesHaveOneOwner) {
  const auto is_of_frame_1 = [](Package* p) { p->frames = {{.id = FrameId{1}}}; };
  EXPECT_NE(ErrorOf(is_of_frame_1).find("both contain frame 1"), std::string::npos);
}

}  // namespace
}  // namespace lf
