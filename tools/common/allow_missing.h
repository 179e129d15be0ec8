// The option --allow-missing N|PERCENT: the number of LF images that a program may leave out
// because they are missing or broken, and still end with exit code 0.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "lf/core/result.h"

namespace lf {

// A number of LF images, or a share of those that were asked for.
class MissingLimit {
 public:
  // None may be missing.
  MissingLimit() = default;

  // Reads "3" (LF images) or "2%", "0.5 %" is refused. Percentages have up to six decimals and end
  // at 100. kUsage: the message names --allow-missing, the value and what was expected.
  static Result<MissingLimit> Parse(const std::string& text);

  // True if `missing` of `asked` LF images may be left out. Exact: 2% of 150 allows 3, and 2% of
  // 149 allows 2.
  bool Allows(uint64_t missing, uint64_t asked) const;
  bool is_share() const { return is_share_; }
  // The value as it was given.
  const std::string& text() const { return text_; }

 private:
  std::string text_ = "0";
  uint64_t value_ = 0;  // LF images, or millionths of a percent
  bool is_share_ = false;
};

// The option of a program that may leave LF images out.
struct AllowMissing {
  std::string text = "0";

  //   asked  names the LF images that a percentage counts, such as "those to be coded"
  CLI::Option* AddTo(CLI::App& app, const std::string& asked);
  Result<MissingLimit> Limit() const { return MissingLimit::Parse(text); }
};

// LF images that a program was asked for and left out.
struct MissingImages {
  uint64_t count = 0;
  uint64_t asked = 0;
  std::string what;    // such as "3 of 25 LF images were left out: ..."
  std::string advice;  // what to do about it, beside accepting it
};

// The end of a program, to be called when all of its results are written. Succeeds where nothing is
// missing. Warns of what is missing if the limit accepts it. kBelowRequired if not.
Result<void> EndWithMissing(const MissingImages& missing, const MissingLimit& limit);
// For a caller that compared the numbers with the limit itself, such as package by package.
Result<void> EndWithMissing(const MissingImages& missing, const MissingLimit& limit,
                            bool is_accepted);

}  // namespace lf
