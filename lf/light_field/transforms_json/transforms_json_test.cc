// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/transforms_json.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

constexpr const char* kUnturned = R"([[1,0,0,1], [0,1,0,2], [0,0,1,3], [0,0,0,1]])";

// Returns a file with one frame. `top` and `frame` are additional keys; each key ends in a comma.
std::string OneFrame(const std::string& top, const std::string& frame = "") {
  return "{" + top + R"("frames": [{)" + frame +
         R"("file_path": "images/a.png", "transform_matrix": )" + kUnturned + "}]}";
}

const std::string kSize = R"("w": 640, "h": 480, )";
const std::string kIntrinsics = R"("fl_x": 500, )" + kSize;

LightField Parsed(const std::string& text) {
  Result<LightField> light_field = ParseTransformsJson(text, "data/transforms.json");
  EXPECT_TRUE(light_field) << light_field.error().message << "\n" << text;
  return light_field ? *std::move(light_field) : LightField{};
}

std::string ErrorOf(const std::string& text) {
  const Result<LightField> light_field = ParseTransformsJson(text, "data/transforms.json");
  EXPECT_FALSE(light_field) << text;
  return light_field ? "" : light_field.error().message;
}

void ExpectError(const std::string& text, const std::vector<std::string>& parts) {
  const std::string message = ErrorOf(text);
  EXPECT_EQ(message.find("data/transforms.json: "), 0u) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

TEST(TransformsJson, ReadsPoseIntrinsicsAndName) {
  const LightField light_field =
      Parsed(OneFrame(R"("camera_model": "OPENCV", "fl_x": 500, "fl_y": 510, "cx": 321, "cy": 239,
                  "w": 640.0, "h": 480, "k1": 0, "k2": 0.0, "is_fisheye": false,
                  "aabb_scale": 16, "applied_scale": 2, "applied_transform": [[1]], )",
                      R"("sharpness": 30, "colmap_im_id": 7, )"));
  ASSERT_EQ(light_field.size(), 1u);
  EXPECT_EQ(light_field.image_names[0], "images/a.png");
  EXPECT_EQ(light_field.ImagePath({0}), "data/images/a.png");
  const PinholeCamera camera = light_field.Camera({0});
  EXPECT_EQ(camera.intrinsics, (Intrinsics{500, 510, 321, 239, 0, 640, 480}));
  EXPECT_EQ(camera.CentreWorld(), Vec3(1, 2, 3));
  EXPECT_EQ(camera.ForwardWorld(), Vec3(0, 0, -1));
  EXPECT_EQ(camera.UpWorld(), Vec3(0, 1, 0));
  EXPECT_TRUE(light_field.mask_names.empty());
  EXPECT_EQ(light_field.unit_m, 1);
  EXPECT_EQ(light_field.cameras[0].gain, ChannelGains());
}

TEST(TransformsJson, FocalLengthAndCentreHaveDefaults) {
  const Intrinsics k = Parsed(OneFrame(kIntrinsics)).intrinsics[0];
  EXPECT_EQ(k, (Intrinsics{500, 500, 320, 240, 0, 640, 480}));
}

TEST(TransformsJson, BlendersAngleOfViewGivesTheFocalLength) {
  const Intrinsics k =
      Parsed(OneFrame(R"("camera_angle_x": 1.5707963267948966, )" + kSize)).intrinsics[0];
  EXPECT_NEAR(k.fx_px, 320, 1e-10);
  EXPECT_EQ(k.fy_px, k.fx_px);
  const Intrinsics both =
      Parsed(OneFrame(R"("camera_angle_x": 1, "camera_angle_y": 1, )" + kSize)).intrinsics[0];
  EXPECT_NEAR(both.fy_px, 240 / std::tan(0.5), 1e-10);
}

