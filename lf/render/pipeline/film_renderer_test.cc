// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/film_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lf/film/develop/frame_file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/state/run_state.h"

namespace lf {
namespace {

using testing::kHeight;
using testing::kWidth;

const std::vector<FrameId> kThird = {FrameId{3}};

// A grid of LF images of noise in a folder, and a film of three frames.
class FilmRendererTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    LightField field = testing::NoiseField(12);
    field.folder = folder_;
    for (uint32_t i = 0; i < field.size(); ++i) {
      field.image_names[i] += ".png";
      Image<uint8_t> image(kWidth, kHeight, 3);
      for (size_t k = 0; k < image.pixels().size(); ++k)
        image.pixels()[k] = static_cast<uint8_t>(RandomBits(7, i, k));
      ASSERT_TRUE(WriteImage(field.ImagePath({i}), image.view()));
    }
    CameraPath path;
    path.cameras = testing::NoiseFrames();
    film_ = PackageOfAll(std::move(field), std::move(path), 3);
    // Most tests compare counts of rays.
    options_.reading.estimator = Estimator::kNearest;
    options_.lens_weights = LensWeights::kNone;
    work_.memory_bytes = size_t{1} << 30;
  }
  std::unique_ptr<FilmRenderer> Open(std::vector<FrameId> frames = {}) {
    auto renderer = FilmRenderer::Open(film_, options_, work_, std::move(frames), pool_);
    EXPECT_TRUE(renderer) << renderer.error().message;
    return *std::move(renderer);
  }
  static void Finish(FilmRenderer& renderer) {
    while (true) {
      const Result<bool> step = renderer.Step();
      ASSERT_TRUE(step) << step.error().message;
      if (!*step) return;
    }
  }
  // Returns a state with what the renderer has collected, in which frame 1 is finished.
  std::unique_ptr<RunState> StateOf(FilmRenderer& renderer) {
    RunStateOptions options;
    options.folder = folder_ / "state";
    std::filesystem::remove_all(options.folder);
    options.frames = renderer.setup().frames();
    options.picture = {{"picture.format", "exr"}};
    {
      const auto state = RunState::Open(options, renderer.setup().path()).value();
      const RenderedFrame frame = renderer.Develop(0).value();
      EXPECT_TRUE(renderer.Save(state.get()));
      EXPECT_TRUE(WritePicture(renderer.NotesOf(0), frame.picture, state->FinishedPath(FrameId{1}),
                               options.format, {}, {}));
      EXPECT_TRUE(state->SaveFinished(frame.report));
    }
    options.resume = true;
    return RunState::Open(options, renderer.setup().path()).value();
  }
  // Returns the pixels of the frame's file, after a render into a folder.
  Image<float> OfFolder(FrameId frame) {
    RenderOptions options;
    options.film = options_;
    options.work.memory_bytes = work_.memory_bytes;
    options.folder.output_folder = folder_ / ("film" + std::to_string(++folder_count_));
    options.folder.format = FrameFormat::kExrFloat;
    const Result<RenderReport> report = Render(film_, options, pool_, nullptr);
    EXPECT_TRUE(report) << report.error().message;
    const auto file = FramePath(options.folder.output_folder, frame, options.folder.format);
    return std::get<Image<float>>(ReadImage(file).value());
  }
  static void ExpectSame(const Image<float>& file, const Image<float>& rgb) {
    ASSERT_EQ(file.width(), rgb.width());
    ASSERT_EQ(file.height(), rgb.height());
    for (int y = 0; y < rgb.height(); ++y)
      for (int x = 0; x < rgb.width(); ++x)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(file.at(x, y, c), rgb.at(x, y, c)) << x << " " << y;
  }

  Package film_;
  FilmSettings options_;
  WorkSettings work_;
  ThreadPool pool_{2};

 private:
  int folder_count_ = 0;
};

