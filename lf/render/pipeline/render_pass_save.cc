// SPDX-License-Identifier: Apache-2.0
// The parts of RenderPass that write checkpoints.
#include <algorithm>
#include <functional>

#include "lf/core/log.h"
#include "lf/render/pipeline/render_pass.h"

namespace lf {
namespace {

// Largest share of the time that checkpoints may spend on pictures: half of the share that
// checkpoints may take altogether (dump_clock.h).
constexpr double kPictureShare = DumpClock::kMostShare / 2;
// Time for pictures after a signal to stop, in addition to the time for the plates.
constexpr double kLastPictures_s = 2;

}  // namespace

// Saves the plates, then the rebinned rays, then pictures of unfinished frames. Those pictures that
// were written longest ago come first; no picture is begun after picture_budget_s.
Result<void> RenderPass::Save(double picture_budget_s) {
  LF_RETURN_IF_ERROR(context_.state.SaveTotals(Totals()));
  for (size_t f = 0; f < saved_.size(); ++f) {
    const FrameProgress progress = renderer_.Progress(f);
    if (renderer_.IsReleased(f) || progress.places_done == saved_[f].places) continue;
    if (context_.setup.film().HasPlates())
      LF_RETURN_IF_ERROR(context_.state.SavePlate(renderer_.id(f), progress, renderer_.plate(f),
                                                  context_.setup.pool(), renderer_.moments(f)));
    saved_[f].places = progress.places_done;
  }
  LF_RETURN_IF_ERROR(SaveRays());
  return SavePictures(picture_budget_s);
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

Result<void> RenderPass::SavePictures(double picture_budget_s) {
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
  if (const Result<void> saved = Save(kLastPictures_s); !saved) return saved.error();
  return {ErrorKind::kInterrupted, "interrupted"};
}

}  // namespace lf
