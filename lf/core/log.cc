// SPDX-License-Identifier: Apache-2.0
#include "lf/core/log.h"

#include <cstdio>
#include <mutex>
#include <string>

#include "lf/core/spelling.h"

namespace lf {
namespace {

std::mutex mutex;
LogLevel threshold = LogLevel::kInfo;
bool line_in_progress = false;
LogReceiver receiver = nullptr;

void ClearLine() {
  if (line_in_progress) std::fputs("\r\x1b[K", stderr);
  line_in_progress = false;
}

}  // namespace

void SetLogLevel(LogLevel level) {
  const std::lock_guard lock(mutex);
  threshold = level;
}

void SetLogReceiver(LogReceiver new_receiver) {
  const std::lock_guard lock(mutex);
  receiver = new_receiver;
}

std::string OneLine(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n')
      line += "\\n";
    else if (c == '\t')
      line += "\\t";
    else if (code < 0x20 || code == 0x7f)
      line += fmt::format("\\x{:02x}", code);
    else
      line += c;
  }
  return line;
}

void LogMessage(LogLevel level, std::string_view message) {
  std::unique_lock lock(mutex);
  if (level < threshold) return;
  if (receiver != nullptr) {
    const LogReceiver receive = receiver;
    lock.unlock();  // the receiver may wait for a thread that sends a message itself
    return receive(level, OneLine(Spelled(message)));
  }
  ClearLine();
  const char* prefix = level == LogLevel::kWarning ? "warning: "
                       : level == LogLevel::kError ? "error: "
                                                   : "";
  std::fputs(fmt::format("{}{}\n", prefix, OneLine(Spelled(message))).c_str(), stderr);
  std::fflush(stderr);
}

void LogProgressLine(std::string_view line) {
  const std::lock_guard lock(mutex);
  ClearLine();
  if (line.empty()) return;
  std::fputs(std::string(line).c_str(), stderr);
  std::fflush(stderr);
  line_in_progress = true;
}

}  // namespace lf