TEST_F(FilmRendererTest, FramesAreThoseOfAFolderInEveryMode) {
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid})
    for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto}) {
      SCOPED_TRACE(std::string(NameOf(mode)) + " " + NameOf(weights));
      options_.mode = mode;
      options_.lens_weights = weights;
      options_.rebin.max_cells = options_.Rebins() ? 100000 : 0;
      const auto renderer = Open();
      Finish(*renderer);
      ASSERT_EQ(renderer->frame_count(), 3u);
      ExpectSame(OfFolder(renderer->id(1)), renderer->Develop(1)->picture.rgb);
    }
}

// Adds to every frame of a film a shutter of three instants.
void AddShutterTo(CameraPath* path) {
  path->shutter = {180, 3};
  for (const RenderCamera& camera : path->cameras)
    for (int k = 0; k < 3; ++k) {
      RenderCamera instant = camera;
      instant.pinhole.cam_from_world.translation.x() += 0.004 * (k - 1);
      instant.aperture.radius_w *= 1 + 0.05 * k;
      path->instants.push_back(instant);
    }
}

TEST_F(FilmRendererTest, AFrameWithAShutterIsTheSumOfItsInstants) {
  options_.reading.estimator = Estimator::kBilinear;
  const std::vector<RenderCamera> frames = film_.path.cameras;
  AddShutterTo(&film_.path);
  const auto renderer = Open();
  Finish(*renderer);
  for (size_t f = 0; f < 3; ++f) {
    Package alone = film_;
    alone.path.shutter = {};
    alone.path.instants.clear();
    const auto instants = film_.path.Instants(FrameId{static_cast<uint32_t>(f + 1)});
    alone.path.cameras.assign(instants.begin(), instants.end());
    auto other = FilmRenderer::Open(alone, options_, work_, {}, pool_).value();
    Finish(*other);
    SensorPlate sum(renderer->plate(f).width(), renderer->plate(f).height());
    for (size_t k = 0; k < 3; ++k) sum.Merge(other->plate(k));
    EXPECT_EQ(renderer->plate(f), sum);
  }
  EXPECT_EQ(renderer->NotesOf(0).shutter->shutter.samples, 3);
  for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto}) {
    options_.lens_weights = weights;
    const auto weighted = Open();
    Finish(*weighted);
    ExpectSame(OfFolder(weighted->id(1)), weighted->Develop(1)->picture.rgb);
  }
}

TEST_F(FilmRendererTest, RulesAndLimitsHoldForAShutter) {
  options_.reading.estimator = Estimator::kBilinear;
  // The view is so narrow that the LF images see all of it.
  for (RenderCamera& camera : film_.path.cameras)
    camera.pinhole.intrinsics.fx_px = camera.pinhole.intrinsics.fy_px = 200;
  AddShutterTo(&film_.path);
  options_.max_image_count = 5;
  auto renderer = Open();
  Finish(*renderer);
  for (size_t f = 0; f < 3; ++f) EXPECT_EQ(renderer->Progress(f).rays.image_count, 5u);
  options_.max_image_count.reset();
  options_.stop_when.noise = 0.08;
  renderer = Open();
  Finish(*renderer);
  FrameReport report;
  ASSERT_TRUE(renderer->Measure(1, &report));
  ASSERT_TRUE(report.noise && report.noise->reached);
  EXPECT_LE(report.noise.value().reached.value(), 0.08);
  EXPECT_LT(renderer->RankOfEnd(1), 144u);
  ExpectSame(OfFolder(renderer->id(1)), renderer->Develop(1)->picture.rgb);
  options_.stop_when.noise.reset();
  options_.stop_when.samples = 12;  // four at each instant
  renderer = Open();
  Finish(*renderer);
  EXPECT_EQ(renderer->StoppedFrames(), (std::vector<size_t>{0, 1, 2}));
  EXPECT_LT(renderer->RankOfEnd(1), 144u);
}

