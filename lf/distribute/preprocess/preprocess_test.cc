// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/preprocess.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/package/package_file.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

// Returns frames that move across the noise field and beyond its border.
CameraPath Film() {
  CameraPath film;
  for (int i = 0; i < 10; ++i) {
    RenderCamera frame = testing::NoiseFrames()[static_cast<size_t>(i % 3)];
    frame.pinhole.cam_from_world =
        *LookAlong({-0.03 + 0.01 * i, 0.002 * i, -0.01 * (i % 2)}, {0, 0, 1}, {0, -1, 0});
    frame.aperture.radius_w = 0.004 + 0.001 * i;
    frame.focus_distance_w = 1 + i % 3;
    frame.focus_plane = FocusPlane(frame.pinhole, frame.focus_distance_w, {});
    film.cameras.push_back(frame);
  }
  return film;
}

class PreprocessTest : public ::testing::Test {
 protected:
  PreprocessTest()
      : field_(testing::NoiseField(24)),
        film_(Film()),
        folder_(fs::temp_directory_path() /
                ("lf_preprocess_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    options_.output_folder = folder_;
    options_.package_count = 3;
    options_.film.seed = 5;
  }
  ~PreprocessTest() override { fs::remove_all(folder_); }

  PreprocessReport Run() {
    Result<PreprocessReport> report = Preprocess(field_, film_, options_, pool_, nullptr);
    EXPECT_TRUE(report) << report.error().message;
    return *std::move(report);
  }
  Package Read(const PackageForecast& forecast) const {
    Result<Package> package = ReadPackage(folder_ / (forecast.name + ".lfp"));
    EXPECT_TRUE(package) << package.error().message;
    return *std::move(package);
  }
  // Expects that the frames of the package need the same LF images, with the same lens weights, as
  // in the whole light field.
  void ExpectPackageIsAsGoodAsTheWhole(const Package& package, const NeedsOptions& needs);

  LightField field_;
  CameraPath film_;
  fs::path folder_;
  PreprocessOptions options_;
  ThreadPool pool_{2};
};

void PreprocessTest::ExpectPackageIsAsGoodAsTheWhole(const Package& package,
                                                     const NeedsOptions& needs) {
  const ImageIndex whole(field_, RanksOf(options_.film.order, field_, options_.film.seed)),
      part(package.light_field, package.ranks);
  EXPECT_EQ(package.whole, IdentityOf(field_));
  for (size_t i = 0; i < package.images.size(); ++i)
    EXPECT_EQ(package.ranks.of_images[i], whole.RankOf(LfImageId{package.images[i].id}));
  std::map<uint32_t, PackageImage> images;  // by id in the whole light field
  for (const PackageFrame& frame : package.frames) {
    const RenderCamera& camera = film_.Camera(frame.id);
    const FrameLens lens(whole, camera, needs.lens_weights, needs.select, pool_);
    const FrameLens again(part, package.path.Camera(frame.id), needs.lens_weights, needs.select,
                          pool_, package.CameraDistance(frame.id));
    EXPECT_EQ(lens.camera().aperture.radius_w, again.camera().aperture.radius_w);
    const FrameNeeds wanted = NeedsOf(whole, camera, needs, pool_);
    EXPECT_EQ(frame.ray_count, wanted.RayCount());
    EXPECT_EQ(frame.image_count, std::count_if(wanted.images.begin(), wanted.images.end(),
                                               [this](const FrameNeeds::Image& image) {
                                                 return !field_.cameras[image.id.value].is_virtual;
                                               }));
    for (const FrameNeeds::Image& image : wanted.images) {
      PackageImage& all = images[image.id.value];
      all.rect = Bounds(all.rect, image.rect);
      all.frame_count += 1;
      all.ray_count += image.ray_count;
      const auto found =
          std::find_if(package.images.begin(), package.images.end(),
                       [&](const PackageImage& known) { return known.id == image.id.value; });
      ASSERT_NE(found, package.images.end());
      const LfImageId id{static_cast<uint32_t>(found - package.images.begin())};
      for (int y = 0; y < 60; y += 7)
        for (int x = 0; x < 80; x += 9)
          ASSERT_EQ(lens.WeightsOf(image.id).At(x, y), again.WeightsOf(id).At(x, y));
    }
    // The package contains all that is needed to compute the same needs.
    const FrameNeeds found =
        NeedsOf(part, package.path.Camera(frame.id), needs, pool_, SamplingOf(package, frame.id));
    ASSERT_EQ(found.images.size(), wanted.images.size());
    for (size_t i = 0; i < found.images.size(); ++i) {
      EXPECT_EQ(package.images[found.images[i].id.value].id, wanted.images[i].id.value);
      EXPECT_EQ(found.images[i].rect, wanted.images[i].rect);
    }
  }
  for (const PackageImage& image : package.images) {
    const PackageImage& expected = images[image.id];
    EXPECT_EQ(image.rect, expected.rect);
    EXPECT_EQ(image.frame_count, expected.frame_count);
    EXPECT_EQ(image.ray_count, expected.ray_count);
  }
}

TEST_F(PreprocessTest, PackagesHaveWhatTheirFramesNeed) {
  for (const LensWeights weights : {LensWeights::kAuto, LensWeights::kNone})
    for (const std::optional<size_t> most : {std::optional<size_t>(), std::optional<size_t>(9)}) {
      options_.film.lens_weights = weights;
      options_.film.max_image_count = most;
      options_.film.max_angle_rad = most ? std::optional<double>() : 0.02;
      options_.overwrite = true;
      const PreprocessReport report = Run();
      ASSERT_EQ(report.packages.size(), 3u);
      NeedsOptions needs;
      needs.select.reach = PixelReach::kElement;
      needs.select.max_angle_rad = options_.film.max_angle_rad;
      needs.lens_weights = weights;
      needs.max_image_count = most;
      std::vector<FrameId> frames;
      for (const PackageForecast& forecast : report.packages) {
        const Package package = Read(forecast);
        EXPECT_EQ(package.FrameIds(), forecast.frames);
        frames.insert(frames.end(), forecast.frames.begin(), forecast.frames.end());
        ExpectPackageIsAsGoodAsTheWhole(package, needs);
        EXPECT_EQ(package.light_field.size(), forecast.image_count + forecast.neighbour_count);
        if (weights == LensWeights::kNone) {
          EXPECT_LT(package.light_field.size(), field_.size());
        }
      }
      EXPECT_EQ(frames.size(), film_.frame_count());
      EXPECT_FALSE(report.rate);  // because there are no image files
      EXPECT_NE(report.rate_error, "");
    }
}

// With a shutter, the lens weights of every instant, and the LF images of the frame, are those of
// the whole light field.
TEST_F(PreprocessTest, PackagesHaveWhatAShutterNeeds) {
  film_.shutter = {180, 3};
  for (const RenderCamera& camera : film_.cameras)
    for (int k = 0; k < 3; ++k) {
      RenderCamera instant = camera;
      instant.pinhole.cam_from_world.translation.x() -= 0.003 * (k - 1);
      instant.aperture.radius_w += 0.0005 * k;
      film_.instants.push_back(instant);
    }
  const ImageIndex whole(field_, RanksOf(options_.film.order, field_, options_.film.seed));
  for (const LensWeights weights : {LensWeights::kAuto, LensWeights::kNone})
    for (const std::optional<size_t> most : {std::optional<size_t>(), std::optional<size_t>(9)}) {
      options_.film.lens_weights = weights;
      options_.film.max_image_count = most;
      options_.overwrite = true;
      NeedsOptions needs;
      needs.select.reach = PixelReach::kElement;
      needs.lens_weights = weights;
      needs.max_image_count = most;
      for (const PackageForecast& forecast : Run().packages) {
        const Package package = Read(forecast);
        ASSERT_EQ(package.path.instants.size(), 30u);
        const ImageIndex part(package.light_field, package.ranks);
        for (const PackageFrame& frame : package.frames) {
          const FrameNeeds wanted = NeedsOf(whole, film_, frame.id, needs, pool_);
          const FrameNeeds found = NeedsOf(part, package.path, frame.id, needs, pool_, &package);
          EXPECT_EQ(frame.image_count, wanted.images.size());
          EXPECT_EQ(frame.ray_count, wanted.RayCount());
          EXPECT_LE(wanted.images.size(), most.value_or(field_.size()));
          ASSERT_EQ(found.images.size(), wanted.images.size());
          for (size_t i = 0; i < found.images.size(); ++i) {
            EXPECT_EQ(package.images[found.images[i].id.value].id, wanted.images[i].id.value);
            EXPECT_EQ(found.images[i].rect, wanted.images[i].rect);
          }
          EXPECT_EQ(package.InstantDistances(frame.id).empty(), weights == LensWeights::kNone);
          const auto lenses =
              LensesOf(whole, film_.Instants(frame.id), weights, needs.select, pool_);
          const auto again = LensesOf(part, package.path.Instants(frame.id), weights, needs.select,
                                      pool_, package.InstantDistances(frame.id));
          for (size_t k = 0; k < 3; ++k)
            for (uint32_t i = 0; i < package.light_field.size(); ++i)
              ASSERT_EQ(again[k].WeightsOf(LfImageId{i}).At(40, 30),
                        lenses[k].WeightsOf(LfImageId{package.images[i].id}).At(40, 30));
        }
      }
    }
  options_.film.rebin.interpolation = RayInterpolation::kCells;
  for (const RenderMode mode : {RenderMode::kRebin, RenderMode::kHybrid}) {
    options_.film.mode = mode;
    options_.film.lens_weights = LensWeights::kAuto;
    options_.film.max_image_count.reset();
    const Result<PreprocessReport> report = Preprocess(field_, film_, options_, pool_, nullptr);
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("shutter"), std::string::npos);
  }
}

