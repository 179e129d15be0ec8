// SPDX-License-Identifier: Apache-2.0
#include "tools/common/allow_missing.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "tools/common/help.h"

#include "lf/core/log.h"
#include "lf/core/parse_number.h"

namespace lf {
namespace {

constexpr uint64_t kMillion = 1'000'000;
constexpr size_t kMostDecimals = 6;

// Reads a number that consists of digits. Returns false for other characters, an empty text, or too
// many digits.
bool ReadDigits(std::string_view text, uint64_t* value) {
  const std::optional<uint64_t> number = ParseWhole<uint64_t>(text);
  if (number) *value = *number;
  return number.has_value();
}

// Reads a percentage from 0 to 100, such as "2.5", as a number of millionths of a percent.
bool ReadPercentage(std::string_view text, uint64_t* millionths) {
  const size_t point = text.find('.');
  uint64_t whole = 0, decimals = 0;
  if (!ReadDigits(text.substr(0, point), &whole) || whole > 100) return false;
  if (point != std::string_view::npos) {
    const std::string_view after = text.substr(point + 1);
    if (after.size() > kMostDecimals || !ReadDigits(after, &decimals)) return false;
    for (size_t i = after.size(); i < kMostDecimals; ++i) decimals *= 10;
  }
  *millionths = whole * kMillion + decimals;
  return *millionths <= 100 * kMillion;
}

}  // namespace

Result<MissingLimit> MissingLimit::Parse(const std::string& text) {
  MissingLimit limit;
  limit.text_ = text;
  limit.is_share_ = text.ends_with('%');
  const std::string_view number = std::string_view(text).substr(0, text.size() - limit.is_share_);
  if (limit.is_share_ ? ReadPercentage(number, &limit.value_) : ReadDigits(number, &limit.value_))
    return limit;
  return UsageError(
      fmt::format("--allow-missing {}: expected a number of LF images, such as 3, or a percentage "
                  "from 0% to 100% with at most {} decimals, such as 2%",
                  text.empty() ? "(nothing)" : text, kMostDecimals));
}

bool MissingLimit::Allows(uint64_t missing, uint64_t asked) const {
  if (!is_share_) return missing <= value_;
  // No light field has more LF images than this, and the products below fit into 64 bits.
  const uint64_t most = UINT32_MAX;
  return std::min(missing, most) * 100 * kMillion <= std::min(asked, most) * value_;
}

CLI::Option* AllowMissing::AddTo(CLI::App& app, const std::string& asked) {
  app_ = &app;
  OptionGroup input(app, kInputGroup);
  return input.Add(
      "--allow-missing N|PERCENT", text,
      fmt::format("Accept this many missing or broken LF images (none)\n"
                  "Such LF images are left out. Up to N of them are accepted, or up to PERCENT of "
                  "{}, such as 2%. If there are more, the program ends with exit code 6.",
                  asked));
}

Result<MissingLimit> AllowMissing::Limit() const {
  LF_ASSIGN_OR_RETURN(MissingLimit limit, MissingLimit::Parse(text));
  const auto is_given = [&](const char* name) {
    const CLI::Option* const option = app_->get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
  };
  if (app_ != nullptr && app_->get_option_no_throw("--overwrite") != nullptr &&
      !is_given("--overwrite") && !is_given("--resume"))
    limit.SetAgain(" --overwrite");
  return limit;
}

Result<void> EndWithMissing(const MissingImages& missing, const MissingLimit& limit) {
  return EndWithMissing(missing, limit, limit.Allows(missing.count, missing.asked));
}

Result<void> EndWithMissing(const MissingImages& missing, const MissingLimit& limit,
                            bool is_accepted) {
  if (missing.count == 0) return {};
  if (is_accepted) {
    LogWarning("{}; --allow-missing {} accepts this", missing.what, limit.text());
    return {};
  }
  return Error{
      ErrorKind::kBelowRequired,
      fmt::format("{}; --allow-missing {}{} would accept this{}{}", missing.what, missing.count,
                  limit.again(), missing.advice.empty() ? "" : "; ", missing.advice)};
}

}  // namespace lf
