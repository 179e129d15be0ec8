// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/merge_shards.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/log.h"
#include "lf/film/develop/completion.h"
#include "lf/film/develop/video.h"
#include "lf/pixels/files/whole_file.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/pipeline/render_pass.h"
#include "lf/render/pipeline/shard_plate.h"
#include "lf/render/settings/render_mode.h"
#include "lf/render/state/other_format.h"
#include "lf/render/state/plate_notes.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

struct MergedFrame {
  std::vector<ShardPlate> plates;
  std::optional<FrameReport> report;  // set once this merge or an earlier one has made the frame
  bool is_kept = false;               // true: the frame of an earlier merge is kept
};

// The sums of all plates of a frame.
struct MergedPlate {
  SensorPlate plate{0, 0};
  PlateGaps gaps;  // empty if the plates have none
};

// Adds the plates of each frame, and makes the pictures of all frames.
class Merger {
 public:
  Merger(const MergeOptions& options, ThreadPool& pool,
         const std::function<void(const MergeProgress&)>& progress)
      : options_(options), pool_(pool), progress_(progress) {}
  ~Merger() {
    if (!lock_) return;
    lock_->Remove();
    std::error_code ignored;
    fs::remove(PartialFolder(), ignored);  // fails, as intended, if files are left in it
  }
  Merger(const Merger&) = delete;
  Merger& operator=(const Merger&) = delete;

  Result<RenderReport> Run(const std::vector<fs::path>& given) {
    LF_ASSIGN_OR_RETURN(const std::vector<fs::path> files, PlateFilesOf(given));
    if (files.empty())
      return InputError(
          "no plates are given: expected plate files of {lfrenderer shard} or {keep_plates}, or "
          "folders with such files");
    for (const fs::path& file : files) {
      if (IsStopped()) return Interrupted();
      LF_ASSIGN_OR_RETURN(ShardPlate plate, LookAtPlate(file));
      frames_[plate.notes.frame].plates.push_back(std::move(plate));
    }
    LF_RETURN_IF_ERROR(CheckFrames());
    WarnOfMissingFrames();
    WarnOfHybridsWithoutGaps();
    LogDebug("{} plates of {} frames, the first in {} shards", files.size(), frames_.size(),
             First().shard.count);
    LF_RETURN_IF_ERROR(CheckOutputs(files));
    if (options_.video) {
      LF_RETURN_IF_ERROR(CheckVideoTool());
      LF_RETURN_IF_ERROR(CheckVideoTarget(*options_.video));
    }
    LF_RETURN_IF_ERROR(Lock());
    LF_RETURN_IF_ERROR(FindFinished());
    now_.frame_total = frames_.size();
    for (const auto& [id, frame] : frames_) now_.plate_total += frame.plates.size();
    for (auto& [id, frame] : frames_)
      if (const Result<void> written = WriteFrameOf(&frame); !written) {
        // A later run with --resume reads this report, and rewrites the frames that the report does
        // not name. An error of writing the report is ignored, because the disk may be full.
        (void)WriteReport(Report(), ReportPath());
        return written.error();
      }
    return End();
  }

 private:
  // The first plate of the first frame.
  const ShardPlate& First() const { return frames_.begin()->second.plates.front(); }
  bool IsStopped() const { return options_.signals != nullptr && options_.signals->stop; }
  Error Interrupted() const {
    return {ErrorKind::kInterrupted,
            now_.frame_count == 0
                ? fmt::format("interrupted after 0 of {} frames; nothing was made yet",
                              now_.frame_total)
                : fmt::format("interrupted after {} of {} frames; these are kept in {}, and "
                              "{{resume}} continues",
                              now_.frame_count, now_.frame_total, options_.output_folder.string())};
  }
  fs::path PathOf(FrameId frame) const {
    return FramePath(options_.output_folder, frame, options_.format);
  }

  Result<void> CheckOutputs(const std::vector<fs::path>& files) const {
    std::vector<FrameId> frames;
    for (const auto& [id, frame] : frames_) frames.push_back(id);
    const fs::path& folder = options_.output_folder;
    LF_ASSIGN_OR_RETURN(
        const OutputFiles outputs,
        MakeFilmOutputs(OutputsOfFilm(folder, frames, options_.format), folder, options_.video));
    LF_RETURN_IF_ERROR(outputs.CheckReplacesNone(files, "a plate that is read"));
    return outputs.CheckReplacesNone(options_.kept_files, "an LF image");
  }

