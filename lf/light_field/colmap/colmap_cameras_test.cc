// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_cameras.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace lf {
namespace {

Result<Intrinsics> Read(std::string_view name, const std::vector<double>& parameters,
                        uint64_t width = 640, uint64_t height = 480) {
  const Result<ColmapCameraModel> model = FindColmapCameraModel(name);
  if (!model) return model.error();
  EXPECT_EQ(static_cast<size_t>(model->parameter_count), parameters.size()) << name;
  return IntrinsicsOfColmap(*model, width, height, parameters);
}

std::string IntrinsicsErrorOf(const Result<Intrinsics>& result) {
  return result ? "no error" : result.error().message;
}

Intrinsics Expected(double fx, double fy, Distortion distortion) {
  return {fx, fy, 320, 240, 0, 640, 480, distortion};
}

TEST(ColmapCameras, EveryModelIsADistortion) {
  using enum DistortionModel;
  const struct {
    const char* name;
    int number;
    std::vector<double> parameters;
    Intrinsics expected;
  } table[] = {
      {"SIMPLE_PINHOLE", 0, {500, 320, 240}, Expected(500, 500, {})},
      {"PINHOLE", 1, {500, 501, 320, 240}, Expected(500, 501, {})},
      {"SIMPLE_RADIAL", 2, {500, 320, 240, 0.1}, Expected(500, 500, {kRadialTangential, {0.1}})},
      {"RADIAL", 3, {500, 320, 240, 0.1, 0.2}, Expected(500, 500, {kRadialTangential, {0.1, 0.2}})},
      {"OPENCV",
       4,
       {500, 501, 320, 240, 1, 2, 3, 4},
       Expected(500, 501, {kRadialTangential, {1, 2, 3, 4}})},
      {"OPENCV_FISHEYE",
       5,
       {500, 501, 320, 240, 1, 2, 3, 4},
       Expected(500, 501, {kFisheye, {1, 2, 3, 4}})},
      {"FULL_OPENCV",
       6,
       {500, 501, 320, 240, 1, 2, 3, 4, 5, 6, 7, 8},
       Expected(500, 501, {kRadialTangential, {1, 2, 3, 4, 5, 6, 7, 8}})},
      {"FOV", 7, {500, 501, 320, 240, 0.9}, Expected(500, 501, {kFov, {0.9}})},
      {"SIMPLE_RADIAL_FISHEYE", 8, {500, 320, 240, 0.1}, Expected(500, 500, {kFisheye, {0.1}})},
      {"RADIAL_FISHEYE", 9, {500, 320, 240, 0.1, 0.2}, Expected(500, 500, {kFisheye, {0.1, 0.2}})},
      {"THIN_PRISM_FISHEYE",
       10,
       {500, 501, 320, 240, 1, 2, 3, 4, 5, 6, 7, 8},
       Expected(500, 501, {kThinPrism, {1, 2, 3, 4, 5, 6, 7, 8}})},
      {"RAD_TAN_THIN_PRISM_FISHEYE",
       11,
       {500, 501, 320, 240, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12},
       Expected(500, 501, {kRadialTangentialThinPrism, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}})},
      {"SIMPLE_DIVISION", 12, {500, 320, 240, -0.1}, Expected(500, 500, {kDivision, {-0.1}})},
      {"DIVISION", 13, {500, 501, 320, 240, -0.1}, Expected(500, 501, {kDivision, {-0.1}})},
      {"SIMPLE_FISHEYE", 14, {500, 320, 240}, Expected(500, 500, {kFisheye, {}})},
      {"FISHEYE", 15, {500, 501, 320, 240}, Expected(500, 501, {kFisheye, {}})},
      {"EUCM", 16, {500, 501, 320, 240, 0.6, 1.1}, Expected(500, 501, {kUnified, {0.6, 1.1}})},
  };
  for (const auto& row : table) {
    const Result<Intrinsics> intrinsics = Read(row.name, row.parameters);
    ASSERT_TRUE(intrinsics) << intrinsics.error().message;
    EXPECT_EQ(*intrinsics, row.expected) << row.name;
    EXPECT_EQ(FindColmapCameraModel(row.number)->name, row.name);
  }
}

