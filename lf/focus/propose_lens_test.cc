// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/propose_lens.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/geometry.h"

namespace lf {
namespace {

// Returns a grid of side x side parallel cameras, `spacing_w` apart.
LightField ParallelGrid(int side, double spacing_w) {
  LightField field;
  field.intrinsics = {{300, 300, 100, 80, 0, 200, 160}};
  for (int i = 0; i < side * side; ++i) {
    const Vec3 at(spacing_w * (i % side - side / 2), spacing_w * (i / side - side / 2), 0);
    field.cameras.push_back({*LookAlong(at, {0, 0, 1}, {0, -1, 0}), 0, 1});
    field.image_names.emplace_back("none.png");
  }
  return field;
}

PinholeCamera CameraInTheMiddle(const LightField& field) {
  return field.Camera(LfImageId{static_cast<uint32_t>(field.size() / 2)});
}

TEST(ProposeLens, ADenseCaptureHasALensOfEightSpacings) {
  const LightField field = ParallelGrid(15, 0.01);
  const auto lens = ProposeLens(field, CameraInTheMiddle(field), 1);
  ASSERT_TRUE(lens);
  EXPECT_NEAR(lens->diameter_w, 0.08, 1e-9);
  EXPECT_FALSE(lens->needs_densifying);
  EXPECT_NE(lens->reason.find("8 spacings of LF cameras"), std::string::npos) << lens->reason;
}

TEST(ProposeLens, TheLensIsNoWiderThanTheCapture) {
  const LightField field = ParallelGrid(5, 0.01);
  const auto lens = ProposeLens(field, CameraInTheMiddle(field), 1);
  ASSERT_TRUE(lens);
  EXPECT_LE(lens->diameter_w, 0.04 + 1e-9);
  EXPECT_GE(lens->diameter_w, 0.02);
}

TEST(ProposeLens, LfCamerasFarApartNeedVirtualLfImages) {
  const LightField field = ParallelGrid(5, 0.3);  // copies 30 px apart
  const auto lens = ProposeLens(field, CameraInTheMiddle(field), 1);
  ASSERT_TRUE(lens);
  EXPECT_TRUE(lens->needs_densifying);
  EXPECT_GT(lens->diameter_w, 0.01);
  EXPECT_LE(lens->diameter_w, 0.3);
}

TEST(ProposeLens, ThereIsNoLensWithoutTwoPositionsOrAFocus) {
  const LightField field = ParallelGrid(5, 0.01);
  for (const double focus_w : {0.0, -1.0, double{INFINITY}, double{NAN}})
    EXPECT_FALSE(ProposeLens(field, CameraInTheMiddle(field), focus_w)) << focus_w;
  const LightField one = ParallelGrid(1, 0.01), same = ParallelGrid(3, 0);
  EXPECT_FALSE(ProposeLens(one, CameraInTheMiddle(one), 1));
  EXPECT_FALSE(ProposeLens(same, CameraInTheMiddle(same), 1));
}

}  // namespace
}  // namespace lf
