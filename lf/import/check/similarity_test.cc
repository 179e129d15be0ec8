// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/similarity.h"

#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

std::string MessageOf(const std::string& text) {
  const Result<Similarity> similarity = ParseSimilarity(text);
  return similarity ? "" : similarity.error().message;
}

// A quarter turn about z, with the scale 2 and the translation (10, 20, 30).
constexpr const char* kTurned = "0 -2 0 10\n2 0 0 20\n0 0 2 30\n0 0 0 1\n";

LightField TwoCameras() {
  LightField light_field;
  light_field.intrinsics = {{100, 90, 50, 40, 0, 100, 80}};
  light_field.cameras.push_back({*LookAlong({1, 2, 3}, {0.1, 0.2, 1}, {0, -1, 0}), 0, 1});
  light_field.cameras.push_back({*LookAlong({-1, 0, 2}, {1, 0.3, 0.2}, {0, 0, 1}), 0, 1});
  light_field.image_names = {"a.png", "b.png"};
  light_field.depth_range = DepthRange{1, 4};
  return light_field;
}

TEST(Similarity, IsReadFromTextAndFromJson) {
  for (const std::string& text :
       {std::string(kTurned), std::string("[[0, -2, 0, 10], [2, 0, 0, 20], [0,0,2,30],[0,0,0,1]]"),
        std::string("0,-2e0,0,+10;2,0,0,20;0,0,2,30;0,0,0,1")}) {
    const Result<Similarity> similarity = ParseSimilarity(text);
    ASSERT_TRUE(similarity) << similarity.error().message;
    EXPECT_DOUBLE_EQ(similarity->scale, 2);
    EXPECT_LT((similarity->rotation * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
    EXPECT_EQ(similarity->translation, Vec3(10, 20, 30));
  }
}

TEST(Similarity, OtherMatricesAreErrors) {
  EXPECT_NE(MessageOf("1 2 3").find("3 numbers: expected 16"), std::string::npos);
  EXPECT_NE(MessageOf("").find("0 numbers"), std::string::npos);
  EXPECT_NE(MessageOf(std::string(kTurned) + " 1").find("more than 16"), std::string::npos);
  EXPECT_NE(MessageOf("a 2 3").find("holds \"a\": expected a number"), std::string::npos);
  EXPECT_NE(MessageOf("1e13").find("expected a number from -1e12"), std::string::npos);
  EXPECT_NE(MessageOf("nan").find("expected a number"), std::string::npos);
  EXPECT_NE(MessageOf("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2").find("last row"), std::string::npos);
  EXPECT_NE(MessageOf("-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1").find("mirror the scene"),
            std::string::npos);
  EXPECT_NE(MessageOf("0 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1").find("determinant"), std::string::npos);
  EXPECT_NE(MessageOf("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1").find("equal lengths"), std::string::npos);
  EXPECT_NE(MessageOf("1 0.1 0 0 0 1 0 0 0 0 1 0 0 0 0 1").find("right angles"), std::string::npos);
  EXPECT_NE(MessageOf("1e-11 0 0 0 0 1e-11 0 0 0 0 1e-11 0 0 0 0 1").find("scale"),
            std::string::npos);
}

TEST(Similarity, FewDigitsAreTheNearestRotation) {
  const Result<Similarity> similarity =
      ParseSimilarity("0.8660 -0.5 0 0  0.5 0.8660 0 0  0 0 1 0  0 0 0 1");
  ASSERT_TRUE(similarity) << similarity.error().message;
  const Mat3& r = similarity->rotation;
  EXPECT_LT((r.transpose() * r - Mat3::Identity()).norm(), 1e-14);
  EXPECT_NEAR(r(1, 0), 0.5, 1e-4);
}

class SimilarityFileTest : public FolderTest {};

TEST_F(SimilarityFileTest, IsNumbersOrTheNameOfAFile) {
  const std::string path = (folder_ / "m.txt").string();
  ASSERT_TRUE(WriteFileAtomically(path, kTurned));
  EXPECT_EQ(ReadSimilarity(path)->translation, Vec3(10, 20, 30));
  EXPECT_EQ(ReadSimilarity(kTurned)->translation, Vec3(10, 20, 30));
  EXPECT_NE(ReadSimilarity("1 2 3").error().message.find("3 numbers"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(path, "1 2 3"));
  EXPECT_NE(ReadSimilarity(path).error().message.find("m.txt: the transform holds 3 numbers"),
            std::string::npos);
  EXPECT_NE(ReadSimilarity((folder_ / "no").string()).error().message.find("no"),
            std::string::npos);
}

TEST(Similarity, MovesTheWorldUnderTheSamePixels) {
  const LightField before = TwoCameras();
  LightField after = before;
  const Similarity b_from_a = *ParseSimilarity(kTurned);
  ASSERT_TRUE(Transform(b_from_a, &after));
  const auto moved = [](const Vec3& x) {
    return Vec3(10 - 2 * x.y(), 20 + 2 * x.x(), 30 + 2 * x.z());
  };
  const Vec3 point(1.5, 2.2, 6);
  for (uint32_t i = 0; i < 2; ++i) {
    EXPECT_LT((after.Camera({i}).CentreWorld() - moved(before.Camera({i}).CentreWorld())).norm(),
              1e-13);
    const auto pixel = Project(before.Camera({i}), point);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*Project(after.Camera({i}), moved(point)) - *pixel).norm(), 1e-11);
  }
  EXPECT_EQ(after.depth_range, (DepthRange{2, 8}));
  EXPECT_EQ(after.unit_m, 1);
}

TEST(Similarity, PositionsStayWithinBounds) {
  LightField light_field = TwoCameras();
  light_field.cameras[1].cam_from_world.translation = Vec3(1e4, 0, 0);
  Similarity far;
  far.scale = 1e9;
  const Result<void> result = Transform(far, &light_field);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("b.png: the transform would move"), std::string::npos);
}

}  // namespace
}  // namespace lf
