// SPDX-License-Identifier: Apache-2.0
// The option --allow-missing N|PERCENT: the number of LF images that a program may leave out
// because they are missing or broken, and still end with exit code 0.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <utility>

#include "lf/core/result.h"

namespace lf {

// The largest number of LF images that may be missing, or their largest share of the requested
// ones.
class MissingLimit {
 public:
  // Allows no missing LF image.
  MissingLimit() = default;

  // Reads "3" (LF images) or "2%"; a blank, as in "2 %", is refused. Percentages go up to 100 and
  // have at most six decimals. kUsage: the message names --allow-missing, the value and what was
  // expected.
  static Result<MissingLimit> Parse(const std::string& text);

  // Returns true if `missing` of `asked` LF images may be left out. Exact: 2% of 150 allows 3, and
  // 2% of 149 allows 2.
  bool Allows(uint64_t missing, uint64_t asked) const;
  bool is_share() const { return is_share_; }
  // Returns the value as it was given, such as "2%".
  const std::string& text() const { return text_; }
  // Options that the same call needs beside --allow-missing, because its output exists now, such as
  // " --overwrite"; empty: none.
  const std::string& again() const { return again_; }
  void SetAgain(std::string options) { again_ = std::move(options); }

 private:
  std::string text_ = "0", again_;
  uint64_t value_ = 0;  // number of LF images or, if is_share_, millionths of a percent
  bool is_share_ = false;
};

// The option of a program that can leave LF images out.
struct AllowMissing {
  std::string text = "0";

  //   asked  the LF images of which a percentage is taken, in words for the help, such as "the LF
  //          images to be encoded"
  CLI::Option* AddTo(CLI::App& app, const std::string& asked);
  Result<MissingLimit> Limit() const;

 private:
  const CLI::App* app_ = nullptr;
};

// LF images that a program was to use and has left out.
struct MissingImages {
  uint64_t count = 0;  // number of LF images that were left out
  uint64_t asked = 0;  // number of LF images that the program was to use, including these
  std::string what;    // such as "3 of 25 LF images were left out: ..."
  std::string advice;  // a remedy, other than accepting the loss
};

// Returns the outcome of a program that has written all of its results: success if nothing is
// missing, or, with a warning, if the limit accepts what is missing. Otherwise kBelowRequired.
Result<void> EndWithMissing(const MissingImages& missing, const MissingLimit& limit);
// Returns the same outcome for a caller that has itself compared the numbers with the limit, for
// example separately for each package.
//   is_accepted  result of this comparison
Result<void> EndWithMissing(const MissingImages& missing, const MissingLimit& limit,
                            bool is_accepted);

}  // namespace lf
