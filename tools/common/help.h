// SPDX-License-Identifier: Apache-2.0
// The help of the programs: --help, which one can scan, and --help-all, which tells everything.
//
//   OptionGroup output(app, kOutputGroup);
//   output.Add("-o,--output DIR", folder, "Folder of the frames")->required();
//   output.Add("--max-images N", max_images,
//              "Most LF images that a frame takes (all)\n"
//              "A frame takes the first N of its order.");
//   output.AddChoice("--format", format, {"exr", "png"}, "File format of the frames");
//   output.AddFlag("--overwrite", overwrite, "Replace the frames in DIR");
//
// The text of an option is its summary and, after a line break, its details in sentences. --help
// shows the option in one line: names, placeholder (DIR), summary and default. A summary that ends
// with words in parentheses says what the default means: (all) in place of (0).
#pragma once

#include <CLI/CLI.hpp>
#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "tools/common/file_kinds.h"

namespace lf {

// The groups that --help shows, in this order. Only --help-all shows the options of other groups.
inline constexpr const char* kInputGroup = "Input";
inline constexpr const char* kOutputGroup = "Output";
inline constexpr const char* kPictureGroup = "Picture";
inline constexpr const char* kQualityGroup = "Quality";
inline constexpr const char* kRunningGroup = "Running";
// Groups that only --help-all shows; kHelpGroup (--help, --help-all, --version) comes last.
inline constexpr const char* kMeasuringGroup = "Measuring";
inline constexpr const char* kHelpGroup = "Help";

// The help of the argument PATH, which many programs have.
inline constexpr const char* kPathHelp =
    "Camera path\n"
    "Our own YAML (doc/formats/path.md); a path of nerfstudio, instant-ngp or Nuke; or a "
    "transforms.json, a COLMAP model or a cameras.json of 3D Gaussian splatting, whose cameras "
    "become "
    "the frames (doc/formats/foreign_paths.md).";

// The texts of one program. Lines that begin with two spaces, such as commands, are printed as they
// are; other lines are wrapped, in `details` after the lines of a paragraph are joined.
struct HelpTexts {
  const char* summary = "";   // one sentence: what the program does
  const char* usage = "";     // one line for each way to call the program
  const char* examples = "";  // one line for each command
  const char* details = "";   // paragraphs of --help-all: what is written, signals, ...
  // The program whose options may follow "--", such as "lfrenderer", and the names of the options
  // that are refused there.
  const char* rest_program = "";
  std::span<const char* const> refused_in_rest = {};
};

// A command, which is the first word of a call and has a help of its own.
struct CommandText {
  std::string name;     // stack
  std::string call;     // program or command that runs: lffocus stack
  std::string summary;  // shown in the list of commands of --help; empty: the command is not listed
};

// The last lines of --help-all.
inline constexpr const char* kExitCodes =
    "Exit codes: 0 success, 1 internal error (a bug), 2 wrong usage, 3 bad input, 4 failed output, "
    "full disk or lack of memory, 5 interrupted, 6 finished, but with LF images left out or less "
    "quality than required. The last line on stderr states the reason.";

// Returns the text with the lines of each paragraph joined. Empty lines and lines that begin with
// two spaces stay as they are.
std::string WithJoinedLines(std::string_view text);

// The kind of words that an option takes.
enum class OptionWords { kAny, kNumbers, kWholeNumbers, kWholeNumbersFromZero };

// The kind of words of an option whose value has this type. Optional numbers, and pairs and vectors
// of numbers have the kind of their numbers.
template <typename Value>
inline constexpr OptionWords kWordsOf = OptionWords::kAny;
template <std::floating_point Value>
inline constexpr OptionWords kWordsOf<Value> = OptionWords::kNumbers;
template <std::integral Value>
requires(!std::same_as<Value, bool>) inline constexpr OptionWords kWordsOf<Value> =
    std::is_signed_v<Value> ? OptionWords::kWholeNumbers : OptionWords::kWholeNumbersFromZero;
template <typename Value>
inline constexpr OptionWords kWordsOf<std::optional<Value>> = kWordsOf<Value>;
template <typename Value>
inline constexpr OptionWords kWordsOf<std::vector<Value>> = kWordsOf<Value>;
template <typename Value>
inline constexpr OptionWords kWordsOf<std::pair<Value, Value>> = kWordsOf<Value>;

// Adds options to one group of a program.
class OptionGroup {
 public:
  // The app must outlive the group. Options of a group with an empty name are hidden.
  OptionGroup(CLI::App& app, std::string name);

  // Adds an option, such as "-o,--output DIR", or a positional argument, such as "LIGHTFIELD". If
  // `value` is a number or contains numbers, a word is refused unless the whole of it is a number
  // (lf/core/parse_number.h): "0x10" and "nan" are refused and, for whole numbers, "1.5".
  template <typename Value>
  CLI::Option* Add(const std::string& names_and_placeholder, Value& value,
                   const std::string& text) {
    const size_t end = names_and_placeholder.find(' ');
    CLI::Option* const option = app_.add_option(names_and_placeholder.substr(0, end), value, text);
    AddCheck(option, kWordsOf<Value>);
    return Present(option, end == std::string::npos ? "" : names_and_placeholder.substr(end + 1));
  }

  // Adds an option whose value must be a number, and is kept as the word that is given.
  CLI::Option* AddNumber(const std::string& names_and_placeholder, std::string& word,
                         OptionWords words, const std::string& text);

  // Adds an option whose value must be one of `words`. The help shows the words as the placeholder
  // of an option; for a positional argument, `text` must name them.
  template <typename Value>
  CLI::Option* AddChoice(const std::string& names, Value& value,
                         const std::vector<std::string>& words, const std::string& text) {
    CLI::Option* const option = app_.add_option(names, value, text)->check(CLI::IsMember(words));
    return Present(option, option->get_positional() ? "" : CLI::detail::join(words, "|"));
  }

  template <typename Value>
  CLI::Option* AddFlag(const std::string& names, Value& value, const std::string& text) {
    return app_.add_flag(names, value, text)->group(name_);
  }

 private:
  static void AddCheck(CLI::Option* option, OptionWords words);
  CLI::Option* Present(CLI::Option* option, const std::string& placeholder) const;

  CLI::App& app_;
  std::string name_;
};

// Makes the text of --help (CLI::AppFormatMode::Normal) and of --help-all (All).
class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(const HelpTexts& texts) : texts_(texts) {}

  // Adds a list of commands to the help. Called before the command line is parsed.
  void SetCommands(std::vector<CommandText> commands) { commands_ = std::move(commands); }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;

 private:
  HelpTexts texts_;
  std::vector<CommandText> commands_;
};

}  // namespace lf
