// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/rectified/rectified_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lf {
namespace {

Mat3 Turned(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vec3(0.3, 1, 0.2).normalized()).toRotationMatrix();
}

Intrinsics Lens() { return {80, 82, 30, 25, 0, 64, 48}; }

// The light of an LF image is a function of the direction of the ray in the world.
float LightIn(const Vec3& direction_world) {
  const Vec3 d = direction_world.normalized();
  return static_cast<float>(1 + 0.5 * std::sin(6 * d.x()) * std::cos(5 * d.y()));
}

// Loads an image of LightIn() that the LF camera records.
class WorldStore : public LfImageStore {
 public:
  WorldStore(const LightField& light_field) : light_field_(light_field) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    const PinholeCamera camera = light_field_.Camera(id);
    const DistortionMap map(camera.intrinsics.distortion);
    pixels->Reset(rect, BayerPattern::kNone);
    for (int y = rect.y_begin; y < rect.y_end; ++y)
      for (int x = rect.x_begin; x < rect.x_end; ++x) {
        const Vec3 at = camera.intrinsics.InverseMatrix() * Vec3(x + 0.5, y + 0.5, 1);
        const Vec3 direction = *map.Undistort(at.head<2>());
        uint16_t* const to = &pixels->radiance.at(x - rect.x_begin, y - rect.y_begin, 0);
        std::fill_n(
            to, 3,
            QuantizeRadiance(light_field_.encoding,
                             LightIn(camera.cam_from_world.rotation.transpose() * direction), 1));
        to[LfPixels::kRayLane] = 1;
      }
    loaded = rect;
    return {};
  }
  mutable PixelRect loaded;

 private:
  const LightField& light_field_;
};

LightField FieldOf(const Mat3& rotation, const Distortion& distortion) {
  LightField light_field;
  light_field.encoding.max_radiance = 2;
  light_field.intrinsics.push_back(Lens());
  light_field.intrinsics[0].distortion = distortion;
  light_field.cameras.emplace_back();
  light_field.cameras[0].cam_from_world.rotation = rotation;
  light_field.image_names = {"image.png"};
  return light_field;
}

// Returns the largest difference between the pixels of a view and the light of their rays, and
// counts the pixels that the LF image does not show.
double ErrorOf(const LightField& light_field, const Mat3& view_rotation, const PixelRect& rect,
               double shift_px, int* missing) {
  const WorldStore store(light_field);
  const RectifiedRays rays(light_field.Camera(LfImageId{0}), view_rotation, Lens());
  const auto view = LoadRectified(light_field, store, LfImageId{0}, rays, rect, shift_px);
  double error = 0;
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const float found = view->at(x - rect.x_begin, y - rect.y_begin);
      const Vec3 ray = Lens().InverseMatrix() * Vec3(x + 0.5 + shift_px, y + 0.5, 1);
      if (std::isnan(found))
        ++*missing;
      else
        error = std::max(error, std::abs(double{found} - LightIn(view_rotation.transpose() * ray)));
    }
  return error;
}

TEST(RectifiedView, ShowsTheSameRaysAsTheLfImage) {
  const Distortion bent = {DistortionModel::kRadialTangential, {-0.2, 0.05, 0.002, -0.001}};
  for (const Distortion& distortion : {Distortion(), bent})
    for (const double angle_rad : {0.0, 0.05}) {
      int missing = 0;
      const LightField light_field = FieldOf(Turned(0.4 + angle_rad), distortion);
      EXPECT_LT(ErrorOf(light_field, Turned(0.4), {0, 0, 64, 48}, 0.3, &missing), 2e-3);
      EXPECT_LT(missing, 64 * 48 / 4);
    }
}

TEST(RectifiedView, LoadsOnlyTheRowsThatItNeeds) {
  const LightField light_field = FieldOf(Turned(0.4), {});
  const WorldStore store(light_field);
  const RectifiedRays rays(light_field.Camera(LfImageId{0}), Turned(0.41), Lens());
  ASSERT_TRUE(LoadRectified(light_field, store, LfImageId{0}, rays, {0, 20, 64, 21}));
  EXPECT_LT(store.loaded.height(), 8);
  EXPECT_EQ(store.loaded.width(), 64);
}

TEST(RectifiedView, IsTheLfImageIfOrientationAndIntrinsicsAgree) {
  const LightField light_field = FieldOf(Turned(0.4), {});
  const PinholeCamera camera = light_field.Camera(LfImageId{0});
  EXPECT_TRUE(RectifiedRays(camera, Turned(0.4), Lens()).IsSame());
  EXPECT_TRUE(RectifiedRays(camera, Turned(0.4 + 1e-6), Lens()).IsSame());
  EXPECT_FALSE(RectifiedRays(camera, Turned(0.4 + 1e-4), Lens()).IsSame());
  Intrinsics other = Lens();
  other.cx_px += 0.002;
  EXPECT_FALSE(RectifiedRays(camera, Turned(0.4), other).IsSame());
  other = Lens();
  other.width_px = 63;
  EXPECT_FALSE(RectifiedRays(camera, Turned(0.4), other).IsSame());
  int missing = 0;
  // The values are those of the file, of 16 bits.
  EXPECT_LT(ErrorOf(light_field, Turned(0.4), {3, 4, 60, 48}, 0, &missing), 2.0 / 65535);
  EXPECT_EQ(missing, 0);
}

TEST(RectifiedView, HasNoValueWhereTheLfImageHasNone) {
  const LightField light_field = FieldOf(Turned(0.4), {});
  int missing = 0;
  ErrorOf(light_field, Turned(0.4), {0, 10, 64, 11}, 20.25, &missing);
  EXPECT_EQ(missing, 21);  // x + 0.5 + 20.25 beyond the last pixel centre, 63.5
}

TEST(RectifiedView, SamplesOnlyPixelsThatAreThere) {
  Image<float> light(4, 4, 3, 1.0F);
  const PixelRect rect = {10, 20, 14, 24};
  float rgb[3];
  for (int c = 0; c < 3; ++c) light.at(0, 1, c) = std::numeric_limits<float>::quiet_NaN();
  SampleLight(light, rect, {12.5, 22.5}, rgb);
  EXPECT_EQ(rgb[0], 1);
  SampleLight(light, rect, {11.75, 21.75}, rgb);  // the cubics lack a pixel, the line does not
  EXPECT_EQ(rgb[0], 1);
  SampleLight(light, rect, {10.75, 21.75}, rgb);
  EXPECT_TRUE(std::isnan(rgb[0]));
  SampleLight(light, rect, {10.2, 21.75}, rgb);
  EXPECT_TRUE(std::isnan(rgb[0]));
}

}  // namespace
}  // namespace lf