  // A render into the same folder takes the same lock, unless it renders a package file or a shard
  // (lf/render/state/run_state.h).
  fs::path PartialFolder() const { return options_.output_folder / "partial"; }
  Result<void> Lock() {
    LF_RETURN_IF_ERROR(CreateFolder(options_.output_folder));
    std::vector<FrameId> ids;
    for (const auto& [id, frame] : frames_) ids.push_back(id);
    WarnOfOtherFormat(options_.output_folder, ids, options_.format);
    LF_ASSIGN_OR_RETURN(FileLock lock, FileLock::TakeInFolder(PartialFolder()));
    lock_ = std::move(lock);
    return {};
  }

  fs::path ReportPath() const { return options_.output_folder / "report.json"; }

  // Checks that the shards of each frame are there, and that all frames are of one film.
  Result<void> CheckFrames() {
    const ShardPlate& first = First();
    for (auto& [id, frame] : frames_) {
      std::vector<ShardPlate>& plates = frame.plates;
      LF_RETURN_IF_ERROR(CheckShards(id, &plates));
      const ShardPlate& one = plates.front();
      if (one.width_px != first.width_px || one.height_px != first.height_px)
        return InputError(fmt::format(
            "{}: has {} x {} elements, but {} has {} x {}: give plates of one film only",
            one.path.string(), one.width_px, one.height_px, first.path.string(), first.width_px,
            first.height_px));
      if (const auto difference = FirstDifference(LightFieldOf(one), LightFieldOf(first)))
        return InputError(fmt::format(
            "frame {}: {}: give plates of one light field only", id.value,
            difference->Text(one.path.string() + " was made with", first.path.string() + " with")));
    }
    return {};
  }

  // Warns about frames without plates between frames with plates. It is no error, because
  // lfrenderer --frames may have left them out on purpose. Without the warning, a user who forgot
  // the plates of one machine would only get a shorter film.
  void WarnOfMissingFrames() const {
    std::vector<std::string> gaps;
    for (auto next = std::next(frames_.begin()); next != frames_.end(); ++next) {
      const uint32_t begin = std::prev(next)->first.value + 1, end = next->first.value;
      if (begin + 1 == end) gaps.push_back(fmt::format("{}", begin));
      if (begin + 1 < end) gaps.push_back(fmt::format("{}-{}", begin, end - 1));
    }
    if (gaps.empty()) return;
    const size_t said = std::min<size_t>(gaps.size(), 10);
    LogWarning("no plates are given for frames {}{}: the film is made without them",
               fmt::join(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(said), ", "),
               gaps.size() > said ? ", ..." : "");
  }

  // Warns if the plates of a hybrid do not say what completes them.
  void WarnOfHybridsWithoutGaps() const {
    for (const auto& [id, frame] : frames_) {
      const ShardPlate& plate = frame.plates.front();
      const std::string* const mode = FindEntry(plate.inputs, "mode");
      if (plate.has_gaps || mode == nullptr || *mode != NameOf(RenderMode::kHybrid)) continue;
      LogWarning(
          "{}: was rendered with {{lfrenderer mode hybrid}}, but has collected rays only, because "
          "plates do not store light that is interpolated from cells: the frames lack this light; "
          "to keep it, render with {{lfrenderer interpolation pixels}}",
          plate.path.string());
      return;
    }
  }

  // Refuses to replace a finished video by one without frames of the earlier film, and warns if
  // only the report loses them: plates of one machine may have been forgotten.
  Result<void> CheckKeepsFrames(const RenderReport& earlier) const {
    std::vector<FrameId> lost;
    for (const FrameReport& frame : earlier.frames)
      if (!frames_.contains(frame.frame) && fs::exists(PathOf(frame.frame)))
        lost.push_back(frame.frame);
    if (lost.empty()) return {};
    const std::string words =
        fmt::format("no plates are given of {} finished frame{}, the first: {}", lost.size(),
                    lost.size() == 1 ? "" : "s", PathOf(lost.front()).string());
    if (options_.video && fs::exists(*options_.video))
      return UsageError(
          fmt::format("{}, so that {{resume}} would shorten {}: give their plates, too, or another "
                      "{{video}}",
                      words, options_.video->string()));
    LogWarning("{}: they stay, but the report does not describe them", words);
    return {};
  }

