// SPDX-License-Identifier: Apache-2.0
// Frames of a densified light field: never worse than those of its recorded LF images alone.
#include <gtest/gtest.h>

#include <algorithm>
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

// A packed store of noise, of whose LF images two of three are virtual; with noise as alpha or not.
class GuardedRenderTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    field_ = testing::NoiseField(9);
    field_.folder = folder_;
    for (uint32_t i = 0; i < field_.size(); ++i) {
      field_.image_names[i] += ".png";
      field_.cameras[i].is_virtual = i % 3 != 0;
    }
    WriteImages(3);
    film_.cameras = testing::NoiseFrames();
    work_.memory_bytes = size_t{1} << 30;
  }
  void WriteImages(int channels) {
    for (uint32_t i = 0; i < field_.size(); ++i) {
      Image<uint8_t> image(testing::kWidth, testing::kHeight, channels);
      for (size_t k = 0; k < image.pixels().size(); ++k)
        image.pixels()[k] = static_cast<uint8_t>(RandomBits(7, i, k));
      ASSERT_TRUE(WriteImage(field_.ImagePath({i}), image.view()));
    }
  }
  void UseAlpha() {
    WriteImages(4);
    field_.encoding.alpha = AlphaMeaning::kStraight;
    field_.encoding.background.emplace();
    field_.encoding.keeps_opacity = true;
  }
  // Writes the store. number_of(id, k) returns number k of the plane of a recorded LF image, which
  // stands for the inverse depth number / 1000. trust_of(id, k) returns the trust in pixel k of a
  // virtual one; null: the store has no trust.
  LightField Densified(const std::function<uint16_t(uint32_t id, size_t k)>& number_of,
                       const std::function<uint8_t(uint32_t id, size_t k)>& trust_of = nullptr) {
    const std::filesystem::path path = folder_ / "dense.lfs";
    PackedStorePlan plan;
    plan.densified = DensifiedPlan{"settings", 0.001, 65.535, 1};
    PackedStoreWriter writer = PackedStoreWriter::Create(path, field_, plan).value();
    for (uint32_t i = 0; i < field_.size(); ++i) {
      const auto image = ReadRecordedImage(field_, {i}, {0, 0, testing::kWidth, testing::kHeight});
      EXPECT_TRUE(writer.Add({i}, CodeOf(*image, {.profile = CodecProfile::kLossless})));
      if (field_.cameras[i].is_virtual) {
        if (!trust_of) continue;
        Image<uint8_t> trust(testing::kWidth, testing::kHeight);
        for (size_t k = 0; k < trust.pixels().size(); ++k) trust.pixels()[k] = trust_of(i, k);
        EXPECT_TRUE(writer.AddTrust({i}, trust));
        continue;
      }
      Image<uint16_t> plane(testing::kWidth, testing::kHeight);
      for (size_t k = 0; k < plane.pixels().size(); ++k) plane.pixels()[k] = number_of(i, k);
      EXPECT_TRUE(writer.AddPlane({i}, PlaneKind::kDisparity, plane));
    }
    EXPECT_TRUE(writer.Finish());
    return ReadPackedStore(path).value().light_field;
  }
  // Depths of noise, some of them unknown, so that elements are in focus in part. Trust of noise,
  // so that elements are trusted in part.
  LightField WithNoiseDepths() {
    return Densified(
        [](uint32_t id, size_t k) {
          return static_cast<uint16_t>(k / 64 % 16 < 8 ? 500 : RandomBits(9, id, k) % 4000);
        },
        [](uint32_t id, size_t k) { return static_cast<uint8_t>(RandomBits(10, id, k)); });
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

// Compares all channels of b with those of a from `a_first` on.
void ExpectHasChannels(const SensorPlate& a, int a_first, const SensorPlate& b) {
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      for (int c = 0; c < b.channels(); ++c)
        ASSERT_EQ(a.At(x, y, a_first + c), b.At(x, y, c)) << x << " " << y << " " << c;
}

TEST_F(GuardedRenderTest, PlatesHoldTheFilmBeforeAndAfterDensifying) {
  LightField densified = WithNoiseDepths();
  for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto, LensWeights::kHat}) {
    options_.lens_weights = weights;
    if (weights == LensWeights::kHat) {
      UseAlpha();
      densified = WithNoiseDepths();
    }
    const auto guarded = Rendered(densified), all = Rendered(densified, false);
    const auto before = Rendered(Recorded());
    for (size_t f = 0; f < 3; ++f) {
      ASSERT_TRUE(guarded->plate(f).is_guarded());
      EXPECT_FALSE(all->plate(f).is_guarded());
      EXPECT_EQ(guarded->plate(f).has_opacity(), densified.encoding.HasOpacity());
      ExpectHasChannels(guarded->plate(f), 0, before->plate(f));
      ExpectHasChannels(guarded->plate(f), guarded->plate(f).all_rays_channel(), all->plate(f));
      const FrameRays rays = guarded->Progress(f).rays;
      EXPECT_EQ(rays.image_count, before->Progress(f).rays.image_count);
      EXPECT_EQ(rays.accepted_count, before->Progress(f).rays.accepted_count);
      const Image<float> effective = guarded->Develop(f)->picture.effective_count;
      EXPECT_EQ(effective.pixels(), before->Develop(f)->picture.effective_count.pixels());
    }
  }
}

