// SPDX-License-Identifier: Apache-2.0
// A render from a packed store is bit-identical to the render from the image files.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>

#include "lf/core/file.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/render/pipeline/render.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {
namespace {

using testing::kHeight;
using testing::kWidth;

class PackedRenderTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    field_ = testing::NoiseField(4);
    field_.folder = folder_;
    film_.cameras = testing::NoiseFrames();
    store_ = folder_ / "store.lfs";
  }
  template <class T>
  void WriteImages(int channels, const std::string& extension) {
    for (uint32_t i = 0; i < field_.size(); ++i) {
      field_.image_names[i] = "image" + std::to_string(i) + extension;
      Image<T> image(kWidth, kHeight, channels);
      for (size_t k = 0; k < image.pixels().size(); ++k)
        image.pixels()[k] = static_cast<T>(RandomBits(7, i, k));
      ASSERT_TRUE(WriteImage(field_.ImagePath({i}), image.view()));
    }
  }
  LightField Packed(uint64_t shard_bytes = 0) {
    PackedStorePlan plan;
    plan.shard_bytes = shard_bytes;
    if (HasVirtual(field_)) plan.densified = DensifiedPlan{"steps 5", 0.1, 2, 2};
    PackedStoreWriter writer = PackedStoreWriter::Create(store_, field_, plan).value();
    for (uint32_t i = 0; i < field_.size(); ++i) {
      const auto image = ReadRecordedImage(field_, {i}, {0, 0, kWidth, kHeight});
      EXPECT_TRUE(writer.Add({i}, CodeOf(*image, {.profile = CodecProfile::kLossless})));
    }
    EXPECT_TRUE(writer.Finish());
    return ReadPackedStore(store_).value().light_field;
  }
  Result<RenderReport> RenderTo(const std::string& name, LightField field) {
    options_.folder.output_folder = folder_ / name;
    return Render(PackageOfAll(std::move(field), film_, 3), options_, pool_, nullptr);
  }
  std::map<std::string, std::string> Frames(const std::string& name) {
    std::map<std::string, std::string> frames;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / name))
      if (entry.path().extension() == ".exr")
        frames[entry.path().filename().string()] = *ReadFile(entry.path());
    return frames;
  }
  void ExpectSameFrames() {
    const LightField packed = Packed();
    for (const Estimator estimator : {Estimator::kBilinear, Estimator::kNearest}) {
      options_.film.reading.estimator = estimator;
      const std::string suffix = std::to_string(static_cast<int>(estimator));
      const Result<RenderReport> files = RenderTo("files" + suffix, field_);
      ASSERT_TRUE(files) << files.error().message;
      const Result<RenderReport> codes = RenderTo("codes" + suffix, packed);
      ASSERT_TRUE(codes) << codes.error().message;
      EXPECT_TRUE(codes->skipped.empty());
      EXPECT_EQ(Frames("files" + suffix).size(), 3u);
      EXPECT_EQ(Frames("files" + suffix), Frames("codes" + suffix));
    }
  }

  LightField field_;
  CameraPath film_;
  RenderOptions options_;
  std::filesystem::path store_;
  ThreadPool pool_{2};
};

TEST_F(PackedRenderTest, ColoursWithMasks) {
  WriteImages<uint8_t>(4, ".png");
  field_.mask_names.resize(field_.size());
  field_.mask_names[5] = field_.image_names[0];
  field_.cameras[6].gain = 1.5f;
  ExpectSameFrames();
}

