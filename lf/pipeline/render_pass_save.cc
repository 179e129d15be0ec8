// Checkpoints of a pass.
#include <algorithm>
#include <functional>

#include "lf/core/log.h"
#include "lf/pipeline/render_pass.h"

namespace lf {
namespace {

// Share of the time for pictures in checkpoints: half of the share of checkpoints (dump_clock.h).
constexpr double kPictureShare = DumpClock::kMostShare / 2;
// Time for pictures after a signal to end, when the plates are saved.
constexpr double kLastPictures_s = 2;

}  // namespace

// Saves plates first, then pictures, the oldest first, as many as the time allows.
Result<void> RenderPass::Save(double picture_budget_s) {
  LF_RETURN_IF_ERROR(job_.state.SaveTotals(Totals()));
  for (size_t f = 0; f < frames_.size(); ++f) {
    Frame& frame = frames_[f];
    const FrameProgress progress = ProgressOf(f);
    if (frame.is_finished || progress.places_done == frame.saved_places) continue;
    if (job_.HasPlates())
      LF_RETURN_IF_ERROR(job_.state.SavePlate(frame.id, progress, plates_[f], job_.pool,
                                              frame.has_noise ? &moments_[f] : nullptr));
    frame.saved_places = progress.places_done;
  }
  LF_RETURN_IF_ERROR(SaveRays());
  return SavePictures(picture_budget_s);
}

Result<void> RenderPass::SaveRays() {
  if (!rebinned_) return {};
  for (size_t i = 0; i < rebinned_->section_count(); ++i) {
    const uint32_t places_done = rebinned_->places_done(i);
    if (places_done == saved_rays_places_[i]) continue;
    LF_RETURN_IF_ERROR(job_.state.SaveRays(frames_.front().id, i, rays_frames_, rebinned_->map(i),
                                           places_done, job_.pool));
    saved_rays_places_[i] = places_done;
  }
  return {};
}

Result<void> RenderPass::SavePictures(double picture_budget_s) {
  std::vector<size_t> oldest_first;
  for (size_t f = 0; f < frames_.size(); ++f)
    if (!frames_[f].is_finished && frames_[f].saved_places > 0) oldest_first.push_back(f);
  std::stable_sort(oldest_first.begin(), oldest_first.end(), [this](size_t a, size_t b) {
    return frames_[a].picture_s < frames_[b].picture_s;
  });
  const double begin_s = NowSeconds();
  // A signal to end may interrupt these pictures. If it came before, they are the last ones, and
  // the time may interrupt even the first, which may take minutes.
  std::function<bool()> is_interrupted = [this] { return job_.IsStopped(); };
  if (job_.IsStopped()) is_interrupted = [=] { return NowSeconds() - begin_s >= picture_budget_s; };
  for (const size_t f : oldest_first) {
    if (NowSeconds() - begin_s >= picture_budget_s) break;
    Frame& frame = frames_[f];
    const std::vector<Completion> completion = Complete({&f, 1});
    const Result<FrameReport> written =
        WritePicture(f, completion.empty() ? nullptr : completion.data(),
                     job_.state.PicturePath(frame.id), is_interrupted);
    // The state that is written after the signal writes its own pictures.
    if (!written && written.error().kind == ErrorKind::kInterrupted) return {};
    LF_RETURN_IF_ERROR(written);
    frame.picture_s = NowSeconds();
  }
  return {};
}

Result<void> RenderPass::SaveWhenDue() {
  const double begin_s = NowSeconds();
  if (!job_.clock.IsDue(begin_s)) return {};
  LF_RETURN_IF_ERROR(Save(kPictureShare * (begin_s - job_.clock.last_s())));
  LogDebug("checkpoint after {} of {} LF images: {:.2f} s", done_.image_count, images_.size(),
           NowSeconds() - begin_s);
  if (job_.clock.Done(begin_s, NowSeconds()))
    LogInfo(
        "a checkpoint took {:.1f} s: the next one follows after {:.0f} s, so that they cost no "
        "more than {:.0f} % of the time",
        NowSeconds() - begin_s, job_.clock.interval_s(), 100 * DumpClock::kMostShare);
  return {};
}

Error RenderPass::Interrupt() {
  LogInfo("interrupted: writing the state");
  if (const Result<void> saved = Save(kLastPictures_s); !saved) return saved.error();
  return {ErrorKind::kInterrupted, "interrupted; the state is kept"};
}

}  // namespace lf
