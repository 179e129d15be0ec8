// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/render_pass.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "lf/core/log.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/state/run_inputs.h"

namespace lf {
RenderPass::RenderPass(const PassContext& context, std::unique_ptr<FrameSource> source,
                       std::span<const FrameId> early)
    : context_(context),
      early_(early.begin(), early.end()),
      source_(std::move(source)),
      pictures_s_(source_->frame_count()) {}

Result<void> RenderPass::Prepare() {
  LF_RETURN_IF_ERROR(source_->Begin(&context_.state, early_));
  const std::vector<LfCamera>& cameras = context_.setup.light_field().cameras;
  const auto virtual_count = static_cast<size_t>(std::count_if(
      source_->images().begin(), source_->images().end(),
      [&](const SelectedImage& image) { return cameras[image.id.value].is_virtual; }));
  RenderReport& totals = context_.totals;
  totals.selected_image_count =
      std::max(totals.selected_image_count, source_->images().size() - virtual_count);
  totals.selected_virtual_count = std::max(totals.selected_virtual_count, virtual_count);
  return {};
}

Result<void> RenderPass::Collect() {
  LF_RETURN_IF_ERROR(FinishEarlyFrames());
  LF_RETURN_IF_ERROR(FinishStoppedFrames());
  while (!source_->AreAllReleased()) {
    const Result<bool> step = source_->Step();
    if (!step && step.error().kind != ErrorKind::kInterrupted) {
      // After an error, the plates have all rays of the steps before, and can be saved.
      if (!Save(0)) return step.error();
      return Error{step.error().kind,
                   step.error().message + " (finished work is kept: {resume} continues)"};
    }
    LF_RETURN_IF_ERROR(FinishStoppedFrames());
    context_.progress(source_->progress(), finished_count_);
    if (IsStopped()) return Interrupt();
    if (!step) context_.signals->attention = false;
    if (source_->CanSave() && context_.signals != nullptr &&
        context_.signals->save.exchange(false)) {
      LF_RETURN_IF_ERROR(Save(std::numeric_limits<double>::infinity()));
      LogInfo("the state is written, as the signal requested");
    }
    if (step && !*step) return {};
    LF_RETURN_IF_ERROR(SaveWhenDue());
  }
  return {};
}

// Finishes the frames of early_ before collection, because they get no more rays than the state
// has. If the state has all rays of a frame, the frame is finished as usual.
Result<void> RenderPass::FinishEarlyFrames() {
  std::vector<size_t> early;
  for (size_t f = 0; f < source_->frame_count(); ++f) {
    if (source_->IsReleased(f) || !std::binary_search(early_.begin(), early_.end(), source_->id(f)))
      continue;
    if (source_->EndsEarly(f))
      early.push_back(f);
    else if (source_->Progress(f).ranks_done == 0)
      LogWarning(
          "{{finish}}: frame {} has no rays yet, and is therefore rendered from all of its LF "
          "images",
          source_->id(f).value);
  }
  return FinishFrames(early);
}

Result<void> RenderPass::FinishStoppedFrames() {
  const std::vector<size_t> stopped = source_->StoppedFrames();
  if (stopped.empty()) return {};
  LF_RETURN_IF_ERROR(context_.state.SaveTotals(Totals()));
  return FinishFrames(stopped);
}

Result<void> RenderPass::Finish() {
  LF_RETURN_IF_ERROR(context_.state.SaveTotals(Totals()));
  std::vector<size_t> left;
  for (size_t f = 0; f < source_->frame_count(); ++f)
    if (!source_->IsReleased(f)) left.push_back(f);
  LF_RETURN_IF_ERROR(FinishFrames(left));
  source_->End(&context_.state);
  const double earlier_s = context_.totals.total_s;
  context_.totals = Totals();
  context_.totals.total_s = earlier_s;
  return {};
}

// Writes frames and their records. kInterrupted: the state was written.
Result<void> RenderPass::FinishFrames(std::span<const size_t> frames) {
  const size_t at_once = context_.frames_finished_at_once;
  Result<void> finished;
  for (size_t begin = 0; finished && begin < frames.size(); begin += at_once)
    finished = FinishAtOnce(frames.subspan(begin, std::min(at_once, frames.size() - begin)));
  LF_RETURN_IF_ERROR(EndRecords());
  if (!finished && finished.error().kind == ErrorKind::kInterrupted) return Interrupt();
  return finished;
}

// Writes several frames at the same time, because an encoder keeps only one thread busy, and begins
// to write their records. A frame that was written is kept even if another frame fails.
// kInterrupted: at least one of the frames is not written.
Result<void> RenderPass::FinishAtOnce(std::span<const size_t> frames) {
  struct Finishing {
    size_t f = 0;
    std::optional<Completion> completion;
    Result<FrameReport> written = FrameReport();
  };
  if (IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  std::vector<Finishing> finishing(frames.size());
  for (size_t i = 0; i < frames.size(); ++i) {
    finishing[i].f = frames[i];
    LF_ASSIGN_OR_RETURN(finishing[i].completion, source_->Complete(frames[i], WritesPlates()));
  }
  context_.setup.pool().ForEach(finishing.size(), [&](size_t i) {
    finishing[i].written = WriteFiles(finishing[i].f, finishing[i].completion);
  });
  LF_RETURN_IF_ERROR(EndRecords());
  for (auto& [f, completion, written] : finishing) {
    source_->ForgetPicture(f);
    if (written) recording_.push_back({f, *std::move(written)});
  }
  BeginRecords();
  for (const auto& [f, completion, written] : finishing)
    if (!written && written.error().kind != ErrorKind::kInterrupted) return written.error();
  for (const auto& [f, completion, written] : finishing)
    if (!written) return written.error();
  return {};
}

PlateNotes RenderPass::NotesOf(size_t f) const {
  PlateNotes notes = source_->NotesOf(f);
  notes.version = context_.folder.version;
  return notes;
}

// Writes the files of a frame. Several threads may call this at the same time, for different
// frames.
Result<FrameReport> RenderPass::WriteFiles(size_t f, const std::optional<Completion>& completion) {
  const FrameId id = source_->id(f);
  const std::filesystem::path to = context_.state.FinishedPath(id);
  const bool is_shard = context_.setup.film().shard.has_value();
  if (WritesPlates()) {
    std::filesystem::path plate = to;
    LF_RETURN_IF_ERROR(source_->WritePlateOf(f, plate.replace_extension(".plate"), context_.state,
                                             NotesOf(f), Totals().skipped));
  }
  if (is_shard) {
    FrameReport report;
    report.frame = id;
    report.rays = source_->Progress(f).rays;
    report.camera = InputsOfFrame(context_.setup.path(), id);
    return report;
  }
  LF_ASSIGN_OR_RETURN(FrameReport report,
                      WritePicture(f, completion, to, [this] { return IsStopped(); }));
  LF_RETURN_IF_ERROR(source_->Measure(f, &report));
  return report;
}

Result<FrameReport> RenderPass::WritePicture(size_t f, const std::optional<Completion>& completion,
                                             const std::filesystem::path& to,
                                             const std::function<bool()>& is_interrupted) const {
  const FrameFormat format = context_.folder.format;
  RenderedFrame frame = source_->Develop(f, completion, IsExr(format), is_interrupted);
  LF_RETURN_IF_ERROR(lf::WritePicture(NotesOf(f), std::move(frame.picture), to, format,
                                      context_.folder.picture, is_interrupted, context_.metadata));
  return frame.report;
}

void RenderPass::WarnIfBlack(const FrameReport& report) {
  if (context_.setup.film().shard || report.rays.image_count != 0 ||
      report.rays.virtual_count != 0 || report.interpolated_share.value_or(0) != 0)
    return;
  // Only the first kTold black frames are logged; report.json states 0 LF images for all of them.
  constexpr size_t kTold = 10;
  if (++context_.black_count <= kTold)
    LogWarning(
        "frame {} is black, because no LF image has a ray for it: widen its aperture, or move "
        "its camera nearer to the LF cameras",
        report.frame.value);
  if (context_.black_count == kTold + 1)
    LogWarning(
        "more frames are black; report.json states for every frame how many LF images it "
        "contains");
}

// Begins to write the records of recording_, on a thread that does nothing else: it mostly waits
// for the disk, and the next frames are developed meanwhile. If the system refuses a thread,
// EndRecords() writes them.
void RenderPass::BeginRecords() {
  for (const Written& frame : recording_) WarnIfBlack(frame.report);
  records_ = std::async([this]() -> Result<void> {
    for (const Written& frame : recording_)
      LF_RETURN_IF_ERROR(context_.state.SaveFinished(frame.report));
    return {};
  });
}

// Waits until the records of recording_ are written, and releases these frames.
Result<void> RenderPass::EndRecords() {
  if (!records_.valid()) return {};
  const Result<void> saved = records_.get();
  for (const auto& [f, report] : std::exchange(recording_, {})) {
    if (!context_.state.finished().contains(report.frame)) continue;
    LogDebug("frame {}: written, with {} rays of {} LF images", report.frame.value,
             report.rays.accepted_count, report.rays.image_count);
    source_->Release(f);
    ++finished_count_;
    context_.progress(source_->progress(), finished_count_);
  }
  return saved;
}

// Returns the totals of earlier passes and runs, plus the work of this pass so far.
RenderReport RenderPass::Totals() const {
  RenderReport totals = context_.totals;
  totals.total_s += NowSeconds() - context_.begin_s;
  source_->AddTo(&totals);
  totals.AddSkipped(source_->skipped());
  return totals;
}

}  // namespace lf
