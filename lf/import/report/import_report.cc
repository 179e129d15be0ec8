// SPDX-License-Identifier: Apache-2.0
#include "lf/import/report/import_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lf/camera/distortion_name.h"
#include "lf/core/log.h"
#include "lf/core/spelling.h"
#include "lf/import/report/exposure_report.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

using Json = nlohmann::ordered_json;

const char* NameOf(DistanceSource source) {
  switch (source) {
    case DistanceSource::kStated:
      return "stated";
    case DistanceSource::kDepthRange:
      return "depth range";
    case DistanceSource::kMeeting:
      return "where optical axes pass nearest to one another";
  }
  LF_CHECK(false);
}

Spread Degrees(const Spread& rad) {
  return {DegreesFromRadians(rad.min), DegreesFromRadians(rad.median), DegreesFromRadians(rad.max)};
}

// Return a number, a spread or a point as text for people, with five digits. A spread is one number
// if its smallest and largest value have the same digits.
std::string Brief(double value) { return fmt::format("{:.5g}", value == 0 ? 0.0 : value); }
std::string Brief(const Spread& spread) {
  const std::string min = Brief(spread.min), max = Brief(spread.max);
  return min == max ? max : fmt::format("{} ({} to {})", Brief(spread.median), min, max);
}
std::string Brief(Vec3 point) {
  for (double& x : point)  // coordinates that are only rounding errors become 0
    if (std::abs(x) < 1e-9 * point.cwiseAbs().maxCoeff()) x = 0;
  return fmt::format("{}, {}, {}", Brief(point.x()), Brief(point.y()), Brief(point.z()));
}

void AddLine(const char* name, const std::string& text, std::string* lines) {
  *lines += fmt::format("{:<14} {}\n", name, text);
}

void AddCameras(const std::vector<CameraGroup>& groups, std::string* lines) {
  constexpr size_t kShown = 5;
  for (size_t i = 0; i < std::min(kShown, groups.size()); ++i) {
    const CameraGroup& group = groups[i];
    const std::string focal = Brief(group.fx_px) == Brief(group.fy_px)
                                  ? Brief(group.fx_px)
                                  : fmt::format("{} x {}", Brief(group.fx_px), Brief(group.fy_px));
    AddLine("cameras",
            fmt::format("{} of {} {}x{}, {} distinct: focal length {} px, field of view {} x {} "
                        "degrees",
                        group.image_count, NameOf(group.model), group.width_px, group.height_px,
                        group.intrinsics_count, focal, Brief(Degrees(group.horizontal_fov_rad)),
                        Brief(Degrees(group.vertical_fov_rad))),
            lines);
  }
  if (groups.size() > kShown)
    AddLine("", fmt::format("and {} other models and sizes", groups.size() - kShown), lines);
}

void AddDensity(const Density& density, std::string* lines) {
  AddLine("density",
          fmt::format("{:.3g} degrees, or {:.3g} pixels, between neighbours at distance {} ({})",
                      DegreesFromRadians(density.spacing_rad), density.disparity_px,
                      Brief(density.distance_w), NameOf(density.source)),
          lines);
  AddLine("ghosts",
          fmt::format("{:.3g} pixels apart 25 % before the focus plane, {:.3g} behind it",
                      density.near_ghost_px, density.far_ghost_px),
          lines);
}

std::string ImagesText(const ImportReport& report) {
  std::string text = fmt::format("{}", report.capture.image_count);
  if (report.capture.virtual_count > 0)
    text += fmt::format(" recorded, {} virtual", report.capture.virtual_count);
  if (report.predicted_count > 0)
    text += fmt::format(", {} predicted from others", report.predicted_count);
  if (report.capture.mask_count > 0) text += fmt::format(", {} masks", report.capture.mask_count);
  if (report.excluded_count > 0) text += fmt::format(", {} left out", report.excluded_count);
  if (!report.faults) return text + ", not checked";
  if (report.faults->left_out_count > 0)
    text += fmt::format(", {} not in the store", report.faults->left_out_count);
  return text + fmt::format(", {} missing, {} broken", report.faults->missing.size(),
                            report.faults->broken.size());
}

