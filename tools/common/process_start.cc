// SPDX-License-Identifier: Apache-2.0
#include "tools/common/process_start.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "lf/core/log.h"
#include "lf/core/result.h"

namespace lf {
namespace {

[[noreturn]] void EndByException() {
  const int status = std::current_exception() ? TellException() : 1;
  std::_Exit(status);
}

// Ignores SIGUSR1; ends the program at any other signal.
void OnEarlySignal(int signal) {
  if (signal != SIGUSR1) EndInterrupted();
}

void OccupyStandardFiles() {
  // open() returns the lowest free descriptor, which is the descriptor of the closed file.
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(file, F_GETFD) < 0 && errno == EBADF && ::open("/dev/null", O_RDONLY) < 0) return;
}

}  // namespace

// Calls only functions that signal handlers may call.
void EndInterrupted() {
  constexpr const char* kClearLine = "\r\x1b[K";
  constexpr const char* kMessage = "error: interrupted\n";
  if (::isatty(STDERR_FILENO) == 1) [[maybe_unused]]
    const ssize_t cleared = ::write(STDERR_FILENO, kClearLine, std::strlen(kClearLine));
  [[maybe_unused]] const ssize_t told = ::write(STDERR_FILENO, kMessage, std::strlen(kMessage));
  ::_exit(static_cast<int>(ErrorKind::kInterrupted));
}

void StartProcess() {
  OccupyStandardFiles();
  std::set_terminate(EndByException);
  struct sigaction action {};
  action.sa_handler = OnEarlySignal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    struct sigaction before {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_DFL)
      ::sigaction(signal, &action, nullptr);
  }
}

// With a sanitizer, only Program::Run() calls StartProcess(), because the sanitizer's runtime is
// not ready earlier.
#if defined(__ELF__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace {
[[gnu::section(".preinit_array"), gnu::used]] void (*start_process_early)() = StartProcess;
}  // namespace
#endif

int TellException() {
  const auto is_about_threads = [](const std::exception& error) {
    // Only the text of oneTBB's exception tells that a thread could not be started.
    return std::string_view(error.what()).find("pthread_create") != std::string_view::npos;
  };
  constexpr const char* kNoThread =
      "cannot start a thread ({}); lower --threads, or allow this user more processes (ulimit -u)";
  try {
    throw;
  } catch (const std::bad_alloc&) {
    // Memory may not suffice to format a message.
    std::fputs("error: out of memory; lower --memory, or render fewer frames at once\n", stderr);
    return static_cast<int>(ErrorKind::kOutput);
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again && !is_about_threads(error)) {
      LogMessage(LogLevel::kError, fmt::format("a system call failed: {}", error.what()));
      return static_cast<int>(ErrorKind::kOutput);
    }
    LogMessage(LogLevel::kError, fmt::format(kNoThread, error.what()));
    return static_cast<int>(ErrorKind::kOutput);
  } catch (const std::exception& error) {
    if (is_about_threads(error)) {
      LogMessage(LogLevel::kError, fmt::format(kNoThread, error.what()));
      return static_cast<int>(ErrorKind::kOutput);
    }
    LogMessage(LogLevel::kError,
               fmt::format("internal: {}; this is a bug, please report it", error.what()));
  } catch (...) {
    LogMessage(LogLevel::kError, "internal: an unknown exception; this is a bug, please report it");
  }
  return 1;
}

}  // namespace lf
