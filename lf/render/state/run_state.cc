// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/run_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/core/temporary_file.h"
#include "lf/pixels/files/whole_file.h"
#include "lf/rebinning/kept_pixels_file.h"
#include "lf/rebinning/ray_map_file.h"
#include "lf/render/state/other_films.h"
#include "lf/render/state/state_entries.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kNoise = "progress.noise";
constexpr const char* kRaysExtension = ".rays";
constexpr const char* kKeptExtension = ".pixels";
constexpr const char* kVirtual = "progress.virtual_lf_images";

// Returns N if the file name is "frame_N.EXTENSION"; nullopt for other names.
std::optional<FrameId> FrameOf(const fs::path& path) {
  constexpr std::string_view kPrefix = "frame_";
  const std::string stem = path.stem().string();
  if (!stem.starts_with(kPrefix)) return std::nullopt;
  const auto number = ParseFrameNumber(std::string_view(stem).substr(kPrefix.size()));
  return number ? std::optional(FrameId{*number}) : std::nullopt;
}

// Advice for a damaged file: only the work that it holds is done again if it is removed.
constexpr const char* kPlateAdvice = "remove the file to render its frame again";
constexpr const char* kRaysAdvice = "remove the file to rebin its rays again";
constexpr const char* kKeptAdvice = "remove the file to read its pixels again";

// True for the files that the frames of a pass share: rebinned rays and kept pixels.
bool IsOfPass(const fs::path& path) {
  return path.extension() == kRaysExtension || path.extension() == kKeptExtension;
}

std::vector<fs::path> FilesOf(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// Removes temporary files that killed processes left, on any host. The caller holds the lock of the
// state, so that no other process renders `frames` now.
//   frames     ascending; temporary files of other frames stay
//   is_shared  true if other processes may write into the folder: files that belong to no frame
//              stay
void RemoveTemporaryFiles(const fs::path& folder, const std::vector<FrameId>& frames,
                          bool is_shared) {
  constexpr const char* kOurs[] = {".run.", ".report.", ".contact_sheet.", ".rays_", ".kept_"};
  std::error_code ignored;
  for (const fs::path& path : FilesOf(folder)) {
    const std::string name = path.filename().string();
    if (!IsTemporaryName(name)) continue;
    const std::optional<FrameId> frame = FrameOf(name.substr(1, name.find('.', 1) - 1));
    const bool is_ours =
        frame
            ? std::binary_search(frames.begin(), frames.end(), *frame)
            : !is_shared && std::any_of(std::begin(kOurs), std::end(kOurs),
                                        [&](const char* start) { return name.starts_with(start); });
    if (is_ours) fs::remove(path, ignored);
  }
}

fs::path PartialFolder(const RunStateOptions& options) {
  return options.folder / "partial" / NameOfState(options.package, options.shard);
}

}  // namespace

std::string NameOfState(const std::string& package, const std::optional<Shard>& shard) {
  if (!shard) return package;
  return package.empty() ? shard->Name() : package + "." + shard->Name();
}

RunState::RunState(const RunStateOptions& options, const CameraPath& path, FileLock lock)
    : options_(options), path_(path), partial_(PartialFolder(options)), lock_(std::move(lock)) {}

RunState::~RunState() {
  lock_.Remove();
  std::error_code ignored;
  fs::remove(partial_, ignored);  // fails, as intended, if files are left in it
  if (!Name().empty()) fs::remove(options_.folder / "partial", ignored);
}

std::string RunState::Name() const { return NameOfState(options_.package, options_.shard); }
fs::path RunState::FinishedPath(FrameId frame) const {
  if (!options_.shard) return FramePath(options_.folder, frame, options_.format);
  return FramePath(options_.folder / "partial" / "shards" / options_.shard->Name(), frame,
                   options_.format)
      .replace_extension(".plate");
}
fs::path RunState::PlatePath(FrameId frame) const {
  return FramePath(partial_, frame, options_.format).replace_extension(".plate");
}
fs::path RunState::RecordPath(FrameId frame) const {
  return FramePath(partial_, frame, options_.format).replace_extension(".json");
}
fs::path RunState::ReportPath() const {
  return options_.folder / (Name().empty() ? "report.json" : "report-" + Name() + ".json");
}
fs::path RunState::PicturePath(FrameId frame) const {
  return FramePath(partial_, frame, options_.format);
}

