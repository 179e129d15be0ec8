// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_reality_xmp.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

std::string XmpWith(const std::string& attributes, const std::string& elements) {
  return R"(<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF
    xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description
    xmlns:xcr="http://www.capturingreality.com/ns/xcr/1.1#" xcr:Version="3" )" +
         attributes + ">" + elements + "</rdf:Description></rdf:RDF></x:xmpmeta>\n";
}

const std::string kLens = R"(xcr:FocalLength35mm="27" xcr:PrincipalPointU="0.01"
    xcr:PrincipalPointV="-0.02" xcr:Skew="0" xcr:AspectRatio="1" )";
const std::string kPose =
    "<xcr:Rotation>1 0 0 0 0 -1 0 1 0</xcr:Rotation><xcr:Position>1 2 3</xcr:Position>";

RealitySidecar ParsedXmp(const std::string& text) {
  const Result<std::optional<RealitySidecar>> sidecar = ParseRealityXmp(text, "f/a.xmp");
  EXPECT_TRUE(sidecar) << sidecar.error().message;
  EXPECT_TRUE(sidecar && *sidecar) << text;
  return sidecar && *sidecar ? **sidecar : RealitySidecar();
}

void ExpectXmpError(const std::string& text, const std::vector<std::string>& parts) {
  const Result<std::optional<RealitySidecar>> sidecar = ParseRealityXmp(text, "f/a.xmp");
  ASSERT_FALSE(sidecar) << text;
  const std::string& message = sidecar.error().message;
  EXPECT_TRUE(message.starts_with("f/a.xmp: ")) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

TEST(RealityXmp, ThePositionIsTheCentreAndTheRotationCamFromWorld) {
  const RealitySidecar sidecar = ParsedXmp(XmpWith(kLens, kPose));
  EXPECT_EQ(sidecar.image.name, "a");
  const RigidTransform& pose = sidecar.image.cam_from_world;
  EXPECT_EQ(pose * Vec3(1, 2, 3), Vec3(0, 0, 0));
  EXPECT_EQ(pose * Vec3(1, 3, 3), Vec3(0, 0, 1));  // looks along y, with z above
  EXPECT_EQ(pose * Vec3(1, 2, 4), Vec3(0, -1, 0));
  EXPECT_EQ(sidecar.image.intrinsics.fx_px, 0.75);
  EXPECT_EQ(sidecar.image.intrinsics.cy_px, -0.02);
  EXPECT_EQ(sidecar.component, "");
}

TEST(RealityXmp, ValuesMayBeAttributesOrElements) {
  const RealitySidecar sidecar = ParsedXmp(
      XmpWith(R"(xcr:Rotation="1 0 0 0 1 0 0 0 1" xcr:DistortionModel="brown4t2")",
              "<xcr:FocalLength35mm>36</xcr:FocalLength35mm><xcr:Position>0 0 5</xcr:Position>"
              "<xcr:DistortionCoeficients>1 2 3 4 5 6</xcr:DistortionCoeficients>"));
  EXPECT_EQ(sidecar.image.cam_from_world.translation, Vec3(0, 0, -5));
  EXPECT_EQ(sidecar.image.intrinsics.distortion,
            (Distortion{DistortionModel::kBrown, {1, 2, 6, 5, 3, 4}}));
}

TEST(RealityXmp, DistortionWithoutAModelIsNone) {
  const std::string coefficients = R"(xcr:DistortionCoeficients="1 2 3 0 5 6" )";
  const auto lens = [&](const std::string& model) {
    return ParsedXmp(XmpWith(kLens + coefficients + model, kPose)).image.intrinsics.distortion;
  };
  EXPECT_EQ(lens(""), Distortion{});
  EXPECT_EQ(lens(R"(xcr:DistortionModel="perspective")"), Distortion{});
  EXPECT_EQ(lens(R"(xcr:DistortionModel="brown3t2")"),
            (Distortion{DistortionModel::kRadialTangential, {1, 2, 6, 5, 3}}));
}

TEST(RealityXmp, FilesOfOtherProgramsStateNoPose) {
  for (const std::string& text :
       {XmpWith(kLens, ""), XmpWith("", ""), std::string("<x:xmpmeta/>")}) {
    const Result<std::optional<RealitySidecar>> sidecar = ParseRealityXmp(text, "f/a.xmp");
    ASSERT_TRUE(sidecar);
    EXPECT_FALSE(*sidecar);
  }
}

TEST(RealityXmp, WhatCannotBeReadIsAnErrorThatNamesIt) {
  ExpectXmpError("<a", {"is not XML"});
  ExpectXmpError(XmpWith("", kPose), {"has no xcr:FocalLength35mm"});
  ExpectXmpError(XmpWith(R"(xcr:FocalLength35mm="nan")", kPose),
                 {"has the xcr:FocalLength35mm \"nan\": expected a number"});
  ExpectXmpError(XmpWith(kLens, "<xcr:Rotation>1 0 0</xcr:Rotation><xcr:Position/>"),
                 {"has the xcr:Rotation \"1 0 0\": expected 9 numbers"});
  ExpectXmpError(XmpWith(kLens,
                         "<xcr:Rotation>-1 0 0 0 1 0 0 0 1</xcr:Rotation>"
                         "<xcr:Position>0 0 0</xcr:Position>"),
                 {"xcr:Rotation is mirrored"});
  ExpectXmpError(XmpWith(kLens,
                         "<xcr:Rotation>1 0 0 0 1 0 0 0 1</xcr:Rotation>"
                         "<xcr:Position>0 0 1e20</xcr:Position>"),
                 {"xcr:Position"});
  ExpectXmpError(XmpWith(R"(xcr:FocalLength35mm="27" xcr:Skew="0.1")", kPose), {"xcr:Skew 0.1"});
  ExpectXmpError(XmpWith(R"(xcr:FocalLength35mm="27" xcr:AspectRatio="1.1")", kPose),
                 {"xcr:AspectRatio 1.1"});
  ExpectXmpError(XmpWith(kLens + R"(xcr:DistortionModel="division"
                         xcr:DistortionCoeficients="-0.2 0 0 0 0 0")",
                         kPose),
                 {"xcr:DistortionModel \"division\"", "Brown3"});
}

