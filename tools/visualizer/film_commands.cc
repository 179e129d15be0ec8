// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/film_commands.h"

#include "tools/common/setting_options.h"

#include "lf/core/shell_word.h"
#include "lf/densify/densify_plan.h"
#include "lf/render/pipeline/check_film_settings.h"

namespace lf {
namespace {

using Words = std::vector<std::string>;

std::string Command(std::initializer_list<Words> parts) {
  Words words;
  for (const Words& part : parts) words.insert(words.end(), part.begin(), part.end());
  return ShellCommand(words);
}

}  // namespace

FilmCommands CommandsOf(const PageArguments& page, bool takes_densify) {
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
  if (takes_densify)
    commands.densify = Command({{"lfrenderer"}, film, {"--densify"}, output, opened, all});
  // The shell expands the pattern, which is therefore not quoted.
  commands.packages = Command({{"lfpreprocessor"}, film, {"-o", "packages"}, opened, of_packages}) +
                      "\nlfrenderer packages/package-*.lfp " + ShellCommand(output);
  for (const std::string& word : of_their_render) commands.packages += " " + ShellWord(word);
  return commands;
}

bool TakesDensify(const LightField& light_field, const FilmSettings& film, bool has_focal_surface) {
  if (!CheckKind(light_field)) return false;
  Package densified;
  densified.light_field.encoding = light_field.encoding;
  densified.whole_virtual_count = 1;
  densified.choices.has_neighbours = true;
  return !(film.guard && has_focal_surface) && CheckFilmSettings(densified, film, {}).has_value();
}

}  // namespace lf