Result<std::unique_ptr<RunState>> RunState::Open(const RunStateOptions& options,
                                                 const CameraPath& path) {
  const fs::path partial = PartialFolder(options);
  LF_RETURN_IF_ERROR(CreateFolder(options.folder));
  LF_ASSIGN_OR_RETURN(FileLock lock, FileLock::TakeInFolder(partial));
  std::unique_ptr<RunState> state(new RunState(options, path, std::move(lock)));
  if (options.shard)
    LF_RETURN_IF_ERROR(CreateFolder(state->FinishedPath(FrameId{1}).parent_path()));
  LF_RETURN_IF_ERROR(state->FindEarlierRun());
  return state;
}

// Finds the state that an earlier run left. Depending on the options, reads it, removes it, or
// returns an error.
Result<void> RunState::FindEarlierRun() {
  RemoveTemporaryFiles(partial_, options_.frames, false);
  RemoveTemporaryFiles(options_.folder, options_.frames, !Name().empty());
  if (options_.shard)
    RemoveTemporaryFiles(FinishedPath(FrameId{1}).parent_path(), options_.frames, true);
  for (const fs::path& file : FilesOf(partial_)) {
    const std::optional<FrameId> frame = FrameOf(file);
    if (frame && file.extension() == ".plate") plates_.insert(*frame);
    if (frame && file.extension() == ".json") records_.insert(*frame);
    has_rays_ = has_rays_ || IsOfPass(file);
  }
  LF_RETURN_IF_ERROR(CheckOtherPackages());
  if (options_.resume) {
    LF_RETURN_IF_ERROR(Read());
    return FindOtherFilms();
  }
  if (!options_.overwrite && (HasPlates() || !records_.empty()))
    return UsageError(fmt::format(
        "{}: contains an unfinished render ({} frames finished, {} begun): continue it with "
        "{{resume}}, or remove it and start again with {{overwrite}}",
        partial_.string(), records_.size(), plates_.size()));
  LF_RETURN_IF_ERROR(FindOtherFilms());
  if (options_.overwrite) RemoveAll();
  // The contact sheet of an earlier render is removed, and its report, but for frames that stay.
  // Otherwise, if this render fails, they would look like its results.
  std::error_code ignored;
  if (fs::exists(ReportPath(), ignored))
    LogWarning(
        "{}: the earlier render in this folder is complete, and its frames are replaced one by one",
        options_.folder.string());
  fs::remove(ReportPath(), ignored);
  if (staying_) LF_RETURN_IF_ERROR(WriteReport(*staying_, ReportPath()));
  if (Name().empty()) fs::remove(options_.folder / "contact_sheet.png", ignored);
  return {};
}

// Compares the inputs with the reports of other packages and shards in the folder, because the
// frames of two films in one folder would look like one film.
Result<void> RunState::CheckOtherPackages() const {
  if (Name().empty()) return {};
  for (const fs::path& file : ReportsIn(options_.folder)) {
    if (file.filename() == "report.json" || file == ReportPath()) continue;
    LF_ASSIGN_OR_RETURN(const RenderReport other, ReadReport(file));
    if (const auto difference =
            FirstDifference(other.inputs, Joined(options_.rays, options_.picture)))
      return UsageError(fmt::format(
          "{}: is the report of another package or shard, which {}: the frames of both would look "
          "like one film; give another {{output}}, or remove the frames and reports in this folder",
          file.string(), difference->Text("was rendered with", "this one has")));
  }
  return {};
}

