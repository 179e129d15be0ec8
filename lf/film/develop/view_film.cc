// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/view_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/film/develop/file_inputs.h"
#include "lf/film/develop/join_views.h"
#include "lf/film/develop/video.h"
#include "lf/film/develop/view_frames.h"
#include "lf/pixels/files/whole_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr int64_t kMostPixels = int64_t{1} << 30;
constexpr double kDefaultFps = 30;

// One picture or video that is written.
struct Target {
  fs::path file;
  std::span<const ViewMoment> moments;  // one for a picture
  std::optional<int> eye = {};          // kLeftRight: index of the view that is taken
  bool is_kept = false;
};

class FilmWriter {
 public:
  FilmWriter(const ViewFilmOptions& options, ThreadPool& pool,
             const std::function<void(size_t, size_t)>& on_progress)
      : options_(options), pool_(pool), on_progress_(on_progress) {}

  Result<ViewFilmReport> Write(std::span<const fs::path> frames);

 private:
  bool is_video() const { return IsVideoName(options_.output); }
  // True if the file has the bytes of a frame.
  bool is_copied(const Target& target) const {
    return target.eye && !is_video() && !is_developed();
  }
  bool is_left_right() const { return options_.layout == ViewLayout::kLeftRight; }
  // True if EXR frames become PNG files, which show what a video of them shows.
  bool is_developed() const {
    return options_.output.extension() == ".png" && moments_[0].files[0].extension() == ".exr";
  }
  JoinOptions join() const {
    return {options_.layout, options_.grid, is_video() || is_developed(), options_.tile};
  }

  ViewSize of_view() const { return {header_.info.width, header_.info.height}; }
  ViewSize tile() const { return options_.tile.value_or(of_view()); }
  std::string LayoutText() const {
    if (options_.layout != ViewLayout::kQuilt) return NameOf(options_.layout);
    const std::string quilt = fmt::format("quilt {}x{}", options_.grid.columns, options_.grid.rows);
    if (tile() == of_view()) return quilt;
    return fmt::format("{} of {}x{}", quilt, tile().width, tile().height);
  }

  Result<void> CheckOutput() const;
  Result<void> CheckShape() const;
  Result<void> PlanTargets();
  Result<void> CheckTargets() const;
  Result<void> CheckTarget(Target* target) const;
  Result<FileInputs> InputsOf(const Target& target) const;
  Result<bool> IsMadeOfThese(const Target& target) const;
  Result<void> ChooseRate();
  Result<void> WriteTarget(const Target& target);
  Result<void> WriteVideo(const Target& target);
  Result<void> CopyFrame(const Target& target);
  Result<StoredImage> Join(const ViewMoment& moment, std::optional<int> eye);
  bool CountView();

  const ViewFilmOptions& options_;
  ThreadPool& pool_;
  const std::function<void(size_t, size_t)>& on_progress_;
  std::vector<ViewMoment> moments_;
  PictureHeader header_;
  std::vector<Target> targets_;
  ViewFilmReport report_;
  std::mutex mutex_;  // guards the two below
  size_t done_ = 0;
  size_t total_ = 0;
  std::optional<FileLock> lock_;
};

Error Interrupted() {
  return {ErrorKind::kInterrupted,
          "interrupted; the files that are complete stay, and {resume} writes the others"};
}

// Checks what does not depend on the headers of the frames.
Result<void> FilmWriter::CheckOutput() const {
  const fs::path& out = options_.output;
  const fs::path of_frames = moments_[0].files[0].extension();
  if (!is_video() && !is_developed() && out.extension() != of_frames)
    return UsageError(
        fmt::format("{{output {}}}: its extension is \"{}\": expected \"{}\" as the frames have, "
                    "{}\".mp4\" for a video",
                    out.string(), out.extension().string(), of_frames.string(),
                    of_frames == ".exr" ? "\".png\" for pictures in sRGB, or " : "or "));
  if (options_.fps && !is_video())
    return UsageError(
        fmt::format("{{fps}} is for videos, but {} is a picture: leave it out, or give a name that "
                    "ends in .mp4",
                    out.string()));
  const fs::path folder = out.has_parent_path() ? out.parent_path() : ".";
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return OutputError(
        fmt::format("{{output {}}}: the folder {} does not exist: make it, or give another name",
                    out.string(), folder.string()));
  if (is_video()) return CheckVideoTool();
  return {};
}