// Marks of virtual LF images change reports, but no pixel.
TEST_F(PackedRenderTest, ReportsOfADensifiedStoreCountRecordedImages) {
  field_ = testing::NoiseField(9);
  field_.folder = folder_;
  // Every element is in many LF images, so that noise can be measured.
  for (RenderCamera& camera : film_.cameras)
    for (double* value : {&camera.pinhole.intrinsics.fx_px, &camera.pinhole.intrinsics.fy_px})
      *value *= 3;
  WriteImages<uint8_t>(3, ".png");
  options_.film.lens_weights = LensWeights::kNone;  // weights depend on all LF cameras
  options_.film.require.noise = 1;
  options_.film.guard = false;  // a guarded plate keeps the recorded rays apart
  const RenderReport all = RenderTo("all", Packed()).value();
  for (uint32_t i = 0; i < field_.size(); i += 5) field_.cameras[i].is_virtual = true;
  const LightField dense = Packed();
  const RenderReport densified = RenderTo("densified", dense).value();
  const RenderReport recorded = RenderTo("recorded", RecordedPart(dense)).value();
  EXPECT_EQ(densified.lf_image_count, RecordedCount(field_));
  EXPECT_EQ(densified.virtual_count, field_.size() - RecordedCount(field_));
  EXPECT_EQ(densified.selected_image_count, recorded.selected_image_count);
  EXPECT_EQ(densified.selected_image_count + densified.selected_virtual_count,
            all.selected_image_count);
  ASSERT_EQ(densified.frames.size(), 3u);
  size_t measured = 0;
  for (size_t f = 0; f < 3; ++f) {
    const FrameRays &of_all = all.frames[f].rays, &rays = densified.frames[f].rays;
    EXPECT_EQ(rays.accepted_count, of_all.accepted_count);
    EXPECT_EQ(rays.image_count, recorded.frames[f].rays.image_count);
    EXPECT_GT(rays.virtual_count, 0u);
    EXPECT_EQ(rays.image_count + rays.virtual_count, of_all.image_count);
    EXPECT_EQ(densified.frames[f].noise->reached, recorded.frames[f].noise->reached);
    if (densified.frames[f].noise->reached) {
      ++measured;
      EXPECT_NE(densified.frames[f].noise->reached, all.frames[f].noise->reached);
    }
    EXPECT_EQ(densified.frames[f].noise->image_count, rays.image_count);
  }
  EXPECT_GT(measured, 0u);
  options_.film.require.noise.reset();
  options_.film.require.samples = 2;
  const Result<RenderReport> refused = RenderTo("refused", dense);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message.find("densified"), std::string::npos);
  EXPECT_TRUE(RenderTo("recorded2", RecordedPart(dense)));
}

TEST_F(PackedRenderTest, Mosaics) {
  field_.encoding.bayer = BayerPattern::kRggb;
  field_.encoding.transfer = Transfer::kLinear;
  field_.encoding.black_level = 500;
  field_.encoding.pedestal = 1024;
  field_.encoding.white_balance = {2, 1, 1.5};
  WriteImages<uint16_t>(1, ".png");
  ExpectSameFrames();
}

TEST_F(PackedRenderTest, Floats) {
  field_.encoding.max_radiance = 16;
  for (uint32_t i = 0; i < field_.size(); ++i) {
    field_.image_names[i] = "image" + std::to_string(i) + ".exr";
    Image<float> image(kWidth, kHeight, 3);
    for (size_t k = 0; k < image.pixels().size(); ++k)
      image.pixels()[k] = static_cast<float>(17 * RandomUnit(7, i, k) - 0.5);
    ASSERT_TRUE(WriteImage(field_.ImagePath({i}), image.view(), {"R", "G", "B"}, PixelType::kHalf));
  }
  ExpectSameFrames();
}

TEST_F(PackedRenderTest, OneDamagedCodeIsOneSkippedImage) {
  WriteImages<uint8_t>(3, ".png");
  const LightField packed = Packed(20000);
  // Damages a byte in the middle of an encoded image, in the file that contains it.
  const std::vector<PackedCode> codes = FindCodes(store_, packed.image_names).value();
  const std::string bytes(PackedCodeReader::Open(store_).value().Read(codes[5])->code);
  size_t damaged = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().extension() != kStoreExtension) continue;
    std::string file = *ReadFile(entry.path());
    const size_t at = file.find(bytes.substr(bytes.size() / 2, 64));
    if (at == std::string::npos) continue;
    file[at] = static_cast<char>(file[at] ^ 1);
    ASSERT_TRUE(WriteFileAtomically(entry.path(), file));
    ++damaged;
  }
  ASSERT_EQ(damaged, 1u);
  const Result<RenderReport> report = RenderTo("frames", packed);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->skipped.size(), 1u);
  EXPECT_EQ(report->skipped[0].name, "image5.png");
  EXPECT_NE(report->skipped[0].reason.find("store.lfs/image5.png: "), std::string::npos);
  // The frames are those of a light field without this LF image.
  std::filesystem::remove(field_.ImagePath({5}));
  ASSERT_TRUE(RenderTo("files", field_));
  EXPECT_EQ(Frames("files"), Frames("frames"));
  options_.work.strict = true;
  const Result<RenderReport> strict = RenderTo("strict", packed);
  ASSERT_FALSE(strict);
  EXPECT_EQ(strict.error().kind, ErrorKind::kInput);
  EXPECT_NE(strict.error().message.find("store.lfs/image5.png"), std::string::npos);
}

}  // namespace
}  // namespace lf
