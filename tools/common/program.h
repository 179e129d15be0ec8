// SPDX-License-Identifier: Apache-2.0
// Shared by all programs: common options, exit codes for errors, help, version, and the description
// as JSON (describe.h).
//
//   int main(int argc, char** argv) {
//     lf::Program program("lfexample", {.summary = "Writes a camera path ...", ...});
//     lf::OptionGroup input(program.app(), lf::kInputGroup);
//     input.Add("LIGHTFIELD", light_field, "Folder or file ...")->required();
//     program.AddCommonOptions({.threads = true, .verbose = true});
//     return program.Run(argc, argv, [&]() -> lf::Result<void> { ... });
//   }
//
// The exit code is 0, 1 for a bug, or the ErrorKind of the error (lf/core/result.h). The reason is
// the last line of stderr, "error: ...".
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/common/help.h"

#include "lf/core/result.h"

namespace lf {

// Values of the common options. An option that the program does not offer keeps its default.
struct CommonOptions {
  int threads = 0;  // 0: as many as the machine has
  uint64_t seed = 0;
  bool strict = false;
  std::string progress =
      "auto";  // auto (bar on a terminal, else plain), bar, plain, json, none, or of a farm
  bool json = false;
};

// The common options that a program offers, because it obeys them. The other common options are
// refused as unknown. A text is the help of the option, as for OptionGroup::Add(); nullptr: the
// option is not offered.
struct OfferedOptions {
  bool threads = false;
  const char* seed = nullptr;    // help text: what the seed decides
  const char* strict = nullptr;  // help text: what becomes an error
  const char* json = nullptr;    // help text: what is printed
  bool progress = false;
  bool verbose = false;  // true if the program, or a library that it uses, calls LogDebug()
  bool quiet = false;    // true if the program calls LogInfo() or shows progress
};

class Program {
 public:
  Program(std::string name, const HelpTexts& texts);

  CLI::App& app() { return app_; }
  const CommonOptions& common() const { return common_; }
  // Adds the offered options. To be called last, because --help shows a program's own options
  // first.
  void AddCommonOptions(const OfferedOptions& offered);

  // Tells the help and the description which commands the program has.
  void SetCommands(const std::vector<CommandText>& commands);

  // Parses the command line, runs `body` and returns the exit code for main().
  int Run(int argc, char** argv, const std::function<Result<void>()>& body);

 private:
  CLI::App app_;
  HelpTexts texts_;
  std::vector<CommandText> commands_;
  CommonOptions common_;
  int verbosity_ = 0;
  bool quiet_ = false;
};

// Prints a whole report to stdout. kOutput if that fails. If its reader has ended, such as "head",
// Program::Run() then ends the program by SIGPIPE, without a message, once `body` has returned.
Result<void> PrintReport(const std::string& text);

}  // namespace lf
