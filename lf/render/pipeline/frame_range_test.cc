// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/frame_range.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

std::vector<uint32_t> Numbers(std::string_view text, size_t count = 100) {
  const Result<std::vector<FrameId>> frames = ParseFrameRange(text, {1, count});
  std::vector<uint32_t> numbers;
  if (frames)
    for (const FrameId frame : *frames) numbers.push_back(frame.value);
  return numbers;
}

TEST(FrameRange, ReadsRangesStepsAndLists) {
  EXPECT_EQ(Numbers("7"), (std::vector<uint32_t>{7}));
  EXPECT_EQ(Numbers("3-5"), (std::vector<uint32_t>{3, 4, 5}));
  EXPECT_EQ(Numbers("1-8x3"), (std::vector<uint32_t>{1, 4, 7}));
  EXPECT_EQ(Numbers("9,1-2,2"), (std::vector<uint32_t>{1, 2, 9}));
  EXPECT_EQ(Numbers("1-100x2").size(), 50u);
}

TEST(FrameRange, AStepMayFollowAColon) {
  EXPECT_EQ(Numbers("1-8:3,20"), (std::vector<uint32_t>{1, 4, 7, 20}));
  EXPECT_EQ(Numbers("7-20:2"), Numbers("7-20x2"));
  EXPECT_TRUE(Numbers("1-8:").empty());
  EXPECT_TRUE(Numbers("1-8:0").empty());
}

TEST(FrameRange, FramesBeyondTheEndMayBeLeftOut) {
  const auto clamped = [](std::string_view text) {
    return ParseFrameRange(text, {1, 72}, "{frames}", FramesBeyondEnd::kLeftOut);
  };
  EXPECT_EQ(clamped("71-80").value(), (std::vector<FrameId>{FrameId{71}, FrameId{72}}));
  EXPECT_EQ(clamped("72-75").value(), (std::vector<FrameId>{FrameId{72}}));
  EXPECT_EQ(clamped("99,70-90:5,80-85").value(), (std::vector<FrameId>{FrameId{70}}));
  EXPECT_TRUE(clamped("73-80,4000000000").value().empty());
  EXPECT_FALSE(clamped("0-3"));
  EXPECT_FALSE(clamped("80-73"));
  EXPECT_FALSE(clamped("80-90x0"));
}

TEST(FrameRange, NumbersAreThoseOfThePath) {
  const FrameNumbers plate = {1001, 48};
  EXPECT_EQ(ParseFrameRange("1001-1002,1048", plate).value(),
            (std::vector<FrameId>{{1001}, {1002}, {1048}}));
  EXPECT_EQ(ParseFrameRange("0-1", {0, 2}).value(), (std::vector<FrameId>{{0}, {1}}));
  EXPECT_EQ(ParseFrameRange("1047-1060", plate, "{frames}", FramesBeyondEnd::kLeftOut).value(),
            (std::vector<FrameId>{{1047}, {1048}}));
  for (const char* text : {"1", "1000-1002", "1048-1049"})
    EXPECT_EQ(
        ParseFrameRange(text, plate).error().message,
        std::string("{frames} '") + text + "': expected frames from 1001 to 1048, the last frame");
  // Frames before the first are a mistake of numbering, which is never left out.
  EXPECT_FALSE(ParseFrameRange("1-48", plate, "{frames}", FramesBeyondEnd::kLeftOut));
}

TEST(FrameRange, RefusesWhatItDoesNotUnderstand) {
  for (const char* text : {"", "x", "0", "5-", "-5", "5-3", "1-101", "1-9x0", "1,", "1 2", "1-9x",
                           "99999999999", "1.5"}) {
    const auto frames = ParseFrameRange(text, {1, 100});
    ASSERT_FALSE(frames) << text;
    EXPECT_EQ(frames.error().kind, ErrorKind::kUsage);
  }
  std::string repeated;
  for (int i = 0; i < 10; ++i) repeated += "1-1000000,";
  EXPECT_FALSE(ParseFrameRange(repeated + "1", {1, 1'000'000}));
  const auto says = [](const char* text) { return ParseFrameRange(text, {1, 4}).error().message; };
  EXPECT_NE(says("4-1").find("1-4"), std::string::npos);
  EXPECT_NE(says("1-4x0").find("at least 1"), std::string::npos);
  EXPECT_NE(says("2-7").find("expected frames from 1 to 4"), std::string::npos);
}

}  // namespace
}  // namespace lf
