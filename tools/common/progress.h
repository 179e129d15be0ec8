// Progress for people and for programs: one line that lives (bar), lines now and then (plain), or
// objects (json). With the rate and the time left, as honest as the work done so far allows.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace lf {

enum class ProgressStyle { kBar, kPlain, kJson, kNone };

// From --progress; "auto" is a bar on a terminal, else plain.
ProgressStyle ParseProgressStyle(const std::string& name);

class ProgressMeter {
 public:
  // unit: what is counted, e.g. "rays"
  ProgressMeter(ProgressStyle style, std::string unit);
  ~ProgressMeter();

  // done of total units; `detail` is shown before the bar. Cheap: prints at most a few times a
  // second (bar) or every some seconds (plain, json).
  void Update(uint64_t done, uint64_t total, const std::string& detail);

 private:
  using Clock = std::chrono::steady_clock;
  ProgressStyle style_;
  std::string unit_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

// A bar and numbers in a line of a terminal that has room for `width` characters; where there is
// none for a bar, without one.
std::string ProgressLine(double share, const std::string& numbers, size_t width);

// "1.5 G", "320 M", "12 k".
std::string ShortNumber(double value);
// "3 h 20 min", "2 min 5 s", "14 s".
std::string ShortDuration(double seconds);

}  // namespace lf
