// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "lf/core/file.h"
#include "lf/core/ids.h"
#include "lf/render/state/record_fields.h"
#include "lf/render/state/report.h"

namespace lf {
namespace {

constexpr size_t kLimitBytes = size_t{256} << 20;

FrameReport FrameFromJson(const Json& json, std::string* fault) {
  RecordFields fields(json, fault);
  FrameReport frame;
  fields.Get("frame", &frame.frame.value);
  fields.Get("lf_images", &frame.rays.image_count);
  fields.Get("rays_tested", &frame.rays.tested_count);
  fields.Get("rays_accepted", &frame.rays.accepted_count);
  fields.Get("elements_without_ray", &frame.empty_element_count);
  fields.Get("rays_per_element_min", &frame.min_count);
  fields.Get("rays_per_element_median", &frame.median_count);
  fields.Get("develop_s", &frame.develop_s);
  fields.Get("virtual_lf_images", &frame.rays.virtual_count);
  fields.Get("inputs", &frame.camera);
  if (fields.Find("interpolated_share") != nullptr)
    fields.Get("interpolated_share", &frame.interpolated_share.emplace());
  if (fields.Find("densified_share") != nullptr) {
    VirtualLight& light = frame.virtual_light.emplace();
    fields.Get("densified_share", &light.densified_share);
    fields.Get("doubtful_share", &light.doubtful_share);
  }
  if (fields.Find("effective_lf_images") != nullptr) {
    FrameReport::Weighed weighed;
    fields.Get("effective_lf_images", &weighed.effective_count);
    fields.Get("hat_share", &weighed.hat_share);
    fields.Get("uncovered_share", &weighed.coverage.uncovered_share);
    fields.Get("fitting_aperture_w", &weighed.coverage.fitting_diameter_w);
    frame.weighed = weighed;
  }
  if (fields.Find("finished_early_before_rank") != nullptr)
    fields.Get("finished_early_before_rank", &frame.ranks_done.emplace());
  if (const Json* samples = fields.Find("samples")) {
    RecordFields sample_fields(*samples, fault);
    frame.samples.emplace();
    sample_fields.Get("asked", &frame.samples->asked);
    sample_fields.Get("share", &frame.samples->measured.share);
    sample_fields.Get("most_have", &frame.samples->measured.most_have);
  }
  if (const Json* noise = fields.Find("noise")) {
    RecordFields noise_fields(*noise, fault);
    frame.noise.emplace();
    noise_fields.Get("asked", &frame.noise->asked);
    noise_fields.Get("ranks", &frame.noise->ranks);
    noise_fields.Get("lf_images", &frame.noise->image_count);
    if (noise_fields.Find("reached") != nullptr)
      noise_fields.Get("reached", &frame.noise->reached.emplace());
  }
  const bool has_number = fields.Find("frame") != nullptr;
  if ((!has_number || frame.frame.value > kLargestFrameNumber) && fault->empty())
    *fault = fmt::format("\"frame\": expected a number from 0 to {}", kLargestFrameNumber);
  return frame;
}

}  // namespace

Result<RenderReport> ParseReport(std::string_view text, const std::string& name) {
  std::string fault;
  RenderReport report;
  const Json json = ParseRecord(text, "lfreport 2", &fault);
  if (fault.empty()) {
    RecordFields fields(json, &fault);
    fields.Get("version", &report.version);
    fields.Get("inputs", &report.inputs);
    fields.Get("lf_images_selected", &report.selected_image_count);
    fields.Get("virtual_lf_images_selected", &report.selected_virtual_count);
    fields.Get("seconds", &report.total_s);
    fields.Get("load_cpu_s", &report.load_cpu_s);
    fields.Get("load_wall_s", &report.load_wall_s);
    fields.Get("collect_cpu_s", &report.collect_cpu_s);
    fields.Get("peak_memory_bytes", &report.peak_memory_bytes);
    if (const Json* item = fields.Find("rebinning")) {
      RecordFields rebinning_fields(*item, &fault);
      RebinReport& rebinning = report.rebinning.emplace();
      rebinning_fields.Get("slabs", &rebinning.slab_count);
      rebinning_fields.Get("cells", &rebinning.cell_count);
      rebinning_fields.Get("lf_pixels_looked_at", &rebinning.looked_at_count);
      rebinning_fields.Get("cpu_s", &rebinning.cpu_s);
      rebinning_fields.Get("kept", &rebinning.kept);
      if (rebinning_fields.Find("pixels") != nullptr) {
        rebinning.pixels.emplace();
        rebinning_fields.Get("pixels", &rebinning.pixels->count);
        rebinning_fields.Get("kept_share", &rebinning.pixels->kept_share);
      }
    }
    for (const Json* item : fields.List("skipped_lf_images")) {
      RecordFields skipped_fields(*item, &fault);
      SkippedImage& skipped = report.skipped.emplace_back();
      skipped_fields.Get("name", &skipped.name);
      skipped_fields.Get("reason", &skipped.reason);
    }
    for (const Json* item : fields.List("frames"))
      report.frames.push_back(FrameFromJson(*item, &fault));
  }
  if (!fault.empty())
    return InputError(
        fmt::format("{}: is not a report from which a render can be resumed: {}; remove the file "
                    "to render these frames again",
                    name, fault));
  return report;
}

Result<RenderReport> ReadReport(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kLimitBytes));
  return ParseReport(text, path.string());
}

}  // namespace lf