// If all pixels that frames ask for are kept, frames are the ones that are collected, for every
// lens and every limit.
TEST_F(FilmRendererTest, KeptPixelsGiveTheBitsOfCollection) {
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear})
    for (const int what : {0, 1, 2, 3, 4}) {
      SCOPED_TRACE(std::string(NameOf(estimator)) + " " + std::to_string(what));
      const Package plain = film_;
      options_ = {};
      options_.reading.estimator = estimator;
      for (RenderCamera& camera : film_.path.cameras) {
        if (what == 1) camera.hood = {0.05, 0.02};
        if (what == 2) camera.aperture.radius_w = 0.001;  // a lens between LF cameras
      }
      if (what == 3) AddShutterTo(&film_.path);
      if (what == 4) options_.max_image_count = 7;
      const auto collected = Open();
      Finish(*collected);
      options_.rebin.max_cells = 10'000'000;
      for (const RenderMode mode : {RenderMode::kRebin, RenderMode::kHybrid}) {
        options_.mode = mode;
        const auto kept = Open();
        Finish(*kept);
        EXPECT_TRUE(kept->pixels()->facts().keeps_all);
        for (size_t f = 0; f < 3; ++f) {
          const auto picture = kept->Develop(f);
          ASSERT_TRUE(picture) << picture.error().message;
          const auto expected = collected->Develop(f);
          EXPECT_EQ(kept->PictureOf(f), collected->plate(f));
          EXPECT_EQ(picture->report.rays.accepted_count, expected->report.rays.accepted_count);
          // A hybrid completes what collection leaves open.
          const LargeVector<float>& share = picture->picture.interpolated.pixels();
          if (std::all_of(share.begin(), share.end(), [](float part) { return part == 0; })) {
            EXPECT_EQ(picture->picture.rgb.pixels(), expected->picture.rgb.pixels());
          }
        }
        ExpectSame(OfFolder(kept->id(1)), kept->Develop(1)->picture.rgb);
      }
      film_ = plain;
    }
}

// A frame gets light for the part of its lens that no LF camera sees through.
TEST_F(FilmRendererTest, AHybridCompletesALensBeyondTheCapture) {
  options_ = {};
  options_.mode = RenderMode::kHybrid;
  options_.rebin.max_cells = 10'000'000;
  for (const bool has_shutter : {false, true}) {
    SCOPED_TRACE(has_shutter);
    film_.path.cameras = testing::NoiseFrames();
    for (RenderCamera& camera : film_.path.cameras) camera.aperture.radius_w = 0.08;
    if (has_shutter) AddShutterTo(&film_.path);
    const auto renderer = Open();
    Finish(*renderer);
    const RenderedFrame frame = renderer->Develop(1).value();
    ASSERT_FALSE(frame.picture.interpolated.empty());
    EXPECT_GT(frame.picture.interpolated.at(40, 30), 0.2);
    EXPECT_LT(frame.picture.interpolated.at(40, 30), 0.9);
    const FilmSettings hybrid = std::exchange(options_, {});
    const auto collected = Open();
    Finish(*collected);
    EXPECT_EQ(renderer->plate(1), collected->plate(1));
    EXPECT_NE(collected->Develop(1)->picture.rgb.pixels(), frame.picture.rgb.pixels());
    options_ = hybrid;
    ExpectSame(OfFolder(renderer->id(1)), frame.picture.rgb);
  }
}