  Result<void> FindFinished() {
    RunInputs film_before;
    if (options_.resume && fs::exists(ReportPath())) {
      LF_ASSIGN_OR_RETURN(const RenderReport earlier, ReadReport(ReportPath()));
      film_before = earlier.inputs;
      LF_RETURN_IF_ERROR(CheckKeepsFrames(earlier));
      for (const FrameReport& report : earlier.frames)
        if (const auto found = frames_.find(report.frame); found != frames_.end())
          found->second.report = report;
    }
    for (auto& [id, frame] : frames_) {
      if (!fs::exists(PathOf(id)) || options_.overwrite) continue;
      if (!options_.resume)
        return UsageError(
            fmt::format("{}: exists already: keep such frames with {{resume}}, or replace them "
                        "with {{overwrite}}",
                        PathOf(id).string()));
      if (!frame.report) continue;
      if (const auto difference = DifferenceFrom(film_before, frame)) {
        LogWarning("{}: {}; the frame is made again", PathOf(id).string(),
                   difference->Text("was made with", "these plates have"));
        continue;
      }
      const Result<void> whole = CheckFileIsWhole(PathOf(id));
      frame.is_kept = whole.has_value();
      if (!whole) LogWarning("{}; the frame is made again", whole.error().message);
    }
    return {};
  }

  // Compares the film and the render camera in an earlier report with those of the plates. The
  // report and the plates may differ after an interrupted --overwrite, which leaves frames of the
  // film that it was replacing.
  std::optional<InputDifference> DifferenceFrom(const RunInputs& film_before,
                                                const MergedFrame& frame) const {
    if (const auto difference = FirstDifference(film_before, FilmInputs())) return difference;
    const PlateNotes& notes = frame.plates.front().notes;
    return FirstDifference(frame.report->camera,
                           InputsOfCamera(notes.frame, notes.camera, notes.shutter));
  }

  // Adds a plate file to the sums of its frame.
  Result<void> Add(const ShardPlate& plate, MergedPlate* sum) const {
    LF_ASSIGN_OR_RETURN(PlateReader reader, OpenPlate(plate.path));
    if (reader.width() != plate.width_px || reader.height() != plate.height_px ||
        reader.kind() != plate.kind || reader.has_gaps() != plate.has_gaps)
      return InputError(fmt::format("{}: was replaced while lfmerge read it: start lfmerge again",
                                    plate.path.string()));
    const auto is_stopped = [this] { return IsStopped(); };
    Result<void> added = reader.AddTo(&sum->plate, is_stopped);
    if (added && reader.has_gaps()) added = reader.AddGapsTo(&sum->gaps, is_stopped);
    if (!added && added.error().kind == ErrorKind::kInterrupted) return Interrupted();
    if (!added) return WithPlateRemedy(added.error());
    return {};
  }

  // Develops the sums of a frame, and writes its picture.
  Result<FrameReport> WritePictureOf(const PlateNotes& notes, MergedPlate sum) const {
    const auto is_stopped = [this] { return IsStopped(); };
    std::optional<Completion> completion;
    if (!sum.gaps.share.empty())
      completion = CompletionOf(sum.gaps.rays, std::move(sum.gaps.share), &pool_);
    sum.gaps = PlateGaps();  // frees the memory
    RenderedFrame made = DevelopFrame(notes, sum.plate, completion ? &*completion : nullptr,
                                      IsExr(options_.format), pool_, is_stopped);
    const Result<void> written = WritePicture(notes, std::move(made.picture), PathOf(notes.frame),
                                              options_.format, options_.picture, is_stopped);
    if (!written && written.error().kind == ErrorKind::kInterrupted) return Interrupted();
    LF_RETURN_IF_ERROR(written);
    return std::move(made.report);
  }

  Result<void> WriteFrameOf(MergedFrame* frame) {
    const std::vector<ShardPlate>& plates = frame->plates;
    const ShardPlate& first = plates.front();
    PlateNotes notes = first.notes;
    notes.rays = {};
    notes.develop.adds_opacity = options_.adds_opacity;
    for (const ShardPlate& plate : plates) notes.rays += plate.notes.rays;
    MergedPlate sum;
    if (!frame->is_kept) sum.plate = SensorPlate(first.width_px, first.height_px, first.kind);
    for (const ShardPlate& plate : plates) {
      if (IsStopped()) return Interrupted();
      if (!frame->is_kept) LF_RETURN_IF_ERROR(Add(plate, &sum));
      ++now_.plate_count;
      if (progress_) progress_(now_);
    }
    if (!frame->is_kept) {
      LF_ASSIGN_OR_RETURN(frame->report, WritePictureOf(notes, std::move(sum)));
    }
    LogDebug("frame {}: {} plates, {} rays of {} LF images{}", notes.frame.value, plates.size(),
             notes.rays.accepted_count, notes.rays.image_count, frame->is_kept ? "; kept" : "");
    ++now_.frame_count;
    if (progress_) progress_(now_);
    return {};
  }