Result<void> FilmWriter::CheckShape() const {
  constexpr double kMostOff = 0.01;
  const double aspect = static_cast<double>(of_view().width) / of_view().height;
  if (options_.aspect && std::abs(aspect / *options_.aspect - 1) > kMostOff)
    return UsageError(fmt::format(
        "{}: has {} x {} pixels, width / height {:.3f}, but the display has {:.3f}: render the "
        "views of {{lfpath device}}",
        moments_[0].files[0].string(), of_view().width, of_view().height, aspect,
        *options_.aspect));
  if (tile().width > of_view().width || tile().height > of_view().height)
    return UsageError(fmt::format(
        "{}: has {} x {} pixels, and a tile of the quilt {} x {}: render views of at least this "
        "size, or make the tiles smaller ({{tile}})",
        moments_[0].files[0].string(), of_view().width, of_view().height, tile().width,
        tile().height));
  const int64_t pixels = int64_t{report_.width} * report_.height;
  if (pixels > kMostPixels)
    return InputError(fmt::format(
        "{} views of {} x {} pixels would become a picture of {} pixels: expected at "
        "most {}; render smaller views",
        report_.view_count, header_.info.width, header_.info.height, pixels, kMostPixels));
  // A video of odd size is cropped by a pixel, which would move the tiles of a quilt.
  if (is_video() && options_.layout == ViewLayout::kQuilt &&
      (report_.width % 2 != 0 || report_.height % 2 != 0))
    return InputError(
        fmt::format("{} x {} views of {} x {} pixels become a quilt of {} x {}, and a video needs "
                    "an even width and height: render views of even size",
                    options_.grid.columns, options_.grid.rows, tile().width, tile().height,
                    report_.width, report_.height));
  return {};
}

// Checks that the files replace no frame.
Result<void> FilmWriter::CheckTargets() const {
  std::vector<OutputFile> outputs;
  for (const Target& target : targets_) outputs.emplace_back(target.file, "a picture");
  std::vector<fs::path> frames;
  for (const ViewMoment& moment : moments_)
    frames.insert(frames.end(), moment.files.begin(), moment.files.end());
  LF_ASSIGN_OR_RETURN(const OutputFiles files, OutputFiles::Make(std::move(outputs)));
  return files.CheckReplacesNone(frames, "a frame that is joined");
}

// Checks that the file may be written, and decides whether it is kept.
Result<void> FilmWriter::CheckTarget(Target* target) const {
  std::error_code error;
  if (!fs::exists(target->file, error)) return {};
  if (is_video()) LF_RETURN_IF_ERROR(CheckVideoTarget(target->file, "{output}"));
  if (options_.overwrite) return {};
  if (!options_.resume)
    return UsageError(
        fmt::format("{}: exists already: give another name, keep what exists with {{resume}}, or "
                    "replace it with "
                    "{{overwrite}}",
                    target->file.string()));
  LF_ASSIGN_OR_RETURN(target->is_kept, IsMadeOfThese(*target));
  return {};
}

// Returns the inputs that the file states: layout, moments, a hash of its frames, and its rate.
Result<FileInputs> FilmWriter::InputsOf(const Target& target) const {
  std::vector<fs::path> files;
  for (const ViewMoment& moment : target.moments) {
    const std::span<const fs::path> views = moment.files;
    const auto taken = target.eye ? views.subspan(static_cast<size_t>(*target.eye), 1) : views;
    files.insert(files.end(), taken.begin(), taken.end());
  }
  LF_ASSIGN_OR_RETURN(const std::string frames, HashOfFiles(files, pool_, options_.is_interrupted));
  FileInputs inputs = {{"layout", LayoutText()},
                       {"moment", fmt::format("{}", target.moments[0].number)},
                       {"moments", fmt::format("{}", target.moments.size())},
                       {"frames", frames}};
  if (report_.fps) inputs.emplace_back("fps", fmt::format("{}", *report_.fps));
  return inputs;
}

