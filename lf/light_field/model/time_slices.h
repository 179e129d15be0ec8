// SPDX-License-Identifier: Apache-2.0
// The slices of a light field video: the LF images that were recorded at one time, of which a frame
// shows one slice alone.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the index of the number that is nearest to `time`; the smaller one if two are equally
// near, but for rounding errors.
//   ascending  at least one number
size_t NearestTime(std::span<const double> ascending, double time);

// Returns the different times, ascending. Times that differ by at most a millionth of the span of
// all count as equal, because programs round them; the first of them stands for all.
std::vector<double> DistinctTimes(std::span<const double> times);

// Returns how many times there are for each unit of time; nullopt if there are fewer than two, or
// if a step differs from the mean step by more than a quarter of it.
std::optional<double> RateOfTimes(std::span<const double> ascending);

// Returns "from 0 to 9.967 s (300 times, 30 per second)", which describes the times of a video.
std::string TextOfSpan(const VideoFacts& video);

// Tells which LF images a frame may take: those of the slice nearest to its recording time. All if
// at most one slice is open. Refers to the light field, which must outlive it.
class SliceOfFrame {
 public:
  //   recording_time  RenderCamera::recording_time; without one, a frame shows the first slice
  SliceOfFrame(const LightField& light_field, const std::optional<double>& recording_time);

  bool Holds(LfImageId id) const { return times_ == nullptr || times_[id.value] == time_; }
  bool HoldsAll() const { return times_ == nullptr; }

 private:
  const double* times_ = nullptr;  // of all LF images; null: all are held
  double time_ = 0;
};

}  // namespace lf
