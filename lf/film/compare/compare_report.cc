// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

namespace lf {
namespace {

PictureDifference SumOf(const std::vector<ComparedPair>& compared) {
  PictureDifference sum;
  for (const ComparedPair& one : compared) sum += one.difference;
  return sum;
}

std::string LineOf(const std::string& name, size_t name_width, const PictureDifference& d) {
  return fmt::format("{:<{}}  {:>8.2f}  {:>8.2f}  {:>7.4f}  {:>7.4f}\n", name, name_width,
                     d.PsnrDb(), d.LinearPsnrDb(), d.Ssim(), d.Flip());
}

nlohmann::ordered_json JsonOf(const PictureDifference& d) {
  nlohmann::ordered_json json = {{"pixels", d.pixel_count}, {"undefined", d.undefined_count},
                                 {"psnr_db", nullptr},      {"linear_psnr_db", nullptr},
                                 {"ssim", d.Ssim()},        {"flip", d.Flip()}};
  if (std::isfinite(d.PsnrDb())) json["psnr_db"] = d.PsnrDb();
  if (std::isfinite(d.LinearPsnrDb())) json["linear_psnr_db"] = d.LinearPsnrDb();
  return json;
}

double Badness(const PictureDifference& d) { return d.display_squares / d.pixel_count; }

// Returns the pair with the largest value.
const ComparedPair& WorstBy(const std::vector<ComparedPair>& compared,
                            const std::function<double(const PictureDifference&)>& value) {
  return *std::max_element(compared.begin(), compared.end(),
                           [&](const ComparedPair& a, const ComparedPair& b) {
                             return value(a.difference) < value(b.difference);
                           });
}
const ComparedPair& WorstBySsim(const std::vector<ComparedPair>& compared) {
  return WorstBy(compared, [](const PictureDifference& d) { return -d.Ssim(); });
}
const ComparedPair& WorstByFlip(const std::vector<ComparedPair>& compared) {
  return WorstBy(compared, [](const PictureDifference& d) { return d.Flip(); });
}

// Returns "N of M pictures have ..."; empty if none is outside of the limit.
std::string Broken(const std::vector<ComparedPair>& compared, const char* what,
                   const std::function<bool(const PictureDifference&)>& is_outside,
                   const ComparedPair& worst, double value) {
  const auto count = std::count_if(compared.begin(), compared.end(), [&](const ComparedPair& one) {
    return is_outside(one.difference);
  });
  if (count == 0) return "";
  return fmt::format("{} of {} pictures {}; the worst, {}, has {:.4g}", count, compared.size(),
                     what, worst.pair.test.string(), value);
}

}  // namespace

std::string CompareTable(const std::vector<ComparedPair>& compared) {
  size_t width = std::string("picture").size();
  for (const ComparedPair& one : compared) width = std::max(width, one.pair.name.size());
  std::string text = fmt::format("{:<{}}  {:>8}  {:>8}  {:>7}  {:>7}\n", "picture", width,
                                 "PSNR dB", "linear dB", "SSIM", "FLIP");
  for (const ComparedPair& one : compared) text += LineOf(one.pair.name, width, one.difference);
  const PictureDifference sum = SumOf(compared);
  if (compared.size() > 1) text += LineOf("all", width, sum);
  if (sum.undefined_count > 0)
    text += fmt::format("{} pixels are left out, because a value is not a number or infinite\n",
                        sum.undefined_count);
  return text;
}

std::string CompareJson(const std::vector<ComparedPair>& compared) {
  nlohmann::ordered_json json = {{"pictures", nlohmann::ordered_json::array()}};
  for (const ComparedPair& one : compared) {
    nlohmann::ordered_json picture = {{"name", one.pair.name},
                                      {"reference", one.pair.reference.string()},
                                      {"test", one.pair.test.string()},
                                      {"resolution", {one.width, one.height}}};
    picture.update(JsonOf(one.difference));
    if (!one.picture.empty()) picture["picture"] = one.picture.string();
    json["pictures"].push_back(std::move(picture));
  }
  json["all"] = JsonOf(SumOf(compared));
  json["worst"] = {{"psnr", WorstBy(compared, Badness).pair.name},
                   {"ssim", WorstBySsim(compared).pair.name},
                   {"flip", WorstByFlip(compared).pair.name}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Result<void> CheckLimits(const std::vector<ComparedPair>& compared, const CompareLimits& limits) {
  std::vector<std::string> broken;
  const auto add = [&](std::string text) {
    if (!text.empty()) broken.push_back(std::move(text));
  };
  if (limits.min_psnr_db) {
    const ComparedPair& worst = WorstBy(compared, Badness);
    add(Broken(
        compared, fmt::format("have a PSNR below {{min_psnr {}}}", *limits.min_psnr_db).c_str(),
        [&](const PictureDifference& d) { return d.PsnrDb() < *limits.min_psnr_db; }, worst,
        worst.difference.PsnrDb()));
  }
  if (limits.min_ssim) {
    const ComparedPair& worst = WorstBySsim(compared);
    add(Broken(
        compared, fmt::format("have an SSIM below {{min_ssim {}}}", *limits.min_ssim).c_str(),
        [&](const PictureDifference& d) { return d.Ssim() < *limits.min_ssim; }, worst,
        worst.difference.Ssim()));
  }
  if (limits.max_flip) {
    const ComparedPair& worst = WorstByFlip(compared);
    add(Broken(
        compared, fmt::format("have a FLIP above {{max_flip {}}}", *limits.max_flip).c_str(),
        [&](const PictureDifference& d) { return d.Flip() > *limits.max_flip; }, worst,
        worst.difference.Flip()));
  }
  if (broken.empty()) return {};
  return Error{ErrorKind::kBelowRequired, fmt::format("{}", fmt::join(broken, "; "))};
}

}  // namespace lf
