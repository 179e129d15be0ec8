// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/render_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "lf/core/byte_text.h"
#include "lf/render/hybrid/frame_pixels.h"
#include "lf/render/hybrid/rebinned_rays.h"

namespace lf {
namespace {

constexpr size_t kMiB = size_t{1} << 20;
// More memory than any machine has. Nothing that is counted here comes near to it.
constexpr size_t kMostMemory = size_t{1} << 50;

// Returns the least number of MiB, above `low` and at most kMostMemory, that suffices; 0 if none
// does.
template <class Suffices>
size_t LeastMebibytes(size_t low, const Suffices& suffices) {
  size_t high = std::max<size_t>(1, 2 * low);
  while (!suffices(high)) {
    if (high > kMostMemory / kMiB) return 0;
    low = high;
    high *= 2;
  }
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    (suffices(middle) ? high : low) = middle;
  }
  return high;
}

// Divides different amounts of memory for the same render.
class MemoryDivider {
 public:
  explicit MemoryDivider(const RenderMemoryNeed& need) : need_(need) {
    const bool are_pixels = need.interpolation == RayInterpolation::kPixels;
    if (!Rebins(need.mode)) return;
    bytes_per_ray_ = are_pixels
                         ? FramePixels::BytesPerPixel(need.light_field.encoding,
                                                      need.reading.estimator, need.is_guarded)
                         : RebinnedRays::kBytesPerCell;
    // The number of rays must not depend on the reference images, because frames depend on it.
    const Result<MemoryPlan> roomy = Plan(kMostMemory, {});
    if (!roomy) return;
    least_beside_rays_ = roomy->least_bytes;
    fixed_bytes_ = are_pixels ? FramePixels::FixedBytes(
                                    need.light_field, bytes_per_ray_, need.thread_count,
                                    static_cast<size_t>(need.plate_width) * need.plate_height,
                                    Collects(need.mode), *roomy)
                              : RebinnedRays::BytesOf(0);
  }

  // Returns the memory of this number of rays, with all that their use takes.
  size_t BytesOf(size_t ray_count) const {
    return fixed_bytes_ + (KeepsPixels() ? FramePixels::BytesOf(ray_count, bytes_per_ray_)
                                         : ray_count * bytes_per_ray_);
  }

  Result<RenderMemory> Divide(size_t memory_bytes) const {
    RenderMemory memory;
    if (Rebins(need_.mode)) LF_RETURN_IF_ERROR(SetAsideForRays(memory_bytes, &memory));
    LF_ASSIGN_OR_RETURN(memory.plan, Plan(memory_bytes - memory.rebin_bytes, need_.references));
    // With kRebin, which rays are kept depends on the frames of a pass, but must not depend on
    // whether noise is measured. If noise is not measured, all frames are in one pass. If it is
    // measured, all frames must therefore fit in one pass.
    if (NeedsAllPlates() && memory.plan.frames_per_pass < need_.frame_count)
      return OutputError("there is no room for the plates of all frames");
    if (!Collects(need_.mode)) memory.plan.frames_per_pass = need_.frame_count;
    if (KeepsPixels()) ShareBatches(&memory.plan);
    return memory;
  }

  // Returns the least memory of which plan_bytes are left beside the rays.
  size_t MemoryFor(size_t plan_bytes) const {
    if (plan_bytes == 0 || !Rebins(need_.mode)) return plan_bytes;
    if (need_.max_cells > 0) return plan_bytes + BytesOf(need_.max_cells);
    return kMiB * LeastMebibytes(0, [&](size_t mebibytes) {
             RenderMemory memory;
             return SetAsideForRays(mebibytes * kMiB, &memory) &&
                    mebibytes * kMiB - memory.rebin_bytes >= plan_bytes;
           });
  }

  // Returns the error for a memory that does not suffice. Names one that suffices for everything,
  // whatever it is that does not fit.
  Error TooSmall(size_t memory_bytes, size_t enough_mebibytes, bool fewer_fit,
                 bool one_frame_fits) const {
    const size_t count = std::max(need_.max_cells, RebinSettings::kLeastCells);
    return OutputError(fmt::format(
        "{{memory {}}} is too small for {{mode {}}}: the sums of a frame of {} x {} elements and "
        "two LF images take {}, and {} {} take {}{}: give {{memory {}M}}{}{}",
        ByteText(memory_bytes), NameOf(need_.mode), need_.plate_width, need_.plate_height,
        ByteText(least_beside_rays_), count, KeepsPixels() ? "kept pixels" : "rebinned rays",
        ByteText(BytesOf(count)),
        NeedsAllPlates()
            ? fmt::format("; \"noise<=X\" needs the plates of {} frames at once", need_.frame_count)
            : "",
        enough_mebibytes, fewer_fit ? ", or reduce {max_rays}" : "",
        one_frame_fits ? ", or render fewer {frames} at a time" : ""));
  }

