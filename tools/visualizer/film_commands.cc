// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/film_commands.h"

#include "tools/common/setting_options.h"

#include "lf/core/shell_word.h"

namespace lf {
namespace {

using Words = std::vector<std::string>;

std::string Command(std::initializer_list<Words> parts) {
  Words words;
  for (const Words& part : parts) words.insert(words.end(), part.begin(), part.end());
  return ShellCommand(words);
}

}  // namespace

FilmCommands CommandsOf(const PageArguments& page) {
  const Words film = {FileArgument(page.light_field), FileArgument(page.path)};
  const Words output = {"-o", page.watch.empty() ? "frames" : FileArgument(page.watch)};
  const Words& opened = page.light_field_options;
  const Words all = WordsOf(page.film, [](const Setting&) { return true; });
  const Words of_packages = WordsOf(page.film, IsOfPackages);
  const Words of_their_render =
      WordsOf(page.film, [](const Setting& setting) { return !setting.is_in_packages; });
  FilmCommands commands;
  commands.forecast = Command({{"lfpreprocessor"}, film, {"--plan"}, opened, of_packages});
  commands.render = Command({{"lfrenderer"}, film, output, opened, all});
  // The shell expands the pattern, which is therefore not quoted.
  commands.packages = Command({{"lfpreprocessor"}, film, {"-o", "packages"}, opened, of_packages}) +
                      "\nlfrenderer packages/package-*.lfp " + ShellCommand(output);
  for (const std::string& word : of_their_render) commands.packages += " " + ShellWord(word);
  return commands;
}

}  // namespace lf
