// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lf/core/quantities.h"
#include "lf/core/spelling.h"

namespace lf {
namespace {

// Returns a depth in world units; "infinity" for inverse depths of 0 and less.
std::string DepthText(double inverse_depth) {
  return inverse_depth > 0 ? fmt::format("{:.4g}", 1 / inverse_depth) : std::string("infinity");
}

double NanosecondsPer(double cpu_s, double pixels) { return pixels > 0 ? cpu_s * 1e9 / pixels : 0; }

}  // namespace

std::string DensifyText(const DensifyReport& report, const DensifyOptions& options, double total_s,
                        const std::string& next) {
  std::string text = fmt::format(
      "{}: {} recorded and {} virtual LF images\n"
      "depths    {} to {}; {} were compared; near points shift by {:.1f} px against far ones\n"
      "cameras   virtual ones are {:.4g} apart: copies at most {:.2g} px apart\n",
      options.store.string(), report.recorded_count, report.virtual_count,
      DepthText(report.range.greatest), DepthText(report.range.least), report.planes,
      report.shift_px, report.distance_w, report.spacing_px);
  if (report.filled_diameter_w)
    text += fmt::format(
        "lens      not all lenses are filled: LF cameras are near enough to fill one of a diameter "
        "of "
        "{:.4g}\n",
        *report.filled_diameter_w);
  for (const DensifyReport::Skipped& skipped : report.skipped)
    text += fmt::format("skipped   {}: {}\n", skipped.name, Spelled(skipped.reason));
  if (!report.left_out.empty())
    text += fmt::format(
        "left out  {} LF images, whose poses are wrong; those that are used have {:.0f} % of the\n"
        "          nearness to the lenses: {}\n",
        report.left_out.size(), 100 * report.kept_share, fmt::join(report.left_out, ", "));
  if (report.was_there) return text + "existed already: nothing was written\n" + next;
  if (report.spacing_px > options.choices.spacing_px * 1.001)
    text +=
        Spelled(fmt::format("note: {:.2g} px need more virtual LF images than {{most}} allows\n",
                            options.choices.spacing_px));
  text += fmt::format(
      "agreement {:.1f} % of the pixels have depths on which two neighbours agree; {:.1f} % of "
      "the\n"
      "          virtual pixels rest on few\n",
      100 * report.agreeing_share, 100 * report.weak_share);
  for (const bool is_beyond : {false, true}) {
    const std::vector<LeftOut> tests = TestsOf(report.tests, is_beyond);
    if (tests.empty()) continue;
    text += fmt::format(
        "test      LF images left out and made from {}: {:.1f} dB better than a mean\n"
        "          of these\n",
        is_beyond ? "those on one side" : "their neighbours", MedianGainDb(tests));
    for (const LeftOut& test : tests)
      text += fmt::format("          {:.1f} dB (mean: {:.1f} dB) at {:.1f} degrees  {}\n",
                          test.virtual_psnr_db, test.blend_psnr_db, test.angle_deg, test.name);
  }
  if (!options.cache.empty())
    text += fmt::format("cache     {}: had {} depth planes of an earlier call\n",
                        options.cache.string(), report.cached_planes);
  text += fmt::format(
      "speed     {:.0f} ns per swept pixel, {:.0f} ns per virtual pixel (CPU); {}\n",
      NanosecondsPer(report.sweep_cpu_s, report.swept_pixels),
      NanosecondsPer(report.synthesis_cpu_s, report.made_pixels), ShortDuration(total_s));
  return text + next;
}

std::string DensifyJson(const DensifyReport& report, const DensifyOptions& options,
                        double total_s) {
  nlohmann::ordered_json tests = nlohmann::ordered_json::array();
  for (const LeftOut& test : report.tests)
    tests.push_back({{"lf_image", test.name},
                     {"virtual_psnr_db", test.virtual_psnr_db},
                     {"mean_psnr_db", test.blend_psnr_db},
                     {"angle_deg", test.angle_deg},
                     {"beyond", test.is_beyond}});
  nlohmann::ordered_json skipped = nlohmann::ordered_json::array();
  for (const DensifyReport::Skipped& image : report.skipped)
    skipped.push_back({{"lf_image", image.name}, {"reason", Spelled(image.reason)}});
  const nlohmann::ordered_json json = {
      {"store", options.store.string()},
      {"existed", report.was_there},
      {"recorded", report.recorded_count},
      {"virtual", report.virtual_count},
      {"inverse_depths", {report.range.least, report.range.greatest}},
      {"compared_depths", report.planes},
      {"shift_px", report.shift_px},
      {"camera_distance_w", report.distance_w},
      {"spacing_px", report.spacing_px},
      {"filled_diameter_w", report.filled_diameter_w
                                ? nlohmann::ordered_json(*report.filled_diameter_w)
                                : nlohmann::ordered_json(nullptr)},
      {"agreeing_share", report.agreeing_share},
      {"weak_share", report.weak_share},
      {"skipped", skipped},
      {"left_out", report.left_out},
      {"kept_share", report.kept_share},
      {"tests", tests},
      {"cache", options.cache.empty() ? nlohmann::ordered_json()
                                      : nlohmann::ordered_json(options.cache.string())},
      {"cached_planes", report.cached_planes},
      {"swept_pixels", report.swept_pixels},
      {"sweep_cpu_s", report.sweep_cpu_s},
      {"virtual_pixels", report.made_pixels},
      {"synthesis_cpu_s", report.synthesis_cpu_s},
      {"total_s", total_s}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string MissingText(const DensifyReport& report, const DensifyOptions& options) {
  if (report.skipped.empty()) return "";
  return fmt::format(
      "{}: {} of {} LF images were not used, because they are missing or broken; the first: {}: {}",
      options.store.string(), report.skipped.size(), report.asked_count(),
      report.skipped.front().name, report.skipped.front().reason);
}

}  // namespace lf
