// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/describe.h"
#include "tools/common/help.h"
#include "tools/common/next_step.h"
#include "tools/common/parse_errors.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"

#include "lf/core/shell_word.h"

namespace lf {
namespace {

TEST(MissingLimit, ANumberIsOfImagesWhateverWasAskedFor) {
  const Result<MissingLimit> three = MissingLimit::Parse("3");
  ASSERT_TRUE(three);
  EXPECT_FALSE(three->is_share());
  EXPECT_TRUE(three->Allows(3, 1'000'000));
  EXPECT_TRUE(three->Allows(3, 3));
  EXPECT_FALSE(three->Allows(4, 1'000'000));
  EXPECT_TRUE(MissingLimit().Allows(0, 5));
  EXPECT_FALSE(MissingLimit().Allows(1, 1'000'000));
}

TEST(MissingLimit, APercentageIsExact) {
  const auto allows = [](const char* text, uint64_t missing, uint64_t asked) {
    return MissingLimit::Parse(text)->Allows(missing, asked);
  };
  EXPECT_TRUE(allows("2%", 3, 150));
  EXPECT_FALSE(allows("2%", 3, 149));
  EXPECT_TRUE(allows("0.07%", 7, 10'000));  // inexact in binary fractions: 0.07 * 100 > 7
  EXPECT_FALSE(allows("0.069999%", 7, 10'000));
  EXPECT_TRUE(allows("100%", 9, 9));
  EXPECT_FALSE(allows("99.999999%", 4'000'000'000, 4'000'000'000));
  EXPECT_TRUE(allows("0%", 0, 10));
  EXPECT_FALSE(allows("0%", 1, UINT32_MAX));
  EXPECT_FALSE(allows("100%", 1, 0));
}

TEST(MissingLimit, RefusesTheRestAndNamesTheOption) {
  for (const char* text :
       {"",    "%",   "-1",         "x",     "1.5",   "3 ",          " 3",
        "+3",  "1e2", "0x3",        "2 %",   "-2%",   "100.000001%", "101%",
        "1.%", ".5%", "1.2345678%", "1..2%", "1.-2%", "nan%",        "99999999999999999999"}) {
    const Result<MissingLimit> limit = MissingLimit::Parse(text);
    ASSERT_FALSE(limit) << text;
    EXPECT_EQ(limit.error().kind, ErrorKind::kUsage);
    EXPECT_NE(limit.error().message.find("--allow-missing"), std::string::npos);
  }
}

TEST(MissingLimit, DecidesHowAProgramEnds) {
  const MissingImages missing{3, 25, "3 of 25 LF images were left out", "mend them"};
  EXPECT_TRUE(EndWithMissing(missing, *MissingLimit::Parse("3")));
  EXPECT_TRUE(EndWithMissing(missing, *MissingLimit::Parse("12%")));
  EXPECT_TRUE(EndWithMissing({0, 0, "", ""}, MissingLimit()));
  const Result<void> end = EndWithMissing(missing, *MissingLimit::Parse("2"));
  ASSERT_FALSE(end);
  EXPECT_EQ(end.error().kind, ErrorKind::kBelowRequired);
  EXPECT_EQ(end.error().message,
            "3 of 25 LF images were left out; --allow-missing 3 would accept this; mend them");
}

TEST(SameCall, KeepsTheWordsAndAddsOptionsBeforeTheDashes) {
  const std::vector<std::string> call = {"lfx", "a b", "--overwrite", "-o", "c", "--", "-d"};
  EXPECT_EQ(SameCall(call, {"--resume"}, {"--overwrite"}), "lfx 'a b' -o c --resume -- -d");
  EXPECT_EQ(SameCall(call, {"--overwrite", "--pitch", "1"}),
            "lfx 'a b' --overwrite -o c --pitch 1 -- -d");
  const std::vector<std::string> twice = {"lfx",       "--pitch", "1", "a",
                                          "--pitch=3", "--at",    "1", "-2"};
  EXPECT_EQ(SameCall(twice, {"--pitch", "2", "--at", "-3", "4", "--resume"}),
            "lfx a --pitch 2 --at -3 4 --resume");
  EXPECT_EQ(SameCall(twice, {"--at", "-3", "4"}), "lfx --pitch 1 a --pitch=3 --at -3 4");
}

TEST(ShellPackages, APatternMatchesThesePackagesAndNoOthers) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("lf it's {}", ::getpid());
  std::filesystem::create_directory(folder);
  const auto path = [&](const char* name) { return (folder / name).string(); };
  for (const char* name : {"package-0000.lfp", "package-0001.lfp"}) std::ofstream(path(name));
  const std::string quoted = ShellWord(folder.string());
  const std::vector<std::string> both = {path("package-0000.lfp"), path("package-0001.lfp")};
  EXPECT_EQ(ShellPackages(both), quoted + "/package-*.lfp");
  EXPECT_EQ(ShellPackages({both[1]}), ShellWord(both[1]));
  std::ofstream(path("package-0000-of-frames-3.lfp"));
  EXPECT_EQ(ShellPackages(both), quoted + "/package-????.lfp");
  std::ofstream(path("package-0002.lfp"));
  EXPECT_EQ(ShellPackages(both), ShellCommand(both));
  std::filesystem::remove_all(folder);
}

TEST(Progress, ABarHasRoomInTheTerminal) {
  EXPECT_EQ(ProgressLine(0.5, "half", 200), "[############............] half");
  EXPECT_EQ(ProgressLine(1, "all", 19), "[############] all");
  for (size_t width = 1; width < 120; ++width)
    EXPECT_LT(ProgressLine(0.3, "LF image 642/1386, frame 5/12  46 %", width).size(), width);
  EXPECT_EQ(ProgressLine(0.3, "46 %  6 s left", 20), "46 %  6 s left");
}

TEST(Program, WholeNumbersAreDecimalAndFit) {
  std::string word = "010";
  EXPECT_EQ(WholeNumber()(word), "");
  EXPECT_EQ(word, "10");
  word = "-010";
  EXPECT_EQ(WholeNumber()(word), "");
  EXPECT_EQ(word, "-10");
  for (word = "-0"; const auto& number : {WholeNumber(), WholeNumberFromZero()}) {
    EXPECT_EQ(number(word), "");
    EXPECT_EQ(word, "0");
    word = "-00";
  }
  for (std::string wrong : {"", "-1", "a", "1.5", "18446744073709551616", "0x10", "+5", " 5", "5 "})
    EXPECT_NE(WholeNumberFromZero()(wrong).find("expected a whole number"), std::string::npos)
        << wrong;
  for (std::string wrong : {"nan", "inf", "0x1p3", " 1", "1 ", "1,5", "1e999", ""})
    EXPECT_NE(Number()(wrong), "") << wrong;
  for (std::string good : {"1", "-1.5e-3", "+.5", "1."}) EXPECT_EQ(Number()(good), "") << good;
  std::string empty;
  EXPECT_NE(NotEmpty()(empty), "");
}

TEST(Program, AFractionIsARate) {
  std::string word = "24000/1001";
  EXPECT_EQ(Rate()(word), "");
  EXPECT_EQ(word, "23.976023976023978");
  word = "29.970";
  EXPECT_EQ(Rate()(word), "");
  EXPECT_EQ(word, "29.970");
  word = "24/0";
  EXPECT_NE(Rate()(word), "");
}

class HelpTest : public testing::Test {
 protected:
  HelpTest() {
    app_.formatter(std::make_shared<HelpFormatter>(
        HelpTexts{.summary = "Films.",
                  .usage = "  film PATH [OPTIONS]",
                  .examples = "  film a   # a comment",
                  .details = "DIR receives\nframes.\n\nA list:\n  a  1\n  b  2"}));
    app_.set_help_flag("-h,--help", "Show help")->group(kHelpGroup);
    app_.option_defaults()->always_capture_default();
    OptionGroup running(app_, kRunningGroup), output(app_, kOutputGroup), rare(app_, "Rare");
    output.Add("PATH", path_, "Camera path")->required();
    CLI::Option* const plan = output.AddFlag("--plan", plan_, "Write nothing");
    output.Add("-o,--output DIR", path_, "Folder\nThe folder of the frames.")->excludes(plan);
    running.Add("--threads N", threads_, "Threads (all)")->check(CLI::Range(0, 512));
    rare.Add("--slab-position X Y Z", position_, "Place of the slab")->expected(3);
    rare.AddChoice("--format", format_, {"exr", "png"}, "File format");
  }

  // Parses a command line of one option. Returns the message of the error, or nothing.
  std::string Parse(const std::string& words) {
    try {
      app_.parse(words);
    } catch (const CLI::ParseError& error) {
      const char* const argv[] = {"film", "a", "--slab-position=1"};
      text_ = ParseErrorText(app_, error, 3, argv);
      return error.what();
    }
    return "";
  }

  CLI::App app_;
  std::string text_;  // the message of the last error as programs print it
  std::string path_, format_ = "exr";
  std::vector<double> position_;
  int threads_ = 0;
  bool plan_ = false;
};

TEST_F(HelpTest, ShowsALineForEachOptionOfItsGroups) {
  EXPECT_EQ(app_.help("film", CLI::AppFormatMode::Normal),
            "Films.\n"
            "\nUsage:\n  film PATH [OPTIONS]\n"
            "\nExamples:\n  film a   # a comment\n"
            "\nOutput:\n"
            "  PATH              Camera path\n"
            "  --plan            Write nothing\n"
            "  -o, --output DIR  Folder\n"
            "\nRunning:\n"
            "  --threads N       Threads (all)\n"
            "\n--help-all shows 2 more options and the details.\n");
}

TEST_F(HelpTest, HelpAllAddsDetailsFactsAndRareOptions) {
  const std::string help = app_.help("film", CLI::AppFormatMode::All);
  for (const char* part :
       {"  PATH              Camera path\n      Required\n",
        "  -o, --output DIR  Folder\n      The folder of the frames.\n      Not with --plan\n",
        "  --threads N       Threads (all)\n      Default: 0 (all); values: 0 to 512\n",
        "\nRare:\n  --slab-position X Y Z  Place of the slab\n      Default: empty\n",
        "  --format exr|png  File format (exr)\n      Default: exr\n",
        "\nHelp:\n  -h, --help        Show help\n\nDIR receives frames.\n\nA list:\n  a  1\n  b  "
        "2\n\nExit codes: 0 success,"})
    EXPECT_NE(help.find(part), std::string::npos) << part << "\nis not in\n" << help;
}

TEST_F(HelpTest, LongDetailsAreWrapped) {
  std::string details = "\n";
  for (int i = 0; i < 60; ++i) details += "word ";
  OptionGroup(app_, "Rare").AddFlag("--long", plan_, "Summary" + details);
  std::istringstream lines(app_.help("film", CLI::AppFormatMode::All));
  size_t widest = 0;
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, line.size());
  EXPECT_LE(widest, 100u);
  EXPECT_GT(widest, 95u);
}

TEST_F(HelpTest, ErrorsNameTheAllowedValues) {
  EXPECT_EQ(Parse("a --format gif"), "--format: gif not in {exr,png}");
  EXPECT_NE(Parse("a --threads 999").find("999 not in range 0 to 512"), std::string::npos);
  EXPECT_EQ(text_, "--threads N: expected a number from 0 to 512, found '999'");
  Parse("a --threads 1.5");
  EXPECT_EQ(text_, "--threads N: expected a whole number from 0 to 512, found '1.5'");
  Parse("a --threads=0x10");
  EXPECT_EQ(text_, "--threads N: expected a whole number from 0 to 512, found '0x10'");
  Parse("a --threads");
  EXPECT_EQ(text_, "--threads: expected a value, found nothing: --threads N");
  Parse("a --slab-position 1");
  EXPECT_EQ(text_, "--slab-position X Y Z: expected a value of this form, found '1'");
  EXPECT_EQ(Parse("a --slab-position 1 nan 2"), "--slab-position: expected a number, found 'nan'");
}

// Returns the option of that name from a description.
nlohmann::json OptionIn(const nlohmann::json& description, const std::string& name) {
  for (const nlohmann::json& group : description["groups"])
    for (const nlohmann::json& option : group["options"])
      for (const std::string known : option["names"])
        if (known == name) return option;
  return nullptr;
}

TEST_F(HelpTest, DescriptionStatesWhatTheParserKnows) {
  std::string kind = "a", store;
  OptionGroup other(app_, "Rare");
  other.AddChoice("--kind", kind, {"a", "b", "c"},
                  "Kind of film (either)\nThe film is cut.\na: the first\nb, c: the others\nd: no");
  other.Add("--store STORE.lfs", store, "Store")->check(TakesFiles("package .exr folder"));
  OptionGroup(app_, "").AddFlag("--hidden", plan_, "Hidden");
  const auto description = nlohmann::json::parse(DescriptionOf(
      app_, {.summary = "Films.", .usage = "  film A\n  film B"}, {{"a", "film a", ""}}));
  EXPECT_EQ(description["usage"], (std::vector<std::string>{"film A", "film B"}));
  EXPECT_EQ(description["commands"][0]["call"], "film a");
  EXPECT_EQ(description["groups"][0]["name"], kOutputGroup);
  EXPECT_EQ(description["groups"][0]["options"][0]["names"][0], "PATH");
  EXPECT_EQ(OptionIn(description, "PATH")["files"]["kinds"][0], "path");
  EXPECT_EQ(OptionIn(description, "-o")["names"], (std::vector<std::string>{"-o", "--output"}));
  EXPECT_EQ(OptionIn(description, "-o")["excludes"][0], "--plan");
  EXPECT_EQ(OptionIn(description, "-o")["files"]["folders"], true);
  EXPECT_EQ(OptionIn(description, "--plan")["type"], "flag");
  const nlohmann::json threads = OptionIn(description, "--threads");
  EXPECT_EQ(threads["type"], "whole number");
  EXPECT_EQ(threads["summary"], "Threads");
  EXPECT_EQ(threads["default"], "0");
  EXPECT_EQ(threads["default_means"], "all");
  EXPECT_EQ(threads["values"], "0 to 512");
  EXPECT_TRUE(threads["files"].is_null());
  EXPECT_EQ(OptionIn(description, "--slab-position")["value_count"], 3);
  EXPECT_EQ(OptionIn(description, "--slab-position")["type"], "number");
  const nlohmann::json with_choices = OptionIn(description, "--kind");
  EXPECT_EQ(with_choices["choices"][2],
            (nlohmann::json{{"value", "c"}, {"meaning", "the others"}}));
  EXPECT_EQ(with_choices["details"], (std::vector<std::string>{"The film is cut.", "d: no"}));
  EXPECT_EQ(OptionIn(description, "--store")["files"]["extensions"],
            (std::vector<std::string>{".lfp", ".exr"}));
  EXPECT_TRUE(OptionIn(description, "--hidden").is_null());
}

TEST(Progress, FarmsGetTheLinesThatTheyLookFor) {
  EXPECT_EQ(FarmLines(ProgressStyle::kOpenJd, 0.42, "frame 3/10"),
            (std::vector<std::string>{"openjd_progress: 42.0", "openjd_status: frame 3/10"}));
  EXPECT_EQ(FarmLines(ProgressStyle::kOpenJd, 0.99999, "").front(), "openjd_progress: 99.9");
  EXPECT_EQ(FarmLines(ProgressStyle::kOpenJd, 1, ""),
            (std::vector<std::string>{"openjd_progress: 100.0"}));
  EXPECT_EQ(FarmLines(ProgressStyle::kDeadline, 0.429, "x").front(), "Progress: 42%");
  EXPECT_EQ(FarmLines(ProgressStyle::kAlfred, 2, "x").front(), "ALF_PROGRESS 100%");
}

TEST(Progress, StylesHaveNames) {
  EXPECT_EQ(ParseProgressStyle("json"), ProgressStyle::kJson);
  EXPECT_EQ(ParseProgressStyle("none"), ProgressStyle::kNone);
  EXPECT_EQ(ParseProgressStyle("openjd"), ProgressStyle::kOpenJd);
  EXPECT_EQ(ParseProgressStyle("deadline"), ProgressStyle::kDeadline);
  EXPECT_EQ(ParseProgressStyle("alfred"), ProgressStyle::kAlfred);
}

}  // namespace
}  // namespace lf
