// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/capture_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lf {
namespace {

constexpr Intrinsics kCamera = {1000, 900, 400, 300, 0, 800, 600};

void Add(const RigidTransform& pose, LightField* field) {
  if (field->intrinsics.empty()) field->intrinsics.push_back(kCamera);
  field->image_names.push_back(std::to_string(field->size()) + ".png");
  field->cameras.push_back({pose, 0, 1});
}

// Returns a grid of 10 x 10 cameras at z = 0, x = 0, 0.1 ... and y = 0, 0.2 .... They look along z,
// or at `target` if it is given.
LightField Grid(std::optional<Vec3> target = {}) {
  LightField field;
  for (int i = 0; i < 100; ++i) {
    const Vec3 centre(0.1 * (i % 10), 0.2 * (i / 10), 0);
    Add(*LookAlong(centre, target ? Vec3(*target - centre) : Vec3(0, 0, 1), {0, -1, 0}), &field);
  }
  return field;
}

// Returns cameras on a circle around the origin that look inwards (sign 1) or outwards (sign -1).
LightField Ring(double sign) {
  LightField field;
  for (int i = 0; i < 60; ++i) {
    const double angle = 2 * kPi * i / 60;
    const Vec3 centre(3 * std::cos(angle), 3 * std::sin(angle), 1);
    Add(*LookAlong(centre, -sign * centre, {0, 0, 1}), &field);
  }
  return field;
}

CaptureReport ReportOf(const LightField& field, const CaptureReportOptions& options = {}) {
  ThreadPool pool(2);
  return ReportCapture(field, options, pool);
}

std::vector<std::string> Kinds(const CaptureReport& report) {
  std::vector<std::string> kinds;
  for (const CaptureWarning& warning : report.warnings) kinds.push_back(warning.kind);
  return kinds;
}

using Words = std::vector<std::string>;

// Turns the camera by 180 degrees about its optical axis.
void TurnOver(RigidTransform* pose) {
  const Mat3 turn = Vec3(-1, -1, 1).asDiagonal();
  *pose = RigidTransform{turn, Vec3::Zero()} * *pose;
}

// Makes the camera look backwards, with the same up direction.
void TurnRound(RigidTransform* pose) {
  const Mat3 turn = Vec3(-1, 1, -1).asDiagonal();
  *pose = RigidTransform{turn, Vec3::Zero()} * *pose;
}

TEST(CaptureReport, TellsWhereTheCamerasStand) {
  const CaptureReport report = ReportOf(Grid());
  EXPECT_EQ(report.image_count, 100u);
  EXPECT_LT((report.box_max_w - Vec3(0.9, 1.8, 0)).norm(), 1e-12);
  EXPECT_LT(report.box_min_w.norm(), 1e-12);
  ASSERT_TRUE(report.spacing_w);
  EXPECT_NEAR(report.spacing_w->min, 0.1, 1e-12);
  EXPECT_NEAR(report.spacing_w->median, 0.1, 1e-12);
  EXPECT_NEAR(report.spacing_w->max, 0.1, 1e-12);
  EXPECT_FALSE(report.meeting_point_w);
  EXPECT_FALSE(report.density);
  EXPECT_EQ(Kinds(report), Words{});
}

TEST(CaptureReport, DescribesTheRecordedImagesAlone) {
  const CaptureReportOptions options = {.distance_w = 2, .lights = std::vector<double>(100, 1.0)};
  const CaptureReport recorded = ReportOf(Grid(), options);
  LightField field = Grid();
  for (int i = 0; i < 50; ++i) {
    Add(*LookAlong({0.1 * (i % 10) + 0.01, 0.2 * (i / 10), 9}, {0, 0, 1}, {0, -1, 0}), &field);
    field.cameras.back().is_virtual = true;
  }
  CaptureReportOptions of_all = options;
  of_all.lights.resize(150, 1.0);
  const CaptureReport report = ReportOf(field, of_all);
  EXPECT_EQ(report.image_count, 100u);
  EXPECT_EQ(report.virtual_count, 50u);
  EXPECT_EQ(report.box_max_w, recorded.box_max_w);
  EXPECT_EQ(report.spacing_w->median, recorded.spacing_w->median);
  EXPECT_EQ(report.density->disparity_px, recorded.density->disparity_px);
  EXPECT_EQ(report.groups[0].image_count, 100u);
  // A light field without recorded LF images is described as it is.
  for (LfCamera& camera : field.cameras) camera.is_virtual = true;
  EXPECT_EQ(ReportOf(field, of_all).image_count, 150u);
}

TEST(CaptureReport, GroupsCamerasByModelAndSize) {
  LightField field = Grid();
  field.intrinsics.push_back(kCamera);
  field.intrinsics.back().fx_px = 2000;
  field.intrinsics.push_back({500, 500, 200, 300, 0, 400, 600});
  field.intrinsics.push_back({1, 1, 1, 1, 0, 1, 1});  // used by no image
  field.cameras[1].intrinsics_index = 1;
  for (size_t i = 2; i < 12; ++i) field.cameras[i].intrinsics_index = 2;
  const std::vector<CameraGroup> groups = ReportOf(field).groups;
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].image_count, 90u);
  EXPECT_EQ(groups[0].intrinsics_count, 2u);
  EXPECT_EQ(groups[0].width_px, 800);
  EXPECT_EQ(groups[0].fx_px.min, 1000);
  EXPECT_EQ(groups[0].fx_px.median, 1000);
  EXPECT_EQ(groups[0].fx_px.max, 2000);
  EXPECT_NEAR(groups[0].horizontal_fov_rad.max, 2 * std::atan(0.4), 1e-12);
  EXPECT_NEAR(groups[0].vertical_fov_rad.median, 2 * std::atan(1 / 3.0), 1e-12);
  EXPECT_EQ(groups[1].image_count, 10u);
}

