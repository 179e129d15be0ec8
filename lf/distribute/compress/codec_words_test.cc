// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/codec_words.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

CompressOptions OptionsOf(const CodecWords& words) {
  CompressOptions options;
  const Result<void> set = SetCodec(words, &options);
  EXPECT_TRUE(set) << set.error().message;
  return options;
}

TEST(CodecWords, EachProfileHasItsDefaults) {
  const CodecSettings usual = OptionsOf({}).codec;
  EXPECT_EQ(usual.profile, CodecProfile::kDefault);
  EXPECT_EQ(usual.levels, 4);
  EXPECT_EQ(usual.threshold, 3);
  const CodecSettings thesis = OptionsOf({.profile = "thesis"}).codec;
  EXPECT_EQ(thesis.profile, CodecProfile::kThesis);
  EXPECT_EQ(thesis.levels, 1);
  EXPECT_EQ(thesis.threshold, 8);
  const CodecSettings chosen = OptionsOf({.levels = 2, .threshold = 0}).codec;
  EXPECT_EQ(chosen.levels, 2);
  EXPECT_EQ(chosen.threshold, 0);
}

TEST(CodecWords, GroupsKeepNoFiles) {
  EXPECT_EQ(OptionsOf({}).prediction, Prediction::kNone);
  const CompressOptions group = OptionsOf({.profile = "group"});
  EXPECT_EQ(group.prediction, Prediction::kGroups);
  EXPECT_EQ(group.files, KeepFiles::kNone);
  EXPECT_EQ(group.codec.profile, CodecProfile::kDefault);
  EXPECT_EQ(group.group_entropy, Entropy::kContexts);
  EXPECT_EQ(OptionsOf({.profile = "group", .entropy = "packed"}).group_entropy, Entropy::kPacked);
  EXPECT_EQ(OptionsOf({}).codec.entropy, Entropy::kPacked);
  EXPECT_EQ(OptionsOf({.entropy = "contexts"}).codec.entropy, Entropy::kContexts);
  const CompressOptions lossless = OptionsOf({.profile = "group-lossless"});
  EXPECT_EQ(lossless.prediction, Prediction::kGroups);
  EXPECT_EQ(lossless.codec.profile, CodecProfile::kLossless);
  const CompressOptions chosen = OptionsOf({.profile = "auto"});
  EXPECT_EQ(chosen.prediction, Prediction::kChosen);
  EXPECT_EQ(chosen.files, KeepFiles::kSmaller);
}

TEST(CodecWords, DemosaickedImagesKeepNoFiles) {
  EXPECT_EQ(OptionsOf({.demosaic = "joint"}).files, KeepFiles::kNone);
  EXPECT_EQ(OptionsOf({.profile = "lossless", .demosaic = "joint"}).files, KeepFiles::kNone);
}

TEST(CodecWords, AQualityIsSearchedForOnlyIfItIsGiven) {
  EXPECT_FALSE(OptionsOf({}).target_psnr_db);
  EXPECT_EQ(OptionsOf({.target_psnr = 42}).target_psnr_db, 42);
}

TEST(CodecWords, WordsThatDoNotExistOrContradictAreRefused) {
  for (const CodecWords& wrong :
       {CodecWords{.profile = "best"}, CodecWords{.profile = "lossless", .threshold = 3},
        CodecWords{.profile = "lossless", .target_psnr = 40}, CodecWords{.quantizer = "16"},
        CodecWords{.profile = "thesis", .quantizer = "many"}, CodecWords{.entropy = "best"},
        CodecWords{.profile = "thesis", .entropy = "contexts"},
        CodecWords{.profile = "group-lossless", .threshold = 3},
        CodecWords{.profile = "auto", .quality_by_use = true},
        CodecWords{.profile = "auto", .demosaic = "joint"},
        CodecWords{.profile = "recorded", .demosaic = "joint"}, CodecWords{.demosaic = "best"},
        CodecWords{.profile = "auto", .reencode = true}}) {
    CompressOptions options;
    const Result<void> set = SetCodec(wrong, &options);
    ASSERT_FALSE(set) << wrong.profile << " " << wrong.quantizer;
    EXPECT_EQ(set.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace lf
