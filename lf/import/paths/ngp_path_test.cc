// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/ngp_path.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/paths/ngp_curve.h"
#include "lf/import/paths/test_paths.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

Result<ForeignPath> ParsedNgp(const std::string& text, const PathOptions& options = {}) {
  return ParseNgpPath(text, "b.json", options, {});
}

void ExpectNgpError(const std::string& from, const std::string& to,
                    const std::vector<std::string>& parts) {
  ExpectPathError(ParsedNgp(With(kNgpText, from, to)), "b.json", parts);
}

TEST(NgpPath, SpaceAxesAndLensAreUndone) {
  const Result<ForeignPath> path =
      ParsedNgp(kNgpText, {.resolution_px = std::array<int, 2>{200, 100}});
  ASSERT_TRUE(path) << path.error().message;
  ASSERT_EQ(path->cameras.size(), 1u);
  const ForeignCamera& camera = path->cameras[0];
  EXPECT_LT((camera.pinhole.CentreWorld() - Vec3(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((camera.pinhole.ForwardWorld() - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((camera.pinhole.UpWorld() - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_NEAR(camera.pinhole.intrinsics.fy_px, 50, 1e-12);
  EXPECT_NEAR(*camera.focus_distance_w, 4 / 0.33, 1e-12);
  EXPECT_NEAR(*camera.aperture_diameter_w, 0.2, 1e-12);
  EXPECT_EQ(path->lacks.size(), 1u);  // the frame rate
}

TEST(NgpPath, FramesAreFilmedFromTheBeginningOfTheCurveAndNotUpToItsEnd) {
  // The world's x axis is the third axis of instant-ngp's space.
  const auto key = [](double z) {
    return fmt::format(
        R"({{"R": [0, 0, 0, 1], "T": [0.5, 0.5, {}], "slice": 0, "scale": 1, "fov": 50, )"
        R"("aperture_size": 0}})",
        z);
  };
  const std::string text =
      fmt::format(R"({{"path": [{}, {}], "spline_order": 1, "loop": false}})", key(0.5), key(0.83));
  const Result<ForeignPath> path = ParsedNgp(text, {.frame_count = 4});
  ASSERT_TRUE(path) << path.error().message;
  ASSERT_EQ(path->cameras.size(), 4u);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(path->cameras[static_cast<size_t>(i)].pinhole.CentreWorld().x(), i / 4.0, 1e-12);
}

TEST(NgpPath, ErrorsNameTheKeyframeTheValueAndTheRemedy) {
  ExpectNgpError("\"fov\": 90", "\"fov\": 0", {"path[0]: \"fov\" is 0", "vertical"});
  ExpectNgpError("\"slice\": 1, ", "", {"path[0]: \"slice\" is missing"});
  ExpectNgpError("[0.7071067811865476, 0, 0.7071067811865476, 0]", "[0, 0, 0, 0]",
                 {"path[0]: \"R\" is [0,0,0,0]", "length 1"});
  ExpectNgpError("[1.16, 1.49, 0.83]", "[1.16, 1e7, 0.83]", {"path[0]: \"T\" is [1.16,"});
  ExpectNgpError("0.033", "-0.033", {"\"aperture_size\" is -0.033", "radius"});
  ExpectNgpError("\"spline_order\": 3", "\"spline_order\": 4", {"\"spline_order\" is 4"});
  ExpectNgpError("\"loop\": false", "\"lf_frames\": 2", {"\"lf_frames\" is 2"});
}

TEST(NgpPath, OlderFilesSayDofAndHaveNoTimestamps) {
  const Result<ForeignPath> path = ParsedNgp(With(kNgpText, "aperture_size", "dof"));
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_NEAR(*path->cameras[0].aperture_diameter_w, 0.2, 1e-12);
}

TEST(NgpPath, APinholeMayHaveItsFocusBehindItself) {
  const std::string pinhole = With(kNgpText, "0.033", "0");
  const Result<ForeignPath> path = ParsedNgp(With(pinhole, "\"slice\": 1", "\"slice\": -9"));
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_FALSE(path->cameras[0].focus_distance_w);
}

NgpCurve CurveOf(const std::vector<double>& positions, int order, bool loop = false) {
  NgpCurve curve;
  curve.spline_order = order;
  curve.loop = loop;
  for (const double x : positions) {
    NgpNumbers key = NgpNumbers::Zero();
    key[3] = 1;
    key[4] = x;
    curve.keys.push_back(key);
    curve.timestamps.push_back(0);
  }
  RepairTimestamps(&curve);
  return curve;
}

TEST(NgpCurve, AQuaternionAndItsNegativeAreOneRotation) {
  NgpCurve curve = CurveOf({0, 1}, 1);
  // A turn by 0.8 about x; the negative quaternion would be reached by the longer way.
  curve.keys[1].head<4>() << -std::sin(0.4), 0, 0, -std::cos(0.4);
  const NgpNumbers middle = At(curve, 0.5);
  EXPECT_NEAR(middle[0] / middle[3], std::tan(0.2), 1e-12);
}

TEST(NgpCurve, OrdersZeroAndOnePassThroughTheKeys) {
  for (const int order : {0, 1}) {
    const NgpCurve curve = CurveOf({1, 5, 3}, order);
    EXPECT_NEAR(At(curve, 0)[4], 1, 1e-12);
    EXPECT_NEAR(At(curve, 0.5)[4], 5, 1e-12);
    EXPECT_NEAR(At(curve, 1)[4], 3, 1e-12);
  }
  EXPECT_NEAR(At(CurveOf({1, 5, 3}, 1), 0.25)[4], 3, 1e-12);
  // A loop returns to the first key.
  EXPECT_NEAR(At(CurveOf({1, 5, 3}, 1, true), 5.0 / 6)[4], 2, 1e-12);
}

TEST(NgpCurve, SplinesKeepLinesAndMissKeys) {
  for (const int order : {2, 3}) {
    const NgpCurve line = CurveOf({0, 1, 2, 3, 4, 5, 6}, order);
    // The quadratic curve runs half a key behind.
    EXPECT_NEAR(At(line, 0.5)[4], order == 3 ? 3 : 2.5, 1e-12);
    EXPECT_NEAR(At(line, 0.6)[4] - At(line, 0.5)[4], 0.6, 1e-12);
    EXPECT_GT(std::abs(At(CurveOf({0, 0, 0, 6, 0, 0, 0}, order), 0.5)[4] - 6), 1);
  }
}

TEST(NgpCurve, OppositeQuaternionsAreTheSameRotation) {
  NgpCurve curve = CurveOf({0, 1, 2, 3}, 3);
  curve.keys[2].head<4>() *= -1;
  for (const double t : {0.1, 0.4, 0.5, 0.9}) EXPECT_NEAR(std::abs(At(curve, t)[3]), 1, 1e-12);
}

class NgpFileTest : public FolderTest {
 protected:
  void Write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, text));
  }
  Vec3 Centre(const PathOptions& options) {
    const Result<CameraPath> path = OpenPath(folder_ / "base_cam.json", options);
    if (!path) ADD_FAILURE() << path.error().message;
    return path ? path->Camera({1}).pinhole.CentreWorld() : Vec3::Zero();
  }
};

TEST_F(NgpFileTest, ScaleAndOffsetAreThoseOfTheTransformsJsonOrTheOptions) {
  Write("base_cam.json", kNgpText);
  EXPECT_LT((Centre({}) - Vec3(1, 2, 3)).norm(), 1e-12);
  Write("transforms.json", R"({"scale": 1, "offset": [0.83, 0.16, 0.49], "frames": []})");
  EXPECT_LT((Centre({}) - Vec3(0, 1, 1)).norm(), 1e-12);
  EXPECT_LT((Centre({.ngp_scale = 0.5}) - Vec3(0, 2, 2)).norm(), 1e-12);
  EXPECT_LT((Centre({.ngp_offset = Vec3::Zero()}) - Vec3(0.83, 1.16, 1.49)).norm(), 1e-12);
  std::filesystem::create_directory(folder_ / "field");
  Write("field/transforms.json", R"({"offset": 0, "frames": []})");
  EXPECT_LT((Centre({.light_field = folder_ / "field"}) - Vec3(0.83, 1.16, 1.49) / 0.33).norm(),
            1e-12);
}

TEST_F(NgpFileTest, FramesFollowFromDurationAndRate) {
  std::string two = kNgpText;
  const std::string key =
      two.substr(two.find("{\"R\""), two.find("]", two.find("0.033")) - two.find("{\"R\""));
  two = With(two, key, key + ", " + key);
  Write("base_cam.json", With(two, "\"loop\": false", "\"duration_seconds\": 1.5"));
  EXPECT_EQ(OpenPath(folder_ / "base_cam.json", {.fps = 10})->frame_count(), 15u);
  EXPECT_EQ(OpenPath(folder_ / "base_cam.json", {.frame_count = 7})->frame_count(), 7u);
}

}  // namespace
}  // namespace lf
