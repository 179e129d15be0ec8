// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/epi/epipolar_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace lf {
namespace {

constexpr double kDepth_w = 3;

// The light of a point of the wall at z = kDepth_w.
float LightAt(const Vec3& point_world) {
  return static_cast<float>(1 + 0.4 * std::sin(9 * point_world.x()) +
                            0.3 * std::sin(7 * point_world.y()));
}

// LF images of the wall. The images that are in `broken` cannot be loaded.
class WallStore : public LfImageStore {
 public:
  explicit WallStore(const LightField& light_field) : light_field_(light_field) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (id.value == broken) return InputError("broken.png: is broken");
    const PinholeCamera camera = light_field_.Camera(id);
    const DistortionMap map(camera.intrinsics.distortion);
    pixels->Reset(rect, BayerPattern::kNone);
    for (int y = rect.y_begin; y < rect.y_end; ++y)
      for (int x = rect.x_begin; x < rect.x_end; ++x) {
        const Vec3 at = camera.intrinsics.InverseMatrix() * Vec3(x + 0.5, y + 0.5, 1);
        const Vec3 ray = camera.cam_from_world.rotation.transpose() * *map.Undistort(at.head<2>());
        const Vec3 centre = camera.CentreWorld();
        const float light = LightAt(centre + ray * ((kDepth_w - centre.z()) / ray.z()));
        uint16_t* const to = &pixels->radiance.at(x - rect.x_begin, y - rect.y_begin, 0);
        std::fill_n(to, 3, QuantizeRadiance(light_field_.encoding, light, 1));
        to[LfPixels::kRayLane] = 1;
      }
    return {};
  }
  uint32_t broken = UINT32_MAX;

 private:
  const LightField& light_field_;
};

// A grid of 5 x 5 LF cameras. They are turned in different directions, and their lens has
// distortion, unless `is_plain` is true.
LightField Grid(bool is_plain) {
  LightField light_field;
  light_field.encoding.max_radiance = 2;
  light_field.intrinsics.push_back({100, 104, 33, 23, 0, 64, 48});
  if (!is_plain)
    light_field.intrinsics[0].distortion = {DistortionModel::kRadialTangential, {-0.15, 0.04}};
  for (int i = 0; i < 25; ++i) {
    const double angle_rad = is_plain ? 0 : 0.02 * (i % 3 - 1);
    const Mat3 rotation =
        Eigen::AngleAxisd(angle_rad, Vec3(0.5, 0.6, 1 - i % 2).normalized()).toRotationMatrix();
    const Vec3 centre(0.1 * (i % 5), 0.1 * (i / 5), 0);
    LfCamera camera;
    camera.cam_from_world = {rotation, -(rotation * centre)};
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(std::to_string(i) + ".png");
  }
  return light_field;
}

EpipolarOptions OptionsOf(LineKind kind, int pixel) {
  EpipolarOptions options;
  options.kind = kind;
  options.pixel = pixel;
  options.through = LfImageId{12};
  return options;
}

// Compares each pixel with the wall: a ray from the position of its line through the pixel of the
// view, which is moved by f s / g.
void Check(const LightField& light_field, const EpipolarOptions& options, double tolerance) {
  ThreadPool pool(2);
  const WallStore store(light_field);
  const auto picture = MakeEpipolarPicture(light_field, store, options, pool);
  ASSERT_TRUE(picture) << picture.error().message;
  const bool is_row = options.kind == LineKind::kRow;
  const Intrinsics& k = light_field.intrinsics[0];
  EXPECT_EQ(picture->focal_px, is_row ? k.fx_px : k.fy_px);
  ASSERT_EQ(picture->light.width(), is_row ? 64 : 48);
  const Vec3 origin = light_field.Camera(LfImageId{12}).CentreWorld();
  int count = 0;
  for (int line = 0; line < picture->light.height(); ++line)
    for (int i = 0; i < picture->light.width(); ++i) {
      const float found = picture->light.at(i, line);
      if (std::isnan(found)) continue;
      ++count;
      const double s_w = picture->positions_w[static_cast<size_t>(line)];
      const double shift_px =
          options.focus_distance_w ? -picture->focal_px * s_w / *options.focus_distance_w : 0;
      const double along = i + 0.5 + shift_px, across = options.pixel + 0.5;
      const Vec3 ray_view =
          is_row ? Vec3((along - k.cx_px) / k.fx_px, (across - k.cy_px) / k.fy_px, 1)
                 : Vec3((across - k.cx_px) / k.fx_px, (along - k.cy_px) / k.fy_px, 1);
      const Vec3 ray = picture->line.rotation.transpose() * ray_view;
      const Vec3 centre = origin + s_w * picture->line.direction_world;
      const Vec3 point = centre + ray * ((kDepth_w - centre.z()) / ray.z());
      ASSERT_NEAR(found, LightAt(point), tolerance) << line << " " << i;
    }
  EXPECT_GT(count, picture->light.width() * picture->light.height() * 3 / 5);
}

