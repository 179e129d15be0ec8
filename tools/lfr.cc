// SPDX-License-Identifier: Apache-2.0
// lfr COMMAND ...: runs one of the programs, so that one name has to be remembered.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "tools/common/program.h"
#include "tools/common/programs.h"

#include "lf/camera/path/spelling.h"
#include "lf/core/log.h"

namespace {

namespace fs = std::filesystem;

constexpr lf::HelpTexts kHelp = {
    .summary = "Runs the programs of lfrendertools by short names.",
    .usage = R"(  lfr COMMAND [ARGUMENTS]
  lfr help COMMAND)",
    .examples = R"(  lfr render capture/ path.yaml -o frames
  lfr focus stack capture/ path.yaml -o stack.exr
  lfr help render                # as lfr render --help, or lfrenderer --help)",
    .details =
        R"(Each command is replaced by the program that it runs, with its arguments, signals and exit code. The name of
the program is also a command, with or without lf: lfr lfrenderer, lfr renderer. The program beside
lfr is run; if there is none, the one that PATH finds.)",
};

// Returns the program whose command or name the word is; nullptr if there is none.
const lf::ListedProgram* ProgramOf(std::string_view word) {
  for (const lf::ListedProgram& program : lf::kPrograms)
    if (word == program.command || word == program.name ||
        word == std::string_view(program.name).substr(2))
      return &program;
  return nullptr;
}

lf::Error UnknownCommand(const std::string& word) {
  std::vector<std::string> names = {"help"};
  for (const lf::ListedProgram& program : lf::kPrograms) {
    names.emplace_back(program.command);
    names.emplace_back(program.name);
  }
  const std::string nearest = lf::NearestWord(word, names);
  return lf::UsageError(
      fmt::format("{}: unknown command{} to list the commands: lfr --help", word,
                  nearest.empty() ? ";" : fmt::format("; did you mean '{}'?", nearest)));
}

// Replaces this process by the program. Returns only if that fails: kUsage if the program is not
// found, kOutput for another reason.
lf::Error Become(const lf::ListedProgram& program, const std::vector<std::string>& words) {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  std::string file = (self.parent_path() / program.name).string();
  if (error || ::access(file.c_str(), X_OK) != 0) file = program.name;
  std::vector<char*> arguments = {file.data()};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execvp(file.c_str(), arguments.data());
  if (errno == ENOENT)
    return lf::UsageError(fmt::format(
        "{}: the program is neither beside lfr, in {}, nor in a folder of PATH: install it",
        program.name, self.parent_path().string()));
  return lf::OutputError(fmt::format("{}: cannot be run: {}", file, std::strerror(errno)));
}

// Returns the words of "render --help" for the words of "help render".
std::vector<std::string> AskingForHelp(std::vector<std::string> words) {
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && words[0] == "help") words = AskingForHelp(std::move(words));
  if (words.empty()) words = {"--help"};
  if (const lf::ListedProgram* const named = ProgramOf(words[0])) {
    const lf::Error error = Become(*named, {words.begin() + 1, words.end()});
    lf::LogMessage(lf::LogLevel::kError, error.message);
    return static_cast<int>(error.kind);
  }
  // Leaves out the words after an unknown command, of which the parser would tell.
  if (!words[0].starts_with('-')) words.resize(1);

  lf::Program program("lfr", kHelp);
  std::vector<lf::CommandText> commands;
  for (const lf::ListedProgram& listed : lf::kPrograms)
    commands.push_back({listed.command, listed.name, listed.summary});
  program.SetCommands(commands);
  std::string command;
  lf::OptionGroup input(program.app(), lf::kInputGroup);
  input.Add("COMMAND", command, "Short name of a program, from the list of commands");
  std::vector<char*> rest = {argv[0]};
  for (std::string& word : words) rest.push_back(word.data());
  rest.push_back(nullptr);
  return program.Run(static_cast<int>(rest.size()) - 1, rest.data(),
                     [&]() -> lf::Result<void> { return UnknownCommand(command); });
}