  // Returns the inputs that all frames have in common.
  RunInputs FilmInputs() const {
    const ShardPlate& first = First();
    RunInputs inputs;
    for (const auto& entry : first.inputs)
      if (!entry.first.starts_with("plate.") && !entry.first.starts_with("frame"))
        inputs.push_back(entry);
    RunChoices picture;
    picture.format = NameOf(options_.format);
    picture.film.smooth_below = first.notes.develop.smooth_below;
    picture.film.fill_radius_px = first.notes.develop.fill_radius_px;
    picture.film.adds_opacity = options_.adds_opacity;
    picture.look = options_.picture;
    for (auto& entry : InputsOfPicture(picture)) inputs.push_back(std::move(entry));
    return inputs;
  }

  RenderReport Report() const {
    const ShardPlate& first = First();
    RenderReport report;
    report.version = first.notes.version;
    report.inputs = FilmInputs();
    report.estimator = first.notes.estimator;
    report.width = first.width_px;
    report.height = first.height_px;
    report.thread_count = pool_.thread_count();
    for (const auto& [id, frame] : frames_)
      if (frame.report) report.frames.push_back(*frame.report);
    AddImages(&report);
    report.total_s = NowSeconds() - begin_s_;
    report.peak_memory_bytes = PeakMemoryBytes();
    return report;
  }

  // Sets RenderReport::selected_image_count (merge_shards.h), and adds the LF images that were
  // skipped when the plates were rendered.
  void AddImages(RenderReport* report) const {
    for (const auto& [id, frame] : frames_) {
      uint64_t count = 0, virtual_count = 0;
      for (const ShardPlate& plate : frame.plates) {
        virtual_count += plate.notes.rays.virtual_count;
        count += plate.notes.rays.image_count + plate.notes.skipped_count;
        std::vector<SkippedImage> skipped;
        for (const std::string& name : plate.notes.skipped)
          skipped.push_back(
              {name, fmt::format("{}: was rendered without it, because it was missing or broken",
                                 plate.path.string())});
        report->AddSkipped(skipped);
      }
      report->selected_image_count = std::max<size_t>(report->selected_image_count, count);
      report->selected_virtual_count =
          std::max<size_t>(report->selected_virtual_count, virtual_count);
    }
  }

  Result<RenderReport> End() {
    const ShardPlate& first = First();
    std::vector<FrameId> frames;
    for (const auto& [id, frame] : frames_) frames.push_back(id);
    const FilmFiles film = {options_.output_folder,
                            options_.format,
                            options_.picture.colours,
                            first.width_px,
                            first.height_px,
                            first.notes.fps,
                            options_.signals == nullptr ? nullptr : &options_.signals->stop};
    RenderReport report = Report();
    LF_RETURN_IF_ERROR(WriteReport(report, ReportPath()));
    if (options_.contact_sheet) LF_RETURN_IF_ERROR(film.WriteContactSheet(frames, 2, pool_));
    if (options_.video) LF_RETURN_IF_ERROR(film.WriteVideo(frames, *options_.video));
    if (report.IsBlack())
      return InputError(fmt::format(
          "{}: all frames are black, because the plates contain no rays: check in lfvisualizer "
          "that the camera path is within the capture, and check the masks of the LF images",
          options_.output_folder.string()));
    return report;
  }

  const MergeOptions& options_;
  ThreadPool& pool_;
  const std::function<void(const MergeProgress&)>& progress_;
  const double begin_s_ = NowSeconds();
  std::optional<FileLock> lock_;
  std::map<FrameId, MergedFrame> frames_;
  MergeProgress now_;
};

}  // namespace

Result<RenderReport> MergeShards(const std::vector<fs::path>& plates, const MergeOptions& options,
                                 ThreadPool& pool,
                                 const std::function<void(const MergeProgress&)>& progress) {
  return Merger(options, pool, progress).Run(plates);
}

}  // namespace lf