// Returns "9 cameras, 300 times from 0 to 9.967 s, 30 per second; shows 4.5 s".
std::string VideoText(const ImportReport& report) {
  const VideoFacts& video = *report.video;
  const char* const unit = video.is_in_seconds ? " s" : "";
  std::string text;
  if (video.camera_count > 0) text = fmt::format("{} cameras, ", video.camera_count);
  text += fmt::format("{} times from {} to {}{}", video.slice_count, Brief(video.begin),
                      Brief(video.end), unit);
  if (video.rate)
    text += fmt::format(", {} per {}", Brief(*video.rate), video.is_in_seconds ? "second" : "unit");
  if (report.shown_times.size() == 1)
    text += fmt::format("; shows {}{}", Brief(report.shown_times[0]), unit);
  return text;
}

Json VideoJson(const ImportReport& report) {
  const VideoFacts& video = *report.video;
  return {{"cameras", video.camera_count > 0 ? Json(video.camera_count) : Json(nullptr)},
          {"times", video.slice_count},
          {"begin", video.begin},
          {"end", video.end},
          {"rate", video.rate ? Json(*video.rate) : Json(nullptr)},
          {"shown", report.shown_times},
          {"in_seconds", video.is_in_seconds}};
}

std::string PixelsText(const FootprintFacts& pixels) {
  return fmt::format("show {} ({})",
                     pixels.footprint == PixelFootprint::kArea
                         ? "the mean light of their areas, as photographs do"
                         : "the light of points, as renders without anti-aliasing do",
                     pixels.is_stated ? "stated by lf_pixels" : "measured in three images");
}

Json JsonOf(const FootprintFacts& pixels) {
  return {{"show", NameOf(pixels.footprint)}, {"from", pixels.is_stated ? "lf_pixels" : "images"}};
}
Json JsonOf(const Agreement& agreement) {
  const auto json_of = [](const Fit& fit) {
    return Json{{"error_px", fit.error_px}, {"share", fit.share}};
  };
  Json json = {{"verdict", NameOf(agreement.verdict)}};
  json.update(json_of(agreement.fit));
  json.update({{"places", agreement.place_count},
               {"pairs", agreement.pair_count},
               {"images", agreement.image_count},
               {"reason", Spelled(agreement.reason)},
               {"tells_intrinsics", agreement.tells_intrinsics},
               {"tells_order", agreement.tells_order},
               {"repair", nullptr}});
  if (agreement.repair) {
    json["repair"] = {{"words", NameOf(*agreement.repair)}, {"supposes", agreement.clause}};
    json["repair"].update(json_of(agreement.repaired));
  }
  return json;
}
Json JsonOf(const FoundProfile& profile) {
  return {{"name", profile.name},
          {"images", profile.image_count},
          {"examined", profile.asked_count},
          {"converted", profile.is_converted}};
}
Json JsonOf(const Spread& spread) {
  return {{"min", spread.min}, {"median", spread.median}, {"max", spread.max}};
}
Json JsonOf(const Vec3& point) { return {point.x() + 0.0, point.y() + 0.0, point.z() + 0.0}; }
Json JsonOf(const DepthRange& range) { return {range.near_w, range.far_w}; }
Json JsonOf(const CameraGroup& group) {
  return {{"model", NameOf(group.model)},
          {"size_px", {group.width_px, group.height_px}},
          {"images", group.image_count},
          {"distinct", group.intrinsics_count},
          {"fx_px", JsonOf(group.fx_px)},
          {"fy_px", JsonOf(group.fy_px)},
          {"cx_px", JsonOf(group.cx_px)},
          {"cy_px", JsonOf(group.cy_px)},
          {"horizontal_fov_deg", JsonOf(Degrees(group.horizontal_fov_rad))},
          {"vertical_fov_deg", JsonOf(Degrees(group.vertical_fov_rad))}};
}
Json JsonOf(const Density& density) {
  return {{"distance_w", density.distance_w},
          {"distance_from", NameOf(density.source)},
          {"spacing_deg", DegreesFromRadians(density.spacing_rad)},
          {"disparity_px", density.disparity_px},
          {"ghost_near_px", density.near_ghost_px},
          {"ghost_far_px", density.far_ghost_px}};
}
template <class T>
Json OrNull(const std::optional<T>& value) {
  return value ? JsonOf(*value) : Json(nullptr);
}

}  // namespace

