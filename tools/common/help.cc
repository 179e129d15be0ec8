// SPDX-License-Identifier: Apache-2.0
#include "tools/common/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "tools/common/option_facts.h"
#include "tools/common/validators.h"

namespace lf {
namespace {

constexpr size_t kWidth = 100;
// An option whose names are wider does not widen the column of the names.
constexpr size_t kWidestName = 38;
// Returns the text with each line indented. Lines that do not begin with two spaces are wrapped at
// kWidth columns.
std::string Wrapped(std::string_view text, size_t indent) {
  std::string wrapped;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.starts_with("  ")) {
      wrapped += (line.empty() ? "" : std::string(indent, ' ') + line) + "\n";
      continue;
    }
    std::istringstream words(line);
    size_t width = 0;
    for (std::string word; words >> word; width += word.size()) {
      const bool begins = width == 0 || width + 1 + word.size() > kWidth;
      if (begins && width > 0) wrapped += "\n";
      wrapped += begins ? std::string(indent, ' ') : " ";
      width = begins ? indent : width + 1;
      wrapped += word;
    }
    wrapped += "\n";
  }
  return wrapped;
}

// Returns the column at which the summaries of the options begin.
size_t ColumnOf(const CLI::App& app) {
  size_t widest = 0;
  for (const std::string& group : GroupsOf(app, false))
    for (const CLI::Option* option : InGroup(app, group))
      if (const size_t width = NamesOf(*option).size(); width <= kWidestName)
        widest = std::max(widest, width);
  return widest + 4;
}

// Returns the last line of --help.
std::string HintAtTheRest(const CLI::App& app) {
  const size_t count = app.get_options([](const CLI::Option* option) {
                            const std::string& group = option->get_group();
                            return !group.empty() && !IsShownGroup(group) && group != kHelpGroup;
                          })
                           .size();
  if (count == 0) return "--help-all shows the details.\n";
  return fmt::format("--help-all shows {} more option{} and the details.\n", count,
                     count == 1 ? "" : "s");
}

// Returns the type that CLI11 gave an option, such as "INT".
std::string TypeName(const CLI::Option& option) {
  return CLI::detail::split(option.get_type_name(), ':')[0];
}

// Returns the names and summaries of the commands, a line each.
std::string ListOf(const std::vector<CommandText>& commands) {
  size_t widest = 0;
  for (const CommandText& command : commands) widest = std::max(widest, command.name.size());
  std::string list;
  for (const CommandText& command : commands)
    if (!command.summary.empty()) {
      const std::string lines = Wrapped(command.summary, widest + 4);
      list += fmt::format("  {:{}}", command.name, widest + 2) + lines.substr(widest + 4);
    }
  return list.empty() ? "" : "\nCommands:\n" + list;
}

}  // namespace

std::string WithJoinedLines(std::string_view text) {
  const auto stays = [](const std::string& line) { return line.empty() || line.starts_with("  "); };
  std::string joined;
  std::istringstream lines{std::string(text)};
  bool is_in_paragraph = false;
  for (std::string line; std::getline(lines, line);) {
    const bool goes_on = is_in_paragraph && !stays(line);
    if (!joined.empty()) joined += goes_on ? ' ' : '\n';
    joined += line;
    is_in_paragraph = !stays(line);
  }
  return joined;
}

OptionGroup::OptionGroup(CLI::App& app, std::string name) : app_(app), name_(std::move(name)) {}

void OptionGroup::AddCheck(CLI::Option* option, OptionWords words) {
  if (words == OptionWords::kNumbers) option->check(Number());
  if (words == OptionWords::kWholeNumbers) option->transform(WholeNumber());
  if (words == OptionWords::kWholeNumbersFromZero) option->transform(WholeNumberFromZero());
}

CLI::Option* OptionGroup::AddNumber(const std::string& names_and_placeholder, std::string& word,
                                    OptionWords words, const std::string& text) {
  CLI::Option* const option = Add(names_and_placeholder, word, text);
  AddCheck(option, words);
  const std::string type = words == OptionWords::kNumbers ? "FLOAT" : "UINT";
  return option->type_name(names_and_placeholder.substr(names_and_placeholder.find(' ') + 1) + ":" +
                           type);
}

CLI::Option* OptionGroup::Present(CLI::Option* option, const std::string& placeholder) const {
  // The type stays beside the placeholder, for TypeOf().
  if (!placeholder.empty()) option->type_name(placeholder + ":" + TypeName(*option));
  return option->group(name_);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string /*name*/,
                                     CLI::AppFormatMode mode) const {
  const bool is_all = mode == CLI::AppFormatMode::All;
  std::string help = Wrapped(texts_.summary, 0);
  help += "\nUsage:\n" + Wrapped(texts_.usage, 0);
  help += "\nExamples:\n" + Wrapped(texts_.examples, 0);
  help += ListOf(commands_);
  const size_t column = ColumnOf(*app);
  for (const std::string& group : GroupsOf(*app, is_all)) {
    const Options options = InGroup(*app, group);
    if (!options.empty()) help += "\n" + group + ":\n";
    for (const CLI::Option* option : options) {
      help += fmt::format("{:{}}{}\n", "  " + NamesOf(*option) + "  ", column, SummaryOf(*option));
      if (!is_all) continue;
      help += Wrapped(DetailsOf(*option), 6);
      help += Wrapped(FactsOf(*option), 6);
    }
  }
  if (!is_all) return help + "\n" + HintAtTheRest(*app);
  if (*texts_.details != '\0') help += "\n" + Wrapped(WithJoinedLines(texts_.details), 0);
  return help + "\n" + Wrapped(kExitCodes, 0);
}

}  // namespace lf
