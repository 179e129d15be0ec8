#include "tools/common/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string_view>

namespace lf {
namespace {

constexpr size_t kWidth = 100;
// An option whose names are wider does not widen the column of the names.
constexpr size_t kWidestName = 38;
constexpr std::array<std::string_view, 5> kShownGroups = {kInputGroup, kOutputGroup, kPictureGroup,
                                                          kQualityGroup, kRunningGroup};
constexpr const char* kExitCodes =
    "Exit codes: 0 success, 1 internal error (a bug), 2 wrong usage, 3 bad input, 4 failed output, "
    "full disk or lack of memory, 5 interrupted, 6 finished, but with LF images left out or less "
    "quality than required. The last line on stderr states the reason.";

using Options = std::vector<const CLI::Option*>;

CLI::Validator NotNan() {
  return CLI::Validator(
      [](const std::string& word) -> std::string {
        return std::isnan(std::strtod(word.c_str(), nullptr))
                   ? fmt::format("expected a number, found '{}'", word)
                   : "";
      },
      "");
}

// Returns the text with the lines of each paragraph joined. Empty lines and lines that begin with
// two spaces stay as they are.
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

bool IsShownGroup(const std::string& group) {
  return std::find(kShownGroups.begin(), kShownGroups.end(), group) != kShownGroups.end();
}

bool Repeats(const CLI::Option& option) {
  return option.get_expected_max() >= CLI::detail::expected_max_vector_size;
}

// Returns "-o, --output DIR", or the name of a positional argument: "PACKAGE...".
std::string NamesOf(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true) + (Repeats(option) ? "..." : "");
  std::string names;
  for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
  for (const std::string& name : option.get_lnames()) names += "--" + name + ", ";
  names.resize(names.size() - 2);
  if (option.get_type_size() == 0) return names;  // flags have no placeholder
  const std::string type_name = option.get_type_name();
  return names + " " + type_name.substr(0, type_name.find(':'));
}

// Returns the default of an option as the parser states it; "empty" for an empty list; "" for a
// flag, a positional argument, or if there is no default.
std::string DefaultOf(const CLI::Option& option) {
  if (option.get_type_size() == 0 || option.get_positional()) return "";
  const std::string value = option.get_default_str();
  return value == "[]" ? "empty" : value;
}

// Returns the summary of an option, followed by its default in parentheses, unless the summary ends
// with words in parentheses or the default is empty.
std::string SummaryOf(const CLI::Option& option) {
  const std::string& text = option.get_description();
  const std::string summary = text.substr(0, text.find('\n')), value = DefaultOf(option);
  if (value.empty() || value == "empty" || summary.ends_with(')')) return summary;
  return fmt::format("{} ({})", summary, value);
}

// Returns the allowed values, such as "0 to 180", from the description of a validator, such as
// "INT in [0 - 180]". Returns nothing for a choice of words, because the placeholder shows them.
std::string ValuesOf(const std::string& validator) {
  if (validator == "NONNEGATIVE") return "0 or more";
  if (validator == "POSITIVE") return "more than 0";
  const size_t begin = validator.find(" in [");
  if (begin == std::string::npos) return "";
  std::string values = validator.substr(begin + 5, validator.size() - begin - 6);
  return CLI::detail::find_and_replace(values, " - ", " to ");
}

std::string JoinedNames(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return CLI::detail::join(names, ", ");
}

// Returns the facts about an option that the parser knows (whether it is required, its default, its
// values, the options that it needs or excludes), such as "Default: 0 (all); values: 0 to 180; not
// with --packages".
std::string FactsOf(const CLI::Option& option) {
  std::vector<std::string> facts;
  if (option.get_required()) facts.push_back("required");
  const std::string value = DefaultOf(option), summary = SummaryOf(option);
  if (const size_t meaning = summary.rfind('('); !value.empty()) {
    const bool has_meaning = meaning != std::string::npos && summary.ends_with(')') &&
                             summary.substr(meaning) != "(" + value + ")";
    facts.push_back("default: " + value + (has_meaning ? " " + summary.substr(meaning) : ""));
  }
  for (const std::string& validator : CLI::detail::split(option.get_type_name(), ':'))
    if (const std::string values = ValuesOf(validator); !values.empty())
      facts.push_back("values: " + values);
  if (!option.get_needs().empty()) facts.push_back("needs " + JoinedNames(option.get_needs()));
  if (!option.get_excludes().empty())
    facts.push_back("not with " + JoinedNames(option.get_excludes()));
  std::string sentence = CLI::detail::join(facts, "; ");
  if (!sentence.empty())
    sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  return sentence;
}

// Returns the options of a group, positional arguments first.
Options InGroup(const CLI::App& app, const std::string& group) {
  Options options = app.get_options(
      [&](const CLI::Option* option) { return !group.empty() && option->get_group() == group; });
  std::stable_partition(options.begin(), options.end(),
                        [](const CLI::Option* option) { return option->get_positional(); });
  return options;
}

// Returns the names of the groups in the order in which they are shown.
std::vector<std::string> GroupsOf(const CLI::App& app, bool is_all) {
  std::vector<std::string> groups(kShownGroups.begin(), kShownGroups.end());
  if (!is_all) return groups;
  for (const std::string& group : app.get_groups())
    if (!IsShownGroup(group) && group != kHelpGroup) groups.push_back(group);
  groups.emplace_back(kHelpGroup);
  return groups;
}

// Returns the column at which the summaries of the options begin.
size_t ColumnOf(const CLI::App& app) {
  size_t widest = 0;
  for (const std::string_view group : kShownGroups)
    for (const CLI::Option* option : InGroup(app, std::string(group)))
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

}  // namespace

OptionGroup::OptionGroup(CLI::App& app, std::string name) : app_(app), name_(std::move(name)) {}

CLI::Option* OptionGroup::Present(CLI::Option* option, const std::string& placeholder) const {
  if (option->get_type_name() == "FLOAT") option->check(NotNan());
  if (!placeholder.empty()) option->type_name(placeholder);
  return option->group(name_);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string /*name*/,
                                     CLI::AppFormatMode mode) const {
  const bool is_all = mode == CLI::AppFormatMode::All;
  std::string help = Wrapped(texts_.summary, 0);
  help += "\nUsage:\n" + Wrapped(texts_.usage, 0);
  help += "\nExamples:\n" + Wrapped(texts_.examples, 0);
  const size_t column = ColumnOf(*app);
  for (const std::string& group : GroupsOf(*app, is_all)) {
    const Options options = InGroup(*app, group);
    if (!options.empty()) help += "\n" + group + ":\n";
    for (const CLI::Option* option : options) {
      help += fmt::format("{:{}}{}\n", "  " + NamesOf(*option) + "  ", column, SummaryOf(*option));
      if (!is_all) continue;
      const std::string& text = option->get_description();
      if (const size_t end = text.find('\n'); end != std::string::npos)
        help += Wrapped(text.substr(end + 1), 6);
      help += Wrapped(FactsOf(*option), 6);
    }
  }
  if (!is_all) return help + "\n" + HintAtTheRest(*app);
  if (*texts_.details != '\0') help += "\n" + Wrapped(WithJoinedLines(texts_.details), 0);
  return help + "\n" + Wrapped(kExitCodes, 0);
}

}  // namespace lf