TEST(TransformsJson, AFrameOverridesTheTopLevelKeyByKey) {
  const auto k = [](const std::string& top, const std::string& frame) {
    return Parsed(OneFrame(top + kSize, frame)).intrinsics[0];
  };
  EXPECT_EQ(k(R"("fl_x": 500, "fl_y": 510, "cx": 3, )", R"("fl_x": 600, "cx": 4, )"),
            (Intrinsics{600, 510, 4, 240, 0, 640, 480}));
  EXPECT_EQ(k(R"("fl_x": 500, )", R"("w": 320, )"), (Intrinsics{500, 500, 160, 240, 0, 320, 480}));
  // Within the frame or the top level, a length takes precedence over an angle; any key of the
  // frame takes precedence over the top level.
  EXPECT_EQ(k(R"("fl_x": 500, "camera_angle_x": 1, )", "").fx_px, 500);
  EXPECT_NEAR(k(R"("fl_x": 500, )", R"("camera_angle_x": 1, )").fx_px, 320 / std::tan(0.5), 1e-10);
}

TEST(TransformsJson, WhatFollowsTheFramesCountsToo) {
  const std::string frame =
      std::string(R"({"file_path": "a.png", "transform_matrix": )") + kUnturned + "}";
  const LightField light_field =
      Parsed(R"({"frames": [)" + frame + "," + frame + R"(], "fl_x": 5, "w": 6, "h": 7})");
  EXPECT_EQ(light_field.size(), 2u);
  EXPECT_EQ(light_field.intrinsics.size(), 1u);
  EXPECT_EQ(light_field.Camera({1}).intrinsics.width_px, 6);
}

TEST(TransformsJson, EqualIntrinsicsAreKeptOnce) {
  std::string frames;
  for (int i = 0; i < 30; ++i)
    frames += std::string(i ? "," : "") + R"({"file_path": "a.png", "fl_x": )" +
              std::to_string(100 + i % 3) + R"(, "transform_matrix": )" + kUnturned + "}";
  const LightField light_field = Parsed("{" + kSize + R"("fl_y": 9, "frames": [)" + frames + "]}");
  EXPECT_EQ(light_field.intrinsics.size(), 3u);
  for (uint32_t i = 0; i < 30; ++i)
    EXPECT_EQ(light_field.Camera({i}).intrinsics.fx_px, 100 + i % 3);
}

TEST(TransformsJson, NamesWithoutExtensionAreOfPngFiles) {
  const auto name = [](const std::string& file_path) {
    const std::string text = "{" + kIntrinsics + R"("frames": [{"file_path": ")" + file_path +
                             R"(", "transform_matrix": )" + kUnturned + "}]}";
    return Parsed(text).ImagePath({0}).string();
  };
  EXPECT_EQ(name("./train/r_0"), "data/./train/r_0.png");
  EXPECT_EQ(name("a.b/r_0"), "data/a.b/r_0.png");
  EXPECT_EQ(name("r_0.JPG"), "data/r_0.JPG");
  EXPECT_EQ(name("/absolute/r.exr"), "/absolute/r.exr");
  EXPECT_EQ(name("\\u00e9t\\u00e9 1.png"), "data/\u00e9t\u00e9 1.png");
}

TEST(TransformsJson, MatricesMayBeScaledAndLackTheLastRow) {
  const auto camera = [](const std::string& matrix) {
    return Parsed("{" + kIntrinsics + R"("frames": [{"file_path": "a.png", "transform_matrix": )" +
                  matrix + "}]}")
        .Camera({0});
  };
  EXPECT_EQ(camera("[[1,0,0,1],[0,1,0,2],[0,0,1,3]]").CentreWorld(), Vec3(1, 2, 3));
  const PinholeCamera scaled = camera("[[2,0,0,1],[0,2,0,2],[0,0,2,3],[0,0,0,1]]");
  EXPECT_EQ(scaled.CentreWorld(), Vec3(1, 2, 3));
  EXPECT_EQ(scaled.cam_from_world.rotation, Mat3(Vec3(1, -1, -1).asDiagonal()));
}

