#include "tools/common/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "lf/core/log.h"

namespace lf {

ProgressStyle ParseProgressStyle(const std::string& name) {
  if (name == "bar") return ProgressStyle::kBar;
  if (name == "plain") return ProgressStyle::kPlain;
  if (name == "json") return ProgressStyle::kJson;
  if (name == "none") return ProgressStyle::kNone;
  return ::isatty(STDERR_FILENO) ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

ProgressMeter::ProgressMeter(ProgressStyle style, std::string unit)
    : style_(style), unit_(std::move(unit)), last_(start_) {}

ProgressMeter::~ProgressMeter() {
  if (style_ == ProgressStyle::kBar) LogProgressLine("");
}

void ProgressMeter::Update(uint64_t done, uint64_t total, const std::string& detail) {
  if (style_ == ProgressStyle::kNone || total == 0) return;
  const Clock::time_point now = Clock::now();
  const double interval_s = style_ == ProgressStyle::kBar ? 0.2 : 5;
  if (std::chrono::duration<double>(now - last_).count() < interval_s) return;
  last_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const double rate = static_cast<double>(done) / elapsed_s;
  const double left_s = share > 0 ? elapsed_s * (1 - share) / share : 0;
  if (style_ == ProgressStyle::kJson) {
    LogMessage(
        LogLevel::kInfo,
        fmt::format(R"({{"unit":"{}","done":{},"total":{},"rate":{:.4g},"seconds_left":{:.3g}}})",
                    unit_, done, total, rate, left_s));
    return;
  }
  const std::string numbers = fmt::format("{}  {:.0f} %  {}{}/s  {} left", detail, 100 * share,
                                          ShortNumber(rate), unit_, ShortDuration(left_s));
  if (style_ == ProgressStyle::kPlain) {
    LogMessage(LogLevel::kInfo, numbers);
    return;
  }
  constexpr int kBarWidth = 24;
  const int filled = static_cast<int>(share * kBarWidth);
  LogProgressLine(fmt::format("[{}{}] {}", std::string(static_cast<size_t>(filled), '#'),
                              std::string(static_cast<size_t>(kBarWidth - filled), '.'), numbers));
}

std::string ShortNumber(double value) {
  constexpr const char* kPrefixes[] = {"", "k", "M", "G", "T"};
  int prefix = 0;
  for (; value >= 1000 && prefix < 4; ++prefix) value /= 1000;
  return fmt::format("{:.3g} {}", value, kPrefixes[prefix]);
}

std::string ShortDuration(double seconds) {
  const auto whole = static_cast<int64_t>(std::llround(std::max(0.0, seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace lf
