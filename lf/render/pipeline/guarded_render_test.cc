// SPDX-License-Identifier: Apache-2.0
// Frames of a densified light field: never worse than those of its recorded LF images alone.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/merge_shards.h"
#include "lf/render/pipeline/render.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {
namespace {

// A packed store of noise, of whose LF images two of three are virtual.
class GuardedRenderTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    field_ = testing::NoiseField(9);
    field_.folder = folder_;
    for (uint32_t i = 0; i < field_.size(); ++i) {
      field_.image_names[i] += ".png";
      field_.cameras[i].is_virtual = i % 3 != 0;
      Image<uint8_t> image(testing::kWidth, testing::kHeight, 3);
      for (size_t k = 0; k < image.pixels().size(); ++k)
        image.pixels()[k] = static_cast<uint8_t>(RandomBits(7, i, k));
      ASSERT_TRUE(WriteImage(field_.ImagePath({i}), image.view()));
    }
    film_.cameras = testing::NoiseFrames();
    work_.memory_bytes = size_t{1} << 30;
  }
  // Writes the store. number_of(id, k) returns number k of the plane of a recorded LF image, which
  // stands for the inverse depth number / 1000.
  LightField Densified(const std::function<uint16_t(uint32_t id, size_t k)>& number_of) {
    const std::filesystem::path path = folder_ / "dense.lfs";
    PackedStorePlan plan;
    plan.densified = DensifiedPlan{"settings", 0.001, 65.535, 1};
    PackedStoreWriter writer = PackedStoreWriter::Create(path, field_, plan).value();
    for (uint32_t i = 0; i < field_.size(); ++i) {
      const auto image = ReadRecordedImage(field_, {i}, {0, 0, testing::kWidth, testing::kHeight});
      EXPECT_TRUE(writer.Add({i}, CodeOf(*image, {.profile = CodecProfile::kLossless})));
      if (field_.cameras[i].is_virtual) continue;
      Image<uint16_t> plane(testing::kWidth, testing::kHeight);
      for (size_t k = 0; k < plane.pixels().size(); ++k) plane.pixels()[k] = number_of(i, k);
      EXPECT_TRUE(writer.AddPlane({i}, PlaneKind::kDisparity, plane));
    }
    EXPECT_TRUE(writer.Finish());
    return ReadPackedStore(path).value().light_field;
  }
  // Depths of noise, some of them unknown, so that elements are in focus in part.
  LightField WithNoiseDepths() {
    return Densified([](uint32_t id, size_t k) {
      return static_cast<uint16_t>(k / 64 % 16 < 8 ? 500 : RandomBits(9, id, k) % 4000);
    });
  }
  LightField Recorded() const {
    LightField recorded = field_;
    recorded.cameras.clear();
    recorded.image_names.clear();
    for (uint32_t i = 0; i < field_.size(); ++i) {
      if (field_.cameras[i].is_virtual) continue;
      recorded.cameras.push_back(field_.cameras[i]);
      recorded.image_names.push_back(field_.image_names[i]);
    }
    return recorded;
  }
  std::unique_ptr<FilmRenderer> Rendered(LightField field, bool guard = true) {
    options_.guard = guard;
    auto renderer =
        FilmRenderer::Open(PackageOfAll(std::move(field), film_, 3), options_, work_, {}, pool_);
    EXPECT_TRUE(renderer) << renderer.error().message;
    while ((*renderer)->Step().value()) continue;
    return *std::move(renderer);
  }
  // Renders into a folder. Returns the bytes of the frames by name.
  std::map<std::string, std::string> Frames(const std::string& name, const LightField& field,
                                            const std::function<void(RenderOptions*)>& change) {
    RenderOptions options;
    options.work.memory_bytes = work_.memory_bytes;
    options.folder.output_folder = folder_ / name;
    change(&options);
    const auto report = Render(PackageOfAll(field, film_, 3), options, pool_, nullptr);
    EXPECT_TRUE(report) << report.error().message;
    return FramesIn(folder_ / name);
  }
  static std::map<std::string, std::string> FramesIn(const std::filesystem::path& folder) {
    std::map<std::string, std::string> frames;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".exr")
        frames[entry.path().filename().string()] = *ReadFile(entry.path());
    return frames;
  }

  LightField field_;
  CameraPath film_;
  FilmSettings options_;
  WorkSettings work_;
  ThreadPool pool_{2};
};

// Compares the first `channels` of two plates, from the channels `a_first` and `b_first` on.
void ExpectSameChannels(const SensorPlate& a, int a_first, const SensorPlate& b, int b_first) {
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(a.At(x, y, a_first + c), b.At(x, y, b_first + c)) << x << " " << y << " " << c;
}