TEST(TransformsJson, BrokenMatricesAreErrorsThatNameTheFrame) {
  const auto expect = [](const std::string& matrix, const std::string& part) {
    const std::string good =
        R"({"file_path": "a.png", "transform_matrix": )" + std::string(kUnturned) + "}";
    const std::string frame = R"({"file_path": "b.png", "transform_matrix": )" + matrix + "}";
    ExpectError("{" + kIntrinsics + R"("frames": [)" + good + "," + frame + "]}",
                {"frames[1] (b.png): \"transform_matrix\"", part});
  };
  expect("[[-1,0,0,1],[0,1,0,2],[0,0,1,3]]", "mirrored");
  expect("[[1,0.5,0,1],[0,1,0,2],[0,0,1,3]]", "sheared");
  expect("[[1,0,0,1],[0,1,0,2],[0,0,2,3]]", "scaled");
  expect("[[0,0,0,1],[0,0,0,2],[0,0,0,3]]", "determinant");
  expect("[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,1,1]]", "last row");
  expect("[[1,0,0,1],[0,1,0,2],[0,0,1,1e300]]", "1e+12");
  expect("[[1,0,0,1],[0,1,0,2]]", "3 to 4 lists of 4 numbers");
  expect("[[1,0,0],[0,1,0],[0,0,1]]", "4 lists of 4 numbers");
  expect("[[1,0,0,1],[0,1,0,2],[0,0,1,\"3\"]]", "4 lists of 4 numbers");
  expect("[]", "[]");
  expect("7", "is 7");
  expect("null", "is missing");
}

TEST(TransformsJson, ReadsTheDepthRange) {
  const auto range = [](const std::string& list) {
    return OneFrame(kIntrinsics + R"("lf_depth_range": )" + list + ", ");
  };
  EXPECT_EQ(Parsed(range("[0.5, 20]")).depth_range, (DepthRange{0.5, 20}));
  EXPECT_EQ(Parsed(OneFrame(kIntrinsics)).depth_range, std::nullopt);
  ExpectError(range("[0, 20]"), {"lf_depth_range", "above 0"});
  ExpectError(range("[20, 20]"), {"lf_depth_range", "near < far"});
  ExpectError(range("[1, 2, 3]"), {"lf_depth_range", "a list of 2 numbers"});
}

TEST(TransformsJson, AMissingSizeIsThatOfMostImagesAskedForOnce) {
  const std::string frame = std::string(R"("transform_matrix": )") + kUnturned + "}";
  const std::string text = R"({"camera_angle_x": 1, "frames": [{"file_path": "./train/r_0", )" +
                           frame + R"(, {"file_path": "b", "w": 100, "fl_x": 7, )" + frame + "]}";
  std::vector<std::string> asked;
  const auto size = [&asked](const std::filesystem::path& image) {
    asked.push_back(image.string());
    return asked.size() == 1 ? std::array{800, 600} : std::array{80, 60};
  };
  const Result<LightField> light_field = ParseTransformsJson(text, "d/t.json", size);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(asked, (std::vector<std::string>{"d/./train/r_0.png", "d/b.png"}));
  const Intrinsics k = light_field->Camera({0}).intrinsics;
  EXPECT_EQ(k.width_px, 800);
  EXPECT_EQ(k.height_px, 600);
  EXPECT_EQ(k.cy_px, 300);
  EXPECT_NEAR(k.fx_px, 400 / std::tan(0.5), 1e-10);
  EXPECT_EQ(light_field->Camera({1}).intrinsics, (Intrinsics{7, 7, 50, 300, 0, 100, 600}));

  const auto fails = [](const auto&) -> Result<std::array<int, 2>> {
    return InputError("r_0.png: no such file");
  };
  const Result<LightField> error = ParseTransformsJson(text, "d/t.json", fails);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message.find("d/t.json: the image size is missing"), 0u);
  EXPECT_NE(error.error().message.find("r_0.png: no such file; add \"w\""), std::string::npos);
}

