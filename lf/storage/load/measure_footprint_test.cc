// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/measure_footprint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/result.h"

namespace lf {
namespace {

constexpr int kWidth_px = 200;

LightField FieldOf(size_t count) {
  LightField field;
  field.intrinsics = {{300, 300, 100, 100, 0, kWidth_px, kWidth_px, {}}};
  field.cameras.resize(count);
  for (size_t i = 0; i < count; ++i) field.image_names.push_back("image.png");
  return field;
}

// Shows a disk of radius 70 (18: kFewPoints) and light 0.5 on black, whose middle differs from
// image to image.
class DiskStore : public LfImageStore {
 public:
  enum class Pixels { kAreas, kPoints, kFlat, kMosaic };
  // recorded  pattern of the mosaic that the pixels were made from; colours that a pixel did not
  //           record are then the mean light of 3 x 3 pixels
  explicit DiskStore(Pixels pixels, BayerPattern recorded = BayerPattern::kNone)
      : shows_(pixels), recorded_(recorded) {}

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (id.value == broken) return InputError("broken");
    if (id.value == unreadable) return OutputError("too many open files");
    const bool is_mosaic = shows_ == Pixels::kMosaic;
    *pixels = LfPixels(rect, is_mosaic ? BayerPattern::kRggb : BayerPattern::kNone);
    if (is_mosaic) return {};
    pixels->recorded = recorded_;
    const int points = shows_ == Pixels::kAreas ? 8 : 1;
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        for (int c = 0; c < 3; ++c) {
          const double u = rect.x_begin + x + 0.5, v = rect.y_begin + y + 0.5;
          const bool is_recorded = recorded_ == BayerPattern::kNone ||
                                   BayerChannel(recorded_, rect.x_begin + x, rect.y_begin + y) == c;
          const double light = is_recorded ? Light(id, u, v, 1, points) : Light(id, u, v, 3, 4);
          pixels->radiance.at(x, y, c) = static_cast<uint16_t>(32768 * light);
        }
    return {};
  }

  uint32_t broken = UINT32_MAX, unreadable = UINT32_MAX;
  double radius_px = 70;

 private:
  // Returns the mean light of points x points points in a square of `width_px` around (u, v).
  double Light(LfImageId id, double u, double v, double width_px, int points) const {
    int inside = 0;
    for (int i = 0; i < points * points; ++i) {
      const double x = u + width_px * ((i % points + 0.5) / points - 0.5);
      const double y = v + width_px * ((i / points + 0.5) / points - 0.5);
      inside += std::hypot(x - 100.3 - id.value, y - 99.8) < radius_px || shows_ == Pixels::kFlat;
    }
    return static_cast<double>(inside) / (points * points);
  }

  const Pixels shows_;
  const BayerPattern recorded_;
};

TEST(MeasureFootprint, SeesHowEdgesAreRecorded) {
  using Pixels = DiskStore::Pixels;
  const LightField field = FieldOf(9);
  EXPECT_EQ(MeasureFootprint(field, DiskStore(Pixels::kAreas)).value(), PixelFootprint::kArea);
  EXPECT_EQ(MeasureFootprint(field, DiskStore(Pixels::kPoints)).value(), PixelFootprint::kPoint);
}

// The edges of a small disk in three LF images are enough, unless these are mosaics.
TEST(MeasureFootprint, FewEdgesOfMosaicsTellNothing) {
  LightField mosaics = FieldOf(9);
  mosaics.encoding.bayer = BayerPattern::kRggb;
  DiskStore rgb(DiskStore::Pixels::kPoints);
  DiskStore store(DiskStore::Pixels::kPoints, BayerPattern::kRggb);
  EXPECT_EQ(MeasureFootprint(mosaics, store).value(), PixelFootprint::kPoint);
  rgb.radius_px = store.radius_px = 10;
  EXPECT_EQ(MeasureFootprint(FieldOf(9), rgb).value(), PixelFootprint::kPoint);
  EXPECT_EQ(MeasureFootprint(mosaics, store).value(), PixelFootprint::kArea);
}

// Three LF images of this disk have enough edges, and two have too few.
TEST(MeasureFootprint, AnotherLfImageReplacesABrokenOne) {
  DiskStore store(DiskStore::Pixels::kPoints);
  store.radius_px = 5;
  EXPECT_EQ(MeasureFootprint(FieldOf(9), store).value(), PixelFootprint::kPoint);
  EXPECT_EQ(MeasureFootprint(FieldOf(2), store).value(), PixelFootprint::kArea);
  store.broken = 4;
  EXPECT_EQ(MeasureFootprint(FieldOf(9), store).value(), PixelFootprint::kPoint);
}

// Interpolated colours lie between the two sides of an edge even if pixels show points.
TEST(MeasureFootprint, OnlyRecordedColoursOfMosaicsTell) {
  using Pixels = DiskStore::Pixels;
  for (const BayerPattern recorded : {BayerPattern::kRggb, BayerPattern::kGbrg}) {
    EXPECT_EQ(MeasureFootprint(FieldOf(9), DiskStore(Pixels::kAreas, recorded)).value(),
              PixelFootprint::kArea);
    EXPECT_EQ(MeasureFootprint(FieldOf(9), DiskStore(Pixels::kPoints, recorded)).value(),
              PixelFootprint::kPoint);
  }
}

TEST(MeasureFootprint, WithoutEdgesPixelsShowAreas) {
  using Pixels = DiskStore::Pixels;
  EXPECT_EQ(MeasureFootprint(FieldOf(9), DiskStore(Pixels::kFlat)).value(), PixelFootprint::kArea);
  EXPECT_EQ(MeasureFootprint(FieldOf(9), DiskStore(Pixels::kMosaic)).value(),
            PixelFootprint::kArea);
}

TEST(MeasureFootprint, NeedsNotAllLfImages) {
  using Pixels = DiskStore::Pixels;
  DiskStore store(Pixels::kPoints);
  store.broken = 4;
  EXPECT_EQ(MeasureFootprint(FieldOf(9), store).value(), PixelFootprint::kPoint);
  EXPECT_EQ(MeasureFootprint(FieldOf(1), store).value(), PixelFootprint::kPoint);
  EXPECT_EQ(MeasureFootprint(FieldOf(2), store).value(), PixelFootprint::kPoint);
}

// A machine that lacks something for a moment must not decide how frames look.
TEST(MeasureFootprint, DoesNotGuessIfTheMachineFails) {
  DiskStore store(DiskStore::Pixels::kPoints);
  store.unreadable = 4;
  const auto measured = MeasureFootprint(FieldOf(9), store);
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