TEST(CaptureReport, TheFieldOfViewEndsWhereTheLensDoes) {
  LightField field = Grid();
  // The distorted position x (1 - 0.9 x^2) grows only up to x = 1 / sqrt(2.7); no ray is beyond it.
  field.intrinsics[0] = {100, 100, 100, 50,
                         0,   200, 100, {DistortionModel::kRadialTangential, {-0.9}}};
  EXPECT_NEAR(ReportOf(field).groups[0].horizontal_fov_rad.median,
              2 * std::atan(1 / std::sqrt(2.7)), 1e-4);
}

TEST(CaptureReport, AFishEyeSeesMoreThanItsPinhole) {
  LightField field = Grid();
  field.intrinsics[0] = {400, 400, 800, 800, 0, 1600, 1600, {DistortionModel::kFisheye, {}}};
  // The equidistant fish-eye sees width / F = 1600 / 400 radians, more than pi.
  EXPECT_NEAR(ReportOf(field).groups[0].horizontal_fov_rad.median, 4, 1e-9);
}

TEST(CaptureReport, DensityIsTheDisparityOfNeighboursAtTheScene) {
  LightField field = Grid(Vec3(0.45, 0.9, 4));
  CaptureReport report = ReportOf(field);
  ASSERT_TRUE(report.density && report.meeting_point_w);
  EXPECT_EQ(report.density->source, DistanceSource::kMeeting);
  EXPECT_NEAR(report.density->distance_w, 4.05, 0.06);
  EXPECT_NEAR(report.density->disparity_px, 1000 * 0.1 / report.density->distance_w, 1e-9);
  EXPECT_EQ(Kinds(report), Words{"sparse"});

  field.depth_range = DepthRange{5, 20};
  report = ReportOf(field);
  EXPECT_EQ(report.density->source, DistanceSource::kDepthRange);
  EXPECT_NEAR(report.density->distance_w, 8, 1e-12);

  report = ReportOf(field, {.distance_w = 10});
  EXPECT_EQ(report.density->source, DistanceSource::kStated);
  EXPECT_NEAR(report.density->disparity_px, 10, 1e-9);
  EXPECT_NEAR(report.density->spacing_rad, 0.01, 1e-6);
  // Points at 0.75 z appear 100 / 7.5 - 100 / 10 pixels apart if the focus is at z.
  EXPECT_NEAR(report.density->near_ghost_px, 100 / 7.5 - 10, 1e-9);
  EXPECT_NEAR(report.density->far_ghost_px, 10 - 100 / 12.5, 1e-9);
  EXPECT_EQ(Kinds(report), Words{});                                      // 3.3 px of 800 px
  EXPECT_EQ(Kinds(ReportOf(field, {.distance_w = 4})), Words{"sparse"});  // 8.3 px of 800 px
  // The warning says that a spacing of 0.096 would suffice at the distance 4.
  const std::string message = ReportOf(field, {.distance_w = 4}).warnings[0].message;
  EXPECT_NE(message.find("at most 0.096 apart"), std::string::npos) << message;
}

