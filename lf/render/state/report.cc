// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/report.h"

#include <sys/resource.h>

#include <algorithm>
#include <numeric>
#include <unordered_set>

#include "lf/core/file.h"
#include "lf/core/spelling.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace {

VirtualLight VirtualLightOf(const DevelopedFrame& developed) {
  double densified = 0;
  size_t seen = 0;  // number of elements with rays
  for (size_t i = 0; i < developed.densified.pixels().size(); ++i) {
    if (developed.coverage.pixels()[i] == 0) continue;
    densified += developed.densified.pixels()[i];
    ++seen;
  }
  if (seen == 0) return {};
  const auto count = static_cast<double>(seen);
  return {densified / count, static_cast<double>(developed.doubtful_count) / count};
}

Json InputsToJson(const RunInputs& inputs) {
  Json json = Json::object();
  for (const auto& [key, value] : inputs) json[key] = value;
  return json;
}

void AddVirtualLight(const std::optional<VirtualLight>& light, Json* json) {
  if (!light) return;
  (*json)["densified_share"] = light->densified_share;
  (*json)["doubtful_share"] = light->doubtful_share;
}

Json FrameToJson(const FrameReport& frame) {
  Json json = {{"frame", frame.frame.value},
               {"lf_images", frame.rays.image_count},
               {"rays_tested", frame.rays.tested_count},
               {"rays_accepted", frame.rays.accepted_count},
               {"elements_without_ray", frame.empty_element_count},
               {"rays_per_element_min", frame.min_count},
               {"rays_per_element_median", frame.median_count},
               {"develop_s", frame.develop_s}};
  if (frame.rays.virtual_count > 0) json["virtual_lf_images"] = frame.rays.virtual_count;
  if (frame.interpolated_share) json["interpolated_share"] = *frame.interpolated_share;
  AddVirtualLight(frame.virtual_light, &json);
  if (frame.weighed) {
    json["effective_lf_images"] = frame.weighed->effective_count;
    json["hat_share"] = frame.weighed->hat_share;
    json["uncovered_share"] = frame.weighed->coverage.uncovered_share;
    json["fitting_aperture_w"] = frame.weighed->coverage.fitting_diameter_w;
  }
  if (frame.ranks_done) json["finished_early_before_rank"] = *frame.ranks_done;
  if (frame.samples)
    json["samples"] = {{"asked", frame.samples->asked},
                       {"share", frame.samples->measured.share},
                       {"most_have", frame.samples->measured.most_have}};
  if (frame.noise) {
    Json& noise = json["noise"] = {{"asked", frame.noise->asked},
                                   {"ranks", frame.noise->ranks},
                                   {"lf_images", frame.noise->image_count}};
    if (frame.noise->reached) noise["reached"] = *frame.noise->reached;
  }
  json["inputs"] = InputsToJson(frame.camera);
  return json;
}

}  // namespace

uint64_t RenderReport::TestedRays() const {
  uint64_t count = 0;
  for (const FrameReport& frame : frames) count += frame.rays.tested_count;
  return count;
}

uint64_t RenderReport::AcceptedRays() const {
  uint64_t count = 0;
  for (const FrameReport& frame : frames) count += frame.rays.accepted_count;
  return count;
}

