// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/watched_loop.h"

#include <gtest/gtest.h>

#include <vector>

#include "lf/densify/depth_sweep.h"
#include "lf/densify/synthesis.h"
#include "lf/densify/test_world.h"

namespace lf {
namespace {

TEST(WatchedLoop, TellsHowFarItIs) {
  ThreadPool pool(3);
  std::vector<size_t> told;
  std::vector<int> calls(20, 0);
  const Watch watch{"things", nullptr, [&](size_t done, size_t count) {
                      EXPECT_EQ(count, 20u);
                      told.push_back(done);
                    }};
  ASSERT_TRUE(ForEachWatched(pool, calls.size(), watch, [&](size_t i) -> Result<void> {
    ++calls[i];
    return {};
  }));
  EXPECT_EQ(calls, std::vector<int>(20, 1));
  ASSERT_EQ(told.size(), 21u);
  for (size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i], i);
}

TEST(WatchedLoop, EndsAtTheFirstError) {
  ThreadPool pool(1);
  int calls = 0;
  const auto result = ForEachWatched(pool, 20, {}, [&](size_t i) -> Result<void> {
    ++calls;
    if (i == 3) return InputError("the fourth");
    return {};
  });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "the fourth");
  EXPECT_EQ(calls, 4);
}

TEST(WatchedLoop, EndsWhenTheUserInterrupts) {
  ThreadPool pool(1);
  std::atomic<bool> flag = false;
  int calls = 0;
  // A call during which the user interrupts may have returned something unfinished, or an error.
  const auto result = ForEachWatched(pool, 20, {"things", &flag}, [&](size_t i) -> Result<void> {
    ++calls;
    flag = i == 3;
    if (i == 3) return InputError("unfinished");
    return {};
  });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(result.error().message, "interrupted after 3 of 20 (things): {resume} continues");
  EXPECT_EQ(calls, 4);
}

// Returns the CPU time of a call with a flag that is set, as a share of that without a flag.
template <class Call>
double ShareWhenInterrupted(const Call& call) {
  const std::atomic<bool> flag = true;
  const ThreadCpuTimer whole;
  call(nullptr);
  const auto whole_ns = static_cast<double>(whole.Nanoseconds());
  const ThreadCpuTimer interrupted;
  call(&flag);
  return static_cast<double>(interrupted.Nanoseconds()) / whole_ns;
}

TEST(WatchedLoop, LongCallsEndEarly) {
  constexpr InverseDepths kDepths = {0.1, 1.1};
  const std::vector<Wall> walls = {{2, INFINITY, 1}};
  const WorkingImage first = ImageOfWalls(CameraAt(0, 0, 240, 160), walls);
  const WorkingImage second = ImageOfWalls(CameraAt(0.1, 0, 240, 160), walls);
  const SweepView views[] = {ViewFrom(first, second)};
  EXPECT_LT(ShareWhenInterrupted([&](InterruptFlag interrupted) {
              SweepDepths(first, views, kDepths, 128, interrupted);
            }),
            0.2);
  const DepthPlane plane(first.width(), first.height(), 1, 30000);
  const DepthView depth_views[] = {{&plane, MapBetween(second.camera, first.camera)}};
  const Image<uint8_t> agreeing(first.width(), first.height());
  EXPECT_LT(ShareWhenInterrupted([&](InterruptFlag interrupted) {
              CountAgreeing(plane, first.tones, depth_views, kDepths, 0.01, interrupted);
              FillDisagreeing(plane, agreeing, 1, first.tones, kDepths, 10, interrupted);
            }),
            0.2);
  const Source sources[] = {{&first, &plane, 0.5f}, {&second, &plane, 0.5f}};
  EXPECT_LT(ShareWhenInterrupted([&](InterruptFlag interrupted) {
              Synthesize(CameraAt(0.05, 0, 240, 160), sources, kDepths, 0.01, interrupted);
            }),
            0.2);
}

}  // namespace
}  // namespace lf