// Kept pixels are collected at every instant of a shutter. The hybrid also fills the gaps of each.
TEST_F(PreprocessTest, PackagesHaveWhatKeptPixelsOfAShutterNeed) {
  film_.shutter = {180, 3};
  for (RenderCamera& camera : film_.cameras) {
    camera.aperture.radius_w *= 0.02;  // between LF cameras
    for (int k = 0; k < 3; ++k) {
      RenderCamera instant = camera;
      instant.pinhole.cam_from_world.translation.x() -= 0.003 * (k - 1);
      film_.instants.push_back(instant);
    }
  }
  const ImageIndex whole(field_, RanksOf(options_.film.order, field_, options_.film.seed));
  options_.film.lens_weights = LensWeights::kNone;
  std::map<RenderMode, uint64_t> rays;
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid}) {
    options_.film.mode = mode;
    options_.film.rebin.interpolation =
        Rebins(mode) ? RayInterpolation::kPixels : RayInterpolation::kAuto;
    options_.overwrite = true;
    NeedsOptions needs;
    needs.select.reach = PixelReach::kElement;
    needs.lens_weights = LensWeights::kNone;
    needs.mode = mode;
    needs.rebin.interpolation = RayInterpolation::kPixels;
    for (const PackageForecast& forecast : Run().packages) {
      const Package package = Read(forecast);
      const ImageIndex part(package.light_field, package.ranks);
      for (const PackageFrame& frame : package.frames) {
        const FrameNeeds wanted = NeedsOf(whole, film_, frame.id, needs, pool_);
        const FrameNeeds found = NeedsOf(part, package.path, frame.id, needs, pool_, &package);
        EXPECT_EQ(frame.ray_count, wanted.RayCount());
        ASSERT_EQ(found.images.size(), wanted.images.size());
        for (size_t i = 0; i < found.images.size(); ++i) {
          EXPECT_EQ(package.images[found.images[i].id.value].id, wanted.images[i].id.value);
          EXPECT_EQ(found.images[i].rect, wanted.images[i].rect);
        }
        EXPECT_TRUE(wanted.rebinned_count == 0 || mode == RenderMode::kHybrid);
        rays[mode] += frame.ray_count;
      }
    }
  }
  EXPECT_EQ(rays[RenderMode::kRebin], rays[RenderMode::kCollect]);
  EXPECT_GT(rays[RenderMode::kHybrid], rays[RenderMode::kCollect]);
}

