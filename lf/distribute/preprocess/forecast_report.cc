// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/forecast_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lf/core/check.h"
#include "lf/core/quantities.h"
#include "lf/core/spelling.h"
#include "lf/distribute/preprocess/forecast_advice.h"

namespace lf {
namespace {

using Json = nlohmann::ordered_json;

std::string Bytes(uint64_t bytes) {
  return bytes < uint64_t{10} << 30 ? fmt::format("{} MiB", bytes >> 20)
                                    : fmt::format("{:.1f} GiB", std::ldexp(bytes, -30));
}

void AddLine(const char* name, const std::string& text, std::string* lines) {
  *lines += fmt::format("{:<14} {}\n", name, text);
}

double LargestOverMean(const std::vector<PackageForecast>& packages) {
  double largest = 0, sum = 0;
  for (const PackageForecast& package : packages) {
    largest = std::max(largest, static_cast<double>(package.ray_count));
    sum += static_cast<double>(package.ray_count);
  }
  return sum > 0 ? largest * static_cast<double>(packages.size()) / sum : 1;
}

template <class Badness>
const FrameForecast& Worst(const PreprocessReport& report, const Badness& badness) {
  return *std::max_element(
      report.frames.begin(), report.frames.end(),
      [&](const FrameForecast& a, const FrameForecast& b) { return badness(a) < badness(b); });
}

// Returns the indices of at most 12 frames, spread over the film.
std::vector<size_t> ShownFrames(size_t frame_count) {
  constexpr size_t kMost = 12;
  std::vector<size_t> shown;
  const size_t count = std::min(kMost, frame_count);
  for (size_t i = 0; i < count; ++i)
    shown.push_back(count == 1 ? 0 : i * (frame_count - 1) / (count - 1));
  return shown;
}

void AddPackages(const PreprocessReport& report, const ForecastFacts& facts, std::string* lines) {
  *lines +=
      fmt::format("\n{:<14} {:<13} {:>9} {:>11} {:>9} {:>9} {:>9} {:>6}  {}\n", "package", "frames",
                  "LF images", "neighbours", "rays", "to read", "memory", "passes", "about");
  for (const PackageForecast& package : report.packages) {
    const uint32_t first = package.frames.front().value, last = package.frames.back().value;
    std::string frames = fmt::format("{}-{}", first, last);
    if (package.frames.size() < last - first + 1)
      frames += fmt::format(" ({})", package.frames.size());
    *lines +=
        fmt::format("{:<14} {:<13} {:>9} {:>11} {:>9} {:>9} {:>9} {:>6}  {}\n", package.name,
                    frames, package.image_count, package.neighbour_count,
                    ShortNumber(static_cast<double>(package.ray_count)), Bytes(package.read_bytes),
                    Bytes(package.memory_bytes), package.pass_count,
                    report.rate ? ShortDuration(package.cpu.Sum() / facts.thread_count) : "-");
  }
  if (report.packages.size() > 1)
    *lines +=
        fmt::format("rays, largest package / mean: {:.3f}\n", LargestOverMean(report.packages));
}

void AddDensity(const PreprocessReport& report, const CameraPath& path, std::string* lines) {
  *lines += fmt::format("\n{:>7} {:>10} {:>10} {:>12} {:>10} {:>13} {:>13} {:>12} {:>14}\n",
                        "frame", "LF images", "rays", "LF cameras", "spacing", "displacement",
                        "displacement", "of the lens", "least aperture");
  *lines += fmt::format("{:>7} {:>10} {:>10} {:>12} {:>10} {:>13} {:>13} {:>12} {:>14}\n", "", "",
                        "", "in the lens", "there", "near", "far", "uncovered", "that collects");
  for (const size_t f : ShownFrames(report.frames.size())) {
    const FrameForecast& frame = report.frames[f];
    const FrameDensity& density = frame.density;
    *lines += fmt::format(
        "{:>7} {:>10} {:>10} {:>12} {:>10} {:>10.1f} px {:>10.1f} px {:>10.0f} % {:>14}\n",
        frame.frame.value, frame.image_count, ShortNumber(static_cast<double>(frame.ray_count)),
        density.cameras_in_lens, LengthText(density.camera_distance_w, path.unit_m),
        density.near_displacement_px, density.far_displacement_px,
        100 * density.coverage.uncovered_share, LengthText(density.least_aperture_w, path.unit_m));
  }
}

// Returns " and N virtual ones", to follow a number of recorded LF images; "" if N is 0.
std::string AndVirtual(size_t count) {
  return count > 0 ? fmt::format(" and {} virtual ones", count) : "";
}

bool AreKnown(const ForecastFacts& facts) { return facts.depths_from != DepthSource::kUnknown; }

// Returns the source of the depths in JSON.
Json SourceJson(const ForecastFacts& facts) {
  switch (facts.depths_from) {
    case DepthSource::kUnknown:
      return nullptr;
    case DepthSource::kStated:
      return facts.depths_argument;
    case DepthSource::kCalibration:
      return "the calibration";
    case DepthSource::kLfImages:
      return "LF images";
  }
  LF_CHECK(false);
}

// Returns text that says that the depths of the scene were estimated, or how to state unknown
// depths; "" if the user or the calibration stated them.
std::string DepthsText(const ForecastFacts& facts) {
  if (facts.depths_from == DepthSource::kLfImages) return " (depths estimated from LF images)";
  if (AreKnown(facts)) return "";
  return fmt::format(
      " (assumed to be 25 % off the focus distance; no focus distance is advised, because neither "
      "the calibration nor the LF images tell the depths of the scene: give {} NEAR FAR, "
      "lf_depth_range in transforms.json, or the points3D of a COLMAP model)",
      facts.depths_argument);
}

}  // namespace

std::string MissingText(const PreprocessReport& report) {
  if (report.missing_count == 0) return "";
  return fmt::format(
      "{} of {} LF images that packages need do not exist, or are empty; the first: {}",
      report.missing_count, report.needed_count, report.first_missing);
}

std::vector<std::string> DensityWarnings(const PreprocessReport& report, const CameraPath& path,
                                         const ForecastFacts& facts) {
  std::vector<std::string> warnings;
  if (report.missing_count > 0) warnings.push_back(MissingText(report));
  const ForecastAdvice advice = AdviceOf(report, path, AreKnown(facts));
  const FrameForecast& sparse =
      Worst(report, [](const FrameForecast& frame) { return frame.density.MostDisplacement_px(); });
  const double most_px = sparse.density.MostDisplacement_px();
  if (most_px > kDoubleEdge_px) {
    const RenderCamera& camera = path.Camera(sparse.frame);
    const FrameDensity& density = sparse.density;
    const Intrinsics& plate = camera.pinhole.intrinsics;
    warnings.push_back(
        fmt::format("frame {}: expect double edges, {:.0f} px apart, at {}{}, because LF cameras "
                    "are {} apart in the lens; {} or less would be needed. What would help: {}a "
                    "scene that lies {}; frames of {} x {} elements instead of {} x {}; or a "
                    "capture {:.0f} times as dense along each axis{}",
                    sparse.frame.value, most_px, LengthText(density.DepthOfMost_w(), path.unit_m),
                    DepthsText(facts), LengthText(density.camera_distance_w, path.unit_m),
                    LengthText(density.camera_distance_w / most_px, path.unit_m),
                    advice.focus ? fmt::format("a focus distance {} in every frame; ",
                                               RangeText(*advice.focus, path.unit_m))
                                 : "",
                    RangeText(advice.depths, path.unit_m), advice.width_px, advice.height_px,
                    plate.width_px, plate.height_px, std::ceil(most_px / kDoubleEdge_px),
                    WantsVirtual(density, report.light_field_virtual_count > 0)
                        ? ", or virtual LF images between the recorded ones (lfdensify)"
                        : ""));
  }
  size_t black_count = 0;
  const FrameForecast* black = nullptr;
  for (const FrameForecast& frame : report.frames) {
    if (!frame.ReadsNone()) continue;
    ++black_count;
    if (black == nullptr) black = &frame;
  }
  if (black != nullptr)
    warnings.push_back(fmt::format(
        "{} of {} frames will be black, because no LF image has a ray for them; the first is frame "
        "{}: its lens needs an aperture of at least {} to collect rays, but has {}",
        black_count, report.frames.size(), black->frame.value,
        LengthText(black->density.least_aperture_w, path.unit_m),
        LengthText(2 * path.Camera(black->frame).aperture.radius_w, path.unit_m)));
  const FrameForecast& uncovered = Worst(
      report, [](const FrameForecast& frame) { return frame.density.coverage.uncovered_share; });
  if (uncovered.density.coverage.uncovered_share > kMuchUncovered)
    warnings.push_back(fmt::format(
        "frame {}: {:.0f} % of its lens are beyond the LF cameras: {}. What would "
        "help: {}a path nearer to the middle of the capture",
        uncovered.frame.value, 100 * uncovered.density.coverage.uncovered_share,
        facts.completes ? "light of the nearest LF cameras is shown for this part, and blur disks "
                          "keep the shape of the capture"
                        : "this part gets no rays, and the bokeh (blur disks) are cut off there",
        advice.largest_aperture_w > 0
            ? fmt::format("an aperture of at most {}, or ",
                          AtMostText(advice.largest_aperture_w, path.unit_m))
            : ""));
  return warnings;
}

std::string ForecastText(const PreprocessReport& report, const CameraPath& path,
                         const ForecastFacts& facts) {
  std::string lines;
  const Intrinsics& plate = path.Camera(report.frames.front().frame).pinhole.intrinsics;
  size_t image_count = 0, virtual_count = 0;
  uint64_t rays = 0, bytes = 0;
  double cpu_s = 0, rebinned_s = 0;
  for (const PackageForecast& package : report.packages) {
    image_count += package.image_count;
    virtual_count += package.virtual_count;
    rays += package.ray_count;
    bytes += package.read_bytes;
    cpu_s += package.cpu.Sum();
    rebinned_s += package.cpu.rebin_s + package.cpu.complete_s;
  }
  AddLine("light field",
          fmt::format("{}, {} LF images{}", facts.light_field, report.light_field_image_count,
                      AndVirtual(report.light_field_virtual_count)),
          &lines);
  AddLine(
      "film",
      fmt::format("{} frames of {} x {}{}", report.frames.size(), plate.width_px, plate.height_px,
                  path.shutter.exists()
                      ? fmt::format(", each exposed at {} instants", path.shutter.samples)
                      : ""),
      &lines);
  AddLine("to be read",
          fmt::format("{} LF images{} in files of {} together{}", image_count,
                      AndVirtual(virtual_count), Bytes(bytes),
                      report.packages.size() > 1
                          ? "; those that several packages need are counted for each"
                          : ""),
          &lines);
  AddLine("rays", fmt::format("{} pixels to be tried", ShortNumber(static_cast<double>(rays))),
          &lines);
  AddLine("order",
          facts.order == ImageOrder::kArea
              ? std::string("area")
              : fmt::format("{}, seed {}", NameOf(facts.order), facts.seed),
          &lines);
  AddLine(
      "time",
      report.rate
          ? fmt::format("about {} by {} threads of this machine ({:.3g} ms per LF image, {:.3g} "
                        "ns per ray, {:.3g} ms per frame, measured on a few)",
                        ShortDuration(cpu_s / facts.thread_count), facts.thread_count,
                        1e3 * report.rate->load_s, 1e9 * report.rate->collect_s,
                        1e3 * report.rate->finish_s) +
                (facts.rebins ? fmt::format("; rebinned rays take {:.0f} % of it",
                                            100 * rebinned_s / std::max(cpu_s, 1e-9))
                              : "")
          : "not known: " + Spelled(report.rate_error),
      &lines);
  AddLine(
      "spent here",
      fmt::format("{:.2f} s on the calibration, {:.2f} s on the order and the octree, {:.2f} s on "
                  "selection, {:.2f} s on density, {:.2f} s on writing",
                  facts.read_s, report.index_s, report.select_s, report.density_s, report.write_s),
      &lines);
  AddPackages(report, facts, &lines);
  AddDensity(report, path, &lines);
  for (const std::string& warning : DensityWarnings(report, path, facts))
    lines += fmt::format("\nwarning: {}\n", Spelled(warning));
  if (!facts.next.empty()) lines += "\n" + facts.next;
  return lines;
}

std::string ForecastJson(const PreprocessReport& report, const CameraPath& path,
                         const ForecastFacts& facts) {
  const auto finite = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  Json json;
  json["light_field"] = facts.light_field;
  json["output"] = facts.output.empty() ? Json() : Json(facts.output);
  if (path.shutter.exists()) json["shutter_samples"] = path.shutter.samples;
  json["lf_images"] = report.light_field_image_count;
  const auto add_virtual = [](size_t count, Json* to) {
    if (count > 0) (*to)["virtual_lf_images"] = count;
  };
  add_virtual(report.light_field_virtual_count, &json);
  json["lf_images_needed"] = report.needed_count;
  json["lf_images_missing"] = report.missing_count;
  json["order"] = NameOf(facts.order);
  json["seed"] = facts.seed;
  json["unit_m"] = path.unit_m;
  json["depths_from"] = SourceJson(facts);
  json["threads"] = facts.thread_count;
  json["largest_over_mean_rays"] = LargestOverMean(report.packages);
  json["rate"] = report.rate ? Json{{"cpu_s_per_lf_image", report.rate->load_s},
                                    {"cpu_s_per_ray", report.rate->collect_s},
                                    {"cpu_s_per_frame", report.rate->finish_s}}
                             : Json();
  json["spent_s"] = {{"reading", facts.read_s},
                     {"index", report.index_s},
                     {"selection", report.select_s},
                     {"density", report.density_s},
                     {"writing", report.write_s}};
  json["packages"] = Json::array();
  for (const PackageForecast& package : report.packages) {
    Json frames = Json::array();
    for (const FrameId frame : package.frames) frames.push_back(frame.value);
    json["packages"].push_back({{"name", package.name},
                                {"frames", std::move(frames)},
                                {"lf_images", package.image_count},
                                {"lf_images_missing", package.missing_count},
                                {"neighbours", package.neighbour_count},
                                {"rays", package.ray_count},
                                {"bytes_to_read", package.read_bytes},
                                {"memory_bytes", package.memory_bytes},
                                {"passes", package.pass_count},
                                {"cpu_s", report.rate ? Json(package.cpu.Sum()) : Json()}});
    if (report.rate)
      json["packages"].back()["cpu_s_of"] = {
          {"begin", package.cpu.begin_s},       {"load", package.cpu.load_s},
          {"collect", package.cpu.collect_s},   {"rebin", package.cpu.rebin_s},
          {"complete", package.cpu.complete_s}, {"finish", package.cpu.finish_s}};
    add_virtual(package.virtual_count, &json["packages"].back());
  }
  json["frames"] = Json::array();
  for (const FrameForecast& frame : report.frames) {
    const FrameDensity& density = frame.density;
    json["frames"].push_back({{"frame", frame.frame.value},
                              {"lf_images", frame.image_count},
                              {"rays", frame.ray_count},
                              {"cameras_in_lens", density.cameras_in_lens},
                              {"camera_distance", density.camera_distance_w},
                              {"uncovered_share", density.coverage.uncovered_share},
                              {"fitting_aperture_w", density.coverage.fitting_diameter_w},
                              {"least_aperture", finite(density.least_aperture_w)},
                              {"depths", {density.depths.near_w, density.depths.far_w}},
                              {"near_displacement_px", density.near_displacement_px},
                              {"far_displacement_px", density.far_displacement_px}});
    add_virtual(frame.virtual_count, &json["frames"].back());
  }
  json["advice"] = nullptr;
  json["warnings"] = Json::array();
  const auto text = [&] { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; };
  if (report.frames.empty()) return text();
  const ForecastAdvice advice = AdviceOf(report, path, AreKnown(facts));
  json["advice"] = {
      {"focus_distance",
       advice.focus ? Json{advice.focus->near_w, finite(advice.focus->far_w)} : Json()},
      {"depths", {advice.depths.near_w, finite(advice.depths.far_w)}},
      {"resolution", {advice.width_px, advice.height_px}},
      {"largest_aperture",
       advice.largest_aperture_w > 0 ? finite(advice.largest_aperture_w) : Json()}};
  for (const std::string& warning : DensityWarnings(report, path, facts))
    json["warnings"].push_back(Spelled(warning));
  return text();
}

}  // namespace lf
