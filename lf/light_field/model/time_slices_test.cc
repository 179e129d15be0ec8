// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/time_slices.h"

#include <gtest/gtest.h>

#include <vector>

namespace lf {
namespace {

TEST(TimeSlices, TheNearestTimeIsTheEarlierOneInTheMiddle) {
  const std::vector<double> times = {0, 1, 3};
  EXPECT_EQ(NearestTime(times, -5), 0u);
  EXPECT_EQ(NearestTime(times, 0.5), 0u);
  EXPECT_EQ(NearestTime(times, 0.51), 1u);
  EXPECT_EQ(NearestTime(times, 2), 1u);
  EXPECT_EQ(NearestTime(times, 0.5 + 1e-9), 0u);
  EXPECT_EQ(NearestTime(times, 2.01), 2u);
  EXPECT_EQ(NearestTime(times, 99), 2u);
}

TEST(TimeSlices, TimesThatDifferByRoundingAreOne) {
  EXPECT_EQ(DistinctTimes(std::vector<double>{1, 0, 1 + 5e-7, 0.5, 0}),
            (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(DistinctTimes(std::vector<double>{2, 2, 2}), (std::vector<double>{2}));
  EXPECT_TRUE(DistinctTimes({}).empty());
}

TEST(TimeSlices, EvenTimesHaveARate) {
  EXPECT_DOUBLE_EQ(*RateOfTimes(std::vector<double>{1, 1.5, 2}), 2);
  EXPECT_NEAR(*RateOfTimes(std::vector<double>{0, 0.033, 0.067, 0.1}), 30, 1e-9);
  EXPECT_FALSE(RateOfTimes(std::vector<double>{0, 1, 3}));
  EXPECT_FALSE(RateOfTimes(std::vector<double>{1}));
}

TEST(TimeSlices, AVideoIsDescribed) {
  VideoFacts video = {3, 4, 0, 0.1, 30};
  EXPECT_EQ(TextOfSpan(video), "from 0 to 0.1 s (4 times, 30 per second)");
  video.is_in_seconds = false;
  video.rate.reset();
  EXPECT_EQ(TextOfSpan(video), "from 0 to 0.1 (4 times)");
}

LightField FourImages() {
  LightField field;
  field.cameras.resize(4);
  field.times = {0, 0, 1, 1};
  field.slice_times = {0, 1};
  return field;
}

TEST(TimeSlices, AFrameHoldsTheImagesOfItsSliceAlone) {
  const LightField field = FourImages();
  for (const double time : {-1.0, 0.0, 0.5}) {
    const SliceOfFrame slice(field, time);
    EXPECT_FALSE(slice.HoldsAll());
    EXPECT_TRUE(slice.Holds({0}) && slice.Holds({1}));
    EXPECT_FALSE(slice.Holds({2}) || slice.Holds({3}));
  }
  EXPECT_TRUE(SliceOfFrame(field, 0.6).Holds({3}));
  EXPECT_FALSE(SliceOfFrame(field, 0.6).Holds({1}));
}

TEST(TimeSlices, WithoutSlicesAllImagesAreHeld) {
  LightField field = FourImages();
  field.slice_times = {1};
  EXPECT_TRUE(SliceOfFrame(field, std::nullopt).HoldsAll());
  EXPECT_TRUE(SliceOfFrame(field, 7).Holds({0}));
  field.times.clear();
  field.slice_times.clear();
  EXPECT_TRUE(SliceOfFrame(field, std::nullopt).Holds({0}));
}

}  // namespace
}  // namespace lf
