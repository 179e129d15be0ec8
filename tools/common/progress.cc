// SPDX-License-Identifier: Apache-2.0
#include "tools/common/progress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "lf/core/log.h"
#include "lf/core/quantities.h"

namespace lf {

ProgressStyle ParseProgressStyle(const std::string& name) {
  if (name == "bar") return ProgressStyle::kBar;
  if (name == "plain") return ProgressStyle::kPlain;
  if (name == "json") return ProgressStyle::kJson;
  if (name == "none") return ProgressStyle::kNone;
  if (name == "openjd") return ProgressStyle::kOpenJd;
  if (name == "deadline") return ProgressStyle::kDeadline;
  if (name == "alfred") return ProgressStyle::kAlfred;
  return ::isatty(STDERR_FILENO) ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

namespace {

bool IsOfFarm(ProgressStyle style) {
  return style == ProgressStyle::kOpenJd || style == ProgressStyle::kDeadline ||
         style == ProgressStyle::kAlfred;
}

size_t TerminalWidth() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

}  // namespace

ProgressMeter::ProgressMeter(ProgressStyle style, std::string unit)
    : style_(style), unit_(std::move(unit)), last_(start_) {}

ProgressMeter::~ProgressMeter() {
  if (style_ == ProgressStyle::kBar) LogProgressLine("");
}

void ProgressMeter::Restart(uint64_t done) {
  start_ = Clock::now();
  done_before_ = done;
}

// Returns true if it is time to print. It is fast, so callers ask before they format texts.
bool ProgressMeter::IsDue() const {
  if (style_ == ProgressStyle::kNone) return false;
  const double interval_s = style_ == ProgressStyle::kBar                        ? 0.2
                            : style_ == ProgressStyle::kJson || IsOfFarm(style_) ? 1
                                                                                 : 5;
  return std::chrono::duration<double>(Clock::now() - last_).count() >= interval_s;
}

void ProgressMeter::Update(uint64_t done, uint64_t total,
                           const std::vector<ProgressCount>& counts) {
  if (!IsDue()) return;
  std::vector<std::string> detail, json;
  for (const ProgressCount& count : counts) {
    detail.push_back(fmt::format("{} {}/{}", count.name, count.done, count.total));
    json.push_back(fmt::format(R"("{}":[{},{}])", count.name, count.done, count.total));
  }
  Print(done, total, fmt::format("{}", fmt::join(detail, ", ")),
        fmt::format(R"(,"counts":{{{}}})", fmt::join(json, ",")));
}

void ProgressMeter::Update(uint64_t done, uint64_t total, const std::string& detail) {
  if (IsDue()) Print(done, total, detail, "");
}

void ProgressMeter::Print(uint64_t done, uint64_t total, const std::string& detail,
                          const std::string& json_counts) {
  if (total == 0) return;
  last_ = Clock::now();
  const double elapsed_s = std::chrono::duration<double>(last_ - start_).count();
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  if (IsOfFarm(style_)) {
    for (const std::string& line : FarmLines(style_, share, detail))
      LogMessage(LogLevel::kInfo, line);
    return;
  }
  const auto count = static_cast<double>(done > done_before_ ? done - done_before_ : 0);
  const auto left = static_cast<double>(total > done ? total - done : 0);
  const double rate = elapsed_s > 0 ? count / elapsed_s : 0;
  const double left_s = count > 0 ? elapsed_s * left / count : 0;
  if (style_ == ProgressStyle::kJson) {
    LogMessage(
        LogLevel::kInfo,
        fmt::format(R"({{"unit":"{}","done":{},"total":{},"rate":{:.4g},"seconds_left":{:.3g}{}}})",
                    unit_, done, total, rate, left_s, json_counts));
    return;
  }
  std::string numbers = fmt::format("{}  {:.0f} %", detail, 100 * share);
  if (count > 0)
    numbers += fmt::format("  {}{}/s  {} left", ShortNumber(rate), unit_, ShortDuration(left_s));
  if (style_ == ProgressStyle::kPlain) {
    LogMessage(LogLevel::kInfo, numbers);
    return;
  }
  LogProgressLine(ProgressLine(share, numbers, TerminalWidth()));
}

std::vector<std::string> FarmLines(ProgressStyle style, double share, const std::string& detail) {
  const double percent = 100 * std::clamp(share, 0.0, 1.0);
  // The percentage is rounded down, because a farm may take 100 % for the end.
  const auto whole = static_cast<int>(percent);
  if (style == ProgressStyle::kDeadline) return {fmt::format("Progress: {}%", whole)};
  if (style == ProgressStyle::kAlfred) return {fmt::format("ALF_PROGRESS {}%", whole)};
  std::vector<std::string> lines = {
      fmt::format("openjd_progress: {:.1f}", std::floor(10 * percent) / 10)};
  if (!detail.empty()) lines.push_back("openjd_status: " + detail);
  return lines;
}

void TellFarmTheEnd(ProgressStyle style, const Result<void>& result) {
  if (!IsOfFarm(style)) return;
  if (result)
    LogMessage(LogLevel::kInfo, FarmLines(style, 1, "").front());
  else if (style == ProgressStyle::kOpenJd)
    LogMessage(LogLevel::kInfo, "openjd_fail: " + result.error().message);
}

std::string ProgressLine(double share, const std::string& numbers, size_t width) {
  constexpr size_t kMostBar = 24, kLeastBar = 6;
  const size_t frame = 3;  // two brackets and a space
  const size_t room = width - std::min(width, numbers.size() + frame + 1);
  if (room < kLeastBar) return numbers.substr(0, width - std::min<size_t>(width, 1));
  const size_t bar = std::min(room, kMostBar);
  const auto filled = static_cast<size_t>(share * static_cast<double>(bar));
  return fmt::format("[{}{}] {}", std::string(filled, '#'), std::string(bar - filled, '.'),
                     numbers);
}

}  // namespace lf
