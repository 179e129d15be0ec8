#include "lf/pipeline/check_render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/collector/frame_lens.h"
#include "lf/core/geometry.h"
#include "lf/pipeline/check_outputs.h"

namespace lf {
namespace {

// Checks that all frames look about along --slab-forward: only rays in about this direction cut the
// st plane of the slab before the uv plane.
Result<void> CheckSlab(const Package& package, const RenderOptions& options,
                       const std::vector<FrameId>& frames) {
  constexpr double kMost_deg = 60;
  if (options.mode == RenderMode::kCollect || !options.rebin.slab.forward_world) return {};
  const Vec3 forward = options.rebin.slab.forward_world->normalized();
  for (const FrameId frame : frames) {
    const double cosine = forward.dot(package.path.Camera(frame).pinhole.ForwardWorld());
    const double off_deg = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / kPi;
    if (off_deg > kMost_deg)
      return UsageError(fmt::format(
          "--slab-forward {} {} {}: frame {} looks {:.0f} degrees away from it; expected "
          "a direction within {:.0f} degrees of what all frames look along",
          forward.x(), forward.y(), forward.z(), frame.value, off_deg, kMost_deg));
  }
  return {};
}

}  // namespace

Result<void> CheckRenderOptions(const Package& package, const RenderOptions& options) {
  const std::vector<FrameId> frames = options.frames.empty() ? package.FrameIds() : options.frames;
  if (options.mode == RenderMode::kRebin && (options.CountsRays() || options.keep_plates))
    return UsageError(
        "--mode rebin: frames are not made of collected rays, so that \"samples>=N\" of "
        "--stop-when "
        "and --require, --smooth-below and --keep-plates have none: leave them out, or use hybrid "
        "(\"noise<=X\" goes with every mode)");
  LF_RETURN_IF_ERROR(CheckOutputs(package, options));
  LF_RETURN_IF_ERROR(CheckOpacity(package.light_field.encoding, options.mode));
  LF_RETURN_IF_ERROR(CheckSlab(package, options, frames));
  if (Rebins(options.mode) && !package.choices.has_neighbours)
    return UsageError(fmt::format(
        "--mode {}: {} was made by lfpreprocessor --lens-weights none, and lacks the LF cameras "
        "beside the lens: make it again with --mode {}, or without --lens-weights none",
        NameOf(options.mode), package.name, NameOf(options.mode)));
  if (Rebins(options.mode) && (options.max_image_count || package.choices.max_image_count))
    return UsageError(
        fmt::format("--max-images: with --mode {} rebinned rays are shared by frames, so that no "
                    "limit of each frame's LF images can be kept: leave it out, or use --mode "
                    "collect",
                    NameOf(options.mode)));
  const std::optional<size_t>& most = package.choices.max_image_count;
  if (most && (!options.max_image_count || *options.max_image_count > *most))
    return UsageError(fmt::format(
        "{}: was made with --max-images {}, and has no more of each frame", package.name, *most));
  if (!options.finish_early.empty() && (options.shard || !options.resume))
    return UsageError(
        "--finish: finishes frames with the rays that a state has: give --resume, and leave out "
        "--shard, whose parts would end at different LF images");
  if (options.shard &&
      (options.mode != RenderMode::kCollect || options.stop_at_samples || options.require_samples ||
       options.MeasuresNoise() || options.keep_plates || options.video))
    return UsageError(
        "--shard: writes plates for lfmerge, of a part of the LF images, and no shard knows what "
        "the others have: leave out --mode rebin and hybrid, --stop-when, --require, --keep-plates "
        "and --video (lfmerge has one)");
  if (options.rebin.nearest > 0 && options.back_end != CollectBackEnd::kReference)
    return UsageError(
        "--nearest: only by the k-d tree of --back-end reference, which is far slower: give that, "
        "or leave it out");
  if (options.CountsRays() && options.reading.estimator == Estimator::kBilinear &&
      options.reading.filter == PixelFilter::kMosaic)
    return UsageError(
        "--filter mosaic: rays count up to 8 times, so that \"samples>=N\" of --stop-when and "
        "--require, and --smooth-below, have none to count: leave them out, or use bilinear "
        "(\"noise<=X\" goes with every filter)");
  if (options.lens_weights == LensWeights::kNone) return {};
  const char* const name = NameOf(options.lens_weights);
  if (!package.choices.has_neighbours)
    return UsageError(
        fmt::format("--lens-weights {}: {} was made with --lens-weights none, and lacks the LF "
                    "cameras beside the lens: give none, or make it again",
                    name, package.name));
  if (options.CountsRays())
    return UsageError(
        fmt::format("--lens-weights {}: counts are sums of weights, so that \"samples>=N\" of "
                    "--stop-when and --require, and --smooth-below, have no rays to count: leave "
                    "them out (\"noise<=X\" goes with lens weights)",
                    name));
  if (options.lens_weights == LensWeights::kArea)
    for (const FrameId frame : frames)
      LF_RETURN_IF_ERROR(CheckHasArea(package.path.Camera(frame), frame));
  return {};
}

}  // namespace lf