// Returns true if the file that exists was made of these frames, in this way, and is whole. kUsage:
// it was made of others.
Result<bool> FilmWriter::IsMadeOfThese(const Target& target) const {
  if (is_copied(target)) {
    const fs::path frame = target.moments[0].files[static_cast<size_t>(*target.eye)];
    LF_ASSIGN_OR_RETURN(const std::string copy, HashOfFiles(std::span(&target.file, 1), pool_));
    LF_ASSIGN_OR_RETURN(const std::string original, HashOfFiles(std::span(&frame, 1), pool_));
    if (copy == original) return true;
    return CannotResume(target.file, fmt::format("is no copy of {}", frame.string()));
  }
  const std::optional<FileInputs> stated = ReadInputs(target.file);
  if (!stated) return CannotResume(target.file, "does not tell what it was made of");
  LF_ASSIGN_OR_RETURN(const FileInputs asked, InputsOf(target));
  for (size_t i = 0; i < asked.size(); ++i) {
    if (i < stated->size() && (*stated)[i] == asked[i]) continue;
    const std::string was = i < stated->size() ? (*stated)[i].second : "something else";
    return CannotResume(target.file, fmt::format("was made with {} {}, and this call has {}",
                                                 asked[i].first, was, asked[i].second));
  }
  if (is_video()) return true;
  const Result<void> whole = CheckFileIsWhole(target.file);
  if (!whole) LogWarning("{}; it is made again", whole.error().message);
  return whole.has_value();
}

Result<void> FilmWriter::PlanTargets() {
  const int eye_count = is_left_right() ? 2 : 1;
  const std::span<const ViewMoment> moments = moments_;
  const size_t picture_count = is_video() ? 1 : moments.size();
  for (size_t i = 0; i < picture_count; ++i)
    for (int eye = 0; eye < eye_count; ++eye) {
      ViewFileName name = {options_.layout, options_.grid, header_.info.width, header_.info.height};
      if (picture_count > 1) name.moment = moments[i].number;
      name.eye = eye;
      Target target;
      LF_ASSIGN_OR_RETURN(target.file, PathOfViews(options_.output, name));
      target.moments = is_video() ? moments : moments.subspan(i, 1);
      if (is_left_right()) target.eye = eye;
      targets_.push_back(std::move(target));
    }
  LF_RETURN_IF_ERROR(CheckTargets());
  // The lock keeps the files of two calls from being mixed.
  LF_ASSIGN_OR_RETURN(lock_, LockOutput(options_.output));
  for (Target& target : targets_) LF_RETURN_IF_ERROR(CheckTarget(&target));
  for (const Target& target : targets_) {
    report_.files.push_back(target.file);
    const size_t views = target.eye ? 1 : static_cast<size_t>(report_.view_count);
    total_ += target.is_kept ? 0 : target.moments.size() * views;
    report_.kept_count += target.is_kept ? 1 : 0;
  }
  return {};
}

Result<void> FilmWriter::ChooseRate() {
  if (!is_video()) return {};
  report_.fps = options_.fps ? options_.fps : header_.colours.frames_per_second;
  if (report_.fps) return {};
  report_.fps = kDefaultFps;
  LogWarning("{}: states no frames per second ({} are used; set {{fps}})",
             moments_[0].files[0].string(), kDefaultFps);
  return {};
}

// Counts a view that has been joined. Returns false if the film is interrupted.
bool FilmWriter::CountView() {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (on_progress_) on_progress_(done_, total_);
  return !(options_.is_interrupted && options_.is_interrupted());
}

