// Progress for people and for programs: one line that lives (bar), lines now and then (plain), or
// objects (json). With the rate and the time left, as honest as the work done so far allows.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace lf {

enum class ProgressStyle { kBar, kPlain, kJson, kNone };

// From --progress; "auto" is a bar on a terminal, else plain.
ProgressStyle ParseProgressStyle(const std::string& name);

// How far one thing is, such as "frame" 3 of 10.
struct ProgressCount {
  std::string name;
  uint64_t done = 0;
  uint64_t total = 0;
};

class ProgressMeter {
 public:
  // unit: what is counted, e.g. "rays"
  ProgressMeter(ProgressStyle style, std::string unit);
  ~ProgressMeter();

  // done of total units; `detail` is shown before the numbers. Cheap: prints at most a few times a
  // second (bar), every second (json) or every some seconds (plain).
  void Update(uint64_t done, uint64_t total, const std::string& detail);
  // The same with "LF image 3/10, frame 1/4", which json has as "counts": {"frame": [1, 4]}.
  void Update(uint64_t done, uint64_t total, const std::vector<ProgressCount>& counts);

 private:
  using Clock = std::chrono::steady_clock;
  bool IsDue() const;
  void Print(uint64_t done, uint64_t total, const std::string& detail,
             const std::string& json_counts);
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