TEST(TransformsJson, IntrinsicsOutOfRangeAreErrorsThatNameKeyAndValue) {
  ExpectError(OneFrame(R"("fl_x": 0, )" + kSize), {"\"fl_x\" is 0: expected"});
  ExpectError(OneFrame(kIntrinsics, R"("fl_x": -3, )"),
              {"frames[0] (images/a.png): \"fl_x\" is -3: expected"});
  ExpectError(OneFrame(R"("fl_x": "500", )" + kSize), {"\"fl_x\" is \"500\""});
  ExpectError(OneFrame(R"("fl_x": 1e300, )" + kSize), {"\"fl_x\""});
  ExpectError(OneFrame(R"("camera_angle_x": 4, )" + kSize), {"\"camera_angle_x\" is 4", "radians"});
  ExpectError(OneFrame(R"("fl_x": 5, "w": 640.5, "h": 480, )"), {"\"w\" is 640.5"});
  ExpectError(OneFrame(R"("fl_x": 5, "w": 640, "h": 0, )"), {"\"h\" is 0"});
  ExpectError(OneFrame(R"("fl_x": 5, "w": 70000, "h": 1, )"), {"\"w\" is 70000"});
  ExpectError(OneFrame(R"("fl_x": 5, "w": 65536, "h": 65536, )"), {"2^30"});
  ExpectError(OneFrame(R"("cx": 1e9, )" + kIntrinsics), {"\"cx\""});
}

TEST(TransformsJson, MissingSizeAndFocalLengthSayWhatToAdd) {
  ExpectError(OneFrame(R"("camera_angle_x": 0.69, )"),
              {"the image size is missing", "add \"w\" and \"h\""});
  ExpectError(OneFrame(kSize), {"add \"fl_x\"", "camera_angle_x"});
}

TEST(TransformsJson, WhatIsNoTransformsJsonIsAnError) {
  ExpectError("", {"is not JSON"});
  ExpectError("{\"frames\": [", {"is not JSON", "line 1"});
  ExpectError("{\"fl_x\": NaN,}", {"is not JSON"});
  ExpectError("{\"fl_x\": 1e999}", {"is not JSON"});
  ExpectError("{\"a\": \"\xff\"}", {"is not JSON", "UTF-8"});
  ExpectError("[1, 2]", {"holds a list", "no intrinsics"});
  ExpectError("7", {"holds no object"});
  ExpectError("{}", {"\"frames\" is missing"});
  ExpectError("{\"frames\": {\"a\": {}}}", {"\"frames\" is an object"});
  ExpectError("{\"frames\": []}", {"is empty"});
  ExpectError("{\"frames\": [3]}", {"frames[0]: is not an object"});
  ExpectError("{\"frames\": [[{}]]}", {"frames[0]: is not an object"});
  ExpectError("{\"frames\": [{}]}", {"frames[0]: \"file_path\" is missing"});
  ExpectError("{\"frames\": [{\"file_path\": \"\"}]}", {"\"file_path\" is \"\""});
  ExpectError("{\"frames\": [{\"file_path\": \"a\\u0000\"}]}", {"NUL"});
  ExpectError("{\"frames\": [{\"file_path\": \"" + std::string(5000, 'a') + "\"}]}",
              {"aaa", "expected text of at most 4096 bytes"});
  ExpectError("{\"frames\": [{\"file_path\": \"a\"}]}", {"(a): \"transform_matrix\" is missing"});
  ExpectError(OneFrame(kIntrinsics + R"("w": 3, )"), {"\"w\" occurs twice"});
  ExpectError(std::string(100'000, '['), {"is not JSON"});
}

TEST(TransformsJson, AFaultIsFoundWhereverItStands) {
  const std::string frame =
      std::string(R"({"file_path": "a.png", "transform_matrix": )") + kUnturned + "}";
  const auto text = [&](const std::string& second, const std::string& end) {
    return "{" + kIntrinsics + "\"frames\": [\n" + frame + ",\n" + second + ",\n" + frame + end;
  };
  EXPECT_EQ(Parsed(text(frame, "]}")).size(), 3u);
  ExpectError(text(R"({"a": 01})", "]}"), {"is not JSON", "line 3, column 8"});
  ExpectError(text(R"({"a": [1})", "]}"), {"is not JSON", "line 3, column 9"});
  ExpectError(text(R"({"a": "})", "]}"), {"is not JSON", "invalid string"});
  ExpectError(text("{}{}", "]}"), {"is not JSON", "line 3, column 3"});
  ExpectError(text(frame, "}"), {"is not JSON", "line 4"});
  ExpectError(text(frame, "],}"), {"is not JSON", "line 4"});
  ExpectError(text(frame, "]} {}"), {"is not JSON", "line 4"});
  // A syntax error is reported before any other error.
  ExpectError(text("{}", "]"), {"is not JSON", "line 4"});
  ExpectError(text("{}", "]}"), {"frames[1]: \"file_path\" is missing"});
  ExpectError(text("7", R"(,{}]})"), {"frames[1]: is not an object"});
}

TEST(TransformsJson, WhatNobodyReadsMayBeAnything) {
  const std::string deep = std::string(5000, '[') + std::string(5000, ']');
  const std::string keys = R"("a": {"frames": [{"b": "}{"}]}, "id": 340282366920938463463374607431,
                               "e": "\ud83d\ude00", "z": )" +
                           deep + ", ";
  const LightField light_field = Parsed(OneFrame(keys + kIntrinsics, keys));
  EXPECT_EQ(light_field.size(), 1u);
  EXPECT_EQ(light_field.Camera({0}).CentreWorld(), Vec3(1, 2, 3));
}

