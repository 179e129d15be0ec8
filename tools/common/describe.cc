// SPDX-License-Identifier: Apache-2.0
#include "tools/common/describe.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "tools/common/file_kinds.h"
#include "tools/common/option_facts.h"
#include "tools/common/program.h"

#include "lf/core/version.h"

namespace lf {
namespace {

using Json = nlohmann::ordered_json;

// Returns the lines of a text without the spaces before them.
std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(CLI::detail::ltrim(line));
  return lines;
}

// Splits "deadline, alfred: lines that ..." into its words and their meaning. Returns nothing if a
// word is not one of the choices.
std::optional<std::pair<std::vector<std::string>, std::string>> MeaningIn(
    const std::string& line, const std::vector<std::string>& choices) {
  const size_t colon = line.find(": ");
  if (colon == std::string::npos) return std::nullopt;
  std::vector<std::string> words;
  for (std::string word : CLI::detail::split(line.substr(0, colon), ','))
    words.push_back(CLI::detail::trim(word));
  for (const std::string& word : words)
    if (std::find(choices.begin(), choices.end(), word) == choices.end()) return std::nullopt;
  return std::pair(words, line.substr(colon + 2));
}

// Puts the choices and the rest of the details into the JSON of an option.
void AddDetails(const CLI::Option& option, Json& json) {
  const std::vector<std::string> choices = ChoicesOf(option);
  Json with_meanings = Json::array(), details = Json::array();
  for (const std::string& choice : choices)
    with_meanings.push_back({{"value", choice}, {"meaning", ""}});
  for (const std::string& line : LinesOf(DetailsOf(option))) {
    const auto found = MeaningIn(line, choices);
    if (!found) {
      details.push_back(line);
      continue;
    }
    for (Json& choice : with_meanings)
      if (std::find(found->first.begin(), found->first.end(), choice["value"].get<std::string>()) !=
          found->first.end())
        choice["meaning"] = found->second;
  }
  json["choices"] = with_meanings;
  json["details"] = details;
}

std::vector<std::string> AllNames(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

Json FilesToJson(const CLI::Option& option) {
  const TakenFiles files = FilesOf(option);
  if (files.kinds.empty()) return nullptr;
  return {{"kinds", files.kinds}, {"extensions", files.extensions}, {"folders", files.folders}};
}

Json OptionToJson(const CLI::Option& option) {
  const std::string& text = option.get_description();
  std::string meaning = DefaultMeaningOf(option);
  std::string summary = text.substr(0, text.find('\n'));
  // A positional argument has no default, and flags have none that is shown.
  if (!meaning.empty() && summary.ends_with(meaning))
    summary = CLI::detail::rtrim(summary.erase(summary.size() - meaning.size()));
  if (!meaning.empty()) meaning = meaning.substr(1, meaning.size() - 2);
  const std::string value = DefaultOf(option);
  const int count = option.get_items_expected_max();
  Json json = {{"names", AllNames(option)},
               {"positional", option.get_positional()},
               {"placeholder", PlaceholderOf(option)},
               {"type", TypeOf(option)},
               {"value_count", TypeOf(option) == "flag" ? 0
                               : Repeats(option)        ? 1
                                                        : count},
               {"repeats", Repeats(option)},
               {"required", option.get_required()},
               {"default", value == "empty" ? "" : value},
               {"default_means", meaning},
               {"values", ValuesOf(option)},
               {"choices", Json::array()},
               {"files", FilesToJson(option)},
               {"needs", NeedsOf(option)},
               {"excludes", ExcludesOf(option)},
               {"summary", summary},
               {"details", Json::array()}};
  AddDetails(option, json);
  return json;
}

}  // namespace

std::string DescriptionOf(const CLI::App& app, const HelpTexts& texts,
                          const std::vector<CommandText>& commands) {
  Json json = {{"format", "lfrendertools program 1"},
               {"name", app.get_name()},
               {"version", Version()},
               {"summary", texts.summary},
               {"usage", LinesOf(texts.usage)},
               {"examples", LinesOf(texts.examples)},
               {"details", WithJoinedLines(texts.details)},
               {"exit_codes", kExitCodes},
               {"commands", Json::array()},
               {"rest", nullptr},
               {"groups", Json::array()}};
  if (*texts.rest_program != '\0')
    json["rest"] = {{"program", texts.rest_program},
                    {"without", std::vector<std::string>(texts.refused_in_rest.begin(),
                                                         texts.refused_in_rest.end())}};
  for (const CommandText& command : commands)
    json["commands"].push_back(
        {{"name", command.name}, {"call", command.call}, {"summary", command.summary}});
  for (const std::string& group : GroupsOf(app, true)) {
    Json options = Json::array();
    for (const CLI::Option* option : InGroup(app, group)) options.push_back(OptionToJson(*option));
    if (options.empty()) continue;
    json["groups"].push_back(
        {{"name", group}, {"shown", IsShownGroup(group)}, {"options", std::move(options)}});
  }
  return json.dump(1) + "\n";
}

}  // namespace lf
