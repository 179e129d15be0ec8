// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/kept_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "lf/densify/depth_search.h"

namespace lf {
namespace {

std::string InWords(std::span<const std::vector<uint32_t>> compare_with) {
  std::string text;
  for (const std::vector<uint32_t>& others : compare_with)
    text += fmt::format("; {}", fmt::join(others, " "));
  return text;
}

// Returns everything in a plan that pairs and tests depend on.
std::string InWords(const DensifyPlan& plan) {
  std::string text = fmt::format("{} {} {} {} {}", plan.range.least, plan.range.greatest,
                                 plan.planes, plan.divisor, plan.shift_per_depth_px);
  text +=
      fmt::format("; {} {}; {}; {}; {}", plan.is_film, IsWidened(plan), fmt::join(plan.used, " "),
                  fmt::join(plan.serving, " "), fmt::join(plan.sources, " "));
  return text + InWords(plan.compare_with);
}

// Numbers as which a pair and a test are kept.
constexpr size_t kOfPair = 4, kOfTest = 5;

}  // namespace

Result<InverseDepths> KeptFindings::Range(std::span<const std::vector<uint32_t>> compare_with,
                                          const Watch& watch) {
  const std::optional<DepthRange>& stated = light_field_.depth_range;
  const std::string settings = stated ? fmt::format("{} {}", stated->near_w, stated->far_w) : "";
  const DepthCache::Entry entry = keys_.OfAll("range", settings + InWords(compare_with));
  if (const auto kept = cache_.FindNumbers(entry); kept && kept->size() == 2)
    return InverseDepths{(*kept)[0], (*kept)[1]};
  LF_ASSIGN_OR_RETURN(const InverseDepths range,
                      FindInverseDepths(light_field_, store_, compare_with, pool_, watch));
  cache_.KeepNumbers(entry, std::array{range.least, range.greatest});
  return range;
}

Result<std::vector<ComparedPair>> KeptFindings::Pairs(const DensifyPlan& plan,
                                                      std::span<const uint32_t> ids,
                                                      const Watch& watch) {
  const DepthCache::Entry entry =
      keys_.OfAll("pairs", fmt::format("{}; {}", InWords(plan), fmt::join(ids, " ")));
  std::vector<ComparedPair> pairs;
  if (const auto kept = cache_.FindNumbers(entry)) {
    for (size_t i = 0; i + kOfPair <= kept->size(); i += kOfPair) {
      const double* n = kept->data() + i;
      pairs.push_back({static_cast<uint32_t>(n[0]), static_cast<uint32_t>(n[1]), n[2], n[3]});
    }
    return pairs;
  }
  LF_ASSIGN_OR_RETURN(pairs, ComparePairs(light_field_, store_, ids, plan.range, pool_, watch));
  std::vector<double> numbers;
  for (const ComparedPair& pair : pairs)
    numbers.insert(numbers.end(),
                   {1.0 * pair.first, 1.0 * pair.second, pair.distance, pair.agreeing_share});
  cache_.KeepNumbers(entry, numbers);
  return pairs;
}

Result<std::vector<LeftOut>> KeptFindings::Tests(const DensifyPlan& plan, const Watch& watch) {
  const DepthCache::Entry entry = keys_.OfAll("tests", InWords(plan));
  const std::vector<std::string>& names = light_field_.image_names;
  std::vector<LeftOut> tests;
  if (const auto kept = cache_.FindNumbers(entry)) {
    for (size_t i = 0; i + kOfTest <= kept->size(); i += kOfTest) {
      const double* n = kept->data() + i;
      tests.push_back({names.at(static_cast<size_t>(n[0])), n[1], n[2], n[3], n[4] != 0});
    }
    return tests;
  }
  LF_ASSIGN_OR_RETURN(tests, TestByLeavingOut(light_field_, store_, plan, pool_, watch));
  std::vector<double> numbers;
  for (const LeftOut& test : tests) {
    const auto id = std::find(names.begin(), names.end(), test.name) - names.begin();
    numbers.insert(numbers.end(), {static_cast<double>(id), test.virtual_psnr_db,
                                   test.blend_psnr_db, test.angle_deg, test.is_beyond ? 1.0 : 0.0});
  }
  cache_.KeepNumbers(entry, numbers);
  return tests;
}

}  // namespace lf