class TransformsJsonFileTest : public FolderTest {};

// The file spans several blocks and has names of all lengths.
TEST_F(TransformsJsonFileTest, AFileIsReadInPiecesAsItsTextIsAtOnce) {
  std::string frames;
  constexpr uint32_t kCount = 20'000;
  const auto name = [](uint32_t i) {
    return fmt::format("{}\u00e9{{}}[]/{}.png", std::string(i % 97, 'x'), i);
  };
  for (uint32_t i = 0; i < kCount; ++i)
    frames += fmt::format(
        "{}{{\"file_path\": \"{}\", \"note\": \"}}\\\"{{\\u00e9\", \"transform_matrix\": "
        "[[1,0,0,{}],[0,1,0,2],[0,0,1,3]]}}",
        i ? ",\n" : "", name(i), 0.1 * i);
  const std::string text =
      "{\"frames\": [" + frames + "], \"fl_x\": 500, " + R"("w": 640, "h": 480})";
  ASSERT_GT(text.size(), size_t{2} << 20);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms.json", text));
  const Result<LightField> read = ReadTransformsJson(folder_ / "transforms.json");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), kCount);
  EXPECT_EQ(read->image_names, Parsed(text).image_names);
  for (uint32_t i = 0; i < kCount; ++i) {
    EXPECT_EQ(read->image_names[i], name(i));
    EXPECT_EQ(read->cameras[i].cam_from_world.translation, Vec3(0 - 0.1 * i, 2, 3));
  }
}

TEST_F(TransformsJsonFileTest, ABrokenFileNamesTheLine) {
  const std::filesystem::path path = folder_ / "transforms.json";
  ASSERT_TRUE(WriteFileAtomically(path, "{\"frames\": [\n{\"a\": 1,}]}"));
  const Result<LightField> read = ReadTransformsJson(path);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message.find(path.string() + ": is not JSON: parse error at line 2"), 0u);
  EXPECT_FALSE(ReadTransformsJson(folder_));
  EXPECT_FALSE(ReadTransformsJson(folder_ / "none.json"));
}

