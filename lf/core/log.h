// Messages for people: one line per event, to stderr. Results go to stdout and are no business of
// this file.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace lf {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

// Messages below the level are dropped. Default kInfo. For main().
void SetLogLevel(LogLevel level);

// The text as one line: control characters become \n, \t, \x1b and the like, as in C. Names of
// files may hold any of them, and must not look like another message, nor move the cursor.
std::string OneLine(std::string_view text);

// Writes "warning: ..." or the bare message, as OneLine(). Thread-safe. A line in progress (a
// progress bar) is cleared first.
void LogMessage(LogLevel level, std::string_view message);

// Replaces the line in progress on a terminal; "" clears it. For progress bars.
void LogProgressLine(std::string_view line);

template <class... Args>
void LogInfo(fmt::format_string<Args...> format, Args&&... args) {
  LogMessage(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void LogWarning(fmt::format_string<Args...> format, Args&&... args) {
  LogMessage(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void LogDebug(fmt::format_string<Args...> format, Args&&... args) {
  LogMessage(LogLevel::kDebug, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lf
