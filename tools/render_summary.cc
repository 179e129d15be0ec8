// SPDX-License-Identifier: Apache-2.0
#include "tools/render_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tools/common/next_step.h"
#include "tools/common/program.h"
#include "tools/render_end.h"

#include "lf/core/log.h"
#include "lf/core/quantities.h"

namespace lf {
namespace {

// Returns why elements of a frame have no ray, and what would help.
std::string CauseOfEmptyElements(const RenderReport& report, const FrameReport& frame) {
  if (!report.skipped.empty()) return "LF images are missing or broken (see below)";
  if (frame.weighed && frame.weighed->coverage.uncovered_share > kMuchUncovered)
    return "a part of the lens is beyond the LF cameras (see below)";
  if (report.has_masks)
    return "masks, or alpha that is used as a mask (--image-alpha), exclude the pixels that show "
           "them";
  if (!frame.weighed)
    return "no LF camera in the lens sees them: give a wider aperture, or --lens-weights auto";
  return "no LF camera has recorded what they show: give a narrower field of view, or move the "
         "camera nearer to the middle of the capture";
}

// Warns if any frame has more than 1 % of elements without a ray: once, with the worst frame.
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
        "{} of {} frames have elements (pixels of the frame) without rays, most of all frame {} "
        "({:.0f} %): {}",
        thin_count, report.frames.size(), worst->frame.value,
        100 * worst->empty_element_count[1] / element_count, CauseOfEmptyElements(report, *worst));
}

// Reports how much of the pictures is interpolated, and from how many kept pixels or cells.
void TellRebinning(const RenderReport& report) {
  if (!report.rebinning) return;
  const bool are_pixels = report.rebinning->pixels.has_value();
  if (are_pixels && report.rebinning->looked_at_count == 0) {
    LogInfo("no pixels are kept: the lenses of these frames have no gaps");
    return;
  }
  const bool are_mixed =
      std::any_of(report.frames.begin(), report.frames.end(),
                  [](const FrameReport& frame) { return frame.interpolated_share.has_value(); });
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
  LogInfo(
      "{}: {}{} of {}LF pixels{}{}", are_pixels ? "kept" : "rebinned",
      ShortNumber(static_cast<double>(are_pixels ? rebinning.pixels->count : rebinning.cell_count)),
      are_pixels ? "pixels" : "cells", ShortNumber(static_cast<double>(rebinning.looked_at_count)),
      cost,
      are_mixed
          ? fmt::format("; {:.1f} to {:.1f} % of a frame is interpolated", 100 * least, 100 * most)
          : "");
  if (rebinning.kept != "all")
    LogInfo(
        "{}: the picture therefore depends on --max-rays and on which frames are rendered together",
        rebinning.kept == "edges" ? "only rays at edges were kept"
                                  : "there was no room for all rays");
}

// Reports how much of the pictures rests on virtual LF images, and how much of it is doubtful.
void TellVirtualLight(const RenderReport& report) {
  const std::optional<VirtualLight> light = report.MeanVirtualLight();
  if (!light) return;
  LogInfo(
      "virtual light: {:.1f} % of the light of the frames rests on virtual LF images; it is "
      "doubtful in {:.1f} % of the elements",
      100 * light->densified_share, 100 * light->doubtful_share);
}

// Reports which lens weights the frames have: area, hat, or a mix of both.
//   is_chosen  true: by the program, not by an option
void TellLensWeights(const RenderReport& report, bool is_chosen) {
  size_t cells = 0, hats = 0, both = 0;
  for (const FrameReport& frame : report.frames) {
    if (!frame.weighed) continue;
    const double share = frame.weighed->hat_share;
    ++(share == 0 ? cells : share == 1 ? hats : both);
  }
  if (cells + hats + both == 0) return;
  constexpr const char* kHat = "hat (interpolation between LF images)";
  if (cells + both == 0) {
    LogInfo("lens weights: {}{}", kHat, is_chosen ? ", because the lenses are small" : "");
  } else if (hats + both == 0) {
    LogInfo(
        "lens weights: area (each LF image has the area of the lens that is nearest to its camera "
        "as weight)");
  } else if (cells + hats == 0) {
    LogInfo("lens weights: a mix of area and {}{}", kHat,
            is_chosen ? ", because the lenses are neither large nor small" : "");
  } else {
    std::vector<std::string> kinds;
    const auto add = [&kinds](const char* kind, size_t count) {
      if (count > 0) kinds.push_back(fmt::format("{} in {} frames", kind, count));
    };
    add("area", cells);
    add(kHat, hats);
    add("a mix of both", both);
    LogInfo("lens weights: {}", fmt::join(kinds, ", "));
  }
}

// Reports how many frames reached the requested noise, and with how many LF images.
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
  LogInfo("noise: {} of {} frames have at most the requested noise{}", met, measured, images);
}

// Counts the frames with lens weights whose badness exceeds the limit. If there are any, calls
// `warn` with the count and the worst frame.
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