// Looks for frames of earlier renders in the reports of the folder and, because --overwrite removes
// the state but not the finished frames, in its records. Sets staying_.
Result<void> RunState::FindOtherFilms() {
  std::vector<fs::path> reports;
  for (const fs::path& file : ReportsIn(options_.folder)) {
    const std::string name = file.filename().string();
    // CheckOtherPackages() compares packages and shards with each other. The frames of a shard are
    // plates, which no other render takes for frames.
    const bool is_other = name == "report.json" || Name().empty();
    const bool has_plates = options_.shard || name.find("shard_") != std::string::npos;
    if (file == ReportPath() ? !options_.resume : is_other && !has_plates) reports.push_back(file);
  }
  if (!options_.resume)  // Read() compares the report and the records of the state
    for (const FrameId frame : records_) reports.push_back(RecordPath(frame));
  const RunInputs inputs = Joined(options_.rays, options_.picture);
  FilmInFolder film = {path_, inputs, {}, [this](FrameId frame) { return FinishedPath(frame); }};
  for (const fs::path& report : reports) {
    const bool is_ours = report == ReportPath() || report.parent_path() == partial_;
    // A report of others stays, and would describe even the frames that are replaced.
    film.frames = {};
    if (is_ours) film.frames = options_.written.empty() ? options_.frames : options_.written;
    const Result<FramesThatStay> found = FindFramesThatStay(report, film);
    if (!found) {
      LogWarning("{}; frames of another film may be in this folder", found.error().message);
    } else if (!found->others.empty() && options_.overwrite) {
      LogWarning("{}: {}; they stay: remove them, unless they are wanted", options_.folder.string(),
                 found->others);
    } else if (!found->others.empty()) {
      return UsageError(fmt::format(
          "{}: {}: both would look like one film; give another {{output}}, or {{overwrite}}{}",
          options_.folder.string(), found->others, options_.resume ? " instead of {resume}" : ""));
    } else if (is_ours && found->same) {
      const std::optional<RenderReport> before = std::exchange(staying_, found->same);
      if (before) AddFrames(*before, &*staying_);
    }
  }
  return {};
}

void RunState::RemoveAll() {
  std::error_code ignored;
  for (const fs::path& file : FilesOf(partial_))
    if (FrameOf(file) || file.filename() == "run.json" || IsOfPass(file)) fs::remove(file, ignored);
  has_rays_ = false;
  plates_.clear();
  records_.clear();
}

Result<void> RunState::Read() {
  const fs::path report = ReportPath(), run = partial_ / "run.json";
  if (fs::exists(report)) LF_RETURN_IF_ERROR(ReadFinished(report));
  for (const FrameId frame : records_) LF_RETURN_IF_ERROR(ReadFinished(RecordPath(frame)));
  // Without run.json, the totals are those of the report: the earlier render was completed.
  if (fs::exists(run)) {
    LF_ASSIGN_OR_RETURN(earlier_, ReadReport(run));
  }
  for (auto plate = plates_.begin(); plate != plates_.end();) {
    if (finished_.contains(*plate)) {  // the process was killed before it removed the plate
      std::error_code ignored;
      fs::remove(PlatePath(*plate), ignored);
      plate = plates_.erase(plate);
      continue;
    }
    LF_RETURN_IF_ERROR(CheckPlate(*plate));
    ++plate;
  }
  // Nothing is logged if no frame is left to render, because the run then only makes the contact
  // sheet and the video.
  if (finished_.size() < options_.frames.size() && (!finished_.empty() || !plates_.empty()))
    LogInfo("continuing: {} frames are finished, {} begun", finished_.size(), plates_.size());
  return {};
}

// Returns true if the file of a finished frame exists and is whole (the plate of a shard only has
// to exist). Otherwise the frame is rendered again.
bool RunState::IsKept(const fs::path& picture) const {
  if (!fs::exists(picture)) return false;
  if (options_.shard) return true;  // the plate is checked when it is read
  const Result<void> whole = CheckFileIsWhole(picture);
  if (!whole) LogWarning("{}; the frame is rendered again", whole.error().message);
  return whole.has_value();
}

