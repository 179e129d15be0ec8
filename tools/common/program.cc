#include "tools/common/program.h"

#include <malloc.h>
#include <signal.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <system_error>

#include "tools/common/process_start.h"

#include "lf/core/log.h"

namespace lf {

Result<void> PrintReport(const std::string& text) {
  std::cout.flush();  // CLI11 prints to std::cout
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0 &&
      std::cout.good())
    return {};
  return OutputError("cannot write the report to the standard output: is the disk full?");
}

const char* Version() { return LF_VERSION; }

CLI::Validator WholeNumber() {
  return CLI::Validator(
      [](std::string& word) -> std::string {
        uint64_t number = 0;
        const char* const end = word.data() + word.size();
        const auto [rest, error] = std::from_chars(word.data(), end, number);
        if (error != std::errc{} || rest != end)
          return fmt::format("expected a whole number from 0 to {}, found '{}'", UINT64_MAX, word);
        word = fmt::format("{}", number);  // without leading zeros, with which CLI11 would read an
                                           // octal number
        return {};
      },
      "");
}

CLI::Validator NotEmpty() {
  return CLI::Validator(
      [](const std::string& word) -> std::string {
        return word.empty() ? "expected a value, found nothing: is a variable of the shell unset?"
                            : "";
      },
      "");
}

Program::Program(std::string name, std::string description, std::string examples)
    : app_(std::move(description), std::move(name)) {
  app_.footer("\n" + std::move(examples));
  app_.set_version_flag("--version", app_.get_name() + " " + Version());
  app_.option_defaults()->always_capture_default();
}

void Program::AddCommonOptions(const OfferedOptions& offered) {
  constexpr const char* kGroup = "Common";
  if (offered.threads)
    app_.add_option("--threads", common_.threads, "Threads to use; 0: all of the machine's")
        ->check(CLI::Range(0, 512))
        ->group(kGroup);
  if (offered.seed)
    app_.add_option("--seed", common_.seed, offered.seed)->check(WholeNumber())->group(kGroup);
  if (offered.strict) app_.add_flag("--strict", common_.strict, offered.strict)->group(kGroup);
  if (offered.progress)
    app_.add_option("--progress", common_.progress,
                    "How progress is shown on stderr: auto (bar on a terminal, else plain), bar, "
                    "plain (a line now and then), json (one object per line) or none")
        ->check(CLI::IsMember({"auto", "bar", "plain", "json", "none"}))
        ->group(kGroup);
  if (offered.verbose)
    app_.add_flag("-v,--verbose", verbosity_, "Say more, for debugging")->group(kGroup);
  if (offered.quiet)
    app_.add_flag("-q,--quiet", quiet_, "Say only warnings and errors")->group(kGroup);
}

void Program::AddJsonOption(const std::string& what) {
  app_.add_flag("--json", common_.json, what)->group("Common");
}

namespace {

// CLI11 accepts "nan" as a number, even for options with a range.
Result<void> CheckNoNan(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_type_name().find("FLOAT") == std::string::npos) continue;
    for (const std::string& word : option->results()) {
      if (std::isnan(std::strtod(word.c_str(), nullptr)))
        return UsageError(fmt::format("{} {}: expected a number", option->get_name(), word));
    }
  }
  return {};
}

}  // namespace

int Program::Run(int argc, char** argv, const std::function<Result<void>()>& body) {
#ifdef __GLIBC__
  // Makes glibc return the memory of images and plates to the system when they are freed, because
  // --memory bounds what a program holds. Otherwise glibc would adapt and keep large blocks.
  constexpr int kLargeBytes = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargeBytes);
#endif
  StartProcess();
  // A closed pipe or a file size limit must be an error of the write and not end the program.
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  try {
    app_.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    const int code = app_.exit(help_or_version);
    const Result<void> printed = PrintReport("");
    if (printed) return code;
    LogMessage(LogLevel::kError, printed.error().message);
    return static_cast<int>(printed.error().kind);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "Try '%s --help'.\n", app_.get_name().c_str());
    LogMessage(LogLevel::kError, error.what());
    return static_cast<int>(ErrorKind::kUsage);
  }
  SetLogLevel(quiet_ ? LogLevel::kWarning : verbosity_ > 0 ? LogLevel::kDebug : LogLevel::kInfo);
  try {
    Result<void> result = CheckNoNan(app_);
    if (result) result = body();
    if (!result) {
      LogMessage(LogLevel::kError, result.error().message);
      return static_cast<int>(result.error().kind);
    }
    return 0;
  } catch (...) {
    return TellException();
  }
}

}  // namespace lf