// Returns what a frame shows for the part of its lens that is beyond the LF cameras.
std::string LightBeyondCapture(const FrameReport& frame) {
  constexpr const char* kCutOff =
      "This part gets no rays, and the bokeh (blur disks) are cut off there. ";
  const double interpolated = frame.interpolated_share.value_or(0);
  const double uncovered = frame.weighed->coverage.uncovered_share;
  if (interpolated == 0) return kCutOff;
  std::string words = fmt::format(
      "The light of the nearest LF cameras stands for this part, in {:.0f} % of the picture. Blur "
      "is as strong as that of the whole lens, but blur disks keep the shape of the capture. ",
      100 * interpolated);
  if (uncovered - interpolated > kMuchUncovered)
    words += fmt::format(
        "About {:.0f} % of the lens are too far from all LF cameras, and bokeh are cut off there. ",
        100 * (uncovered - interpolated));
  return words;
}

void WarnOfLenses(const RenderReport& report) {
  constexpr double kFewImages = 3.95;
  WarnOfFrames(
      report, kMuchUncovered, [](const auto& weighed) { return weighed.coverage.uncovered_share; },
      [&](size_t count, const FrameReport& worst) {
        const LensCoverage& coverage = worst.weighed->coverage;
        double fitting_w = coverage.fitting_diameter_w;  // becomes the smallest of all frames
        for (const FrameReport& frame : report.frames)
          if (frame.weighed)
            fitting_w = std::min(fitting_w, frame.weighed->coverage.fitting_diameter_w);
        LogWarning(
            "in {} of {} frames a part of the lens is beyond the LF cameras, most of all in frame "
            "{}: {:.0f} %. {}{}a camera nearer to the middle of the capture would help",
            count, report.frames.size(), worst.frame.value, 100 * coverage.uncovered_share,
            LightBeyondCapture(worst),
            fitting_w > 0 ? fmt::format("An aperture of at most {:.4g} world units, or ", fitting_w)
                          : "Only ");
      });
  // Frames with hat weights (interpolation between LF images) always use few LF images, and frames
  // that no LF image sees are black. Both are reported elsewhere and left out here.
  WarnOfFrames(
      report, -kFewImages,
      [](const auto& weighed) {
        const bool is_told = weighed.hat_share == 1 || weighed.effective_count == 0;
        return is_told ? -INFINITY : -weighed.effective_count;
      },
      [&](size_t count, const FrameReport& worst) {
        LogWarning(
            "{} of {} frames are made of fewer than {:.0f} LF images (an LF image of little weight "
            "counts less), fewest in frame {}: {:.1f}. Expect noise, and double edges out of "
            "focus; a wider aperture collects more LF images",
            count, report.frames.size(), kFewImages, worst.frame.value,
            worst.weighed->effective_count);
      });
}

}  // namespace

void SummariseRender(const RenderReport& report, const std::string& look_at,
                     bool weights_are_chosen) {
  const uint64_t rays = report.AcceptedRays();
  const std::string collected =
      rays == 0 && report.rebinning
          ? ""
          : fmt::format("{}rays, {:.3g} M/s per core, ", ShortNumber(static_cast<double>(rays)),
                        report.MraysPerSecondPerCore());
  LogInfo(
      "{} frame{} {}x{} in {}: {}{} of {} LF images{}, peak memory {} MiB", report.frames.size(),
      report.frames.size() == 1 ? "" : "s", report.width, report.height,
      ShortDuration(report.total_s), collected,
      report.selected_image_count - std::min(report.selected_image_count, report.skipped.size()),
      report.lf_image_count,
      report.selected_virtual_count > 0
          ? fmt::format(" and {} virtual ones", report.selected_virtual_count)
          : "",
      report.peak_memory_bytes >> 20);
  TellRebinning(report);
  TellVirtualLight(report);
  TellLensWeights(report, weights_are_chosen);
  TellNoise(report);
  WarnOfEmptyElements(report);
  WarnOfLenses(report);
  LogInfo("see {}", look_at);
}

Error WithResumeCommand(Error error, int argc, char** argv) {
  if (error.kind != ErrorKind::kInterrupted) return error;
  const std::vector<std::string> call(argv, argv + argc);
  error.message += "; continue with: " + SameCall(call, {"--resume"}, {"--overwrite"});
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
                  : fmt::format("frame {} ({} rays in 99 % of them)", frame.frame.value,
                                frame.samples->measured.most_have);
  }
  if (count == 0) return {};
  return Error{
      ErrorKind::kBelowRequired,
      fmt::format(
          "--require samples>={}: {} of {} frames have so many rays in less than 99 % of the "
          "elements that LF images see: {}{}; more LF images or a wider aperture give more",
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
                                  : std::string("not measurable with fewer than two LF images"));
  }
  if (count == 0) return {};
  return Error{
      ErrorKind::kBelowRequired,
      fmt::format("--require noise<={}: {} of {} frames have more noise in over 10 % of the "
                  "elements that LF images see: {}{}; a wider aperture or more LF images reduce it",
                  *noise, count, report.frames.size(), frames, count > kNamed ? ", ..." : "")};
}

Result<void> OutcomeOf(const RenderReport& report, const FilmSettings& film,
                       const AllowMissing& allow_missing, const MissingImages& densify) {
  Result<void> required = CheckRequired(report, film.require.samples);
  if (required) required = CheckRequiredNoise(report, film.require.noise);
  LF_ASSIGN_OR_RETURN(const MissingLimit limit, allow_missing.Limit());
  LF_RETURN_IF_ERROR(EndOfRender(report, limit, required));
  return EndWithMissing(densify, limit);
}

}  // namespace lf