TEST(TransformsJson, ReadsHowStoredNumbersBecomeLight) {
  const LightField light_field = Parsed(
      OneFrame(kIntrinsics + R"("lf_bayer": "GBRG", "lf_transfer": "linear", "lf_black_level": 512,
                       "lf_white_level": 16383, "lf_white_balance": [2, 1, 1.5],
                       "lf_camera_to_srgb": [[1,2,3],[0,1,4],[5,6,1]], "lf_max_radiance": 2,
                       "lf_pedestal": 2048, "lf_unit_m": 0.001, "lf_alpha": "premultiplied",
                       "lf_background": [0, 0.5, 2], "lf_clipped": "mask", )",
               R"("lf_gain": 1.25, "lf_mask": "masks/a.png", )"));
  const RadianceEncoding& encoding = light_field.encoding;
  EXPECT_EQ(encoding.bayer, BayerPattern::kGbrg);
  EXPECT_EQ(encoding.transfer, Transfer::kLinear);
  EXPECT_EQ(encoding.black_level, 512);
  EXPECT_EQ(encoding.white_level, 16383);
  EXPECT_EQ(encoding.white_balance, (std::array<double, 3>{2, 1, 1.5}));
  EXPECT_EQ(encoding.linear_srgb_from_camera(0, 2), 3);
  EXPECT_EQ(encoding.linear_srgb_from_camera(2, 0), 5);
  EXPECT_EQ(encoding.max_radiance, 2);
  EXPECT_EQ(encoding.pedestal, 2048);
  EXPECT_EQ(encoding.alpha, AlphaMeaning::kPremultiplied);
  EXPECT_EQ(encoding.background, (std::array<double, 3>{0, 0.5, 2}));
  EXPECT_TRUE(encoding.masks_clipped);
  EXPECT_FALSE(Parsed(OneFrame(kIntrinsics)).encoding.masks_clipped);
  EXPECT_FALSE(Parsed(OneFrame(kIntrinsics + R"("lf_clipped": "keep", )")).encoding.masks_clipped);
  EXPECT_EQ(light_field.unit_m, 0.001);
  EXPECT_EQ(light_field.cameras[0].gain, ChannelGains(1.25f));
  EXPECT_EQ(light_field.mask_names, std::vector<std::string>{"masks/a.png"});
}

TEST(TransformsJson, PixelsShowAreasOrPoints) {
  const auto footprint = [](const std::string& key) {
    return Parsed(OneFrame(kIntrinsics + key)).encoding.footprint;
  };
  EXPECT_FALSE(footprint(""));
  EXPECT_EQ(footprint(R"("lf_pixels": "areas", )"), PixelFootprint::kArea);
  EXPECT_EQ(footprint(R"("lf_pixels": "points", )"), PixelFootprint::kPoint);
}

TEST(TransformsJson, NothingMayBeBehindAlpha) {
  const RadianceEncoding none =
      Parsed(OneFrame(kIntrinsics + R"("lf_alpha": "straight", "lf_background": "none", )"))
          .encoding;
  EXPECT_TRUE(none.HasOpacity());
  EXPECT_EQ(none.background, (std::array<double, 3>{0, 0, 0}));
  EXPECT_FALSE(
      Parsed(OneFrame(kIntrinsics + R"("lf_alpha": "straight", "lf_background": [0, 0, 0], )"))
          .encoding.HasOpacity());
}

TEST(TransformsJson, AGainIsOfAllChannelsOrOfEach) {
  using Gains = ChannelGains;
  const auto gains = [](const std::string& keys) {
    return Parsed(OneFrame(kIntrinsics, keys)).cameras[0].gain;
  };
  EXPECT_EQ(gains(""), (Gains{1, 1, 1}));
  EXPECT_EQ(gains(R"("lf_gain": 1.25, )"), (Gains{1.25f, 1.25f, 1.25f}));
  EXPECT_EQ(gains(R"("lf_gain": [1.25, 1, 0.5], )"), (Gains{1.25f, 1, 0.5f}));
  for (const std::string wrong : {"[1, 2]", "[1, 2, 3, 4]", "[1, 0, 1]", "[]", "\"a\""})
    ExpectError(OneFrame(kIntrinsics, R"("lf_gain": )" + wrong + ", "),
                {"frames[0]", "lf_gain", "or a list of 3"});
}

TEST(TransformsJson, TheVignettingOfAFrameGoesBeforeThatOfTheTop) {
  const std::string top = kIntrinsics + R"("lf_vignetting": [-0.3, 0.05, -0.15], )";
  const auto vignetting = [](const LightField& field) { return field.intrinsics[0].vignetting; };
  EXPECT_TRUE(vignetting(Parsed(OneFrame(kIntrinsics))).is_none());
  EXPECT_EQ(vignetting(Parsed(OneFrame(top))), (Vignetting{{-0.3, 0.05, -0.15}}));
  EXPECT_EQ(vignetting(Parsed(OneFrame(top, R"("lf_vignetting": [-0.2, 0, 0], )"))),
            (Vignetting{{-0.2, 0, 0}}));
}

