// SPDX-License-Identifier: Apache-2.0
#include "tools/common/program.h"

#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <system_error>

#include "tools/common/describe.h"
#include "tools/common/next_step.h"
#include "tools/common/parse_errors.h"
#include "tools/common/process_start.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"

#include "lf/core/log.h"
#include "lf/core/spelling.h"
#include "lf/core/version.h"

namespace lf {

namespace {

// Prints the error of a command line. Returns the exit code.
int Refuse(const CLI::App& app, const std::string& message) {
  std::fprintf(stderr, "Try '%s --help'.\n", app.get_name().c_str());
  LogMessage(LogLevel::kError, message);
  return static_cast<int>(ErrorKind::kUsage);
}

// True if the reader of the standard output, such as "head", has ended.
std::atomic<bool> was_reader_gone = false;

bool IsReaderGone() {
  pollfd output = {.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

// Ends the program as SIGPIPE would have ended it, without a word and as other programs do: a
// reader that has read enough is no error.
void EndByClosedPipe() {
  ::signal(SIGPIPE, SIG_DFL);
  ::raise(SIGPIPE);
}

}  // namespace

Result<void> PrintReport(const std::string& text) {
  std::cout.flush();  // CLI11 prints to std::cout
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0 &&
      std::cout.good())
    return {};
  if (errno == EPIPE || IsReaderGone()) {
    was_reader_gone = true;
    return OutputError("the standard output cannot be written: its reader has ended");
  }
  return OutputError(fmt::format("the report cannot be written to the standard output: {}",
                                 errno == 0 ? "is the disk full?" : std::strerror(errno)));
}

Program::Program(std::string name, const HelpTexts& texts)
    : app_(texts.summary, std::move(name)), texts_(texts) {
  app_.formatter(std::make_shared<HelpFormatter>(texts));
  app_.set_help_flag("-h,--help", "Show the options that most people need")->group(kHelpGroup);
  app_.set_help_all_flag("--help-all", "Show all options and the details")->group(kHelpGroup);
  app_.set_version_flag("--version", app_.get_name() + " " + Version(), "Show the version")
      ->group(kHelpGroup);
  app_.add_flag_callback(kDescribe,
                         [this] {
                           std::cout << DescriptionOf(app_, texts_, commands_);
                           throw CLI::Success();
                         })
      ->group("");
  app_.option_defaults()->always_capture_default();
}

void Program::SetCommands(const std::vector<CommandText>& commands) {
  commands_ = commands;
  const auto formatter = std::make_shared<HelpFormatter>(texts_);
  formatter->SetCommands(commands);
  app_.formatter(formatter);
}

void Program::AddCommonOptions(const OfferedOptions& offered) {
  OptionGroup input(app_, kInputGroup), output(app_, kOutputGroup), running(app_, kRunningGroup);
  if (offered.strict) input.AddFlag("--strict", common_.strict, offered.strict);
  if (offered.json) output.AddFlag("--json", common_.json, offered.json);
  if (offered.seed) running.Add("--seed N", common_.seed, offered.seed);
  if (offered.threads)
    running.Add("--threads N", common_.threads, "Number of threads (as many as the machine has)")
        ->check(CLI::Range(0, 512));
  if (offered.progress)
    running.AddChoice(
        "--progress", common_.progress,
        {"auto", "bar", "plain", "json", "openjd", "deadline", "alfred", "none"},
        "How progress is shown on stderr\n"
        "auto: a bar on a terminal, otherwise plain\n"
        "bar: one line that is updated\n"
        "plain: a new line every few seconds\n"
        "json: a line with a JSON object about every second\n"
        "openjd, deadline, alfred: lines that render farms understand, about every "
        "second: Open Job Description (openjd_progress: 42.0), Deadline 10 (Progress: "
        "42%), and Tractor or HQueue (ALF_PROGRESS 42%)\n"
        "none: no progress");
  if (offered.verbose)
    running.AddFlag("-v,--verbose", verbosity_, "Also print details, to find out what went wrong");
  if (offered.quiet) running.AddFlag("-q,--quiet", quiet_, "Print only warnings and errors");
}

int Program::Run(int argc, char** argv, const std::function<Result<void>()>& body) {
#ifdef __GLIBC__
  // Makes glibc return the memory of images and plates to the system when they are freed, because
  // --memory limits what a program holds. Otherwise glibc would raise its threshold and keep large
  // blocks.
  constexpr int kLargeBytes = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargeBytes);
#endif
  StartProcess();
  SetSpeller(CommandLineOption);
  SetCallOfProgram({argv, argv + argc});
  // A closed pipe or a file size limit must be an error of the write and not end the program, which
  // may have other work to do, and files to complete.
  const bool ends_by_pipe = ::signal(SIGPIPE, SIG_IGN) != SIG_IGN;
  ::signal(SIGXFSZ, SIG_IGN);
  try {
    app_.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    const int code = app_.exit(help_or_version);
    const Result<void> printed = PrintReport("");
    if (printed) return code;
    if (was_reader_gone && ends_by_pipe) EndByClosedPipe();
    LogMessage(LogLevel::kError, printed.error().message);
    return static_cast<int>(printed.error().kind);
  } catch (const CLI::ParseError& error) {
    return Refuse(app_, ParseErrorText(app_, error, argc, argv));
  }
  if (const std::string text = EmptyPartText(app_, argc, argv); !text.empty())
    return Refuse(app_, text);
  SetLogLevel(quiet_ ? LogLevel::kWarning : verbosity_ > 0 ? LogLevel::kDebug : LogLevel::kInfo);
  try {
    const Result<void> result = body();
    TellFarmTheEnd(ParseProgressStyle(common_.progress), result);
    if (!result) {
      if (was_reader_gone && ends_by_pipe) EndByClosedPipe();
      LogMessage(LogLevel::kError, result.error().message);
      return static_cast<int>(result.error().kind);
    }
    return 0;
  } catch (...) {
    return TellException();
  }
}

}  // namespace lf
