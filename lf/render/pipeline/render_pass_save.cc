// SPDX-License-Identifier: Apache-2.0
// The parts of RenderPass that write checkpoints.
#include <algorithm>
#include <atomic>
#include <functional>
#include <vector>

#include "lf/core/log.h"
#include "lf/render/pipeline/render_pass.h"

namespace lf {
namespace {

// Largest share of the time that checkpoints may spend on pictures: half of the share that
// checkpoints may take altogether (dump_clock.h).
constexpr double kPictureShare = DumpClock::kMostShare / 2;
// Time for the plates and pictures after a signal to stop. The plates are written even if they take
// longer; no picture is begun then.
constexpr double kLastSave_s = 1;
// One plate is compressed while the disk takes the other. More would need more memory.
constexpr size_t kPlatesAtOnce = 2;

}  // namespace

// Saves the rays of all frames, then pictures of unfinished frames.
Result<void> RenderPass::Save(double picture_budget_s) {
  LF_RETURN_IF_ERROR(SaveAllRays());
  return SavePictures(picture_budget_s);
}

// Saves the plates, then the rebinned rays.
Result<void> RenderPass::SaveAllRays() {
  LF_RETURN_IF_ERROR(context_.state.SaveTotals(Totals()));
  std::vector<size_t> changed;
  for (size_t f = 0; f < saved_.size(); ++f)
    if (!renderer_.IsReleased(f) && renderer_.Progress(f).places_done != saved_[f].places)
      changed.push_back(f);
  if (context_.setup.film().HasPlates()) LF_RETURN_IF_ERROR(SavePlates(changed));
  for (const size_t f : changed) saved_[f].places = renderer_.Progress(f).places_done;
  return SaveRays();
}

Result<void> RenderPass::SavePlates(std::span<const size_t> frames) {
  ThreadPool& pool = context_.setup.pool();
  std::atomic<size_t> next = 0;
  std::vector<Result<void>> saved(frames.size());
  pool.ForEach(std::min(kPlatesAtOnce, frames.size()), [&](size_t) {
    for (size_t i = next++; i < frames.size(); i = next++) {
      const size_t f = frames[i];
      saved[i] = context_.state.SavePlate(renderer_.id(f), renderer_.Progress(f),
                                          renderer_.plate(f), pool, renderer_.moments(f));
      if (!saved[i]) next = frames.size();
    }
  });
  for (const Result<void>& one : saved) LF_RETURN_IF_ERROR(one);
  return {};
}

Result<void> RenderPass::SaveRays() {
  const RebinnedRays* const rebinned = renderer_.rebinned();
  for (size_t i = 0; i < saved_rays_places_.size(); ++i) {
    const uint32_t places_done = rebinned->places_done(i);
    if (places_done == saved_rays_places_[i]) continue;
    LF_RETURN_IF_ERROR(context_.state.SaveRays(renderer_.id(0), i, rays_frames_, rebinned->map(i),
                                               places_done, context_.setup.pool()));
    saved_rays_places_[i] = places_done;
  }
  return {};
}

// Saves pictures of unfinished frames. Those that were written longest ago come first; no picture
// is begun after picture_budget_s.
Result<void> RenderPass::SavePictures(double picture_budget_s) {
  if (picture_budget_s <= 0) return {};
  std::vector<size_t> oldest_first;
  for (size_t f = 0; f < saved_.size(); ++f)
    if (!renderer_.IsReleased(f) && saved_[f].places > 0) oldest_first.push_back(f);
  std::stable_sort(oldest_first.begin(), oldest_first.end(), [this](size_t a, size_t b) {
    return saved_[a].picture_s < saved_[b].picture_s;
  });
  const double begin_s = NowSeconds();
  // A signal to stop may interrupt these pictures. If the signal came before, these are the last
  // pictures, and each of them is interrupted when the time is over, because even the first may
  // take minutes.
  std::function<bool()> is_interrupted = [this] { return IsStopped(); };
  if (IsStopped()) is_interrupted = [=] { return NowSeconds() - begin_s >= picture_budget_s; };
  for (const size_t f : oldest_first) {
    if (NowSeconds() - begin_s >= picture_budget_s) break;
    const Result<FrameReport> written = WritePicture(
        f, renderer_.Complete(f), context_.state.PicturePath(renderer_.id(f)), is_interrupted);
    // Interrupt() saves the state after the signal, and then writes pictures again.
    if (!written && written.error().kind == ErrorKind::kInterrupted) return {};
    LF_RETURN_IF_ERROR(written);
    saved_[f].picture_s = NowSeconds();
  }
  return {};
}

Result<void> RenderPass::SaveWhenDue() {
  const double begin_s = NowSeconds();
  DumpClock& clock = context_.clock;
  if (!clock.IsDue(begin_s)) return {};
  LF_RETURN_IF_ERROR(Save(kPictureShare * (begin_s - clock.last_s())));
  LogDebug("checkpoint after {} of {} LF images: {:.2f} s", renderer_.progress().image_count,
           renderer_.images().size(), NowSeconds() - begin_s);
  if (clock.Done(begin_s, NowSeconds()))
    LogInfo(
        "a checkpoint took {:.1f} s: the next one follows after {:.0f} s, so that "
        "checkpoints take no more than {:.0f} % of the time",
        NowSeconds() - begin_s, clock.interval_s(), 100 * DumpClock::kMostShare);
  return {};
}

Error RenderPass::Interrupt() {
  LogInfo("interrupted: writing the state");
  const double begin_s = NowSeconds();
  Result<void> saved = SaveAllRays();
  if (saved) saved = SavePictures(kLastSave_s - (NowSeconds() - begin_s));
  if (!saved) return saved.error();
  return {ErrorKind::kInterrupted, "interrupted"};
}

}  // namespace lf
