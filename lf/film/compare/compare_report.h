// SPDX-License-Identifier: Apache-2.0
// The reports of lfcompare: a table for people, JSON, and limits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/film/compare/compare_pictures.h"
#include "lf/film/compare/picture_pairs.h"

namespace lf {

struct ComparedPair {
  PicturePair pair;
  int width = 0;
  int height = 0;
  PictureDifference difference;
  std::filesystem::path picture = {};  // of the differences; empty: none was written
};

struct CompareLimits {
  std::optional<double> min_psnr_db;
  std::optional<double> min_ssim;
  std::optional<double> max_flip;
};

// Returns a table with a line for each pair, and a line for all pairs if there are several.
std::string CompareTable(const std::vector<ComparedPair>& compared);

// Returns {"pictures": [{"name", "reference", "test", "resolution", "pixels", "undefined",
// "psnr_db", "linear_psnr_db", "ssim", "flip", "picture"}], "all": {...}, "worst": {"psnr", "ssim",
// "flip"}}, where "worst" has names, "picture" only stands where one was written, and a PSNR of
// equal pictures is null.
std::string CompareJson(const std::vector<ComparedPair>& compared);

// kBelowRequired, with the number of pairs and the worst of them: a pair is outside of the limits.
Result<void> CheckLimits(const std::vector<ComparedPair>& compared, const CompareLimits& limits);

}  // namespace lf
