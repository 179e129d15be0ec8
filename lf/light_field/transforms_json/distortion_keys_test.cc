// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/distortion_keys.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace {

// Parses a file with one frame. `top` and `frame` hold keys, each followed by a comma.
Result<LightField> Parse(const std::string& top, const std::string& frame) {
  return ParseTransformsJson(R"({"fl_x": 500, "w": 640, "h": 480, )" + top + R"("frames": [{)" +
                                 frame + R"("file_path": "a.png",
                                 "transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3]]}]})",
                             "data/transforms.json");
}

Distortion LensOf(const std::string& top, const std::string& frame = "") {
  const Result<LightField> light_field = Parse(top, frame);
  EXPECT_TRUE(light_field) << light_field.error().message << "\n" << top << frame;
  return light_field ? light_field->intrinsics[0].distortion : Distortion{};
}

void ExpectLensError(const std::string& top, const std::string& frame,
                     const std::vector<std::string>& parts) {
  const Result<LightField> light_field = Parse(top, frame);
  ASSERT_FALSE(light_field) << top << frame;
  const std::string& message = light_field.error().message;
  EXPECT_EQ(message.find("data/transforms.json: "), 0u) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

using enum DistortionModel;

TEST(DistortionKeys, EveryCameraModelPutsItsParametersInTheirPlaces) {
  const std::string full =
      R"("k1": 1, "k2": 2, "k3": 3, "k4": 4, "k5": 5, "k6": 6, "p1": 7, "p2": 8, )";
  EXPECT_EQ(LensOf(R"("camera_model": "FULL_OPENCV", )" + full),
            (Distortion{kRadialTangential, {1, 2, 7, 8, 3, 4, 5, 6}}));
  EXPECT_EQ(LensOf(R"("camera_model": "OPENCV", "k1": 1, "k2": 2, "k3": 3, "p1": 7, "p2": 8, )"),
            (Distortion{kRadialTangential, {1, 2, 7, 8, 3, 0, 0, 0}}));
  EXPECT_EQ(LensOf(R"("camera_model": "BROWN", "k1": 1, "k2": 2, "k3": 3, "k4": 4, "p1": 7,
                      "p2": 8, )"),
            (Distortion{kBrown, {1, 2, 7, 8, 3, 4}}));
  EXPECT_EQ(LensOf(R"("camera_model": "RADIAL", "k1": 1, "k2": 2, )"),
            (Distortion{kRadialTangential, {1, 2}}));
  EXPECT_EQ(LensOf(R"("camera_model": "SIMPLE_RADIAL", "k1": 1, )"),
            (Distortion{kRadialTangential, {1}}));
  EXPECT_EQ(LensOf(R"("camera_model": "OPENCV_FISHEYE", "k1": 1, "k2": 2, "k3": 3, "k4": 4, )"),
            (Distortion{kFisheye, {1, 2, 3, 4}}));
  EXPECT_EQ(LensOf(R"("camera_model": "RADIAL_FISHEYE", "k1": 1, "k2": 2, )"),
            (Distortion{kFisheye, {1, 2}}));
  EXPECT_EQ(LensOf(R"("camera_model": "SIMPLE_RADIAL_FISHEYE", "k1": 1, )"),
            (Distortion{kFisheye, {1}}));
  EXPECT_EQ(LensOf(R"("camera_model": "FOV", "lf_fov_omega": 0.9, )"), (Distortion{kFov, {0.9}}));
  EXPECT_EQ(LensOf(R"("camera_model": "FISHEYE", )"), (Distortion{kFisheye, {}}));
  EXPECT_EQ(LensOf(R"("camera_model": "DIVISION", "k1": -0.2, )"), (Distortion{kDivision, {-0.2}}));
  EXPECT_EQ(LensOf(R"("camera_model": "EUCM", "lf_eucm_alpha": 0.5, "lf_eucm_beta": 2, )"),
            (Distortion{kUnified, {0.5, 2}}));
  EXPECT_EQ(LensOf(R"("camera_model": "EUCM", "lf_eucm_beta": 2, )"), Distortion{});
  EXPECT_EQ(LensOf(R"("camera_model": "THIN_PRISM_FISHEYE", "k3": 0.1, "lf_sy1": 0.2, )"),
            (Distortion{kThinPrism, {0, 0, 0, 0, 0.1, 0, 0, 0.2}}));
  EXPECT_EQ(LensOf(R"("camera_model": "RAD_TAN_THIN_PRISM_FISHEYE", "k1": 1, "k2": 2, "k3": 3,
                      "k4": 4, "k5": 5, "k6": 6, "lf_p0": 7, "lf_p1": 8, "lf_s0": 9, "lf_s1": 10,
                      "lf_s2": 11, "lf_s3": 12, )"),
            (Distortion{kRadialTangentialThinPrism, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}}));
  EXPECT_EQ(LensOf(R"("camera_model": "PINHOLE", "k1": 0, "p2": 0.0, )"), Distortion{});
  EXPECT_EQ(LensOf(R"("camera_model": "SIMPLE_PINHOLE", )"), Distortion{});
}

