#include "tools/render_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/common/program.h"
#include "tools/common/progress.h"

#include "lf/core/log.h"
#include "lf/core/shell_word.h"

namespace lf {
namespace {

// Returns why elements of a frame have no ray, and what would help.
std::string CauseOfEmptyElements(const RenderReport& report, const FrameReport& frame) {
  if (!report.skipped.empty()) return "LF images are missing or broken, see below";
  if (frame.weighed && frame.weighed->coverage.uncovered_share > kMuchUncovered)
    return "the lens is beyond the capture, see below";
  if (report.has_masks)
    return "masks, or alpha that is taken as one (--image-alpha), leave out what is there";
  if (!frame.weighed)
    return "the lens holds no LF camera that sees them: open it, or leave --lens-weights at auto";
  return "they look past what the LF cameras saw: at the capture's edge a frame must be narrower, "
         "or the camera nearer to the middle";
}

// Warns once, for all frames, about the share of elements without a ray.
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
        "{:.0f} %: {}",
        thin_count, report.frames.size(), worst->frame.value,
        100 * worst->empty_element_count[1] / element_count, CauseOfEmptyElements(report, *worst));
}

// Reports how much of the pictures is interpolated, and from what.
void TellRebinning(const RenderReport& report) {
  if (!report.rebinning) return;
  double least = 1, most = 0;
  for (const FrameReport& frame : report.frames) {
    least = std::min(least, frame.interpolated_share.value_or(0));
    most = std::max(most, frame.interpolated_share.value_or(0));
  }
  const RebinReport& rebinning = *report.rebinning;
  const std::string cost =
      rebinning.looked_at_count == 0
          ? ""
          : fmt::format(" ({:.1f} ns each)",
                        1e9 * rebinning.cpu_s / static_cast<double>(rebinning.looked_at_count));
  LogInfo("rebinned: {}cells of {}LF pixels{}; {:.1f} to {:.1f} % of a frame is interpolated",
          ShortNumber(static_cast<double>(rebinning.cell_count)),
          ShortNumber(static_cast<double>(rebinning.looked_at_count)), cost, 100 * least,
          100 * most);
  if (rebinning.kept != "all")
    LogInfo(
        "rebinned: {}, so that the picture depends on --max-rays and on which frames are rendered "
        "together",
        rebinning.kept == "edges" ? "rays at edges were kept" : "there was no room for all rays");
}

// Reports which lens weights kAuto chose.
void TellLensWeights(const RenderReport& report) {
  size_t cells = 0, hats = 0, both = 0;
  for (const FrameReport& frame : report.frames) {
    if (!frame.weighed) continue;
    const double share = frame.weighed->hat_share;
    ++(share == 0 ? cells : share == 1 ? hats : both);
  }
  if (cells + hats + both == 0) return;
  if (cells + both == 0)
    LogInfo("lens weights: small lenses, interpolated between the LF images around them");
  else if (hats + both == 0)
    LogInfo("lens weights: LF images count as the area of the lens that each stands for");
  else
    LogInfo(
        "lens weights: by area in {} frames, interpolated between LF images (hats) in {}, by "
        "both in {}",
        cells, hats, both);
}

// Reports with how many LF images frames reached the required noise.
void TellNoise(const RenderReport& report) {
  uint64_t fewest = UINT64_MAX, most = 0;
  size_t measured = 0, met = 0;
  for (const FrameReport& frame : report.frames) {
    if (!frame.noise) continue;
    ++measured;
    if (!frame.noise->reached || *frame.noise->reached > frame.noise->asked) continue;
    ++met;
    fewest = std::min(fewest, frame.noise->image_count);
    most = std::max(most, frame.noise->image_count);
  }
  if (measured == 0) return;
  const std::string images = met == 0 ? "" : fmt::format(", with {} to {} LF images", fewest, most);
  LogInfo("noise: {} of {} frames have what was asked for or less{}", met, measured, images);
}

// Counts the frames whose badness exceeds the limit, and calls `warn` with the count and the worst
// frame.
template <class Badness>
void WarnOfFrames(const RenderReport& report, double limit, const Badness& badness,
                  const std::function<void(size_t count, const FrameReport& worst)>& warn) {
  size_t count = 0;
  const FrameReport* worst = nullptr;
  for (const FrameReport& frame : report.frames) {
    if (!frame.weighed || !(badness(*frame.weighed) > limit)) continue;
    ++count;
    if (worst == nullptr || badness(*frame.weighed) > badness(*worst->weighed)) worst = &frame;
  }
  if (count > 0) warn(count, *worst);
}