Result<void> RunState::ReadFinished(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(RenderReport report, ReadReport(path));
  for (FrameReport& frame : report.frames) {
    const RunInputs recorded = Joined(report.inputs, frame.camera);
    // A frame whose file is missing is rendered again, because the user may have removed it for
    // this purpose. If the frame format differs, the file has another name, and Check() reports the
    // difference.
    const bool has_format =
        std::find(recorded.begin(), recorded.end(), options_.picture.front()) != recorded.end();
    if (has_format && !IsKept(FinishedPath(frame.frame))) continue;
    LF_RETURN_IF_ERROR(Check(path.string(), frame.frame, recorded, true));
    finished_[frame.frame] = std::move(frame);
  }
  if (path == ReportPath()) {
    report.frames.clear();
    earlier_ = std::move(report);
  }
  return {};
}

Result<void> RunState::CheckPlate(FrameId frame) const {
  const Result<PlateReader> reader = PlateReader::Open(PlatePath(frame));
  if (!reader) return WithAdvice(reader.error(), kPlateAdvice);
  RunInputs recorded;
  for (const auto& entry : reader->entries())
    if (!entry.first.starts_with(kProgressKeys)) recorded.push_back(entry);
  return Check(PlatePath(frame).string(), frame, recorded, false);
}

bool RunState::HasPlateBeside(FrameId frame) const {
  const Result<PlateReader> reader =
      PlateReader::Open(FinishedPath(frame).replace_extension(".plate"));
  if (!reader) return false;
  const RunInputs wanted = Joined(options_.rays, InputsOfFrame(path_, frame));
  return std::all_of(wanted.begin(), wanted.end(), [&reader](const auto& input) {
    const std::string* const recorded = FindEntry(reader->entries(), input.first);
    return recorded != nullptr && *recorded == input.second;
  });
}

Result<void> RunState::Check(const std::string& place, FrameId frame, const RunInputs& recorded,
                             bool has_picture) const {
  constexpr const char* kAdvice =
      "or another {output}, or start again with {overwrite} instead of {resume}";
  if (!path_.frames().Has(frame))
    return UsageError(fmt::format(
        "{}: belongs to frame {}, but the camera path has the frames {} to {}, so that {{resume}} "
        "cannot use the file; give the same inputs and options, {}",
        place, frame.value, path_.frames().first, path_.frames().last(), kAdvice));
  RunInputs wanted = options_.rays;
  if (has_picture) wanted = Joined(wanted, options_.picture);
  wanted = Joined(wanted, InputsOfFrame(path_, frame));
  if (const auto difference = FirstDifference(recorded, wanted))
    return UsageError(fmt::format("{}: {}, so that {{resume}} cannot continue; {}, {}", place,
                                  difference->Text("was made with", "this call has"),
                                  difference->Remedy(), kAdvice));
  return {};
}

PlateEntries RunState::PlateText(FrameId frame, const FrameProgress& progress,
                                 const NoiseMoments* moments) const {
  PlateEntries text = Joined(options_.rays, InputsOfFrame(path_, frame));
  text.emplace_back(kRanksDone, fmt::format("{}", progress.ranks_done));
  text.emplace_back("progress.lf_images", fmt::format("{}", progress.rays.image_count));
  text.emplace_back("progress.rays_tested", fmt::format("{}", progress.rays.tested_count));
  text.emplace_back("progress.rays_accepted", fmt::format("{}", progress.rays.accepted_count));
  if (progress.rays.virtual_count > 0)
    text.emplace_back(kVirtual, fmt::format("{}", progress.rays.virtual_count));
  if (moments != nullptr) text.emplace_back(kNoise, moments->Text());
  return text;
}