void WarnOfFaults(const LightField& light_field, ImportReport* report) {
  const auto warn = [&](const char* kind, const char* what, const std::vector<ImageFault>& faults) {
    if (faults.empty()) return;
    std::vector<LfImageId> ids;
    for (const ImageFault& fault : faults) ids.push_back(fault.id);
    report->capture.warnings.push_back(
        WarningAbout(light_field, kind,
                     fmt::format("{} of {} images are {} and will be skipped. The first: {}",
                                 faults.size(), light_field.size(), what, faults[0].reason),
                     ids));
  };
  warn("missing-images", "missing", report->faults->missing);
  warn("broken-images", "broken", report->faults->broken);
}

Result<void> JudgePoses(const LightField& light_field, ThreadPool& pool,
                        const std::atomic<bool>& interrupted,
                        const std::function<std::string(const std::string& words)>& repair_call,
                        ImportReport* report) {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> store,
                      OpenStore(light_field, Mosaics::kToRgb));
  LF_ASSIGN_OR_RETURN(report->agreement, JudgeAgreement(light_field, *store, pool, &interrupted));
  const Agreement& agreement = *report->agreement;
  if (agreement.verdict != Verdict::kDisagree) return {};
  std::string message = TextOf(agreement);
  const std::string call = repair_call(NameOf(*agreement.repair));
  if (!call.empty()) message += ". Repair the poses: " + call;
  report->capture.warnings.push_back(
      {.kind = "poses-disagree", .message = std::move(message), .image_count = 0, .names = {}});
  return {};
}

std::string ReportText(const ImportReport& report) {
  const CaptureReport& capture = report.capture;
  std::string lines;
  AddLine("light field", report.light_field, &lines);
  AddLine("first image", report.first_image, &lines);
  AddLine("images", ImagesText(report), &lines);
  if (report.video) AddLine("video", VideoText(report), &lines);
  if (report.films)
    AddLine("encoded for",
            fmt::format("the film of {}: {} frames, lens weights {}", report.films->source,
                        report.films->frame_count, report.films->lens_weights),
            &lines);
  if (report.pixels) AddLine("pixels", PixelsText(*report.pixels), &lines);
  if (report.agreement) AddLine("agreement", Spelled(TextOf(*report.agreement)), &lines);
  if (report.profile) AddLine("colours", TextOf(*report.profile), &lines);
  AddCameras(capture.groups, &lines);
  AddLine("positions",
          fmt::format("from {} to {}", Brief(capture.box_min_w), Brief(capture.box_max_w)), &lines);
  if (capture.spacing_w)
    AddLine("spacing", Brief(*capture.spacing_w) + " to the nearest neighbour", &lines);
  AddLine("optical axes",
          capture.meeting_point_w
              ? "pass nearest to one another at " + Brief(*capture.meeting_point_w)
              : "do not come near one another before the cameras",
          &lines);
  if (capture.depth_range)
    AddLine("depth range",
            fmt::format("{} to {}", Brief(capture.depth_range->near_w),
                        Brief(capture.depth_range->far_w)),
            &lines);
  AddLine("unit",
          Spelled(fmt::format("1 world unit counts as {} m; if it is not, see {{scale}}",
                              capture.unit_m)),
          &lines);
  if (capture.alpha)
    AddLine("alpha", TextOfAlpha(*capture.alpha, capture.background, capture.keeps_opacity),
            &lines);
  if (capture.density)
    AddDensity(*capture.density, &lines);
  else if (capture.spacing_w)
    AddLine("density", Spelled("unknown: give the distance to the scene with {distance}"), &lines);
  if (capture.brackets) AddLine("brackets", BracketsText(*capture.brackets), &lines);
  if (report.exif_gains) AddLine("gains", ExifGainsText(*report.exif_gains), &lines);
  if (report.exposure) {
    AddLine("exposure", ExposureText(*report.exposure), &lines);
    AddLine("seams", SeamsText(*report.exposure), &lines);
    if (report.exposure->falloff)
      AddLine("falloff", FalloffText(*report.exposure->falloff), &lines);
  }
  for (const CaptureWarning& warning : capture.warnings) {
    lines += fmt::format("\nwarning: {}: {}\n", warning.kind, Spelled(warning.message));
    if (!warning.names.empty())
      lines += fmt::format("  {}{}\n", fmt::join(warning.names, ", "),
                           warning.names.size() < warning.image_count ? ", ..." : "");
  }
  if (!report.written.empty()) lines += fmt::format("\nwritten: {}\n", report.written);
  if (!report.next.empty()) lines += "\n" + report.next;
  return lines;
}

