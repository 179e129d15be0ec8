// SPDX-License-Identifier: Apache-2.0
#include "lf/core/shell_word.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(ShellWord, PlainWordsStayAsTheyAre) { EXPECT_EQ(ShellWord("a/b_c-1.lfp"), "a/b_c-1.lfp"); }

TEST(ShellWord, OthersAreQuoted) {
  EXPECT_EQ(ShellWord("two words"), "'two words'");
  EXPECT_EQ(ShellWord(""), "''");
  EXPECT_EQ(ShellWord("$HOME*"), "'$HOME*'");
  EXPECT_EQ(ShellWord("it's"), "'it'\\''s'");
}

TEST(FileArgument, NamesThatLookLikeOptionsOrListsGetAFolder) {
  EXPECT_EQ(FileArgument("film/a"), "film/a");
  EXPECT_EQ(FileArgument("-film"), "./-film");
  EXPECT_EQ(FileArgument("[a]"), "./[a]");
}

TEST(ShellCommand, QuotesEachWord) {
  EXPECT_EQ(ShellCommand({"lfsubmit", "--resume", FileArgument("my film")}),
            "lfsubmit --resume 'my film'");
}

}  // namespace
}  // namespace lf