std::optional<VirtualLight> RenderReport::MeanVirtualLight() const {
  VirtualLight mean;
  double count = 0;
  for (const FrameReport& frame : frames) {
    if (!frame.virtual_light) continue;
    mean.densified_share += frame.virtual_light->densified_share;
    mean.doubtful_share += frame.virtual_light->doubtful_share;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return VirtualLight{mean.densified_share / count, mean.doubtful_share / count};
}

bool RenderReport::IsBlack() const {
  // The accepted rays of a guarded frame are those of recorded LF images alone.
  return AcceptedRays() == 0 &&
         std::all_of(frames.begin(), frames.end(), [](const FrameReport& frame) {
           return frame.rays.virtual_count == 0 && frame.interpolated_share.value_or(0) == 0;
         });
}

double RenderReport::MraysPerSecondPerCore() const {
  return collect_cpu_s > 0 ? static_cast<double>(AcceptedRays()) / 1e6 / collect_cpu_s : 0;
}

void RenderReport::AddSkipped(std::span<const SkippedImage> images) {
  if (images.empty()) return;
  std::unordered_set<std::string> known;
  for (const SkippedImage& image : skipped) known.insert(image.name);
  for (const SkippedImage& image : images)
    if (known.insert(image.name).second) skipped.push_back(image);
}

void RenderReport::AddRebinning(const RebinReport& other) {
  if (!rebinning) rebinning.emplace();
  rebinning->Add(other);
}

void RebinReport::Add(const RebinReport& other) {
  slab_count = std::max(slab_count, other.slab_count);
  cell_count = std::max(cell_count, other.cell_count);
  looked_at_count += other.looked_at_count;
  cpu_s += other.cpu_s;
  if (other.kept == "some" || kept == "all") kept = other.kept;
  if (!other.pixels) return;
  if (!pixels) pixels.emplace();
  pixels->count = std::max(pixels->count, other.pixels->count);
  pixels->kept_share = std::min(pixels->kept_share, other.pixels->kept_share);
}

FrameReport MakeFrameReport(FrameId frame, const FrameRays& rays, const DevelopedFrame& developed) {
  FrameReport report;
  report.frame = frame;
  report.rays = rays;
  if (const auto& shares = developed.interpolated.pixels(); !shares.empty())
    report.interpolated_share =
        std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size());
  if (!developed.densified.empty()) report.virtual_light = VirtualLightOf(developed);
  const LargeVector<uint32_t>& counts = developed.ray_count.pixels();
  std::vector<uint32_t> channel_counts(counts.size() / 3);
  if (channel_counts.empty()) return report;
  for (size_t channel = 0; channel < 3; ++channel) {
    for (size_t i = 0; i < channel_counts.size(); ++i) channel_counts[i] = counts[i * 3 + channel];
    const auto middle = channel_counts.begin() + static_cast<ptrdiff_t>(channel_counts.size() / 2);
    std::nth_element(channel_counts.begin(), middle, channel_counts.end());
    report.median_count[channel] = *middle;
    report.min_count[channel] = *std::min_element(channel_counts.begin(), channel_counts.end());
    const LargeVector<float>& interpolated = developed.interpolated.pixels();
    for (size_t i = 0; i < channel_counts.size(); ++i)
      if (counts[i * 3 + channel] == 0 && (interpolated.empty() || interpolated[i] == 0))
        ++report.empty_element_count[channel];
  }
  return report;
}

uint64_t PeakMemoryBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

std::string ToJson(const RenderReport& report) {
  Json skipped = Json::array();
  for (const SkippedImage& image : report.skipped)
    skipped.push_back({{"name", image.name}, {"reason", Spelled(image.reason)}});
  Json frames = Json::array();
  for (const FrameReport& frame : report.frames) frames.push_back(FrameToJson(frame));
  Json json = {{"format", "lfreport 2"},
               {"version", report.version},
               {"inputs", InputsToJson(report.inputs)},
               {"estimator", NameOf(report.estimator)},
               {"resolution", {report.width, report.height}},
               {"threads", report.thread_count},
               {"lf_images", report.lf_image_count},
               {"lf_images_selected", report.selected_image_count},
               {"passes", report.pass_count},
               {"seconds", report.total_s},
               {"load_cpu_s", report.load_cpu_s},
               {"load_wall_s", report.load_wall_s},
               {"collect_cpu_s", report.collect_cpu_s},
               {"rays_tested", report.TestedRays()},
               {"rays_accepted", report.AcceptedRays()},
               {"mrays_per_s_per_core", report.MraysPerSecondPerCore()},
               {"peak_memory_bytes", report.peak_memory_bytes},
               {"lf_images_skipped", report.skipped.size()},
               {"skipped_lf_images", std::move(skipped)},
               {"frames", std::move(frames)}};
  if (report.virtual_count > 0 || report.selected_virtual_count > 0) {
    json["virtual_lf_images"] = report.virtual_count;
    json["virtual_lf_images_selected"] = report.selected_virtual_count;
  }
  AddVirtualLight(report.MeanVirtualLight(), &json);
  for (const PackageReport& package : report.packages) {
    Json& item =
        json["packages"].emplace_back(Json{{"name", package.name},
                                           {"lf_images_selected", package.selected_image_count},
                                           {"lf_images_skipped", package.skipped_image_count}});
    if (package.selected_virtual_count > 0)
      item["virtual_lf_images_selected"] = package.selected_virtual_count;
  }
  if (report.rebinning)
    json["rebinning"] = {{"slabs", report.rebinning->slab_count},
                         {"cells", report.rebinning->cell_count},
                         {"lf_pixels_looked_at", report.rebinning->looked_at_count},
                         {"kept", report.rebinning->kept},
                         {"cpu_s", report.rebinning->cpu_s}};
  if (report.rebinning && report.rebinning->pixels) {
    json["rebinning"]["pixels"] = report.rebinning->pixels->count;
    json["rebinning"]["kept_share"] = report.rebinning->pixels->kept_share;
  }
  return RecordText(json);
}

Result<void> WriteReport(const RenderReport& report, const std::filesystem::path& path) {
  return WriteFileAtomically(path, ToJson(report));
}

}  // namespace lf