// The first frame is focused at the distance 1.
TEST_F(GuardedRenderTest, InFocusThePictureIsThatOfRecordedImages) {
  const auto guarded = Rendered(Densified([](uint32_t, size_t) { return uint16_t{1000}; }));
  const auto before = Rendered(Recorded());
  const DevelopedFrame picture = guarded->Develop(0)->picture, wanted = before->Develop(0)->picture;
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
    const DevelopedFrame picture = guarded->Develop(0)->picture, wanted = all->Develop(0)->picture;
    EXPECT_TRUE(wanted.densified.empty());
    for (int y = 0; y < picture.rgb.height(); ++y)
      for (int x = 0; x < picture.rgb.width(); ++x) {
        ASSERT_EQ(picture.densified.at(x, y), 1);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(picture.rgb.at(x, y, c), wanted.rgb.at(x, y, c), 1e-6);
      }
  }
}

// The trust, E, R and V of the plate give the picture by the formula of doc/densify.md. Without
// lens weights, the number of recorded LF images is not known.
TEST_F(GuardedRenderTest, VirtualLightIsShownAsFarAsItIsTrusted) {
  UseAlpha();
  const LightField field =
      Densified([](uint32_t, size_t) { return uint16_t{20000}; },
                [](uint32_t, size_t k) { return static_cast<uint8_t>(k % 64 < 60 ? 0 : 60); });
  for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto}) {
    options_.lens_weights = weights;
    const auto guarded = Rendered(field);
    const SensorPlate& plate = guarded->plate(0);
    const RenderedFrame rendered = guarded->Develop(0).value();
    const DevelopedFrame& picture = rendered.picture;
    ASSERT_EQ(picture.effective_count.empty(), weights == LensWeights::kNone);
    const auto mean = [&](int x, int y, int channel) {
      return (plate.At(x, y, channel).Mean() - 16384) / 32768;
    };
    size_t recorded = 0, doubtful = 0, seen = 0;
    double densified = 0;
    for (int y = 0; y < plate.height(); ++y)
      for (int x = 0; x < plate.width(); ++x) {
        if (plate.At(x, y, 9).count == 0) continue;
        ++seen;
        const double trust = mean(x, y, 9);
        ASSERT_NEAR(picture.trust.at(x, y), trust, 1e-6);
        const double s = std::clamp((trust - 0.3) / 0.15, 0.0, 1.0);
        const double single = weights == LensWeights::kNone
                                  ? 1
                                  : std::clamp(2.0 - picture.effective_count.at(x, y), 0.0, 1.0);
        const bool is_recorded = plate.At(x, y, 4).count > 0;
        const double t = is_recorded ? 1 - single * (1 - s * s * (3 - 2 * s)) : 1;
        densified += t;
        doubtful += trust < 0.8 ? 1 : 0;
        ASSERT_NEAR(picture.densified.at(x, y), t, 1e-5);
        recorded += t < 0.999 ? 1 : 0;
        const double all = mean(x, y, 8), opacity = is_recorded ? mean(x, y, 3) : all;
        ASSERT_NEAR(picture.opacity.at(x, y), std::clamp(opacity + t * (all - opacity), 0.0, 1.0),
                    1e-5);
      }
    // Few, because recorded rays, which are trusted, have a part in most elements; and none where
    // several LF images are known to be recorded.
    if (weights == LensWeights::kNone)
      EXPECT_GT(recorded, 10u);
    else
      EXPECT_EQ(recorded, 0u);
    EXPECT_GT(doubtful, 50u);
    EXPECT_GT(seen, recorded + 100);
    const auto count = static_cast<double>(seen);
    ASSERT_TRUE(rendered.report.virtual_light);
    EXPECT_NEAR(rendered.report.virtual_light->densified_share, densified / count, 1e-5);
    EXPECT_NEAR(rendered.report.virtual_light->doubtful_share,
                static_cast<double>(doubtful) / count, 1e-9);
  }
}

// Stores of earlier builds have no trust.
TEST_F(GuardedRenderTest, AStoreWithoutTrustIsTrusted) {
  const auto number = [](uint32_t id, size_t k) {
    return static_cast<uint16_t>(RandomBits(9, id, k) % 4000);
  };
  const auto trusted = Rendered(Densified(number, [](uint32_t, size_t) { return uint8_t{255}; }));
  const auto without = Rendered(Densified(number));
  for (size_t f = 0; f < 3; ++f) EXPECT_EQ(without->plate(f), trusted->plate(f));
}

TEST_F(GuardedRenderTest, ShardsPassesAndThreadsGiveTheSameBits) {
  UseAlpha();
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

TEST_F(GuardedRenderTest, CellsAreRefused) {
  const LightField densified = WithNoiseDepths();
  options_.rebin.interpolation = RayInterpolation::kCells;
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
