// SPDX-License-Identifier: Apache-2.0
#include "lf/core/spelling.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

std::string Spell(const OptionReference& option) {
  return "<" + std::string(option.key) +
         (option.value.empty() ? "" : "=" + std::string(option.value)) +
         (option.is_heading ? "!>" : ">");
}

TEST(Spelling, ReplacesReferencesToOptions) {
  EXPECT_EQ(Spelled("use {mode rebin} or {fill}, or {z}", Spell),
            "use <mode=rebin> or <fill>, or <z>");
  EXPECT_EQ(Spelled("leave {images /a{b}/{c}} out", Spell), "leave <images=/a{b}/{c}> out");
  EXPECT_EQ(Spelled("", Spell), "");
  EXPECT_EQ(Spelled("no reference", Spell), "no reference");
}

TEST(Spelling, ValuesAreAnyText) {
  EXPECT_EQ(Spelled("{fill 1 }: expected", CommandLineOption), "--fill 1 : expected");
  EXPECT_EQ(Spelled("{fill }: expected", CommandLineOption), "--fill: expected");
}

TEST(Spelling, TellsHeadings) {
  EXPECT_EQ(Spelled("a.exr: {z}: leave {z} out", Spell), "a.exr: <z!>: leave <z> out");
}

TEST(Spelling, AProgramIsAProgramForEveryReader) {
  EXPECT_EQ(Spelled("({lfimport exclude})", Spell), "(lfimport --exclude)");
  EXPECT_EQ(Spelled("{lfpreprocessor lens_weights none}", Spell),
            "lfpreprocessor --lens-weights none");
  EXPECT_EQ(Spelled("{lf_pixels areas} {lfrenderer}", Spell), "<lf_pixels=areas> <lfrenderer>");
}

TEST(Spelling, OtherTextInBracesStays) {
  for (const char* text : {"{", "}", "{}", "{open", "close}", "{ mode}", "{Mode}", "{0}",
                           "{\"mode\": 1}", "{left,right}.png", "[0-9]{4}", "{{Param.JobFolder}}",
                           "{max-images}", "{lfimport Exclude}"})
    EXPECT_EQ(Spelled(text, Spell), text);
  EXPECT_EQ(Spelled("{a {mode} {fill", Spell), "{a <mode> {fill");
}

TEST(Spelling, KeysStandForThemselvesUntilSomebodySaysOtherwise) {
  EXPECT_EQ(Spelled("{max_images}: use {mode rebin}"), "max_images: use mode rebin");
  SetSpeller(Spell);
  EXPECT_EQ(Spelled("{max_images}: use {mode rebin}"), "<max_images!>: use <mode=rebin>");
  SetSpeller(CommandLineOption);
  EXPECT_EQ(Spelled("{max_images}: use {mode rebin}"), "--max-images: use --mode rebin");
}

TEST(Spelling, OptionsOfCommandLinesHaveDashes) {
  EXPECT_EQ(CommandLineOption({"max_angle_deg"}), "--max-angle");
  EXPECT_EQ(CommandLineOption({"lens_weights", "none"}), "--lens-weights none");
  EXPECT_EQ(CommandLineOption({"guard", "off"}), "--no-guard");
  EXPECT_EQ(CommandLineOption({"output"}), "-o");
  EXPECT_EQ(CommandLineOption({"output", "film.mp4"}), "-o film.mp4");
}

}  // namespace
}  // namespace lf
