// SPDX-License-Identifier: Apache-2.0
#include "tools/common/parse_errors.h"

#include <fmt/format.h>

#include <regex>
#include <string_view>
#include <vector>

#include "lf/camera/path/spelling.h"
#include "lf/core/parse_number.h"

namespace lf {
namespace {

// Returns the word behind an option or, if there is none, "".
std::string WordOf(const std::string& option, int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == option && i + 1 < argc && !std::string_view(argv[i + 1]).starts_with("--"))
      return argv[i + 1];
    if (word.starts_with(option + "=")) return std::string(word.substr(option.size() + 1));
  }
  return {};
}

// Returns the name of the first option in the words that the help does not show, because CLI11 does
// not name such options in its errors; "" if there is none.
std::string HiddenOption(const CLI::App& app, int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i)
    for (const CLI::Option* option : app.get_options())
      if (option->get_group().empty() && option->check_name(argv[i])) return argv[i];
  return {};
}

// Returns a message about the first word that begins with a dash and is neither an option nor a
// number; "" if there is none. Other errors of CLI11 may be its consequence: in "-o a --formt", a
// missing argument.
std::string UnknownOptionText(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--"; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.find('='));
    if (!word.starts_with("-") || word == "-" || ParseNumber(word)) continue;
    const CLI::Option* const before = i > 1 ? app.get_option_no_throw(argv[i - 1]) : nullptr;
    if (before != nullptr && before->get_items_expected_max() > 0) continue;  // may be its value
    // One dash may be followed by several letters, and by a value: "-vo a".
    const bool is_short = !word.starts_with("--");
    if (app.get_option_no_throw(is_short ? word.substr(0, 2) : name) != nullptr) continue;
    // "-format" is what "--format" was meant to be.
    const std::string nearest = NearestWord(is_short ? "-" + name : name, names);
    return fmt::format("{}: unknown option{}", name,
                       nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest));
  }
  return "";
}

// Returns the option and its placeholder, such as "--grid COLUMNSxROWS".
std::string Usage(const CLI::App& app, const std::string& name) {
  const CLI::Option* const option = app.get_option_no_throw(name);
  if (option == nullptr) return name;
  // The name of the type begins with the placeholder: "N:UINT in [1 - 9]".
  const std::string type = option->get_type_name();
  const std::string placeholder = type.substr(0, type.find(':'));
  return placeholder.empty() || !option->nonpositional() ? name : name + " " + placeholder;
}

// Returns the limits of an option's values, such as "from 1 to 9", as its type has them. The
// message of CLI11 rounds them to six digits.
std::string Limits(const CLI::App& app, const std::string& name) {
  static const std::regex limits(R"(in \[(.+) - (.+)\])");
  const CLI::Option* const option = app.get_option_no_throw(name);
  const std::string type = option == nullptr ? "" : option->get_type_name();
  std::smatch part;
  return std::regex_search(type, part, limits)
             ? fmt::format(" from {} to {}", part[1].str(), part[2].str())
             : "";
}

std::string Found(const std::string& word) {
  return word.empty() ? "found nothing" : fmt::format("found '{}'", word);
}

}  // namespace

std::string ParseErrorText(const CLI::App& app, const CLI::ParseError& error, int argc,
                           const char* const* argv) {
  std::string text = error.what();
  for (const CLI::ExitCodes code : {CLI::ExitCodes::ExtrasError, CLI::ExitCodes::RequiredError,
                                    CLI::ExitCodes::ArgumentMismatch}) {
    if (error.get_exit_code() != static_cast<int>(code)) continue;
    if (std::string unknown = UnknownOptionText(app, argc, argv); !unknown.empty()) return unknown;
  }
  if (text.starts_with(": ")) text = HiddenOption(app, argc, argv) + text;
  std::smatch part;
  static const std::regex range("(.+): Value (.*) not in range .+ to .+");
  static const std::regex above("(.+): Number less or equal to 0: (.*)");
  static const std::regex not_below("(.+): Number less than 0: (.*)");
  static const std::regex missing(
      "(.+): (?:\\d+ required .* missing|At least \\d+ required but received \\d+)");
  static const std::regex type("Could not convert: (.+) = (.*)");
  static const std::regex number("(.+): expected a (whole )?number( from 0)?, found '([^]*)'");
  if (std::regex_match(text, part, range))
    return fmt::format("{}: expected a number{}, {}", Usage(app, part[1]), Limits(app, part[1]),
                       Found(part[2]));
  if (std::regex_match(text, part, number)) {
    const std::string usage = Usage(app, part[1]), whole = part[2];
    std::string word = part[4], limits = Limits(app, part[1]);
    if (limits.empty()) limits = part[3];
    // A list that is written in another form is one word for CLI11, which takes the next option for
    // its second number.
    const std::string_view placeholder = std::string_view(usage).substr(usage.rfind(' ') + 1);
    const bool is_list = placeholder.find_first_of("x,") != std::string::npos;
    if (is_list && word.starts_with("-")) word = WordOf(part[1], argc, argv);
    return fmt::format("{}: expected {}{}{}{}, {}", usage, is_list ? "" : "a ", whole,
                       is_list ? "numbers" : "number", limits, Found(word));
  }
  if (std::regex_match(text, part, above))
    return fmt::format("{}: expected a number above 0, {}", Usage(app, part[1]), Found(part[2]));
  if (std::regex_match(text, part, not_below))
    return fmt::format("{}: expected a number from 0, {}", Usage(app, part[1]), Found(part[2]));
  if (std::regex_match(text, part, missing)) {
    const std::string word = WordOf(part[1], argc, argv), usage = Usage(app, part[1]);
    return word.empty()
               ? fmt::format("{}: expected a value, found nothing: {}", part[1].str(), usage)
               : fmt::format("{}: expected a value of this form, {}", usage, Found(word));
  }
  if (std::regex_match(text, part, type))
    return fmt::format("{}: expected a number, {}", Usage(app, part[1]), Found(part[2]));
  return text;
}

std::string EmptyPartText(const CLI::App& app, int argc, const char* const* argv) {
  for (const CLI::Option* option : app.get_options()) {
    const char delimiter = option->get_delimiter();
    if (delimiter == '\0' || option->count() == 0) continue;
    const std::string name = option->get_name(), word = WordOf(name, argc, argv);
    if (word.starts_with(delimiter) || word.ends_with(delimiter) ||
        word.find(std::string(2, delimiter)) != std::string::npos)
      return fmt::format("{}: expected a value of this form, {}", Usage(app, name), Found(word));
  }
  return "";
}

}  // namespace lf