TEST_F(FilmRendererTest, PixelsAtEdgesAreTheSameForAnyThreadsAndInterruptions) {
  options_ = {};
  options_.mode = RenderMode::kRebin;
  options_.rebin.kept = KeptRays::kEdges;
  options_.rebin.max_cells = 3000;  // far too few
  const auto whole = Open();
  Finish(*whole);
  EXPECT_TRUE(whole->pixels()->facts().is_full);
  EXPECT_LE(whole->pixels()->kept().size(), 3000u);
  const auto begun = Open();
  ASSERT_TRUE(begun->Step().value());
  FilmRenderer renderer(begun->setup(), begun->setup().frames());
  const auto earlier = StateOf(*begun);
  ASSERT_TRUE(renderer.Begin(earlier.get()));
  EXPECT_GT(renderer.pixels()->ranks_done(), 0u);
  Finish(renderer);
  EXPECT_EQ(renderer.Develop(1)->picture.rgb.pixels(), whole->Develop(1)->picture.rgb.pixels());
}

TEST_F(FilmRendererTest, CellsRefuseAShutter) {
  AddShutterTo(&film_.path);
  options_.rebin.interpolation = RayInterpolation::kCells;
  for (const RenderMode mode : {RenderMode::kRebin, RenderMode::kHybrid}) {
    options_.mode = mode;
    const auto renderer = FilmRenderer::Open(film_, options_, work_, {}, pool_);
    ASSERT_FALSE(renderer);
    EXPECT_EQ(renderer.error().kind, ErrorKind::kUsage);
    EXPECT_NE(renderer.error().message.find("use {interpolation pixels} or {mode collect}"),
              std::string::npos);
  }
  options_.mode = RenderMode::kCollect;
  options_.rebin = {};
  film_.whole_virtual_count = 1;
  const auto guarded = FilmRenderer::Open(film_, options_, work_, {}, pool_);
  ASSERT_FALSE(guarded);
  EXPECT_NE(guarded.error().message.find("add {guard off}"), std::string::npos);
}

TEST_F(FilmRendererTest, StopRulesAreThoseOfAFolder) {
  options_.reading.estimator = Estimator::kBilinear;
  options_.stop_when.samples = 4;
  // The view is so narrow that the LF images see all of it.
  for (RenderCamera& camera : film_.path.cameras)
    camera.pinhole.intrinsics.fx_px = camera.pinhole.intrinsics.fy_px = 200;
  const auto renderer = Open();
  Finish(*renderer);
  EXPECT_EQ(renderer->StoppedFrames(), (std::vector<size_t>{0, 1, 2}));
  EXPECT_LT(renderer->RankOfEnd(1), 144u);
  FrameReport report;
  ASSERT_TRUE(renderer->Measure(1, &report));
  EXPECT_GE(report.samples.value().measured.share, kMostElements);
  ExpectSame(OfFolder(renderer->id(1)), renderer->Develop(1)->picture.rgb);
}

TEST_F(FilmRendererTest, PicturesBetweenStepsChangeNothing) {
  const auto looked_at = Open({FrameId{2}}), alone = Open({FrameId{2}});
  std::map<float, int> sums;  // number of pictures, by the sum of their values
  for (bool is_going_on = true; is_going_on;) {
    is_going_on = looked_at->Step().value();
    const RenderedFrame frame = looked_at->Develop(0).value();
    float sum = 0;
    for (const float value : frame.picture.rgb.pixels()) sum += value;
    ++sums[sum];
  }
  Finish(*alone);
  EXPECT_GT(sums.size(), 2u);
  EXPECT_EQ(looked_at->Develop(0)->picture.rgb.pixels(), alone->Develop(0)->picture.rgb.pixels());
}

TEST_F(FilmRendererTest, AnInterruptedStepGoesOn) {
  const auto whole = Open();
  Finish(*whole);
  std::atomic<bool> interrupted = true;
  work_.interrupted = &interrupted;
  const auto renderer = Open();
  const Result<bool> step = renderer->Step();
  ASSERT_FALSE(step);
  EXPECT_EQ(step.error().kind, ErrorKind::kInterrupted);
  interrupted = false;
  Finish(*renderer);
  EXPECT_EQ(renderer->Develop(2)->picture.rgb.pixels(), whole->Develop(2)->picture.rgb.pixels());
}

