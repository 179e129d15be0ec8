// SPDX-License-Identifier: Apache-2.0
// The parts of FilmRenderer that write the rays of frames into a state, and report them.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "lf/core/log.h"
#include "lf/light_field/model/value_hasher.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/skipped_images.h"

namespace lf {
namespace {

// One plate is compressed while the disk takes the other. More would need more memory.
constexpr size_t kPlatesAtOnce = 2;

}  // namespace

// Returns a text that identifies the frames of a pass, because its rebinned rays depend on them.
std::string FilmRenderer::RaysFrames() const {
  ValueHasher numbers;
  for (const Frame& frame : frames_) numbers.Add(frame.id.value);
  return fmt::format("{} from {} to {} ({})", frames_.size(), frames_.front().id.value,
                     frames_.back().id.value, numbers.Text());
}

Result<void> FilmRenderer::Save(RunState* state) {
  std::vector<size_t> changed;
  for (size_t f = 0; f < frames_.size(); ++f)
    if (!IsReleased(f) && Progress(f).ranks_done != frames_[f].saved_ranks) changed.push_back(f);
  if (film_.HasPlates()) LF_RETURN_IF_ERROR(SavePlates(state, changed));
  for (const size_t f : changed) frames_[f].saved_ranks = Progress(f).ranks_done;
  return SaveRays(state);
}

Result<void> FilmRenderer::SavePlates(RunState* state, std::span<const size_t> frames) {
  ThreadPool& pool = setup_.pool();
  std::atomic<size_t> next = 0;
  std::vector<Result<void>> saved(frames.size());
  pool.ForEach(std::min(kPlatesAtOnce, frames.size()), [&](size_t) {
    for (size_t i = next++; i < frames.size(); i = next++) {
      const size_t f = frames[i];
      saved[i] = state->SavePlate(id(f), Progress(f), plate(f), pool, moments(f));
      if (!saved[i]) next = frames.size();
    }
  });
  for (const Result<void>& one : saved) LF_RETURN_IF_ERROR(one);
  return {};
}

Result<void> FilmRenderer::SaveRays(RunState* state) {
  if (pixels_ && pixels_->ranks_done() != saved_rays_ranks_[0]) {
    LF_RETURN_IF_ERROR(state->SaveKept(id(0), RaysFrames(), pixels_->kept(), pixels_->ranks_done(),
                                       setup_.pool()));
    saved_rays_ranks_[0] = pixels_->ranks_done();
  }
  for (size_t i = 0; rebinned_ && i < saved_rays_ranks_.size(); ++i) {
    const uint32_t ranks_done = rebinned_->ranks_done(i);
    if (ranks_done == saved_rays_ranks_[i]) continue;
    LF_RETURN_IF_ERROR(
        state->SaveRays(id(0), i, RaysFrames(), rebinned_->map(i), ranks_done, setup_.pool()));
    saved_rays_ranks_[i] = ranks_done;
  }
  return {};
}

void FilmRenderer::End(RunState* state) {
  if (pixels_) state->RemoveRays();
  if (pixels_ && pixels_->facts().is_full && film_.rebin.kept == KeptRays::kAll)
    LogWarning(
        "{{kept all}}: there was no room for all pixels that frames ask for, and only {:.1f} % of "
        "them are kept: increase {{max_rays}} or {{memory}}",
        100 * pixels_->facts().kept_share);
  if (!rebinned_) return;
  if (rebinned_->facts().is_full && film_.rebin.kept == KeptRays::kAll)
    LogWarning(
        "{{kept all}}: there was no room for the cells of all rays, and some of them were dropped: "
        "increase {{max_rays}} or {{memory}}");
  if (rebinned_->facts().is_too_coarse)
    LogWarning(
        "some cells of rebinned rays are so wide that they got more LF pixels than they can "
        "hold, so that rays were lost: make {{r_st}} or {{r_uv}} smaller");
  state->RemoveRays();
}

void FilmRenderer::AddTo(RenderReport* totals) const {
  totals->load_cpu_s += times().load_cpu_s;
  totals->load_wall_s += times().load_wall_s;
  totals->collect_cpu_s += times().collect_cpu_s;
  if (pixels_) {
    const FramePixels::Facts facts = pixels_->facts();
    totals->AddRebinning({.looked_at_count = facts.looked_at,
                          .cpu_s = facts.cpu_s,
                          .kept = facts.is_full     ? "some"
                                  : facts.keeps_all ? "all"
                                                    : "edges",
                          .pixels = RebinReport::Pixels{facts.pixel_count, facts.kept_share}});
  }
  if (!rebinned_) return;
  const RebinnedRays::Facts facts = rebinned_->facts();
  totals->AddRebinning({.slab_count = facts.section_count,
                        .cell_count = facts.cell_count,
                        .looked_at_count = facts.looked_at,
                        .cpu_s = facts.cpu_s,
                        .kept = facts.is_full     ? "some"
                                : facts.keeps_all ? "all"
                                                  : "edges"});
}

Result<void> FilmRenderer::WritePlateOf(size_t f, const std::filesystem::path& path,
                                        const RunState& state, PlateNotes notes,
                                        std::span<const SkippedImage> skipped) const {
  FrameProgress progress = Progress(f);
  progress.ranks_done = RankOfEnd(f);  // must not depend on the division into passes
  // A plate that was collected from kept pixels is not the one whose noise is measured.
  if (CollectsKept()) progress.rays = frames_[f].kept_rays;
  PlateEntries text = state.PlateText(id(f), progress, CollectsKept() ? nullptr : moments(f));
  std::vector<const FrameLens*> of_frame;
  for (const FrameLens& lens : lenses(f)) of_frame.push_back(&lens);
  if (const FrameLens* const all = all_lens(f)) of_frame.push_back(all);
  std::vector<const GapLens*> gaps;
  for (const GapLens& gap : frames_[f].gaps) gaps.push_back(&gap);
  notes.skipped = SkippedOf(skipped, setup_.index(),
                            {std::move(of_frame),
                             std::move(gaps),
                             {0, progress.ranks_done},
                             setup_.Select().reach,
                             film_.shard});
  notes.skipped_count = notes.skipped.size();
  for (auto& entry : TextOf(notes)) text.push_back(std::move(entry));
  if (film_.shard) text.emplace_back("shard", film_.shard->Text());
  return WritePlate(path, text, PictureOf(f), setup_.pool(), GapsOf(f));
}

}  // namespace lf
