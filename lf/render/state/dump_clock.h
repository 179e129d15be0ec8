// SPDX-License-Identifier: Apache-2.0
// Decides when the next checkpoint is due: after the interval that the user chose, or after a
// longer one if checkpoints would take more than kMostShare of the time.
#pragma once

#include <algorithm>

namespace lf {

class DumpClock {
 public:
  // Largest share of the time that checkpoints may take (doc/design.md, "Failure and load").
  static constexpr double kMostShare = 0.05;

  //   every_s  seconds from the end of a checkpoint until the next is due; 0: none is ever due
  //   now_s    time of a monotonic clock, in seconds; all calls must use the same clock. The first
  //            checkpoint is due every_s later.
  DumpClock(double every_s, double now_s)
      : every_s_(every_s), interval_s_(every_s), last_s_(now_s) {}

  bool IsDue(double now_s) const { return every_s_ > 0 && now_s - last_s_ >= interval_s_; }

  // Records that a checkpoint was written from begin_s to end_s, and sets the new interval. Returns
  // true if the user should be told: the new interval is at least 1.5 times every_s, and at least
  // 1.5 times the interval for which Done() last returned true.
  bool Done(double begin_s, double end_s) {
    interval_s_ = std::max(every_s_, (end_s - begin_s) * (1 / kMostShare - 1));
    last_s_ = end_s;
    if (interval_s_ < 1.5 * std::max(every_s_, told_s_)) return false;
    told_s_ = interval_s_;
    return true;
  }

  double interval_s() const { return interval_s_; }
  // End of the last checkpoint, or the time at construction.
  double last_s() const { return last_s_; }

 private:
  double every_s_;
  double interval_s_;
  double told_s_ = 0;
  double last_s_;
};

}  // namespace lf
