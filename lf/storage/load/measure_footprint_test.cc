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

// Shows a disk of radius 70 and light 0.5 on black, whose middle differs from image to image.
class DiskStore : public LfImageStore {
 public:
  enum class Pixels { kAreas, kPoints, kFlat, kMosaic };
  explicit DiskStore(Pixels pixels) : shows_(pixels) {}

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (id.value == broken) return InputError("broken");
    if (id.value == unreadable) return OutputError("too many open files");
    const bool is_mosaic = shows_ == Pixels::kMosaic;
    *pixels = LfPixels(rect, is_mosaic ? BayerPattern::kRggb : BayerPattern::kNone);
    if (is_mosaic) return {};
    // A pixel shows the mean of kPoints x kPoints points.
    const int points = shows_ == Pixels::kAreas ? 8 : 1;
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        int inside = 0;
        for (int i = 0; i < points * points; ++i) {
          const double u = rect.x_begin + x + (i % points + 0.5) / points;
          const double v = rect.y_begin + y + (i / points + 0.5) / points;
          inside += std::hypot(u - 100.3 - id.value, v - 99.8) < 70 || shows_ == Pixels::kFlat;
        }
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x, y, c) = static_cast<uint16_t>(32768. * inside / (points * points));
      }
    return {};
  }

  uint32_t broken = UINT32_MAX, unreadable = UINT32_MAX;

 private:
  const Pixels shows_;
};

TEST(MeasureFootprint, SeesHowEdgesAreRecorded) {
  using Pixels = DiskStore::Pixels;
  const LightField field = FieldOf(9);
  EXPECT_EQ(MeasureFootprint(field, DiskStore(Pixels::kAreas)).value(), PixelFootprint::kArea);
  EXPECT_EQ(MeasureFootprint(field, DiskStore(Pixels::kPoints)).value(), PixelFootprint::kPoint);
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
