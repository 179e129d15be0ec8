// SPDX-License-Identifier: Apache-2.0
// Tests properties of a thin lens, from the pixels of LF images to the sensor plate.
#include <gtest/gtest.h>

#include "tests/optics/analytic_field.h"

#include "lf/camera/thin_lens.h"

namespace lf {
namespace {

using testing::CollectFrame;
using testing::Frame;
using testing::GridField;
using testing::GridRig;

double MeanAt(const SensorPlate& plate, int x, int y) {
  const ElementSum element = plate.At(x, y, 1);
  return element.count > 0 ? static_cast<double>(element.sum) / 65535 / element.count : -1;
}

// Returns a smooth pattern painted on a plane, as a function of the position on the plane.
testing::Radiance PaintedPlane(const Plane& plane) {
  return [plane](const Ray& ray) {
    const Vec3 p = *IntersectLine(ray, plane);
    return 0.5 + 0.25 * std::sin(35 * p.x()) + 0.2 * std::cos(35 * p.y() + 3 * p.z());
  };
}

// Returns the largest difference between the frame and the pattern, at places where the pattern is
// in focus.
double ErrorOfPaintedPlane(const FocusTilt& painted, const FocusTilt& focused) {
  const GridRig rig;
  const LightField field = GridField(rig);
  const RenderCamera truth = Frame(rig.intrinsics, 0.06, 1.5, painted);
  const testing::Radiance pattern = PaintedPlane(truth.focus_plane);
  const testing::FormulaStore store(field, pattern);
  const RenderCamera frame = Frame(rig.intrinsics, 0.06, 1.5, focused);
  const SensorPlate plate = CollectFrame(field, store, frame);
  double largest = 0;
  for (int y = 10; y < 110; ++y)
    for (int x = 10; x < 150; ++x) {
      const double expected = pattern(RayOfPixel(frame.pinhole, x + 0.5, y + 0.5));
      largest = std::max(largest, std::abs(MeanAt(plate, x, y) - expected));
    }
  return largest;
}

TEST(Optics, ATexturedPlaneInFocusReproducesItself) {
  EXPECT_LT(ErrorOfPaintedPlane({}, {}), 0.02);
}

TEST(Optics, APlaneTiltedHorizontallyIsSharpWithThatTiltOnly) {
  const FocusTilt tilt{RadiansFromDegrees(55), 0};
  EXPECT_LT(ErrorOfPaintedPlane(tilt, tilt), 0.04);
  EXPECT_GT(ErrorOfPaintedPlane(tilt, {-tilt.horizontal_rad, 0}), 0.1);
}

TEST(Optics, APlaneTiltedVerticallyIsSharpWithThatTiltOnly) {
  const FocusTilt tilt{0, RadiansFromDegrees(-50)};
  EXPECT_LT(ErrorOfPaintedPlane(tilt, tilt), 0.04);
  EXPECT_GT(ErrorOfPaintedPlane(tilt, {0, -tilt.vertical_rad}), 0.08);
}

// Returns the diameter, in elements, of the disk that has the second moment of the light on the
// plate. The roundings to an LF pixel and to an element add 1/12 each to the moment along an axis.
double BlurDiameter(const SensorPlate& plate) {
  double light = 0, sum_x = 0, sum_y = 0, sum_squared = 0;
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x) {
      const double v = static_cast<double>(plate.At(x, y, 0).sum) / 65535;
      light += v;
      sum_x += v * x;
      sum_y += v * y;
      sum_squared += v * (x * x + y * y);
    }
  const double mean_x = sum_x / light, mean_y = sum_y / light;
  const double moment = sum_squared / light - mean_x * mean_x - mean_y * mean_y;  // R^2 / 2
  return 2 * std::sqrt(2 * std::max(0.0, moment - 2.0 / 6));
}

TEST(Optics, ThePointSpreadHasTheDiameterOfTheLensFormula) {
  GridRig rig;
  rig.intrinsics = {400, 400, 120.3, 90.2, 0, 240, 180};
  for (const double aperture_w : {0.08, 0.05, 0.03}) {
    rig.side = 61;
    rig.pitch_w = aperture_w / 50;
    const LightField field = GridField(rig);
    for (const double focus_w : {0.6, 1.0, 2.0})
      for (const double depth_w : {0.45, 0.8, 1.3, 5.0}) {
        const testing::PointStore store(field, {0.003, -0.002, depth_w});
        const SensorPlate plate =
            CollectFrame(field, store, Frame(rig.intrinsics, aperture_w, focus_w));
        const double expected =
            BlurOnFocusPlane(aperture_w, focus_w, depth_w) * rig.intrinsics.fx_px / focus_w;
        EXPECT_NEAR(BlurDiameter(plate), expected, std::max(0.01 * expected, 0.5))
            << aperture_w << ", " << focus_w << ", " << depth_w;
      }
  }
}

// Checks that the lit elements, projected back to the lens, have the shape of the aperture.
void ExpectSilhouette(const Aperture& aperture, double focus_w, double depth_w) {
  GridRig rig;
  rig.side = 101;
  rig.pitch_w = 0.001;
  rig.intrinsics = {400, 400, 120, 90, 0, 240, 180};
  const LightField field = GridField(rig);
  const Vec3 point(0.0004, 0.0003, depth_w);
  RenderCamera frame = Frame(rig.intrinsics, 0, focus_w);
  frame.aperture = aperture;
  const SensorPlate plate = CollectFrame(field, testing::PointStore(field, point), frame);
  const Vec2 centre = *Project(frame.pinhole, point);
  // A ray through lens position l meets the focus plane at l (1 - g / z) beside the point's image,
  // with the focus distance g and the depth z of the point.
  const double elements_per_w = (1 - focus_w / depth_w) * rig.intrinsics.fx_px / focus_w;
  const double margin_w = 1.6 / std::abs(elements_per_w);
  const Aperture outer{aperture.radius_w + 2 * margin_w, aperture.blades, aperture.rotation_rad};
  const Aperture inner{aperture.radius_w - 2 * margin_w, aperture.blades, aperture.rotation_rad};
  size_t inside_count = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 240; ++x) {
      const Vec2 lens((x + 0.5 - centre.x()) / elements_per_w,
                      -(y + 0.5 - centre.y()) / elements_per_w);
      const bool lit = plate.At(x, y, 0).sum > 0;
      if (lit) {
        EXPECT_TRUE(Contains(outer, lens)) << x << ", " << y;
      }
      if (!Contains(inner, lens)) continue;
      EXPECT_TRUE(lit) << x << ", " << y;
      ++inside_count;
    }
  EXPECT_GT(inside_count, 100u);
}

TEST(Optics, HighlightsTakeTheShapeOfTheAperture) {
  for (const double rotation : {0.0, RadiansFromDegrees(20), RadiansFromDegrees(-75)}) {
    ExpectSilhouette({0.04, 3, rotation}, 0.8, 3.0);  // behind the focus: upright
    ExpectSilhouette({0.04, 5, rotation}, 0.8, 3.0);
    ExpectSilhouette({0.04, 5, rotation}, 1.5, 0.75);  // in front of the focus: upside down
  }
  ExpectSilhouette({0.04, 0, 0}, 0.8, 3.0);
}

}  // namespace
}  // namespace lf