// Guarded frames take more LF images, because recorded LF cameras are farther apart than all, and
// have the lens weights of the whole light field with and without virtual LF images.
TEST_F(PreprocessTest, PackagesHaveWhatTheGuardNeeds) {
  for (uint32_t i = 0; i < field_.size(); ++i) field_.cameras[i].is_virtual = i % 3 != 0;
  const ImageIndex whole(field_, RanksOf(options_.film.order, field_, options_.film.seed));
  std::map<bool, uint64_t> rays;
  for (const LensWeights weights : {LensWeights::kAuto, LensWeights::kNone})
    for (const bool guard : {true, false}) {
      options_.film.lens_weights = weights;
      options_.film.guard = guard;
      options_.overwrite = true;
      NeedsOptions needs;
      needs.select.reach = PixelReach::kElement;
      needs.lens_weights = weights;
      needs.guard = guard;
      for (const PackageForecast& forecast : Run().packages) {
        const Package package = Read(forecast);
        EXPECT_EQ(package.choices.has_neighbours, needs.HasNeighbours());
        ExpectPackageIsAsGoodAsTheWhole(package, needs);
        rays[guard] += forecast.ray_count;
        const ImageIndex part(package.light_field, package.ranks);
        for (const PackageFrame& frame : package.frames) {
          if (!needs.HasNeighbours()) continue;
          const FrameLens lens(whole.recorded(), film_.Camera(frame.id), weights, needs.select,
                               pool_);
          const FrameLens again(part.recorded(), film_.Camera(frame.id), weights, needs.select,
                                pool_, package.RecordedCameraDistance(frame.id));
          for (uint32_t i = 0; i < package.light_field.size(); ++i)
            ASSERT_EQ(again.WeightsOf(LfImageId{i}).At(40, 30),
                      lens.WeightsOf(LfImageId{package.images[i].id}).At(40, 30));
        }
      }
    }
  EXPECT_GT(rays[true], rays[false]);
}

