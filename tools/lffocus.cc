// SPDX-License-Identifier: Apache-2.0
// lffocus COMMAND ...: pictures of a light field for people and programs that analyse it.
#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/focus_depth.h"
#include "tools/focus_epi.h"
#include "tools/focus_stack.h"
#include "tools/focus_through.h"
#include "tools/focus_views.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lffocus"),
    .usage = R"(  lffocus stack LIGHTFIELD PATH -o OUT [OPTIONS]
  lffocus depth LIGHTFIELD PATH -o FILE [-o FILE...] [OPTIONS]
  lffocus sharp LIGHTFIELD PATH -o FILE [OPTIONS]
  lffocus through LIGHTFIELD PATH -o FILE|FOLDER [OPTIONS]
  lffocus epi LIGHTFIELD --row Y [-o FILE] [OPTIONS]
  lffocus views LIGHTFIELD --grid COLUMNSxROWS -o OUT [OPTIONS])",
    .examples = R"(  lffocus stack --help
  lffocus stack capture/ path.yaml -o stack.exr --planes 30
  lffocus stack capture/ path.yaml --frame 12 -o rack.mp4 --near 0.4 --far 2 --planes 75
  lffocus depth capture/ path.yaml -o depth.exr -o points.ply
  lffocus sharp capture/ path.yaml -o sharp.png
  lffocus through capture/ path.yaml -o seen.png --statistic median
  lffocus epi capture/ --row 240 -o epi.png
  lffocus views capture/ --grid 9x9 -o views)",
    .details =
        R"(Each command has options and a help of its own: lffocus stack --help. doc/focus.md has examples.)",
};

struct Command {
  std::string_view name;
  // Runs the command with the whole command line, and returns the exit code.
  int (*run)(int argc, char** argv);
};
constexpr std::array kCommands = {
    Command{"stack", lf::RunFocusStack}, Command{"depth", lf::RunFocusDepth},
    Command{"sharp", lf::RunFocusSharp}, Command{"through", lf::RunFocusThrough},
    Command{"epi", lf::RunFocusEpi},     Command{"views", lf::RunFocusViews}};

std::string Names() {
  std::string names;
  for (const Command& command : kCommands) {
    if (!names.empty()) names += ", ";
    names += command.name;
  }
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  for (const Command& command : kCommands)
    if (argc > 1 && command.name == argv[1]) return command.run(argc, argv);
  lf::Program program("lffocus", kHelp);
  std::string word;
  lf::OptionGroup input(program.app(), lf::kInputGroup);
  input.Add("COMMAND", word,
            "stack, depth, sharp, through, epi or views\n"
            "stack: pictures of one camera that differ in their focus distance\n"
            "depth: the depth of every element\n"
            "sharp: a picture in which everything is in focus\n"
            "through: a frame that sees through leaves and rain, by a statistic over the lens\n"
            "epi: the same pixel row or column of a row of LF cameras, in one picture\n"
            "views: the light field as a regular grid of views in one orientation");
  std::vector<lf::CommandText> commands;
  for (const Command& command : kCommands)
    commands.push_back({std::string(command.name), fmt::format("lffocus {}", command.name), ""});
  program.SetCommands(commands);
  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    return lf::UsageError(fmt::format(
        "{}: expected one of the commands {} as the first word; for the help of one: lffocus {} "
        "--help",
        word.empty() ? "no command is given" : word, Names(), kCommands[0].name));
  });
}
