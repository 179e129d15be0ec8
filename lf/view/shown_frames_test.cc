// SPDX-License-Identifier: Apache-2.0
#include "lf/view/shown_frames.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(ShownFrames, AShortFilmShowsAllFrames) {
  for (const size_t count : {size_t{1}, size_t{2}, size_t{777}, kMostShownFrames}) {
    const std::vector<FrameId> frames = ShownFrames({1, count});
    ASSERT_EQ(frames.size(), count);
    for (size_t i = 0; i < count; ++i) EXPECT_EQ(frames[i].value, i + 1);
  }
}

TEST(ShownFrames, ALongFilmShowsFramesAtEqualDistancesAndTheLast) {
  for (size_t count = kMostShownFrames + 1; count <= 1'000'000; count += 4'321) {
    const size_t step = ShownStep(count);
    const std::vector<FrameId> frames = ShownFrames({1, count});
    ASSERT_GT(step, 1u);
    ASSERT_LE(frames.size(), kMostShownFrames);
    ASSERT_GE(frames.size(), kMostShownFrames / 2);
    for (size_t i = 0; i + 1 < frames.size(); ++i) ASSERT_EQ(frames[i].value, i * step + 1);
    ASSERT_EQ(frames.back().value, count);
  }
}

TEST(ShownFrames, NumbersBeginWithTheFirstOfThePath) {
  EXPECT_EQ(ShownFrames({1001, 3}), (std::vector<FrameId>{{1001}, {1002}, {1003}}));
  const std::vector<FrameId> frames = ShownFrames({1001, kMostShownFrames + 7});
  EXPECT_EQ(frames[1].value, 1003u);
  EXPECT_EQ(frames.back().value, 1000u + kMostShownFrames + 7);
}

}  // namespace
}  // namespace lf