TEST(TransformsJson, AVignettingLeavesLightEverywhere) {
  for (const std::string wrong : {"[-0.3, 0.05]", "-0.3", "[-0.3, 0.05, \"a\"]"})
    ExpectError(OneFrame(kIntrinsics + R"("lf_vignetting": )" + wrong + ", "),
                {"lf_vignetting", "a list of 3 numbers"});
  ExpectError(OneFrame(kIntrinsics + R"("lf_vignetting": [-1.1, 0, 0], )"),
              {"lf_vignetting", "[-1.1, 0, 0]", "multiplies the light by -0.1 to 1", "1/64"});
}

TEST(TransformsJson, EncodingHasTheDocumentedDefaults) {
  const RadianceEncoding plain = Parsed(OneFrame(kIntrinsics)).encoding;
  EXPECT_EQ(plain.transfer, Transfer::kSrgb);
  EXPECT_EQ(plain.pedestal, 0);
  EXPECT_EQ(plain.max_radiance, 1);
  EXPECT_FALSE(plain.white_level);
  EXPECT_FALSE(plain.alpha);
  EXPECT_FALSE(plain.background);
  const RadianceEncoding raw =
      Parsed(OneFrame(kIntrinsics + R"("lf_bayer": "RGGB", "lf_black_level": 64, )")).encoding;
  EXPECT_EQ(raw.transfer, Transfer::kLinear);
  EXPECT_EQ(raw.pedestal, 1024);
  const std::string exr = std::string(R"({"fl_x": 5, "w": 6, "h": 7, "frames": [
      {"file_path": "a.exr", "transform_matrix": )") +
                          kUnturned + "}]}";
  EXPECT_EQ(Parsed(exr).encoding.max_radiance, 16);
}

TEST(TransformsJson, GainsClipNoLightByDefault) {
  const auto max_radiance = [](const std::string& top, const std::string& of_frame) {
    return Parsed(OneFrame(kIntrinsics + top, of_frame)).encoding.max_radiance;
  };
  EXPECT_EQ(max_radiance("", R"("lf_gain": 3, )"), 3);
  EXPECT_EQ(max_radiance("", R"("lf_gain": [0.25, 1, 2.5], )"), 2.5);
  EXPECT_EQ(max_radiance("", R"("lf_gain": 0.5, )"), 1);
  EXPECT_EQ(max_radiance(R"("lf_max_radiance": 1, )", R"("lf_gain": 3, )"), 1);
  EXPECT_EQ(max_radiance(R"("lf_response": [0, 0.5, 2], )", R"("lf_gain": 3, )"), 6);
  EXPECT_GT(max_radiance(R"("lf_vignetting": [-0.3, 0, 0], )", ""), 1.1);
}

TEST(TransformsJson, GainsThatWouldNeedCoarseStepsWarn) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(Parsed(OneFrame(kIntrinsics, R"("lf_gain": 40, )")).encoding.max_radiance, 16);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find(R"(add "lf_max_radiance": 40)"), std::string::npos) << said;
}

TEST(TransformsJson, AResponseCurveReplacesTheTransferFunction) {
  const RadianceEncoding encoding =
      Parsed(OneFrame(kIntrinsics + R"("lf_response": [0, 0.25, 1], )")).encoding;
  EXPECT_EQ(encoding.transfer, Transfer::kResponse);
  EXPECT_EQ(encoding.response, (std::vector<double>{0, 0.25, 1}));
  const auto expect = [](const std::string& keys, const std::string& part) {
    ExpectError(OneFrame(kIntrinsics + keys), {part});
  };
  expect(R"("lf_response": [0, 1], "lf_transfer": "sRGB", )", "contradict");
  expect(R"("lf_response": [0, 1, 0.5], )", "rise");
  expect(R"("lf_response": [1, 1], )", "rise");
  expect(R"("lf_response": [1], )", "a list of 2 to 65536 numbers");
}

