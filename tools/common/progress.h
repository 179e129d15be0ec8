// SPDX-License-Identifier: Apache-2.0
// Shows progress for people and for programs: one line that is updated (bar), lines now and then
// (plain), or JSON objects (json), each with the rate and an estimate of the time left; or lines
// that render farms look for (openjd, deadline, alfred).
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

enum class ProgressStyle {
  kBar,
  kPlain,
  kJson,
  kNone,
  kOpenJd,    // "openjd_progress: 42.0" and "openjd_status: frame 3/10": Open Job Description
  kDeadline,  // "Progress: 42%": plug-ins of Deadline 10
  kAlfred,    // "ALF_PROGRESS 42%": Tractor, HQueue, and plug-ins of Deadline
};

// Parses the value of --progress; "auto" becomes a bar if stderr is a terminal, otherwise plain.
ProgressStyle ParseProgressStyle(const std::string& name);

// The progress of one kind of thing, such as "frame" 3 of 10.
struct ProgressCount {
  std::string name;
  uint64_t done = 0;
  uint64_t total = 0;
};

class ProgressMeter {
 public:
  // unit: name of what is counted, e.g. "rays"
  ProgressMeter(ProgressStyle style, std::string unit);
  ~ProgressMeter();

  // Begins a phase that counts anew: rate and time left are those of the units after the first
  // `done`, which were done before.
  void Restart(uint64_t done);
  // Reports `done` of `total` units; prints nothing if `total` is 0. `detail` is shown before the
  // numbers; JSON leaves it out. Cheap: prints at most a few times per second (bar), once per
  // second (json) or every few seconds (plain).
  void Update(uint64_t done, uint64_t total, const std::string& detail);
  // Reports also what is done of other things: the detail is "LF image 3/10, frame 1/4"; JSON has
  // "counts": {"LF image": [3, 10], "frame": [1, 4]}.
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
  uint64_t done_before_ = 0;  // Restart()
};

// Returns the lines that tell a farm the progress. The style must be that of a farm.
//   detail  text of the line openjd_status; empty: the line is left out
std::vector<std::string> FarmLines(ProgressStyle style, double share, const std::string& detail);
// Prints what a farm expects at the end: that all is done, or with kOpenJd why it failed. Prints
// nothing with the other styles.
void TellFarmTheEnd(ProgressStyle style, const Result<void>& result);

// Returns a bar and numbers for a terminal line of `width` characters, or the numbers alone, cut to
// fit, if the line is too short for a bar.
//   share  the share of the bar that is filled, from 0 to 1
std::string ProgressLine(double share, const std::string& numbers, size_t width);

}  // namespace lf
