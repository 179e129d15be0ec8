// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/codec_words.h"

#include <fmt/format.h>

#include "lf/core/parse_number.h"

namespace lf {
namespace {

Result<CodecProfile> ProfileOf(const std::string& word) {
  if (word == "default" || word == "group" || word == "auto") return CodecProfile::kDefault;
  if (word == "thesis") return CodecProfile::kThesis;
  if (word == "lossless" || word == "group-lossless" || word == "recorded")
    return CodecProfile::kLossless;
  return UsageError(fmt::format(
      "{{profile {}}}: expected one of default, thesis, lossless, recorded, group, group-lossless, "
      "auto",
      word));
}

// Sets the coders of LF images by themselves, and of those in groups.
Result<void> SetEntropy(const std::string& word, CompressOptions* options) {
  if (word != "auto" && word != "packed" && word != "contexts")
    return UsageError(fmt::format("{{entropy {}}}: expected auto, packed or contexts", word));
  options->codec.entropy = word == "contexts" ? Entropy::kContexts : Entropy::kPacked;
  options->group_entropy = word == "packed" ? Entropy::kPacked : Entropy::kContexts;
  return {};
}

}  // namespace

Result<void> SetCodec(const CodecWords& words, CompressOptions* options) {
  LF_ASSIGN_OR_RETURN(options->codec.profile, ProfileOf(words.profile));
  LF_RETURN_IF_ERROR(SetEntropy(words.entropy, options));
  const bool is_thesis = words.profile == "thesis", is_recorded = words.profile == "recorded";
  const bool is_lossless = options->codec.profile == CodecProfile::kLossless;
  options->prediction = words.profile.starts_with("group") ? Prediction::kGroups
                        : words.profile == "auto"          ? Prediction::kChosen
                                                           : Prediction::kNone;
  options->codec.levels = words.levels > 0 ? words.levels : is_thesis ? 1 : 4;
  options->codec.threshold = words.threshold >= 0 ? words.threshold : is_thesis ? 8 : 3;
  if (is_lossless && (words.threshold >= 0 || words.target_psnr > 0))
    return UsageError(fmt::format(
        "{{threshold}} and {{target_psnr}} cannot be used with {{profile {}}}, which drops no "
        "details: leave them out",
        words.profile));
  if (is_thesis && options->codec.entropy != Entropy::kPacked)
    return UsageError(
        "{entropy contexts} cannot be used with {profile thesis}, whose coefficients are packed: "
        "leave one of them out");
  if (words.profile == "auto" && words.reencode)
    return UsageError(
        "{reencode} cannot be used with {profile auto}, which chooses whether image files are "
        "kept: leave one of them out");
  if (words.quality_by_use && words.profile == "auto")
    return UsageError(
        "{quality_by_use} cannot be used with {profile auto}, which may keep image files as they "
        "are: leave it out, or give {profile default} or {profile group}");
  if (words.quality_by_use && words.profile != "default" && words.profile != "group")
    return UsageError(fmt::format(
        "{{quality_by_use}} cannot be used with {{profile {}}}, which has no threshold for each LF "
        "image: leave one of them out",
        words.profile));
  const bool is_demosaicked = words.demosaic == "joint";
  if (!is_demosaicked && words.demosaic != "none")
    return UsageError(fmt::format("{{demosaic {}}}: expected none or joint", words.demosaic));
  if (is_demosaicked && (is_recorded || words.profile == "auto"))
    return UsageError(fmt::format(
        "{{demosaic joint}} cannot be used with {{profile {}}}, which may keep image files as they "
        "are: leave one of them out",
        words.profile));
  if (is_recorded && words.reencode)
    return UsageError(
        "{reencode} cannot be used with {profile recorded}, which keeps image files: leave one of "
        "them out");
  // Files are decoded by libraries, whose results may change: no image is predicted from them.
  const bool is_in_groups = options->prediction == Prediction::kGroups;
  options->files = is_recorded ? KeepFiles::kAll
                   : is_thesis || words.reencode || is_in_groups || is_demosaicked
                       ? KeepFiles::kNone
                       : KeepFiles::kSmaller;
  if (words.quantizer != "8bit") {
    if (!is_thesis)
      return UsageError(
          "{quantizer} can only be used with {profile thesis}: leave it out, or add "
          "{profile thesis}");
    const auto steps = ParseWhole<int>(words.quantizer);
    if (!steps)
      return UsageError(fmt::format(
          "{{quantizer {}}}: expected 8bit, or a whole number from 2 to 65536", words.quantizer));
  }
  if (words.target_psnr > 0) options->target_psnr_db = words.target_psnr;
  return {};
}

}  // namespace lf