Result<FrameProgress> RunState::LoadPlate(FrameId frame, SensorPlate* plate,
                                          std::optional<NoiseMoments>* moments) const {
  FrameProgress progress;
  if (!plates_.contains(frame)) return progress;
  const fs::path path = PlatePath(frame);
  LF_ASSIGN_OR_RETURN(PlateReader reader, PlateReader::Open(path));
  const auto get = [&](const char* key, auto* value) {
    return NumberOf(path, reader.entries(), key, kPlateAdvice, value);
  };
  LF_RETURN_IF_ERROR(get(kRanksDone, &progress.ranks_done));
  LF_RETURN_IF_ERROR(get("progress.lf_images", &progress.rays.image_count));
  LF_RETURN_IF_ERROR(get("progress.rays_tested", &progress.rays.tested_count));
  LF_RETURN_IF_ERROR(get("progress.rays_accepted", &progress.rays.accepted_count));
  if (FindEntry(reader.entries(), kVirtual) != nullptr)
    LF_RETURN_IF_ERROR(get(kVirtual, &progress.rays.virtual_count));
  const auto fault = [&](const std::string& what) {
    return WithAdvice(InputError(fmt::format("{}: {}", path.string(), what)), kPlateAdvice);
  };
  if (reader.width() != plate->width() || reader.height() != plate->height())
    return fault(fmt::format("has {} x {} elements, expected {} x {}", reader.width(),
                             reader.height(), plate->width(), plate->height()));
  if (reader.kind() != plate->kind())
    return fault(fmt::format("has {} channels, expected {}", static_cast<int>(reader.kind()),
                             plate->channels()));
  if (const Result<void> added = reader.AddTo(plate); !added)
    return WithAdvice(added.error(), kPlateAdvice);
  const std::string* const noise = FindEntry(reader.entries(), kNoise);
  if (moments == nullptr || noise == nullptr) return progress;
  Result<NoiseMoments> read = NoiseMoments::Read(*noise, *plate);
  if (!read) return fault(fmt::format("its entry {} is damaged: {}", kNoise, read.error().message));
  *moments = *std::move(read);
  return progress;
}

Result<void> RunState::SavePlate(FrameId frame, const FrameProgress& progress,
                                 const SensorPlate& plate, ThreadPool& pool,
                                 const NoiseMoments* moments) {
  const PlateEntries text = PlateText(frame, progress, moments);
  LF_RETURN_IF_ERROR(WritePlate(PlatePath(frame), text, plate, pool));
  const std::lock_guard lock(plates_mutex_);
  plates_.insert(frame);
  return {};
}

fs::path RunState::RaysPath(FrameId first, size_t section) const {
  return partial_ / fmt::format("rays_{:04}_{}{}", first.value, section + 1, kRaysExtension);
}

Result<std::optional<RunState::Rays>> RunState::LoadRays(FrameId first, size_t section,
                                                         const std::string& frames,
                                                         size_t max_cells, ThreadPool& pool) const {
  const fs::path path = RaysPath(first, section);
  if (!options_.resume) return std::optional<Rays>();
  LF_RETURN_IF_ERROR(CheckNoneIsOther(partial_, kKeptExtension, "interpolation pixels", "cells"));
  if (!fs::exists(path)) return std::optional<Rays>();
  const auto check = [&](const PlateEntries& entries) {
    return CheckEntriesOfPass(path, entries, options_.rays, frames);
  };
  Result<RaysFile> file = ReadRays(path, max_cells, pool, check);
  if (!file && file.error().kind == ErrorKind::kUsage) return file.error();
  if (!file) return WithAdvice(file.error(), kRaysAdvice);
  Rays rays{std::move(file->map), 0};
  LF_RETURN_IF_ERROR(NumberOf(path, file->entries, kRanksDone, kRaysAdvice, &rays.ranks_done));
  return std::optional<Rays>(std::move(rays));
}

Result<void> RunState::SaveRays(FrameId first, size_t section, const std::string& frames,
                                const RayMap& map, uint32_t ranks_done, ThreadPool& pool) {
  LF_RETURN_IF_ERROR(WriteRays(RaysPath(first, section),
                               EntriesOfPass(options_.rays, frames, ranks_done), map, pool));
  has_rays_ = true;
  return {};
}

