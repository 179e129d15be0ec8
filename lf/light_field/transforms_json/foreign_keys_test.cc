// SPDX-License-Identifier: Apache-2.0
// Tests keys and values that other programs write into a transforms.json.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace {

const std::string kFrameSize = R"("w": 640, "h": 480)";

Result<LightField> ParseFrame(const std::string& top, const std::string& frame) {
  return ParseTransformsJson(fmt::format(R"({{{}, "frames": [{{"file_path": "a.png", {},
                  "transform_matrix": [[1,0,0,1], [0,1,0,2], [0,0,1,3]]}}]}})",
                                         top, frame),
                             "data/transforms.json");
}

void ExpectFrameError(const std::string& top, const std::string& frame,
                      const std::vector<std::string>& parts) {
  const Result<LightField> light_field = ParseFrame(top, frame);
  ASSERT_FALSE(light_field) << top << frame;
  for (const std::string& part : parts)
    EXPECT_NE(light_field.error().message.find(part), std::string::npos)
        << part << "\nnot in: " << light_field.error().message;
}

TEST(ForeignKeys, FramesMayStateACalibrationMatrix) {
  for (const char* matrix : {R"("K": [[500, 0.5, 321], [0, 510, 239], [0, 0, 1]])",
                             R"("intrinsic_matrix": [[500, 0.5, 321], [0, 510, 239], [0, 0, 1]])",
                             R"("K": [500, 0.5, 321, 0, 510, 239, 0, 0, 1])"}) {
    const Result<LightField> light_field = ParseFrame(kFrameSize, matrix);
    ASSERT_TRUE(light_field) << light_field.error().message;
    EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{500, 510, 321, 239, 0.5, 640, 480}));
  }
  // Single keys take precedence, and the matrix of a frame over that of the top level.
  const Result<LightField> light_field =
      ParseFrame(kFrameSize + R"(, "K": [[5, 0, 6], [0, 7, 8], [0, 0, 1]])",
                 R"("fl_x": 400, "K": [[500, 0, 321], [0, 510, 239], [0, 0, 1]])");
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{400, 510, 321, 239, 0, 640, 480}));
}

TEST(ForeignKeys, MatricesOfAnotherFormAreErrors) {
  const std::vector<std::string> expected = {"frames[0] (a.png): \"K\"",
                                             "[[fx, skew, cx], [0, fy, cy], [0, 0, 1]]"};
  ExpectFrameError(kFrameSize, R"("K": [[500, 0, 0], [0, 510, 0], [321, 239, 1]])", expected);
  ExpectFrameError(kFrameSize, R"("K": [[0.0001, 0, 321], [0, 510, 239], [0, 0, 1]])", expected);
  ExpectFrameError(kFrameSize, R"("K": [[500, 0], [0, 510]])", {"\"K\""});
  ExpectFrameError(kFrameSize, R"("K": "fx")", {"\"K\""});
}

TEST(ForeignKeys, NanHarmsOnlyTheKeysThatAreRead) {
  const Result<LightField> light_field =
      ParseFrame(R"("fl_x": 5, "a": [NaN, -Infinity], "NaN \" NaN": Infinity, )" + kFrameSize,
                 R"("sharpness": NaN)");
  ASSERT_TRUE(light_field) << light_field.error().message;
  ExpectFrameError(kFrameSize + R"(, "fl_x": NaN)", R"("a": 1)", {"\"fl_x\" is \"NaN\""});
  ExpectFrameError(kFrameSize, R"("a": NaN, "fl_x": -Infinity)",
                   {"frames[0] (a.png): \"fl_x\" is \"-Infinity\""});
}

Result<LightField> ParseTwoTimes(const std::string& first, const std::string& second) {
  const std::string frame =
      R"({{"file_path": "{}.png", {} "transform_matrix": [[1,0,0,1], [0,1,0,2], [0,0,1,3]]}})";
  return ParseTransformsJson(fmt::format(R"({{"fl_x": 5, {}, "frames": [{}, {}]}})", kFrameSize,
                                         fmt::format(fmt::runtime(frame), "a", first),
                                         fmt::format(fmt::runtime(frame), "b", second)),
                             "data/transforms.json");
}

TEST(ForeignKeys, FramesMayStateTheirTimes) {
  Result<LightField> light_field = ParseTwoTimes(R"("time": 0.25,)", R"("time": -3,)");
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->times, (std::vector<double>{0.25, -3}));
}

TEST(ForeignKeys, TimesCountOnlyIfAllFramesStateANumber) {
  for (const char* const other :
       {"", R"("time": null,)", R"("time": "noon",)", R"("time": [1],)"}) {
    for (const bool is_first : {true, false}) {
      const Result<LightField> light_field =
          is_first ? ParseTwoTimes(other, R"("time": 1,)") : ParseTwoTimes(R"("time": 1,)", other);
      ASSERT_TRUE(light_field) << light_field.error().message;
      EXPECT_TRUE(light_field->times.empty()) << other;
    }
  }
}

}  // namespace
}  // namespace lf