TEST(ColmapCameras, WhatBendsNothingIsAPinhole) {
  const Intrinsics pinhole = Expected(500, 500, {});
  EXPECT_EQ(*Read("SIMPLE_RADIAL", {500, 320, 240, 0}), pinhole);
  EXPECT_EQ(*Read("OPENCV", {500, 500, 320, 240, 0, -0.0, 0, 0}), pinhole);
  EXPECT_EQ(*Read("FOV", {500, 500, 320, 240, 0}), pinhole);
  EXPECT_EQ(*Read("FOV", {500, 500, 320, 240, 5e-324}), pinhole);
  EXPECT_EQ(*Read("DIVISION", {500, 500, 320, 240, 0}), pinhole);
  EXPECT_EQ(*Read("EUCM", {500, 500, 320, 240, 0, 1}), pinhole);
  EXPECT_NE(
      IntrinsicsErrorOf(Read("EUCM", {500, 500, 320, 240, 1.2, 1})).find("parameters alpha 1.2"),
      std::string::npos);
  // A fish-eye lens without coefficients still bends rays: rd = theta.
  EXPECT_TRUE(Read("OPENCV_FISHEYE", {500, 500, 320, 240, 0, 0, 0, 0})->has_distortion());
}

TEST(ColmapCameras, TheSignOfOmegaDoesNotMatter) {
  EXPECT_EQ(*Read("FOV", {500, 500, 320, 240, -0.9}), *Read("FOV", {500, 500, 320, 240, 0.9}));
  EXPECT_NE(IntrinsicsErrorOf(Read("FOV", {500, 500, 320, 240, 3.2})).find("parameter omega 3.2"),
            std::string::npos);
}

TEST(ColmapCameras, OtherModelsAreNamedWithAWayOut) {
  for (const char* name : {"opencv", "", "OPENCV2"}) {
    const Result<ColmapCameraModel> model = FindColmapCameraModel(name);
    ASSERT_FALSE(model) << name;
    EXPECT_NE(model.error().message.find(name), std::string::npos);
    EXPECT_NE(model.error().message.find("colmap image_undistorter"), std::string::npos);
  }
  EXPECT_NE(FindColmapCameraModel(18).error().message.find("number 18"), std::string::npos);
  EXPECT_NE(FindColmapCameraModel(-1).error().message.find("number -1"), std::string::npos);
}

TEST(ColmapCameras, APanoramaIsNoLfImage) {
  for (const Result<ColmapCameraModel>& model :
       {FindColmapCameraModel(17), FindColmapCameraModel("EQUIRECTANGULAR")}) {
    ASSERT_FALSE(model);
    const std::string& message = model.error().message;
    EXPECT_NE(message.find("EQUIRECTANGULAR, which is a panorama"), std::string::npos) << message;
    EXPECT_NE(message.find("perspective or fish-eye"), std::string::npos) << message;
  }
}

TEST(ColmapCameras, NumbersOutOfRangeAreErrors) {
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> good = {500, 500, 320, 240};
  EXPECT_NE(IntrinsicsErrorOf(Read("PINHOLE", good, 0, 480)).find("0 x 480 pixels"),
            std::string::npos);
  EXPECT_NE(IntrinsicsErrorOf(Read("PINHOLE", good, 640, 65537)).find("640 x 65537"),
            std::string::npos);
  EXPECT_NE(IntrinsicsErrorOf(Read("PINHOLE", good, 65536, 65536)).find("2^30"), std::string::npos);
  EXPECT_NE(
      IntrinsicsErrorOf(Read("PINHOLE", {500, kNotANumber, 320, 240})).find("500 nan 320 240"),
      std::string::npos);
  EXPECT_NE(IntrinsicsErrorOf(Read("PINHOLE", {500, -1, 320, 240})).find("focal length of -1 px"),
            std::string::npos);
  EXPECT_NE(IntrinsicsErrorOf(Read("PINHOLE", {500, 500, 320, 1e8}))
                .find("principal point at 100000000 px"),
            std::string::npos);
  EXPECT_NE(
      IntrinsicsErrorOf(Read("SIMPLE_RADIAL", {500, 320, 240, -2e6})).find("parameter -2000000"),
      std::string::npos);
  EXPECT_NE(IntrinsicsErrorOf(Read("SIMPLE_RADIAL", {500, 320, 240, 1 / 0.0})).find("inf"),
            std::string::npos);
}

}  // namespace
}  // namespace lf