TEST_F(FilmRendererTest, GoesOnFromAnEarlierRun) {
  const auto begun = Open(), whole = Open();
  ASSERT_TRUE(begun->Step().value());
  Finish(*whole);
  FilmRenderer renderer(begun->setup(), begun->setup().frames());
  const auto earlier = StateOf(*begun);
  ASSERT_TRUE(renderer.Begin(earlier.get(), kThird));
  EXPECT_TRUE(renderer.IsReleased(0));
  EXPECT_TRUE(renderer.EndsEarly(2));
  Finish(renderer);
  EXPECT_EQ(renderer.Progress(1).rays.accepted_count, whole->Progress(1).rays.accepted_count);
  EXPECT_EQ(renderer.Develop(1)->picture.rgb.pixels(), whole->Develop(1)->picture.rgb.pixels());
  EXPECT_EQ(renderer.Develop(2)->picture.rgb.pixels(), begun->Develop(2)->picture.rgb.pixels());
  EXPECT_NE(renderer.Develop(2)->picture.rgb.pixels(), whole->Develop(2)->picture.rgb.pixels());
}

TEST_F(FilmRendererTest, AFrameThatHasAllItsRaysIsNotCutShort) {
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid}) {
    SCOPED_TRACE(std::string(NameOf(mode)));
    options_.mode = mode;
    options_.rebin.max_cells = options_.Rebins() ? 100000 : 0;
    const auto whole = Open();
    Finish(*whole);
    FilmRenderer renderer(whole->setup(), whole->setup().frames());
    const auto earlier = StateOf(*whole);
    ASSERT_TRUE(renderer.Begin(earlier.get(), kThird));
    EXPECT_FALSE(renderer.EndsEarly(2));
    Finish(renderer);
    EXPECT_FALSE(renderer.NotesOf(2).ranks_done);
    EXPECT_EQ(renderer.Develop(2)->picture.rgb.pixels(), whole->Develop(2)->picture.rgb.pixels());
  }
}

TEST_F(FilmRendererTest, TooManyFramesAtATimeAreRefused) {
  for (int i = 0; i < 2000; ++i) {
    film_.path.cameras.push_back(film_.path.cameras.front());
    film_.path.cameras.back().pinhole.intrinsics = {800, 800, 400, 300, 0, 800, 600};
    film_.frames.push_back({.id = FrameId{static_cast<uint32_t>(4 + i)}});
  }
  for (size_t i = 0; i < 3; ++i)
    film_.path.cameras[i].pinhole.intrinsics = film_.path.cameras.back().pinhole.intrinsics;
  const auto renderer = FilmRenderer::Open(film_, options_, work_, {}, pool_);
  ASSERT_FALSE(renderer);
  EXPECT_EQ(renderer.error().kind, ErrorKind::kOutput);
  EXPECT_NE(renderer.error().message.find("2003 frames cannot be rendered at the same time"),
            std::string::npos)
      << renderer.error().message;
}

TEST_F(FilmRendererTest, AFilmWithoutLfImagesSaysSo) {
  film_.path.cameras[0].pinhole.cam_from_world = *LookAlong({100, 0, 0}, {0, 0, 1}, {0, -1, 0});
  const auto renderer = Open({FrameId{1}});
  const Result<void> checked = renderer->CheckAnyContributes();
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().kind, ErrorKind::kInput);
  EXPECT_FALSE(Open({FrameId{2}})->images().empty());
}

TEST_F(FilmRendererTest, BrokenLfImagesAreNamed) {
  for (uint32_t i = 0; i < film_.light_field.size(); ++i)
    std::filesystem::resize_file(film_.light_field.ImagePath({i}), 100);
  const auto renderer = Open({FrameId{2}});
  Finish(*renderer);
  EXPECT_TRUE(renderer->AllBroken());
  const Result<void> checked = renderer->CheckNotAllBroken();
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("image"), std::string::npos);
}

}  // namespace
}  // namespace lf