TEST(CaptureReport, CamerasThatLookAwayFromTheOthersAreNamed) {
  for (LightField field : {Grid(), Grid(Vec3(0.45, 0.9, 40)), Ring(1)}) {
    EXPECT_EQ(ReportOf(field, {.distance_w = 1e6}).warnings.size(), 0u);
    for (const size_t i : {3, 17, 20, 21, 22, 23, 24}) TurnRound(&field.cameras[i].cam_from_world);
    const CaptureReport report = ReportOf(field, {.distance_w = 1e6});
    ASSERT_EQ(Kinds(report), Words{"facing-away"});
    EXPECT_EQ(report.warnings[0].image_count, 7u);
    EXPECT_EQ(report.warnings[0].names, (Words{"3.png", "17.png", "20.png", "21.png", "22.png"}));
  }
}

TEST(CaptureReport, MixedUpAxesDiverge) {
  EXPECT_EQ(Kinds(ReportOf(Ring(-1))), Words{"diverging-axes"});
  // These cameras have OpenCV's axes, but were read with OpenGL's.
  LightField field = Grid(Vec3(0.45, 0.9, 40));
  const Mat3 flip = Vec3(1, -1, -1).asDiagonal();
  for (LfCamera& camera : field.cameras)
    camera.cam_from_world = RigidTransform{flip, Vec3::Zero()} * camera.cam_from_world;
  EXPECT_EQ(Kinds(ReportOf(field)), Words{"diverging-axes"});
}

TEST(CaptureReport, ImagesUpsideDownBesideTheOthersAreNamed) {
  for (LightField field : {Grid(), Ring(1)}) {
    TurnOver(&field.cameras[3].cam_from_world);
    TurnOver(&field.cameras[50].cam_from_world);
    const CaptureReport report = ReportOf(field, {.distance_w = 1e6});
    ASSERT_EQ(Kinds(report), Words{"upside-down"});
    EXPECT_EQ(report.warnings[0].names, (Words{"3.png", "50.png"}));
    for (LfCamera& camera : field.cameras) TurnOver(&camera.cam_from_world);
    EXPECT_EQ(ReportOf(field, {.distance_w = 1e6}).warnings[0].names, (Words{"3.png", "50.png"}));
  }
}

TEST(CaptureReport, ASurveyFlownToAndFroHasNoUpsideDown) {
  for (const int lines : {2, 3, 8}) {  // a half or a third of the images is turned
    LightField field;
    for (int i = 0; i < 10 * lines; ++i) {
      const bool returns = i / 10 % 2 == 1;
      const double along = returns ? 9 - i % 10 : i % 10;
      // Half a degree of sway, as drones have it.
      const Vec3 down(0.01 * std::sin(i), 0.01 * std::cos(2 * i), -1);
      Add(*LookAlong({along, i / 10 * 1.5, 20}, down.normalized(), {returns ? -1.0 : 1.0, 0, 0}),
          &field);
    }
    EXPECT_EQ(Kinds(ReportOf(field, {.distance_w = 1e6})), Words{}) << lines;
    // A single image that is turned in its line is still named.
    if (lines != 8) continue;
    LightField one_way;
    for (int i = 0; i < 10; ++i) one_way.cameras.push_back(field.cameras[i]);
    one_way.intrinsics = field.intrinsics;
    one_way.image_names.assign(field.image_names.begin(), field.image_names.begin() + 10);
    TurnOver(&one_way.cameras[4].cam_from_world);
    EXPECT_EQ(Kinds(ReportOf(one_way, {.distance_w = 1e6})), Words{"upside-down"});
  }
}

TEST(CaptureReport, ADomeHasNoUpsideDown) {
  LightField field;
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (i + 0.5) / 200, angle = 2.4 * i, r = std::sqrt(1 - z * z);
    const Vec3 centre(r * std::cos(angle), r * std::sin(angle), z);
    Add(*LookAlong(centre, -centre, {0, 0, 1}), &field);
  }
  EXPECT_EQ(Kinds(ReportOf(field, {.distance_w = 1e6})), Words{});
}

