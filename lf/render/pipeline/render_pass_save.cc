// SPDX-License-Identifier: Apache-2.0
// The parts of RenderPass that write checkpoints.
#include <algorithm>
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

}  // namespace

// Saves the rays of all frames, then pictures of unfinished frames.
Result<void> RenderPass::Save(double picture_budget_s) {
  if (!source_->CanSave()) return {};
  LF_RETURN_IF_ERROR(SaveAllRays());
  return SavePictures(picture_budget_s);
}

Result<void> RenderPass::SaveAllRays() {
  LF_RETURN_IF_ERROR(context_.state.SaveTotals(Totals()));
  return source_->Save(&context_.state);
}

// Saves pictures of unfinished frames. Those that were written longest ago come first; no picture
// is begun after picture_budget_s.
Result<void> RenderPass::SavePictures(double picture_budget_s) {
  if (picture_budget_s <= 0) return {};
  std::vector<size_t> oldest_first;
  for (size_t f = 0; f < pictures_s_.size(); ++f)
    if (!source_->IsReleased(f) && source_->Progress(f).ranks_done > 0) oldest_first.push_back(f);
  std::stable_sort(oldest_first.begin(), oldest_first.end(),
                   [this](size_t a, size_t b) { return pictures_s_[a] < pictures_s_[b]; });
  const double begin_s = NowSeconds();
  // A signal to stop may interrupt these pictures. If the signal came before, these are the last
  // pictures, and each of them is interrupted when the time is over, because even the first may
  // take minutes.
  std::function<bool()> is_interrupted = [this] { return IsStopped(); };
  if (IsStopped()) is_interrupted = [=] { return NowSeconds() - begin_s >= picture_budget_s; };
  for (const size_t f : oldest_first) {
    if (NowSeconds() - begin_s >= picture_budget_s) break;
    const Result<std::optional<Completion>> completion = source_->Complete(f, false);
    const Result<FrameReport> written =
        completion ? WritePicture(f, *completion, context_.state.PicturePath(source_->id(f)),
                                  is_interrupted)
                   : completion.error();
    source_->ForgetPicture(f);
    // Interrupt() saves the state after the signal, and then writes pictures again.
    if (!written && written.error().kind == ErrorKind::kInterrupted) return {};
    LF_RETURN_IF_ERROR(written);
    pictures_s_[f] = NowSeconds();
  }
  return {};
}

Result<void> RenderPass::SaveWhenDue() {
  const double begin_s = NowSeconds();
  DumpClock& clock = context_.clock;
  if (!source_->CanSave() || !clock.IsDue(begin_s)) return {};
  LF_RETURN_IF_ERROR(Save(kPictureShare * (begin_s - clock.last_s())));
  LogDebug("checkpoint after {} of {} LF images: {:.2f} s", source_->progress().image_count,
           source_->images().size(), NowSeconds() - begin_s);
  if (clock.Done(begin_s, NowSeconds()))
    LogInfo(
        "a checkpoint took {:.1f} s: the next one follows after {:.0f} s, so that "
        "checkpoints take no more than {:.0f} % of the time",
        NowSeconds() - begin_s, clock.interval_s(), 100 * DumpClock::kMostShare);
  return {};
}

Error RenderPass::Interrupt() {
  if (!source_->CanSave()) return {ErrorKind::kInterrupted, "interrupted"};
  LogInfo("interrupted: writing the state");
  const double begin_s = NowSeconds();
  Result<void> saved = SaveAllRays();
  if (saved) saved = SavePictures(kLastSave_s - (NowSeconds() - begin_s));
  if (!saved) return saved.error();
  return {ErrorKind::kInterrupted, "interrupted"};
}

}  // namespace lf