// Packages have the LF images for rebinned rays, even if no ray of an LF camera passes through the
// lens.
TEST_F(PreprocessTest, PackagesHaveWhatTheModeNeeds) {
  for (RenderCamera& camera : film_.cameras) camera.aperture.radius_w *= 0.2;
  for (const RayInterpolation way : {RayInterpolation::kCells, RayInterpolation::kPixels}) {
    std::map<RenderMode, uint64_t> rays;
    for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid}) {
      options_.film.mode = mode;
      options_.film.rebin.interpolation = Rebins(mode) ? way : RayInterpolation::kAuto;
      options_.film.lens_weights = LensWeights::kNone;
      options_.overwrite = true;
      NeedsOptions needs;
      needs.select.reach = PixelReach::kElement;
      needs.lens_weights = LensWeights::kNone;
      needs.mode = mode;
      needs.rebin.interpolation = way;
      for (const PackageForecast& forecast : Run().packages) {
        const Package package = Read(forecast);
        EXPECT_EQ(package.choices.mode, mode);
        EXPECT_EQ(package.choices.interpolation, Rebins(mode) ? way : RayInterpolation::kAuto);
        EXPECT_EQ(package.choices.has_neighbours, Rebins(mode));
        ExpectPackageIsAsGoodAsTheWhole(package, needs);
        rays[mode] += forecast.ray_count;
      }
    }
    if (way == RayInterpolation::kCells) {
      EXPECT_GT(rays[RenderMode::kRebin], rays[RenderMode::kCollect]);
    } else {
      EXPECT_EQ(rays[RenderMode::kRebin], rays[RenderMode::kCollect]);
    }
    EXPECT_GT(rays[RenderMode::kHybrid], rays[RenderMode::kCollect]);
  }
}

// Kept pixels have the weights, limits and guard of collected ones.
TEST_F(PreprocessTest, PackagesHaveWhatKeptPixelsNeed) {
  for (uint32_t i = 0; i < field_.size(); ++i) field_.cameras[i].is_virtual = i % 3 != 0;
  // The view is so narrow that frames need parts of LF images.
  for (RenderCamera& camera : film_.cameras)
    camera.pinhole.intrinsics.fx_px = camera.pinhole.intrinsics.fy_px = 300;
  options_.film.lens_weights = LensWeights::kHat;
  options_.film.max_image_count = 9;
  std::map<RenderMode, std::vector<FrameNeeds>> found;
  const ImageIndex whole(field_, RanksOf(options_.film.order, field_, options_.film.seed));
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid}) {
    options_.film.mode = mode;
    options_.overwrite = true;
    NeedsOptions needs;
    needs.select.reach = PixelReach::kElement;
    needs.lens_weights = LensWeights::kHat;
    needs.max_image_count = 9;
    needs.mode = mode;
    needs.rebin.interpolation = RayInterpolation::kPixels;
    needs.guard = true;
    for (const PackageForecast& forecast : Run().packages)
      ExpectPackageIsAsGoodAsTheWhole(Read(forecast), needs);
    for (const RenderCamera& camera : film_.cameras)
      found[mode].push_back(NeedsOf(whole, camera, needs, pool_));
  }
  const int around = PixelsAround(RebinOptions(), true);
  EXPECT_GT(around, 0);
  const auto grown = [around](const PixelRect& rect) {
    return Intersection(
        {rect.x_begin - around, rect.y_begin - around, rect.x_end + around, rect.y_end + around},
        {0, 0, 64, 48});
  };
  size_t grown_count = 0;
  for (size_t f = 0; f < film_.cameras.size(); ++f) {
    const std::vector<FrameNeeds::Image>& collected = found[RenderMode::kCollect][f].images;
    const std::vector<FrameNeeds::Image>& kept = found[RenderMode::kRebin][f].images;
    ASSERT_EQ(kept.size(), collected.size());
    for (size_t i = 0; i < kept.size(); ++i) {
      EXPECT_EQ(kept[i].id, collected[i].id);
      EXPECT_EQ(kept[i].ray_count, collected[i].ray_count);
      // Edges are found from the pixels around.
      EXPECT_EQ(kept[i].rect, grown(collected[i].rect));
      grown_count += kept[i].rect == collected[i].rect ? 0 : 1;
    }
  }
  EXPECT_GT(grown_count, 0u);
}