TEST(CaptureReport, CamerasOnTheirSideAroundARingHaveNoUpsideDown) {
  for (int shown = 10; shown <= 60; ++shown) {  // arcs of different lengths
    LightField field = Ring(1), arc;
    for (int i = 0; i < shown; ++i) {
      const Mat3 turn = Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()).toRotationMatrix();
      Add(RigidTransform{turn, Vec3::Zero()} * field.cameras[i].cam_from_world, &arc);
    }
    EXPECT_EQ(Kinds(ReportOf(arc, {.distance_w = 1e6})), Words{}) << shown;
  }
}

TEST(CaptureReport, RepeatedPositionsAreNamed) {
  LightField field = Grid();
  Add(field.cameras[5].cam_from_world, &field);
  TurnOver(&field.cameras[5].cam_from_world);  // changes only the rounding of its position
  TurnOver(&field.cameras[5].cam_from_world);
  const CaptureReport report = ReportOf(field);
  ASSERT_EQ(Kinds(report), Words{"repeated-positions"});
  EXPECT_EQ(report.warnings[0].names, (Words{"5.png", "100.png"}));
  EXPECT_NE(report.warnings[0].message.find("2 of 101 cameras"), std::string::npos);
}

TEST(CaptureReport, OneCameraFarAwayMakesNoOthersRepeated) {
  LightField field = Grid();
  field.cameras[7].cam_from_world.translation = Vec3(1e9, 0, 0);
  EXPECT_EQ(Kinds(ReportOf(field, {.distance_w = 1e12})), Words{});
  Add(field.cameras[5].cam_from_world, &field);
  const CaptureReport report = ReportOf(field, {.distance_w = 1e12});
  ASSERT_EQ(Kinds(report), Words{"repeated-positions"});
  EXPECT_EQ(report.warnings[0].names, (Words{"5.png", "100.png"}));
}

TEST(CaptureReport, ImagesThatWereAllListedTwiceAreRepeated) {
  LightField field = Grid();
  const size_t count = field.size();
  for (size_t i = 0; i < count; ++i) Add(LfCamera(field.cameras[i]).cam_from_world, &field);
  const CaptureReport report = ReportOf(field);
  ASSERT_EQ(Kinds(report), Words{"repeated-positions"});
  EXPECT_EQ(report.warnings[0].image_count, 2 * count);
}

TEST(CaptureReport, BracketsAreNoRepeatedPositions) {
  LightField field = Grid();
  const size_t pose_count = field.size();
  for (size_t i = 0; i < pose_count; ++i)
    for (int copy = 0; copy < 2; ++copy) Add(field.cameras[i].cam_from_world, &field);
  EXPECT_EQ(Kinds(ReportOf(field)), Words{"repeated-positions"});
  CaptureReportOptions options;
  for (size_t i = 0; i < field.size(); ++i)
    options.lights.push_back(i < pose_count ? 1 : i % 2 == 0 ? 4 : 0.25);
  const CaptureReport report = ReportOf(field, options);
  ASSERT_EQ(Kinds(report), Words{"brackets"});
  for (const char* words : {"300 images", "100 poses", "--gain-from-exif --mask-clipped"})
    EXPECT_NE(report.warnings[0].message.find(words), std::string::npos)
        << report.warnings[0].message;
  EXPECT_EQ(report.brackets->stops, (std::vector<double>{-2, 0, 2}));
  EXPECT_NEAR(report.spacing_w->median, 0.1, 1e-12);

  for (size_t i = 0; i < field.size(); ++i)
    field.cameras[i].gain = static_cast<float>(1 / options.lights[i]);
  field.encoding.masks_clipped = true;
  EXPECT_EQ(Kinds(ReportOf(field)), Words{});
  Add(field.cameras[7].cam_from_world, &field);  // a repeated exposure of this pose
  field.cameras.back().gain = field.cameras[7].gain;
  EXPECT_EQ(Kinds(ReportOf(field)), Words{});
}

TEST(CaptureReport, OneCameraHasNoSpacing) {
  LightField field;
  Add(RigidTransform{}, &field);
  const CaptureReport report = ReportOf(field, {.distance_w = 1});
  EXPECT_FALSE(report.spacing_w);
  EXPECT_FALSE(report.density);
  EXPECT_EQ(Kinds(report), Words{});
}

}  // namespace
}  // namespace lf
