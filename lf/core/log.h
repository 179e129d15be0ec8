// SPDX-License-Identifier: Apache-2.0
// Writes messages for people to stderr, one line for each event. Results go to stdout, and not
// through this file.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace lf {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

// Drops all messages below `level` from now on. Until this function is called, the level is kInfo.
// Meant for main().
void SetLogLevel(LogLevel level);

// Calls `receiver` with every message from now on, instead of writing it to stderr; null: writes to
// stderr again. Several threads may call `receiver` at the same time. It is meant for a process
// that is not ours, such as a Python that has loaded the library.
using LogReceiver = void (*)(LogLevel level, std::string_view message);
void SetLogReceiver(LogReceiver receiver);

// Returns the text as one line: control characters become \n, \t, \x1b and the like, as in C. File
// names may contain any of them, and must neither look like another message nor move the cursor.
std::string OneLine(std::string_view text);

// Writes the message in one line (OneLine()), after "warning: " or "error: " if `level` is kWarning
// or kError, with its options as the reader knows them (Spelled()). Clears a line in progress (a
// progress bar) first. Thread-safe.
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