void WarnOfLenses(const RenderReport& report) {
  constexpr double kFewImages = 3.95;
  WarnOfFrames(
      report, kMuchUncovered, [](const auto& weighed) { return weighed.coverage.uncovered_share; },
      [&](size_t count, const FrameReport& worst) {
        const LensCoverage& coverage = worst.weighed->coverage;
        double fitting_w = coverage.fitting_diameter_w;  // in all frames
        for (const FrameReport& frame : report.frames)
          if (frame.weighed)
            fitting_w = std::min(fitting_w, frame.weighed->coverage.fitting_diameter_w);
        LogWarning(
            "in {} of {} frames a part of the lens is beyond the capture, most of all in frame {}: "
            "{:.0f} %. It stays empty, and bokeh are cut off there. {}a camera nearer to the "
            "middle of the capture would show the truth",
            count, report.frames.size(), worst.frame.value, 100 * coverage.uncovered_share,
            fitting_w > 0 ? fmt::format("An aperture of at most {:.4g} world units, or ", fitting_w)
                          : "Only ");
      });
  // Hat weights always have few images, and frames that no LF image sees are black; both have
  // reports of their own.
  WarnOfFrames(
      report, -kFewImages,
      [](const auto& weighed) {
        const bool is_told = weighed.hat_share == 1 || weighed.effective_count == 0;
        return is_told ? -INFINITY : -weighed.effective_count;
      },
      [&](size_t count, const FrameReport& worst) {
        LogWarning(
            "{} of {} frames are made of fewer than {:.0f} LF images, counted by their weights, "
            "fewest of all frame {}: {:.1f}. Expect double edges out of focus, and noise; a wider "
            "aperture has more",
            count, report.frames.size(), kFewImages, worst.frame.value,
            worst.weighed->effective_count);
      });
}

}  // namespace

void SummariseRender(const RenderReport& report, const std::string& look_at) {
  const uint64_t rays = report.AcceptedRays();
  const std::string collected =
      rays == 0 && report.rebinning
          ? ""
          : fmt::format("{}rays, {:.3g} M/s per core, ", ShortNumber(static_cast<double>(rays)),
                        report.MraysPerSecondPerCore());
  LogInfo(
      "{} frames {}x{} in {}: {}{} of {} LF images, peak memory {} MiB", report.frames.size(),
      report.width, report.height, ShortDuration(report.total_s), collected,
      report.selected_image_count - std::min(report.selected_image_count, report.skipped.size()),
      report.lf_image_count, report.peak_memory_bytes >> 20);
  TellRebinning(report);
  TellLensWeights(report);
  TellNoise(report);
  WarnOfEmptyElements(report);
  WarnOfLenses(report);
  LogInfo("look at {}", look_at);
}

Error WithResumeCommand(Error error, int argc, char** argv) {
  if (error.kind != ErrorKind::kInterrupted) return error;
  std::string command;
  bool has_resume = false;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--overwrite") continue;
    has_resume = has_resume || word == "--resume";
    if (i > 0) command += ' ';
    command += ShellWord(word);
  }
  error.message += "; go on with: " + command + (has_resume ? "" : " --resume");
  return error;
}

Result<void> CheckRequired(const RenderReport& report, std::optional<uint32_t> samples) {
  if (!samples) return {};
  constexpr size_t kNamed = 10;
  size_t count = 0;
  std::string frames;
  for (const FrameReport& frame : report.frames) {
    if (!frame.samples || frame.samples->measured.most_have >= *samples) continue;
    if (++count > kNamed) continue;
    if (!frames.empty()) frames += ", ";
    frames += frame.samples->asked == *samples
                  ? fmt::format("frame {} ({:.1f} %)", frame.frame.value,
                                100 * frame.samples->measured.share)
                  : fmt::format("frame {} ({} in most)", frame.frame.value,
                                frame.samples->measured.most_have);
  }
  if (count == 0) return {};
  return Error{
      ErrorKind::kBelowRequired,
      fmt::format("--require samples>={}: {} of {} frames have them in less than 99 % of "
                  "the elements that LF images see: {}{}",
                  *samples, count, report.frames.size(), frames, count > kNamed ? ", ..." : "")};
}

Result<void> CheckRequiredNoise(const RenderReport& report, std::optional<double> noise) {
  if (!noise) return {};
  constexpr size_t kNamed = 10;
  size_t count = 0;
  std::string frames;
  for (const FrameReport& frame : report.frames) {
    const std::optional<double> reached = frame.noise ? frame.noise->reached : std::nullopt;
    if (reached && *reached <= *noise) continue;
    if (++count > kNamed) continue;
    if (!frames.empty()) frames += ", ";
    frames += fmt::format("frame {} ({})", frame.frame.value,
                          reached ? fmt::format("{:.3g}", *reached)
                                  : std::string("not measurable: fewer than two LF images"));
  }
  if (count == 0) return {};
  return Error{
      ErrorKind::kBelowRequired,
      fmt::format("--require noise<={}: {} of {} frames have more in more than a tenth of "
                  "the elements that LF images see: {}{}; a wider aperture or more LF "
                  "images lower it",
                  *noise, count, report.frames.size(), frames, count > kNamed ? ", ..." : "")};
}

}  // namespace lf