fs::path RunState::KeptPath(FrameId first) const {
  return partial_ / fmt::format("kept_{:04}{}", first.value, kKeptExtension);
}

Result<std::optional<RunState::Kept>> RunState::LoadKept(FrameId first, const std::string& frames,
                                                         size_t max_pixels,
                                                         ThreadPool& pool) const {
  const fs::path path = KeptPath(first);
  if (!options_.resume) return std::optional<Kept>();
  LF_RETURN_IF_ERROR(CheckNoneIsOther(partial_, kRaysExtension, "interpolation cells", "pixels"));
  if (!fs::exists(path)) return std::optional<Kept>();
  const auto check = [&](const PlateEntries& entries) {
    return CheckEntriesOfPass(path, entries, options_.rays, frames);
  };
  Result<KeptFile> file = ReadKept(path, max_pixels, pool, check);
  if (!file && file.error().kind == ErrorKind::kUsage) return file.error();
  if (!file) return WithAdvice(file.error(), kKeptAdvice);
  Kept kept{std::move(file->pixels), 0};
  LF_RETURN_IF_ERROR(NumberOf(path, file->entries, kRanksDone, kKeptAdvice, &kept.ranks_done));
  return std::optional<Kept>(std::move(kept));
}

Result<void> RunState::SaveKept(FrameId first, const std::string& frames, const KeptPixels& pixels,
                                uint32_t ranks_done, ThreadPool& pool) {
  LF_RETURN_IF_ERROR(
      WriteKept(KeptPath(first), EntriesOfPass(options_.rays, frames, ranks_done), pixels, pool));
  has_rays_ = true;
  return {};
}

Result<void> RunState::CheckNoRays() const {
  if (!options_.resume) return {};
  for (const char* const extension : {kRaysExtension, kKeptExtension})
    LF_RETURN_IF_ERROR(
        CheckNoneIsOther(partial_, extension, "mode rebin or hybrid", "mode collect"));
  return {};
}

void RunState::RemoveRays() {
  std::error_code ignored;
  for (const fs::path& file : FilesOf(partial_))
    if (IsOfPass(file)) fs::remove(file, ignored);
  has_rays_ = false;
}

Result<void> RunState::SaveTotals(const RenderReport& totals) {
  RenderReport report = totals;
  report.frames.clear();
  return WriteReport(report, partial_ / "run.json");
}

Result<void> RunState::SaveFinished(const FrameReport& frame) {
  RenderReport record;
  record.inputs = Joined(options_.rays, options_.picture);
  record.frames = {frame};
  LF_RETURN_IF_ERROR(WriteReport(record, RecordPath(frame.frame)));
  records_.insert(frame.frame);
  finished_[frame.frame] = frame;
  std::error_code ignored;
  fs::remove(PlatePath(frame.frame), ignored);
  fs::remove(PicturePath(frame.frame), ignored);
  plates_.erase(frame.frame);
  return {};
}

Error RunState::Interruption(std::span<const FrameId> frames) const {
  const auto finished_count = std::count_if(
      frames.begin(), frames.end(), [this](FrameId frame) { return finished_.contains(frame); });
  const bool has_finished = finished_count > 0;
  const std::string kept = !has_finished && !HasPlates()
                               ? "nothing was made yet"
                               : fmt::format("{} kept in {}",
                                             !HasPlates()    ? "finished frames are"
                                             : !has_finished ? "the state is"
                                                             : "finished frames and the state are",
                                             options_.folder.string());
  return {ErrorKind::kInterrupted, fmt::format("interrupted after {} of {} frames; {}",
                                               finished_count, frames.size(), kept)};
}

Result<void> RunState::Close(const RenderReport& report) {
  RenderReport all = report;
  if (staying_) AddFrames(*staying_, &all);
  LF_RETURN_IF_ERROR(WriteReport(all, ReportPath()));
  std::error_code ignored;
  for (const FrameId frame : records_) fs::remove(RecordPath(frame), ignored);
  records_.clear();
  if (plates_.empty()) RemoveAll();
  return {};
}

}  // namespace lf