TEST_F(PreprocessTest, WhatCellsCannotHaveIsRefused) {
  options_.film.mode = RenderMode::kRebin;
  options_.film.rebin.interpolation = RayInterpolation::kCells;
  for (const bool has_weights : {true, false}) {
    // kAuto means none here.
    options_.film.lens_weights = has_weights ? LensWeights::kHat : LensWeights::kAuto;
    if (!has_weights) options_.film.max_image_count = 5;
    const Result<PreprocessReport> report = Preprocess(field_, film_, options_, pool_, nullptr);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().kind, ErrorKind::kUsage);
    EXPECT_NE(report.error().message.find(has_weights ? "{lens_weights hat}" : "{max_images}"),
              std::string::npos);
    EXPECT_NE(report.error().message.find("{interpolation pixels}"), std::string::npos);
  }
  options_.film.rebin.interpolation = RayInterpolation::kPixels;
  options_.film.rebin.query.lens_sets = 2;
  const Result<PreprocessReport> report = Preprocess(field_, film_, options_, pool_, nullptr);
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("{lens_sets 2}"), std::string::npos);
}

TEST_F(PreprocessTest, FramesAndSectionsAsAsked) {
  options_.package_count.reset();
  EXPECT_EQ(Run().packages.size(), 1u);
  options_.overwrite = true;
  options_.frames_per_package = 4;
  options_.frames = {FrameId{2}, FrameId{3}, FrameId{5}, FrameId{7}, FrameId{8}, FrameId{9}};
  const PreprocessReport report = Run();
  ASSERT_EQ(report.packages.size(), 2u);
  EXPECT_EQ(report.packages[0].frames.size(), 4u);
  EXPECT_EQ(report.packages[1].frames, (std::vector<FrameId>{FrameId{8}, FrameId{9}}));
}

TEST_F(PreprocessTest, APlanWritesNothingAndTellsTheSame) {
  const PreprocessReport written = Run();
  options_.output_folder.reset();
  const PreprocessReport plan = Run();
  ASSERT_EQ(plan.packages.size(), written.packages.size());
  for (size_t i = 0; i < plan.packages.size(); ++i) {
    EXPECT_EQ(plan.packages[i].ray_count, written.packages[i].ray_count);
    EXPECT_EQ(plan.packages[i].image_count, written.packages[i].image_count);
  }
}

TEST_F(PreprocessTest, PackagesThatAreThereAreReplacedOnRequestOnly) {
  Run();
  const Result<PreprocessReport> again = Preprocess(field_, film_, options_, pool_, nullptr);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kUsage);
  EXPECT_NE(again.error().message.find("{overwrite}"), std::string::npos);
  options_.overwrite = true;
  options_.package_count = 2;
  Run();
  EXPECT_TRUE(fs::exists(folder_ / "package-0001.lfp"));
  EXPECT_FALSE(fs::exists(folder_ / "package-0002.lfp"));
}

TEST_F(PreprocessTest, AFilmThatNobodySeesIsAnError) {
  for (RenderCamera& camera : film_.cameras)
    camera.pinhole.cam_from_world = *LookAlong({50, 0, 0}, {0, 0, 1}, {0, -1, 0});
  options_.film.lens_weights = LensWeights::kNone;
  const Result<PreprocessReport> report = Preprocess(field_, film_, options_, pool_, nullptr);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::kInput);
}

TEST_F(PreprocessTest, OrdersAreOfTheWholeFilm) {
  for (const ImageOrder order : {ImageOrder::kRoundRobin, ImageOrder::kArea}) {
    options_.film.order = order;
    options_.overwrite = true;
    const PreprocessReport report = Run();
    std::map<uint32_t, uint32_t> ranks;  // [LF image]
    for (const PackageForecast& forecast : report.packages) {
      const Package package = Read(forecast);
      EXPECT_EQ(package.choices.order, order);
      for (size_t i = 0; i < package.images.size(); ++i) {
        const auto [known, is_new] =
            ranks.emplace(package.images[i].id, package.ranks.of_images[i]);
        EXPECT_EQ(known->second, package.ranks.of_images[i]);
      }
    }
    std::set<uint32_t> distinct;
    for (const auto& [id, rank] : ranks) distinct.insert(rank);
    EXPECT_EQ(distinct.size(), ranks.size());
  }
}

}  // namespace
}  // namespace lf
