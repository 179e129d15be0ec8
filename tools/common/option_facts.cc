// SPDX-License-Identifier: Apache-2.0
#include "tools/common/option_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "tools/common/help.h"

namespace lf {
namespace {

constexpr std::array<std::string_view, 5> kShownGroups = {kInputGroup, kOutputGroup, kPictureGroup,
                                                          kQualityGroup, kRunningGroup};

// Returns the placeholder, the type, and the descriptions of the validators, which CLI11 joins by
// colons (OptionGroup::Present).
std::vector<std::string> TypeParts(const CLI::Option& option) {
  return CLI::detail::split(option.get_type_name(), ':');
}

// Returns the allowed values, such as "0 to 180", from the description of a validator, such as
// "INT in [0 - 180]".
std::string AllowedBy(const std::string& validator) {
  if (validator == "NONNEGATIVE") return "0 or more";
  if (validator == "POSITIVE") return "more than 0";
  const size_t begin = validator.find(" in [");
  if (begin == std::string::npos) return "";
  std::string values = validator.substr(begin + 5, validator.size() - begin - 6);
  return CLI::detail::find_and_replace(values, " - ", " to ");
}

// Flags alone have no name of a type.
bool IsFlag(const CLI::Option& option) { return option.get_type_name().empty(); }

std::vector<std::string> SortedNames(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

bool IsShownGroup(const std::string& group) {
  return std::find(kShownGroups.begin(), kShownGroups.end(), group) != kShownGroups.end();
}

std::vector<std::string> GroupsOf(const CLI::App& app, bool is_all) {
  std::vector<std::string> groups(kShownGroups.begin(), kShownGroups.end());
  if (!is_all) return groups;
  for (const std::string& group : app.get_groups())
    if (!group.empty() && !IsShownGroup(group) && group != kHelpGroup) groups.push_back(group);
  groups.emplace_back(kHelpGroup);
  return groups;
}

Options InGroup(const CLI::App& app, const std::string& group) {
  Options options = app.get_options(
      [&](const CLI::Option* option) { return !group.empty() && option->get_group() == group; });
  std::stable_partition(options.begin(), options.end(),
                        [](const CLI::Option* option) { return option->get_positional(); });
  return options;
}

bool Repeats(const CLI::Option& option) {
  return option.get_expected_max() >= CLI::detail::expected_max_vector_size;
}

std::string PlaceholderOf(const CLI::Option& option) {
  if (IsFlag(option) || option.get_positional()) return "";
  return TypeParts(option)[0];
}

std::string TypeOf(const CLI::Option& option) {
  if (IsFlag(option)) return "flag";
  if (!ChoicesOf(option).empty()) return "choice";
  for (const std::string& part : TypeParts(option)) {
    if (part == "INT" || part == "UINT") return "whole number";
    if (part == "FLOAT") return "number";
  }
  return "text";
}

std::string NamesOf(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true) + (Repeats(option) ? "..." : "");
  std::string names;
  for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
  for (const std::string& name : option.get_lnames()) names += "--" + name + ", ";
  names.resize(names.size() - 2);
  const std::string placeholder = PlaceholderOf(option);
  return placeholder.empty() ? names : names + " " + placeholder;
}

std::string DefaultOf(const CLI::Option& option) {
  if (IsFlag(option) || option.get_positional()) return "";
  const std::string value = option.get_default_str();
  return value == "[]" ? "empty" : value;
}

std::string DefaultMeaningOf(const CLI::Option& option) {
  const std::string summary = SummaryOf(option);
  const size_t meaning = summary.rfind('(');
  if (meaning == std::string::npos || !summary.ends_with(')')) return "";
  return summary.substr(meaning) == "(" + DefaultOf(option) + ")" ? "" : summary.substr(meaning);
}

std::string SummaryOf(const CLI::Option& option) {
  const std::string& text = option.get_description();
  const std::string summary = text.substr(0, text.find('\n')), value = DefaultOf(option);
  if (value.empty() || value == "empty" || summary.ends_with(')')) return summary;
  return fmt::format("{} ({})", summary, value);
}

std::string DetailsOf(const CLI::Option& option) {
  const std::string& text = option.get_description();
  const size_t end = text.find('\n');
  return end == std::string::npos ? "" : text.substr(end + 1);
}

std::string ValuesOf(const CLI::Option& option) {
  std::vector<std::string> values;
  for (const std::string& part : TypeParts(option))
    if (const std::string allowed = AllowedBy(part); !allowed.empty()) values.push_back(allowed);
  return CLI::detail::join(values, "; ");
}

std::vector<std::string> ChoicesOf(const CLI::Option& option) {
  for (const std::string& part : TypeParts(option))
    if (part.starts_with('{') && part.ends_with('}'))
      return CLI::detail::split(part.substr(1, part.size() - 2), ',');
  return {};
}

std::vector<std::string> NeedsOf(const CLI::Option& option) {
  return SortedNames(option.get_needs());
}

std::vector<std::string> ExcludesOf(const CLI::Option& option) {
  return SortedNames(option.get_excludes());
}

std::string FactsOf(const CLI::Option& option) {
  std::vector<std::string> facts;
  if (option.get_required()) facts.emplace_back("required");
  if (const std::string value = DefaultOf(option); !value.empty()) {
    const std::string meaning = DefaultMeaningOf(option);
    facts.push_back("default: " + value + (meaning.empty() ? "" : " " + meaning));
  }
  if (const std::string values = ValuesOf(option); !values.empty())
    facts.push_back("values: " + values);
  if (!NeedsOf(option).empty())
    facts.push_back("needs " + CLI::detail::join(NeedsOf(option), ", "));
  if (!ExcludesOf(option).empty())
    facts.push_back("not with " + CLI::detail::join(ExcludesOf(option), ", "));
  std::string sentence = CLI::detail::join(facts, "; ");
  if (!sentence.empty())
    sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  return sentence;
}

}  // namespace lf