 private:
  bool KeepsPixels() const {
    return Rebins(need_.mode) && need_.interpolation == RayInterpolation::kPixels;
  }
  bool NeedsAllPlates() const { return !Collects(need_.mode) && HasPlates(); }
  bool HasPlates() const { return Collects(need_.mode) || need_.measured_bytes > 0; }

  Result<MemoryPlan> Plan(size_t memory_bytes, const ReferenceNeed& references) const {
    return PlanMemory(memory_bytes, need_.light_field, need_.reading, need_.plate_width,
                      need_.plate_height, HasPlates() ? need_.frame_count : 1, need_.thread_count,
                      need_.measured_bytes, need_.is_guarded, need_.instants, need_.surface,
                      references);
  }

  Result<void> SetAsideForRays(size_t memory_bytes, RenderMemory* memory) const {
    const size_t part = memory_bytes / (need_.mode == RenderMode::kRebin ? 2 : 4);
    size_t count = need_.max_cells;
    if (count == 0 && KeepsPixels()) {
      // The least memory of rays, plates and LF images is set aside first, so that small memories
      // suffice. The rest is divided, because more LF images in a batch save time.
      const size_t least = least_beside_rays_ + fixed_bytes_;
      const size_t rest = memory_bytes - std::min(memory_bytes, least);
      count =
          std::max(RebinSettings::kLeastCells, std::min(part, rest / 2) / 17 * 16 / bytes_per_ray_);
    } else if (count == 0) {
      count = (part - std::min(part, fixed_bytes_)) / bytes_per_ray_;
    }
    memory->max_cells = count;
    memory->rebin_bytes = BytesOf(count);
    if (count >= RebinSettings::kLeastCells && memory->rebin_bytes <= memory_bytes) return {};
    return OutputError("there is no room for the rays");
  }

  // Divides the memory of the batches between LF images that are read, and those that are made of
  // kept pixels; frames are made of the latter while a batch of the former is in memory.
  void ShareBatches(MemoryPlan* plan) const {
    const size_t count = plan->batch_image_count;
    plan->kept_batch_image_count = std::max<size_t>(1, count / 4);
    plan->batch_image_count = count - count / 4;
    // While a frame is made, those before it wait with the plates that kept pixels gave them, and
    // hybrids also with what completes them, and then are developed together.
    size_t waiting_bytes = plan->plate_bytes;
    if (Collects(need_.mode))
      waiting_bytes +=
          FramePixels::CompletionBytes(static_cast<size_t>(need_.plate_width) * need_.plate_height);
    plan->frames_finished_at_once =
        std::min(plan->frames_finished_at_once, 1 + (plan->batches_bytes - plan->plan_bytes) * 3 /
                                                        4 / (plan->develop_bytes + waiting_bytes));
    plan->plan_bytes = plan->plan_bytes / count * plan->batch_image_count;
  }

  const RenderMemoryNeed& need_;
  size_t bytes_per_ray_ = 0;
  size_t fixed_bytes_ = 0;
  size_t least_beside_rays_ = 0;
};

}  // namespace

Result<RenderMemory> PlanRenderMemory(size_t memory_bytes, const RenderMemoryNeed& need) {
  const MemoryDivider divider(need);
  Result<RenderMemory> memory = divider.Divide(memory_bytes);
  const auto suffices = [&divider](size_t mebibytes) {
    return static_cast<bool>(divider.Divide(mebibytes * kMiB));
  };
  if (memory) {
    memory->enough_bytes = divider.MemoryFor(memory->plan.enough_bytes);
    memory->least_bytes = kMiB * LeastMebibytes(0, suffices);
    return memory;
  }
  if (!Rebins(need.mode)) return memory.error();
  const size_t enough = LeastMebibytes(memory_bytes / kMiB, suffices);
  if (enough == 0) return memory.error();
  RenderMemoryNeed fewer = need, one_frame = need;
  fewer.max_cells = RebinSettings::kLeastCells;
  one_frame.frame_count = 1;
  const auto fits = [memory_bytes](const RenderMemoryNeed& other) {
    return static_cast<bool>(MemoryDivider(other).Divide(memory_bytes));
  };
  return divider.TooSmall(memory_bytes, enough,
                          need.max_cells > RebinSettings::kLeastCells && fits(fewer),
                          need.frame_count > 1 && fits(one_frame));
}

const FocalSurface* LargestSurface(const CameraPath& path, std::span<const FrameId> frames) {
  const FocalSurface* largest = nullptr;
  for (const FrameId frame : frames)
    for (const RenderCamera& camera : path.Instants(frame))
      if (camera.surface &&
          (largest == nullptr || camera.surface->row_count() > largest->row_count()))
        largest = camera.surface.get();
  return largest;
}

}  // namespace lf