std::string ReportJson(const ImportReport& report) {
  const CaptureReport& capture = report.capture;
  Json json = {{"light_field", report.light_field},
               {"first_image", report.first_image},
               {"images", capture.image_count},
               {"masks", capture.mask_count},
               {"left_out", report.excluded_count},
               {"missing", nullptr},
               {"broken", nullptr}};
  if (report.faults) {
    json["missing"] = report.faults->missing.size();
    json["broken"] = report.faults->broken.size();
    if (report.faults->left_out_count > 0) json["not_stored"] = report.faults->left_out_count;
  }
  if (report.predicted_count > 0) json["predicted"] = report.predicted_count;
  if (report.video) json["video"] = VideoJson(report);
  if (report.films)
    json["encoded_for"] = {{"packages", report.films->source},
                           {"frames", report.films->frame_count},
                           {"lens_weights", report.films->lens_weights}};
  json["pixels"] = OrNull(report.pixels);
  json["agreement"] = OrNull(report.agreement);
  json["colour_profile"] = OrNull(report.profile);
  json["cameras"] = Json::array();
  if (capture.virtual_count > 0) json["virtual"] = capture.virtual_count;
  for (const CameraGroup& group : capture.groups) json["cameras"].push_back(JsonOf(group));
  json["positions_w"] = {{"min", JsonOf(capture.box_min_w)}, {"max", JsonOf(capture.box_max_w)}};
  json["spacing_w"] = OrNull(capture.spacing_w);
  json["axes_meet_at_w"] = OrNull(capture.meeting_point_w);
  json["depth_range_w"] = OrNull(capture.depth_range);
  json["unit_m"] = capture.unit_m;
  json["alpha"] = nullptr;
  if (capture.alpha) {
    json["alpha"] = {{"meaning", NameOf(*capture.alpha)}};
    if (*capture.alpha != AlphaMeaning::kMask)
      json["alpha"]["background"] =
          capture.keeps_opacity ? Json(kNoBackground) : Json(capture.background);
  }
  json["density"] = OrNull(capture.density);
  json["brackets"] = capture.brackets ? BracketsJson(*capture.brackets) : Json(nullptr);
  json["exif_gains"] = report.exif_gains ? ExifGainsJson(*report.exif_gains) : Json(nullptr);
  json["exposure"] = report.exposure ? ExposureJson(*report.exposure) : Json(nullptr);
  json["warnings"] = Json::array();
  for (const CaptureWarning& warning : capture.warnings)
    json["warnings"].push_back({{"kind", warning.kind},
                                {"message", Spelled(warning.message)},
                                {"images", warning.image_count},
                                {"names", warning.names}});
  json["written"] = report.written.empty() ? Json(nullptr) : Json(report.written);
  // Names that are not UTF-8 are shown with replacement characters instead of being refused.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lf
