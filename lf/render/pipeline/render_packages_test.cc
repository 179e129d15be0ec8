// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/render_packages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lf/pixels/files/image_file.h"
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
  expect([](Package* p) { p->choices.max_angle_rad = 0.5; }, "another {max_angle_deg}");
  expect([](Package* p) { p->choices.max_image_count = 2; }, "another {max_images}");
  expect([](Package* p) { p->choices.seed = 4; }, "another order");
  expect([](Package* p) { p->choices.order = ImageOrder::kArea; }, "another order");
  expect([](Package* p) { p->path.cameras[2].aperture.blades = 7; }, "another camera path");
  expect(
      [](Package* p) {
        p->path.first_frame = 1001;
        for (PackageFrame& frame : p->frames) frame.id.value += 1000;
      },
      "another camera path");
  expect([](Package* p) { p->whole.image_count = 5; }, "another light field");
}

TEST_F(OpenPackagesTest, FramesHaveOneOwner) {
  const auto is_of_frame_1 = [](Package* p) { p->frames = {{.id = FrameId{1}}}; };
  EXPECT_NE(ErrorOf(is_of_frame_1).find("both contain frame 1"), std::string::npos);
}

TEST_F(OpenPackagesTest, ReportAndProgressAddUpThePackages) {
  const auto with_images = [this](Package* package) {
    LightField& field = package->light_field;
    package->choices.has_neighbours = true;
    package->choices.mode = RenderMode::kHybrid;
    package->surroundings.resize(package->path.cameras.size(), {0.03, 0.01, Vec3::Zero(), 0});
    for (uint32_t i = 0; i < field.size(); ++i) {
      field.image_names[i] += ".png";
      Image<uint8_t> image(testing::kWidth, testing::kHeight, 3);
      for (size_t k = 0; k < image.pixels().size(); ++k)
        image.pixels()[k] = static_cast<uint8_t>(RandomBits(7, i, k));
      ASSERT_TRUE(WriteImage(folder_ / field.image_names[i], image.view()));
      package->images[i].rect = {0, 0, testing::kWidth, testing::kHeight};
      package->images[i].frame_count = 1;
    }
  };
  const std::vector<fs::path> paths = {Packed(1, with_images), Packed(3, with_images)};
  ThreadPool pool(2);
  RenderOptions options;
  options.film.mode = RenderMode::kRebin;
  options.folder.contact_sheet = false;
  const auto render = [&](const std::string& name, const std::vector<fs::path>& files,
                          RenderProgress* last) {
    options.folder.output_folder = folder_ / name;
    Result<PackagedFilm> film = OpenPackages(files, {});
    EXPECT_TRUE(film) << film.error().message;
    auto report = RenderPackages(*std::move(film), options, pool, [&](const RenderProgress& now) {
      EXPECT_GE(now.image_count, last->image_count);
      *last = now;
    });
    EXPECT_TRUE(report) << report.error().message;
    return *std::move(report);
  };
  RenderProgress first_last, second_last, last;
  const RenderReport first = render("first", {paths[0]}, &first_last);
  const RenderReport second = render("second", {paths[1]}, &second_last);
  const RenderReport both = render("both", paths, &last);
  ASSERT_TRUE(first.rebinning && second.rebinning && both.rebinning);
  EXPECT_GT(second.rebinning->looked_at_count, 0u);
  EXPECT_EQ(both.rebinning->looked_at_count,
            first.rebinning->looked_at_count + second.rebinning->looked_at_count);
  EXPECT_EQ(both.rebinning->cell_count,
            std::max(first.rebinning->cell_count, second.rebinning->cell_count));
  EXPECT_GT(second_last.image_count, 0u);
  EXPECT_EQ(last.image_count, first_last.image_count + second_last.image_count);
  EXPECT_EQ(last.image_total, last.image_count);
}

}  // namespace
}  // namespace lf