Result<StoredImage> FilmWriter::Join(const ViewMoment& moment, std::optional<int> eye) {
  std::span<const fs::path> files = moment.files;
  JoinOptions options = join();
  if (eye) {
    // A single view is a quilt of one tile.
    files = files.subspan(static_cast<size_t>(*eye), 1);
    options.layout = ViewLayout::kQuilt;
    options.grid = {};
    options.tile.reset();
  }
  return JoinViews(files, header_, options, pool_, [this] { return CountView(); });
}

Result<void> FilmWriter::WriteVideo(const Target& target) {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<VideoWriter> video,
                      VideoWriter::Open(target.file, report_.width, report_.height, *report_.fps));
  for (const ViewMoment& moment : target.moments) {
    LF_ASSIGN_OR_RETURN(const StoredImage joined, Join(moment, target.eye));
    LF_RETURN_IF_ERROR(video->Add(std::get<Image<uint8_t>>(joined)));
  }
  LF_ASSIGN_OR_RETURN(const FileInputs inputs, InputsOf(target));
  return video->Close(TextOfInputs(inputs));
}

Result<void> FilmWriter::CopyFrame(const Target& target) {
  const fs::path& frame = target.moments[0].files[static_cast<size_t>(*target.eye)];
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(frame));
  LF_RETURN_IF_ERROR(WriteFileAtomically(target.file, bytes));
  if (!CountView()) return Interrupted();
  return {};
}

Result<void> FilmWriter::WriteTarget(const Target& target) {
  if (is_video()) return WriteVideo(target);
  if (is_copied(target)) return CopyFrame(target);
  const ViewMoment& moment = target.moments[0];
  LF_ASSIGN_OR_RETURN(const FileInputs inputs, InputsOf(target));
  LF_ASSIGN_OR_RETURN(const StoredImage joined, Join(moment, target.eye));
  LF_ASSIGN_OR_RETURN(const std::vector<std::string> names,
                      JoinedChannels(header_, join(), moment.files[0].string()));
  const ImageMetadata metadata = {{"lf:layout", LayoutText()},
                                  {"imageCounter", moment.number},
                                  {kInputsText, TextOfInputs(inputs)}};
  const ColourFacts colours =
      is_developed()
          ? ColourFacts{PixelType::kUint8, {}, header_.colours.frames_per_second, true, {}}
          : header_.colours;
  return WriteStoredImage(target.file, joined, names, colours, metadata, options_.is_interrupted);
}

Result<ViewFilmReport> FilmWriter::Write(std::span<const fs::path> frames) {
  report_.view_count = ViewCountOf(options_.layout, options_.grid);
  LF_ASSIGN_OR_RETURN(moments_, FindViewMoments(frames, report_.view_count));
  report_.moment_count = moments_.size();
  LF_RETURN_IF_ERROR(CheckOutput());
  LF_ASSIGN_OR_RETURN(header_, CommonHeader(moments_, pool_));
  if (is_video() || is_developed() || !is_left_right())
    LF_RETURN_IF_ERROR(JoinedChannels(header_, join(), moments_[0].files[0].string()));
  const TileCounts grid = GridOf(options_.layout, options_.grid);
  report_.width = grid.columns * tile().width;
  report_.height = grid.rows * tile().height;
  LF_RETURN_IF_ERROR(CheckShape());
  LF_RETURN_IF_ERROR(ChooseRate());
  if (const Result<void> planned = PlanTargets(); !planned)
    return planned.error().kind == ErrorKind::kInterrupted ? Interrupted() : planned.error();
  for (const Target& target : targets_) {
    if (target.is_kept) continue;
    if (options_.is_interrupted && options_.is_interrupted()) return Interrupted();
    const Result<void> written = WriteTarget(target);
    if (!written && written.error().kind == ErrorKind::kInterrupted) return Interrupted();
    if (!written) return written.error();
  }
  return report_;
}

}  // namespace

Result<ViewFilmReport> WriteViewFilm(std::span<const fs::path> frames,
                                     const ViewFilmOptions& options, ThreadPool& pool,
                                     const std::function<void(size_t, size_t)>& on_progress) {
  return FilmWriter(options, pool, on_progress).Write(frames);
}

}  // namespace lf