class RealityXmpFolder : public FolderTest {
 protected:
  void Write(const std::string& name, const std::string& attributes) const {
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, XmpWith(kLens + attributes, kPose)));
  }
  LightField Read() const {
    ExportOptions options;
    options.image_size = [](const std::filesystem::path&) { return Result(std::array{640, 480}); };
    Result<LightField> light_field = ReadRealityXmp(folder_ / "a.xmp", options);
    EXPECT_TRUE(light_field) << light_field.error().message;
    return light_field ? *std::move(light_field) : LightField();
  }
};

TEST_F(RealityXmpFolder, EveryFileIsTheCameraOfTheImageOfItsName) {
  Write("b.xmp", "");
  Write("a.xmp", "");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "c.xmp", XmpWith("", "")));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.JPG", "x"));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "b.JPG", "x"));
  const LightField light_field = Read();
  EXPECT_EQ(light_field.image_names, (std::vector<std::string>{"a.JPG", "b.JPG"}));
  EXPECT_EQ(light_field.intrinsics.size(), 1u);
  EXPECT_NEAR(light_field.intrinsics[0].cx_px, 326.4, 1e-12);
}

TEST_F(RealityXmpFolder, PosesRelativeToOtherComponentsAreLeftOut) {
  Write("a.xmp", R"(xcr:Coordinates="relative" xcr:ComponentId="{1}")");
  Write("b.xmp", R"(xcr:Coordinates="relative" xcr:ComponentId="{2}")");
  Write("c.xmp", R"(xcr:Coordinates="relative" xcr:ComponentId="{2}")");
  testing::internal::CaptureStderr();
  const LightField light_field = Read();
  EXPECT_EQ(light_field.image_names, (std::vector<std::string>{"b", "c"}));
  const std::string warning = testing::internal::GetCapturedStderr();
  EXPECT_NE(warning.find("1 of 3 cameras are left out"), std::string::npos) << warning;
}

TEST_F(RealityXmpFolder, AbsolutePosesShareOneWorld) {
  Write("a.xmp", R"(xcr:Coordinates="absolute" xcr:ComponentId="{1}")");
  Write("b.xmp", R"(xcr:Coordinates="absolute" xcr:ComponentId="{2}")");
  EXPECT_EQ(Read().size(), 2u);
}

}  // namespace
}  // namespace lf
