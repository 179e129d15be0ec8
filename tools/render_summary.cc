#include "tools/render_summary.h"

#include "tools/common/progress.h"

#include "lf/core/log.h"

namespace lf {
namespace {

// The share of elements without a ray, once for all frames.
void WarnOfEmptyElements(const RenderReport& report) {
  const double element_count = static_cast<double>(report.width) * report.height;
  size_t thin_count = 0;
  const FrameReport* worst = nullptr;
  for (const FrameReport& frame : report.frames) {
    if (frame.empty_element_count[1] > 0.01 * element_count) ++thin_count;
    if (worst == nullptr || frame.empty_element_count[1] > worst->empty_element_count[1])
      worst = &frame;
  }
  if (thin_count > 0)
    LogWarning(
        "{} of {} frames have elements that no ray reached, most of all frame {}: "
        "{:.0f} %. Was the camera within the capture, the lens wider than the spacing?",
        thin_count, report.frames.size(), worst->frame.value,
        100 * worst->empty_element_count[1] / element_count);
}

}  // namespace

void SummariseRender(const RenderReport& report, const std::string& look_at) {
  LogInfo(
      "{} frames {}x{} in {}: {}rays from {} of {} LF images, {:.3g} Mrays/s per core, "
      "peak memory {} MiB",
      report.frames.size(), report.width, report.height, ShortDuration(report.total_s),
      ShortNumber(static_cast<double>(report.AcceptedRays())), report.selected_image_count,
      report.lf_image_count, report.MraysPerSecondPerCore(), report.peak_memory_bytes >> 20);
  WarnOfEmptyElements(report);
  if (!report.skipped.empty())
    LogWarning("{} LF images were skipped; report.json names them", report.skipped.size());
  LogInfo("look at {}", look_at);
}

}  // namespace lf