TEST(DistortionKeys, WithoutACameraModelTheyAreThoseOfInstantNgp) {
  EXPECT_EQ(LensOf(R"("k1": 0.1, "k2": 0.2, "p1": 0.3, "p2": 0.4, )"),
            (Distortion{kRadialTangential, {0.1, 0.2, 0.3, 0.4}}));
  EXPECT_EQ(LensOf(R"("is_fisheye": false, "k3": 0.1, "k4": 0, )"),
            (Distortion{kRadialTangential, {0, 0, 0, 0, 0.1}}));
  EXPECT_EQ(LensOf(R"("is_fisheye": true, "k1": 0.1, "k4": 0.4, "p1": 0, )"),
            (Distortion{kFisheye, {0.1, 0, 0, 0.4}}));
  EXPECT_EQ(LensOf(R"("is_fisheye": true, "camera_model": "OPENCV_FISHEYE", )").model, kFisheye);
}

TEST(DistortionKeys, ZerosAreNoDistortionButForAFisheye) {
  EXPECT_EQ(LensOf(""), Distortion{});
  EXPECT_EQ(LensOf(R"("camera_model": "OPENCV", "k1": 0, "k2": -0.0, "p1": null, )"), Distortion{});
  EXPECT_EQ(LensOf(R"("camera_model": "FULL_OPENCV", )"), Distortion{});
  EXPECT_EQ(LensOf(R"("camera_model": "BROWN", )"), Distortion{});
  EXPECT_EQ(LensOf(R"("camera_model": "OPENCV_FISHEYE", "k1": 0, )"), (Distortion{kFisheye, {}}));
  EXPECT_EQ(LensOf(R"("is_fisheye": true, )"), (Distortion{kFisheye, {}}));
}

TEST(DistortionKeys, AFrameOverridesTheTopLevelKeyByKey) {
  EXPECT_EQ(LensOf(R"("k1": 0.1, "k2": 0.2, )", R"("k1": 0.5, "p1": 0.3, )"),
            (Distortion{kRadialTangential, {0.5, 0.2, 0.3}}));
  EXPECT_EQ(LensOf(R"("camera_model": "RADIAL", "k1": 0.1, )", R"("k1": 0, )"), Distortion{});
  EXPECT_EQ(
      LensOf(R"("camera_model": "OPENCV", "k1": 0.1, )", R"("camera_model": "OPENCV_FISHEYE", )"),
      (Distortion{kFisheye, {0.1}}));
  EXPECT_EQ(LensOf(R"("camera_model": "FOV", "lf_fov_omega": 0.9, )",
                   R"("camera_model": "PINHOLE", "lf_fov_omega": 0, )"),
            Distortion{});
  EXPECT_EQ(LensOf("", R"("lf_skew": 0.25, )"), Distortion{});
  EXPECT_EQ(Parse(R"("lf_skew": 2, )", R"("lf_skew": 0.25, )")->intrinsics[0].skew_px, 0.25);
  EXPECT_EQ(Parse(R"("lf_skew": 2, )", "")->intrinsics[0].skew_px, 2);
}