TEST(TransformsJson, WrongLfValuesAreErrors) {
  const auto expect = [](const std::string& keys, const std::string& part) {
    ExpectError(OneFrame(kIntrinsics + keys), {part});
  };
  expect(R"("lf_bayer": "RGBG", )", "\"lf_bayer\" is \"RGBG\": expected RGGB");
  expect(R"("lf_bayer": "", )", "lf_bayer");
  expect(R"("lf_transfer": "gamma", )", "\"sRGB\" or \"linear\"");
  expect(R"("lf_black_level": 100, "lf_white_level": 100, )", "less than lf_white_level");
  expect(R"("lf_black_level": 65535, )", "less than lf_white_level");
  expect(R"("lf_black_level": -1, )", "lf_black_level");
  expect(R"("lf_white_balance": [1, 1], )", "a list of 3 numbers");
  expect(R"("lf_white_balance": [1, 0, 1], )", "above 0");
  expect(R"("lf_camera_to_srgb": [1,0,0,0,1,0,0,0,1], )", "3 lists of 3 numbers");
  expect(R"("lf_camera_to_srgb": [[1,1,1],[1,1,1],[1,1,1]], )", "an invertible matrix");
  expect(R"("lf_max_radiance": 0, )", "lf_max_radiance");
  expect(R"("lf_pedestal": 10.5, )", "whole number");
  expect(R"("lf_pedestal": 65535, )", "lf_pedestal");
  expect(R"("lf_alpha": "associated", )", "\"mask\", \"straight\" or \"premultiplied\"");
  expect(R"("lf_pixels": "dots", )", "\"areas\" or \"points\"");
  expect(R"("lf_background": [1, 1], )", "a list of 3 numbers");
  expect(R"("lf_background": [1, -1, 1], )", "radiances from 0");
  expect(R"("lf_background": [1, 1, 1], "lf_alpha": "mask", )", "cannot be used with lf_alpha");
  expect(R"("lf_clipped": "drop", )", "\"mask\" or \"keep\"");
  expect(R"("lf_clipped": true, )", "lf_clipped");
  expect(R"("lf_unit_m": 0, )", "lf_unit_m");
  ExpectError(OneFrame(kIntrinsics, R"("lf_gain": 0, )"), {"frames[0]", "\"lf_gain\" is 0"});
  ExpectError(OneFrame(kIntrinsics, R"("lf_mask": 3, )"), {"\"lf_mask\" is 3"});
}

TEST(TransformsJson, UnknownLfKeysNameTheNearestKnownOne) {
  ExpectError(OneFrame(kIntrinsics + R"("lf_blacklevel": 3, )"),
              {"\"lf_blacklevel\" is not a known key", "\"lf_black_level\""});
  ExpectError(OneFrame(kIntrinsics, R"("lf_gian": 3, )"), {"frames[0]", "\"lf_gain\""});
  ExpectError(OneFrame(kIntrinsics + R"("lf_gain": 3, )"), {"move it into each frame"});
  ExpectError(OneFrame(kIntrinsics, R"("lf_bayer": "RGGB", )"), {"move it to the top level"});
}

TEST(TransformsJson, MasksAreListedOnceAnyFrameHasOne) {
  const auto frame = [](const std::string& keys) {
    return "{" + keys + R"("file_path": "a.png", "transform_matrix": )" + kUnturned + "}";
  };
  const LightField light_field = Parsed(
      "{" + kIntrinsics + R"("frames": [)" + frame("") + "," + frame(R"("lf_mask": "m.png", )") +
      "," + frame("") + "," + frame(R"("mask_path": "n.png", )") + "," + frame("") + "]}");
  EXPECT_EQ(light_field.mask_names, (std::vector<std::string>{"", "m.png", "", "n.png", ""}));
}

TEST(TransformsJson, TheExactTranslationMustAgreeWithTheMatrix) {
  const auto translation = [](const std::string& list) {
    return OneFrame(kIntrinsics, R"("lf_translation": )" + list + ", ");
  };
  EXPECT_EQ(Parsed(translation("[-1, 2, 3.0000001]")).cameras[0].cam_from_world.translation,
            Vec3(-1, 2, 3.0000001));
  ExpectError(translation("[-1, 2, 3.1]"), {"frames[0]", "lf_translation", "[-1, 2, 3]"});
}

}  // namespace
}  // namespace lf
