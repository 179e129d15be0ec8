// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/render_memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/core/byte_text.h"
#include "lf/render/hybrid/frame_pixels.h"
#include "lf/render/hybrid/rebinned_rays.h"

namespace lf {
namespace {

// Upper bound of the memory for rays that are kept.
size_t BytesOfRays(RayInterpolation interpolation, size_t count) {
  return interpolation == RayInterpolation::kPixels ? FramePixels::BytesOf(count)
                                                    : RebinnedRays::BytesOf(count);
}

Result<void> SetAsideForRays(size_t memory_bytes, RenderMode mode, RayInterpolation interpolation,
                             size_t max_cells, RenderMemory* memory) {
  const size_t parts = mode == RenderMode::kRebin ? 2 : 4;
  const size_t part = memory_bytes / parts;
  const size_t given = max_cells;
  const bool are_pixels = interpolation == RayInterpolation::kPixels;
  if (max_cells == 0)
    max_cells = (part - std::min(part, BytesOfRays(interpolation, 0))) /
                (are_pixels ? FramePixels::kBytesPerPixel : RebinnedRays::kBytesPerCell);
  memory->max_cells = max_cells;
  memory->rebin_bytes = BytesOfRays(interpolation, max_cells);
  if (max_cells >= RebinSettings::kLeastCells && memory->rebin_bytes <= memory_bytes) return {};
  const size_t wanted = std::max(max_cells, RebinSettings::kLeastCells);
  const bool fewer_fit = wanted > RebinSettings::kLeastCells &&
                         BytesOfRays(interpolation, RebinSettings::kLeastCells) <= memory_bytes;
  const size_t enough = BytesOfRays(interpolation, wanted) * (given == 0 ? parts : 1);
  return OutputError(fmt::format(
      "{{memory {}}} is too small for {} {}, which take {} MiB: increase {{memory}} to more than "
      "{} "
      "MiB{}{}",
      ByteText(memory_bytes), wanted, are_pixels ? "kept pixels" : "rebinned rays",
      BytesOfRays(interpolation, wanted) >> 20, enough >> 20,
      fewer_fit ? ", or reduce {max_rays}" : "",
      given == 0
          ? " (without {max_rays}, half of {memory} is for rays, or a quarter with {mode hybrid})"
          : ""));
}

// Returns the least memory of which plan_bytes are left beside the rays.
size_t MemoryFor(size_t plan_bytes, RenderMode mode, RayInterpolation interpolation,
                 size_t max_cells) {
  if (plan_bytes == 0 || !Rebins(mode)) return plan_bytes;
  if (max_cells > 0) return plan_bytes + BytesOfRays(interpolation, max_cells);
  return mode == RenderMode::kRebin ? 2 * plan_bytes : plan_bytes + (plan_bytes + 2) / 3;
}

}  // namespace

Result<RenderMemory> PlanRenderMemory(size_t memory_bytes, RenderMode mode,
                                      RayInterpolation interpolation, size_t max_cells,
                                      const LightField& light_field, const RayReading& reading,
                                      int plate_width, int plate_height, size_t frame_count,
                                      int thread_count, size_t measured_bytes, bool is_guarded,
                                      size_t instants, const FocalSurface* surface,
                                      const ReferenceNeed& references) {
  RenderMemory memory;
  const bool has_plates = Collects(mode) || measured_bytes > 0;
  if (Rebins(mode))
    LF_RETURN_IF_ERROR(SetAsideForRays(memory_bytes, mode, interpolation, max_cells, &memory));
  const Result<MemoryPlan> plan =
      PlanMemory(memory_bytes - memory.rebin_bytes, light_field, reading, plate_width, plate_height,
                 has_plates ? frame_count : 1, thread_count, measured_bytes, is_guarded, instants,
                 surface, references);
  if (!plan && memory.rebin_bytes > 0)
    return Error{
        plan.error().kind,
        fmt::format("{} (in addition to {} MiB for {} rays: increase {{memory}}, or reduce "
                    "{{max_rays}})",
                    plan.error().message, memory.rebin_bytes >> 20, memory.max_cells)};
  if (!plan) return plan.error();
  memory.plan = *plan;
  memory.enough_bytes = MemoryFor(plan->enough_bytes, mode, interpolation, max_cells);
  // With kRebin, which rays are kept depends on the frames of a pass, but must not depend on
  // whether noise is measured. If noise is not measured, all frames are in one pass. If it is
  // measured, all frames must therefore fit in one pass.
  if (!Collects(mode) && has_plates && plan->frames_per_pass < frame_count)
    return OutputError(fmt::format(
        "{{mode rebin}}: \"noise<=X\" needs a plate of {} MiB for each frame, but {{memory {}}} "
        "has room for only {} of {} plates (in addition to {} MiB for {} rays): increase "
        "{{memory}}, reduce {{max_rays}}, or render fewer {{frames}} at a time",
        plan->plate_bytes >> 20, ByteText(memory_bytes), plan->frames_per_pass, frame_count,
        memory.rebin_bytes >> 20, memory.max_cells));
  if (!Collects(mode)) memory.plan.frames_per_pass = frame_count;
  return memory;
}

}  // namespace lf