TEST(DistortionKeys, K4WithOpenCvIsAmbiguous) {
  for (const char* model : {"", R"("camera_model": "OPENCV", )"})
    ExpectLensError(std::string(model) + R"("k4": 0.01, )", "",
                    {"\"k4\" is 0.01", "ambiguous", "FULL_OPENCV", "BROWN"});
}

TEST(DistortionKeys, ParametersThatTheModelLacksAreErrors) {
  ExpectLensError(R"("camera_model": "PINHOLE", "k1": 0.1, )", "",
                  {"(a.png): \"k1\" is 0.1", "\"PINHOLE\" has no such parameter"});
  ExpectLensError(R"("camera_model": "SIMPLE_RADIAL", )", R"("k2": 0.1, )", {"\"k2\" is 0.1"});
  ExpectLensError(R"("camera_model": "RADIAL", "p1": 0.1, )", "", {"\"p1\" is 0.1", "\"RADIAL\""});
  ExpectLensError(R"("camera_model": "OPENCV", "k5": 0.1, )", "", {"\"k5\"", "FULL_OPENCV has"});
  ExpectLensError(R"("camera_model": "OPENCV_FISHEYE", "p2": 0.1, )", "", {"\"p2\" is 0.1"});
  ExpectLensError(R"("camera_model": "SIMPLE_RADIAL_FISHEYE", "k2": 0.1, )", "", {"\"k2\" is 0.1"});
  ExpectLensError(R"("is_fisheye": true, "k5": 0.1, )", "", {"\"k5\"", "OPENCV_FISHEYE"});
  ExpectLensError(R"("camera_model": "RAD_TAN_THIN_PRISM_FISHEYE", "p1": 0.1, )", "",
                  {"\"p1\" is 0.1", "\"RAD_TAN_THIN_PRISM_FISHEYE\" has no such"});
  ExpectLensError(R"("camera_model": "OPENCV_FISHEYE", "lf_s3": 0.1, )", "", {"\"lf_s3\" is 0.1"});
  ExpectLensError(R"("camera_model": "EUCM", "lf_eucm_alpha": 0.5, )", "", {"lf_eucm_beta 0"});
  ExpectLensError(R"("camera_model": "OPENCV", "lf_fov_omega": 0.9, )", "",
                  {"\"lf_fov_omega\" is 0.9"});
  ExpectLensError(R"("camera_model": "FOV", "lf_fov_omega": 0.9, "k1": 1, )", "", {"\"k1\" is 1"});
}

TEST(DistortionKeys, ContradictionsAndWrongValuesAreErrors) {
  ExpectLensError(R"("camera_model": "OPENCV", "is_fisheye": true, )", "",
                  {"is_fisheye", "\"OPENCV\"", "contradict"});
  ExpectLensError(R"("camera_model": "OPENCV_FISHEYE", )", R"("is_fisheye": false, )",
                  {"contradict"});
  ExpectLensError(R"("camera_model": "FOV", )", "", {"\"lf_fov_omega\" is missing"});
  ExpectLensError(R"("camera_model": "FOV", "lf_fov_omega": 3.2, )", "",
                  {"lf_fov_omega", "below pi"});
  ExpectLensError(R"("camera_model": "EQUIRECTANGULAR", )", "",
                  {"EQUIRECTANGULAR", "PINHOLE", "FULL_OPENCV", "RADIAL_FISHEYE", "undistort"});
  ExpectLensError(R"("camera_model": 3, )", "", {"\"camera_model\" is 3"});
  ExpectLensError(R"("k1": "0.1", )", "", {"\"k1\" is \"0.1\""});
  ExpectLensError(R"("k6": 1e7, )", "", {"\"k6\"", "within +-1e6"});
  ExpectLensError("", R"("lf_skew": 1e8, )", {"frames[0] (a.png): \"lf_skew\""});
}

}  // namespace
}  // namespace lf