TEST(EpipolarPicture, ShowsTheRaysOfItsLines) {
  for (const bool is_plain : {true, false})
    for (const LineKind kind : {LineKind::kRow, LineKind::kColumn}) {
      EpipolarOptions options = OptionsOf(kind, 21);
      // Values are interpolated linearly at the borders. A pixel beside differs by up to 0.1.
      constexpr double kInterpolated = 7e-3;
      Check(Grid(is_plain), options, is_plain ? 1e-4 : kInterpolated);
      options.focus_distance_w = 2.5;
      Check(Grid(is_plain), options, kInterpolated);
    }
}

TEST(EpipolarPicture, HasOneLineForEachLfImageOfAnEvenRow) {
  const LightField light_field = Grid(true);
  ThreadPool pool(1);
  const auto picture =
      MakeEpipolarPicture(light_field, WallStore(light_field), OptionsOf(LineKind::kRow, 3), pool);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->lines, EpipolarLines::kRecorded);
  ASSERT_EQ(picture->ids.size(), 5u);
  for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(picture->ids[i].value, 10 + i);
}

// Moves the second camera of the row to the right.
LightField UnevenGrid() {
  LightField light_field = Grid(true);
  light_field.cameras[11].cam_from_world.translation.x() -= 0.03;
  return light_field;
}

TEST(EpipolarPicture, HasEvenLinesOfAnUnevenRow) {
  const LightField light_field = UnevenGrid();
  ThreadPool pool(1);
  EpipolarOptions options = OptionsOf(LineKind::kRow, 3);
  options.line_count = 9;
  const auto nearest = MakeEpipolarPicture(light_field, WallStore(light_field), options, pool);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->lines, EpipolarLines::kNearest);
  std::vector<uint32_t> ids;
  for (const LfImageId id : nearest->ids) ids.push_back(id.value);
  // Positions 0, 0.05, ..., 0.4; LF images at 0, 0.13, 0.2, 0.3 and 0.4.
  EXPECT_EQ(ids, (std::vector<uint32_t>{10, 10, 11, 11, 12, 12, 13, 13, 14}));
  EXPECT_NEAR(nearest->positions_w[1] - nearest->positions_w[0], 0.05, 1e-12);

  options.lines = EpipolarLines::kLinear;
  const auto linear = MakeEpipolarPicture(light_field, WallStore(light_field), options, pool);
  ASSERT_TRUE(linear);
  const double weight = 0.1 / 0.13;
  EXPECT_NEAR(linear->light.at(20, 2),
              (1 - weight) * nearest->light.at(20, 0) + weight * nearest->light.at(20, 2), 1e-6);
  EXPECT_EQ(linear->light.at(20, 8), nearest->light.at(20, 8));
}

TEST(EpipolarPicture, LeavesOutLfImagesThatCannotBeLoaded) {
  const LightField light_field = Grid(true);
  WallStore store(light_field);
  store.broken = 13;
  ThreadPool pool(2);
  EpipolarOptions options = OptionsOf(LineKind::kRow, 3);
  const auto picture = MakeEpipolarPicture(light_field, store, options, pool);
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->missing.size(), 1u);
  EXPECT_EQ(picture->missing[0].value, 13u);
  EXPECT_EQ(picture->first_reason, "broken.png: is broken");
  EXPECT_TRUE(std::isnan(picture->light.at(20, 3)));
  EXPECT_FALSE(std::isnan(picture->light.at(20, 4)));
  options.strict = true;
  EXPECT_EQ(MakeEpipolarPicture(light_field, store, options, pool).error().message,
            "broken.png: is broken");
}

TEST(EpipolarPicture, RefusesOptionsThatAreOutOfRange) {
  const LightField light_field = Grid(true);
  ThreadPool pool(1);
  for (const int pixel : {-1, 48}) {
    const auto result = MakeEpipolarPicture(light_field, WallStore(light_field),
                                            OptionsOf(LineKind::kRow, pixel), pool);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("expected 0 to 47"), std::string::npos);
  }
  EXPECT_TRUE(MakeEpipolarPicture(light_field, WallStore(light_field),
                                  OptionsOf(LineKind::kColumn, 63), pool));
  EpipolarOptions options = OptionsOf(LineKind::kRow, 3);
  options.line_count = 1;
  EXPECT_FALSE(MakeEpipolarPicture(light_field, WallStore(light_field), options, pool));
  LightField brackets = light_field;
  brackets.encoding.masks_clipped = true;
  EXPECT_FALSE(
      MakeEpipolarPicture(brackets, WallStore(brackets), OptionsOf(LineKind::kRow, 3), pool));
  std::atomic<bool> stop = true;
  options = OptionsOf(LineKind::kRow, 3);
  options.stop = &stop;
  EXPECT_EQ(MakeEpipolarPicture(light_field, WallStore(light_field), options, pool).error().kind,
            ErrorKind::kInterrupted);
}

}  // namespace
}  // namespace lf