TEST_F(GuardedRenderTest, PlatesHoldTheFilmBeforeAndAfterDensifying) {
  const LightField densified = WithNoiseDepths();
  for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto, LensWeights::kHat}) {
    options_.lens_weights = weights;
    const auto guarded = Rendered(densified), all = Rendered(densified, false);
    const auto before = Rendered(Recorded());
    for (size_t f = 0; f < 3; ++f) {
      ASSERT_TRUE(guarded->plate(f).is_guarded());
      EXPECT_FALSE(all->plate(f).is_guarded());
      ExpectSameChannels(guarded->plate(f), 0, before->plate(f), 0);
      ExpectSameChannels(guarded->plate(f), SensorPlate::kAllRaysChannel, all->plate(f), 0);
      const FrameRays rays = guarded->Progress(f).rays;
      EXPECT_EQ(rays.image_count, before->Progress(f).rays.image_count);
      EXPECT_EQ(rays.accepted_count, before->Progress(f).rays.accepted_count);
      const Image<float> effective = guarded->Develop(f).picture.effective_count;
      EXPECT_EQ(effective.pixels(), before->Develop(f).picture.effective_count.pixels());
    }
  }
}

// The first frame is focused at the distance 1.
TEST_F(GuardedRenderTest, InFocusThePictureIsThatOfRecordedImages) {
  const auto guarded = Rendered(Densified([](uint32_t, size_t) { return uint16_t{1000}; }));
  const auto before = Rendered(Recorded());
  const DevelopedFrame picture = guarded->Develop(0).picture, wanted = before->Develop(0).picture;
  size_t count = 0;
  for (int y = 0; y < picture.rgb.height(); ++y)
    for (int x = 0; x < picture.rgb.width(); ++x) {
      if (wanted.ray_count.at(x, y, 0) == 0) continue;
      ++count;
      ASSERT_EQ(picture.densified.at(x, y), 0);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(picture.rgb.at(x, y, c), wanted.rgb.at(x, y, c));
    }
  EXPECT_GT(count, 1000u);
}

TEST_F(GuardedRenderTest, FarOutOfFocusOrAtUnknownDepthsItIsThatOfAll) {
  for (const uint16_t number : {20000, 0}) {
    const LightField densified = Densified([=](uint32_t, size_t) { return number; });
    const auto guarded = Rendered(densified), all = Rendered(densified, false);
    const DevelopedFrame picture = guarded->Develop(0).picture, wanted = all->Develop(0).picture;
    EXPECT_TRUE(wanted.densified.empty());
    for (int y = 0; y < picture.rgb.height(); ++y)
      for (int x = 0; x < picture.rgb.width(); ++x) {
        ASSERT_EQ(picture.densified.at(x, y), 1);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(picture.rgb.at(x, y, c), wanted.rgb.at(x, y, c), 1e-6);
      }
  }
}

TEST_F(GuardedRenderTest, ShardsPassesAndThreadsGiveTheSameBits) {
  const LightField densified = WithNoiseDepths();
  const auto whole = Frames("whole", densified, [](RenderOptions*) {});
  ASSERT_EQ(whole.size(), 3u);
  for (uint32_t k = 1; k <= 2; ++k)
    Frames("shards", densified, [&](RenderOptions* options) { options->film.shard = {k, 2}; });
  MergeOptions merge;
  merge.output_folder = folder_ / "merged";
  const auto merged = MergeShards({folder_ / "shards"}, merge, pool_, nullptr);
  ASSERT_TRUE(merged) << merged.error().message;
  EXPECT_EQ(FramesIn(folder_ / "merged"), whole);
}

// An interrupted render saves its plates, and a resumed one continues from them.
TEST_F(GuardedRenderTest, ResumesToTheSameBits) {
  const LightField densified = WithNoiseDepths();
  const auto whole = Frames("whole", densified, [](RenderOptions*) {});
  RenderSignals signals;
  RenderOptions options;
  options.work.memory_bytes = work_.memory_bytes;
  options.folder.output_folder = folder_ / "cut";
  options.signals = &signals;
  const auto stop = [&](const RenderProgress&) {
    signals.stop = true;
    signals.attention = true;
  };
  const auto cut = Render(PackageOfAll(densified, film_, 3), options, pool_, stop);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().kind, ErrorKind::kInterrupted);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cut" / "partial" / "frame_0001.plate"));
  const auto resumed = Frames("cut", densified, [](RenderOptions* o) { o->folder.resume = true; });
  EXPECT_EQ(resumed, whole);
  // The state of a guarded film is not continued without the guard.
  signals.stop = signals.attention = false;
  options.folder.output_folder = folder_ / "other";
  ASSERT_FALSE(Render(PackageOfAll(densified, film_, 3), options, pool_, stop));
  ASSERT_TRUE(std::filesystem::exists(folder_ / "other" / "partial" / "frame_0001.plate"));
  signals.stop = signals.attention = false;
  options.folder.resume = true;
  options.film.guard = false;
  const auto refused = Render(PackageOfAll(densified, film_, 3), options, pool_, nullptr);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message.find("guard"), std::string::npos);
}

TEST_F(GuardedRenderTest, RebinnedRaysAreRefused) {
  const LightField densified = WithNoiseDepths();
  for (const RenderMode mode : {RenderMode::kRebin, RenderMode::kHybrid}) {
    options_.mode = mode;
    const auto refused =
        FilmRenderer::Open(PackageOfAll(densified, film_, 3), options_, work_, {}, pool_);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
    EXPECT_NE(refused.error().message.find("{guard off}"), std::string::npos);
  }
}

}  // namespace
}  // namespace lf
