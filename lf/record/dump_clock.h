// When the next checkpoint is due: as asked for, but so seldom that they cost little.
#pragma once

#include <algorithm>

namespace lf {

class DumpClock {
 public:
  // Checkpoints take at most this share of the time (doc/design.md, "Failure and load").
  static constexpr double kMostShare = 0.05;

  // every_s  seconds from the end of a checkpoint to the next; 0: never
  // now_s    of any clock, here and below; the first is due after an interval
  DumpClock(double every_s, double now_s)
      : every_s_(every_s), interval_s_(every_s), last_s_(now_s) {}

  bool IsDue(double now_s) const { return every_s_ > 0 && now_s - last_s_ >= interval_s_; }

  // A checkpoint was written from begin_s to end_s. True if the interval became longer than it was
  // asked for, by half at least from what was told of it last.
  bool Done(double begin_s, double end_s) {
    interval_s_ = std::max(every_s_, (end_s - begin_s) * (1 / kMostShare - 1));
    last_s_ = end_s;
    if (interval_s_ < 1.5 * std::max(every_s_, told_s_)) return false;
    told_s_ = interval_s_;
    return true;
  }

  double interval_s() const { return interval_s_; }
  // End of the last checkpoint, or the beginning.
  double last_s() const { return last_s_; }

 private:
  double every_s_;
  double interval_s_;
  double told_s_ = 0;
  double last_s_;
};

}  // namespace lf
