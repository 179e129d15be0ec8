// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/open_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/core/shell_word.h"
#include "lf/core/spelling.h"
#include "lf/import/exports/read_google_models.h"
#include "lf/import/formats/read_llff.h"
#include "lf/import/video/video_facts.h"
#include "lf/import/video/video_frames.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/light_field/model/time_slices.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kUsualFps = 30;  // of frames without a rate, as in Neural 3D Video

bool IsOfPath(const OpenOptions& options) { return !options.time && !options.path_times.empty(); }

// Facts about a camera, known once its video or its files were looked at.
struct CameraRecord {
  std::optional<Error> fault;
  RecordedVideo facts;                     // of a video
  std::map<size_t, std::string> numbered;  // image files by the number of their frame
  std::vector<double> times_s;             // of the frames, ascending
};

// Calls body(i) for each i below count, on a few threads.
template <class Body>
void OnThreads(size_t count, const Body& body) {
  constexpr size_t kMostThreads = 8;
  std::atomic<size_t> next = 0;
  std::vector<std::thread> threads;
  for (size_t t = 0; t < std::min(kMostThreads, count); ++t)
    threads.emplace_back([&] {
      for (size_t i = next++; i < count; i = next++) body(i);
    });
  for (std::thread& thread : threads) thread.join();
}

// Returns the number at the end of the name of an image file, before its ending.
std::optional<size_t> NumberOfFrame(const std::string& file) {
  const std::string stem = fs::path(file).stem().string();
  const size_t last = stem.find_last_not_of("0123456789");
  return ParseWhole<uint32_t>(std::string_view(stem).substr(last == stem.npos ? 0 : last + 1));
}

// Reads the light field video of a folder.
class VideoOpener {
 public:
  VideoOpener(const VideoFolder& found, const OpenOptions& options, const fs::path& asked_for)
      : found_(found), options_(options), asked_for_(asked_for), records_(found.cameras.size()) {}

  Result<LightField> Open() {
    LF_RETURN_IF_ERROR(CheckCounts());
    LF_RETURN_IF_ERROR(LookAtFrames());
    LF_RETURN_IF_ERROR(FindTimes());
    LF_ASSIGN_OR_RETURN(const std::vector<double> slices,
                        SlicesOf(options_, asked_for_, facts_, times_));
    LF_RETURN_IF_ERROR(ChooseFrames(slices));
    LF_RETURN_IF_ERROR(Decode());
    return Build(slices);
  }

  // Returns those of `times` that the options ask for: the nearest ones, ascending. Errors as for
  // OpenVideoFolder().
  static Result<std::vector<double>> SlicesOf(const OpenOptions& options, const fs::path& path,
                                              const VideoFacts& facts,
                                              std::span<const double> times);

 private:
  bool HasVideos() const { return !found_.cameras[0].video.empty(); }
  bool IsLlff() const { return found_.calibration.filename() == kLlffName; }

  Result<void> CheckCounts() const {
    if (!IsLlff()) return {};
    const size_t rows = PoseRowCount(found_.calibration);
    if (rows == found_.cameras.size()) return {};
    return InputError(fmt::format(
        "{}: holds {} poses, but there are {} {} beside it, from {} to {}: expected one for each "
        "pose, in the order of their names",
        found_.calibration.string(), rows, found_.cameras.size(),
        HasVideos() ? "videos" : "folders of frames", found_.cameras.front().name,
        found_.cameras.back().name));
  }

  // Reads the times of all frames.
  Result<void> LookAtFrames() {
    if (HasVideos()) {
      OnThreads(records_.size(), [this](size_t i) {
        Result<RecordedVideo> facts = ReadVideoFacts(found_.cameras[i].video);
        if (!facts) {
          records_[i].fault = facts.error();
          return;
        }
        records_[i].facts = *std::move(facts);
        records_[i].times_s = SecondsFromFirst(records_[i].facts);
      });
    } else {
      NumberFrames();
    }
    size_t fault_count = 0;
    for (const CameraRecord& record : records_) {
      if (!record.fault) continue;
      if (record.fault->kind != ErrorKind::kInput) return *record.fault;
      if (++fault_count == records_.size()) return *records_.front().fault;
      LogWarning("{}; its LF image is missing", record.fault->message);
    }
    return {};
  }

  // Finds the frame that each image file is: its number counts from the smallest number of all
  // cameras, so that a lost file shifts no other. Files without numbers count by their order.
  void NumberFrames() {
    size_t first = SIZE_MAX;
    bool are_numbered = true;
    for (size_t i = 0; i < records_.size(); ++i)
      for (const std::string& file : found_.cameras[i].frames) {
        const std::optional<size_t> number = NumberOfFrame(file);
        are_numbered = are_numbered && number;
        first = std::min(first, number.value_or(0));
      }
    const double fps = options_.recorded_fps.value_or(kUsualFps);
    for (size_t i = 0; i < records_.size(); ++i) {
      size_t order = 0;
      for (const std::string& file : found_.cameras[i].frames)
        records_[i].numbered.emplace(are_numbered ? *NumberOfFrame(file) - first : order++, file);
      for (const auto& [number, file] : records_[i].numbered)
        records_[i].times_s.push_back(static_cast<double>(number) / fps);
    }
    if (!options_.recorded_fps)
      LogInfo("{}: frames are taken as {} for each second ({{recorded_fps}} states another rate)",
              asked_for_.string(), kUsualFps);
  }

  // Finds the recording times: those of the camera with the most frames.
  Result<void> FindTimes() {
    if (HasVideos() && options_.recorded_fps)
      return UsageError(
          fmt::format("{{recorded_fps}} is for folders of frames, which state no rate; the videos "
                      "of {} state it: "
                      "leave the option out",
                      asked_for_.string()));
    size_t longest = 0;
    for (size_t i = 0; i < records_.size(); ++i)
      if (records_[i].times_s.size() > records_[longest].times_s.size()) longest = i;
    times_ = records_[longest].times_s;
    facts_ = {records_.size(), times_.size(), times_.front(), times_.back(), RateOfTimes(times_)};
    for (size_t i = 0; i < records_.size(); ++i) {
      const std::vector<double>& own = records_[i].times_s;
      if (records_[i].fault || (own.size() == times_.size() && own.back() == times_.back()))
        continue;
      LogWarning(
          "{}: {} has {} frames up to {:.5g} s, but {} has {} up to {:.5g} s: each camera shows "
          "its "
          "frame nearest to the time, counted from its first frame",
          asked_for_.string(), found_.cameras[i].name, own.size(), own.back(),
          found_.cameras[longest].name, times_.size(), times_.back());
      break;
    }
    return {};
  }

  // Returns the frame of a camera that is shown at a time, as an index in its times; nullopt if it
  // has none, because it ends earlier or because a file is lost.
  std::optional<size_t> FrameAt(size_t camera, double time_s) const {
    const std::vector<double>& own = records_[camera].times_s;
    if (records_[camera].fault || own.empty()) return std::nullopt;
    const size_t nearest = NearestTime(own, time_s);
    const double step = own.size() > 1
                            ? (own.back() - own.front()) / static_cast<double>(own.size() - 1)
                        : times_.size() > 1 ? times_[1] - times_[0]
                                            : 1;
    // A frame of a video is shown until the next one. Frames in files have equal steps.
    const bool is_within = HasVideos() ? time_s <= own.back() + 0.75 * step
                                       : std::abs(own[nearest] - time_s) * 2 < FileStep();
    return is_within ? std::optional(nearest) : std::nullopt;
  }

  double FileStep() const { return 1 / options_.recorded_fps.value_or(kUsualFps); }

  // Chooses the frame of each camera for each slice.
  Result<void> ChooseFrames(const std::vector<double>& slices) {
    frames_.assign(slices.size(), {});
    std::vector<size_t> missing_count(records_.size());
    for (size_t s = 0; s < slices.size(); ++s)
      for (size_t i = 0; i < records_.size(); ++i) {
        frames_[s].push_back(FrameAt(i, slices[s]));
        if (!frames_[s].back() && !records_[i].fault) ++missing_count[i];
      }
    for (size_t i = 0; i < records_.size(); ++i)
      if (missing_count[i] > 0)
        LogWarning(
            "{}: {} has no frame at {} of the {} times, such as {:.5g} s; its LF images are "
            "missing",
            asked_for_.string(), found_.cameras[i].name, missing_count[i], slices.size(),
            FirstMissing(i, slices));
    return {};
  }

  double FirstMissing(size_t camera, const std::vector<double>& slices) const {
    for (size_t s = 0; s < slices.size(); ++s)
      if (!frames_[s][camera]) return slices[s];
    return 0;
  }

  // Decodes the frames that were chosen.
  Result<void> Decode() {
    if (!HasVideos()) return {};
    const bool is_beside = !options_.frame_cache;
    if (is_beside) {
      LF_ASSIGN_OR_RETURN(decoded_, DecodedFramesBeside(found_.folder));
    } else {
      decoded_ = fs::absolute(*options_.frame_cache);
    }
    std::vector<WantedFrames> wanted;
    std::vector<size_t> cameras;
    for (size_t i = 0; i < records_.size(); ++i) {
      std::set<size_t> frames;
      for (const auto& of_slice : frames_)
        if (of_slice[i]) frames.insert(*of_slice[i]);
      if (frames.empty()) continue;
      wanted.push_back(
          {found_.cameras[i].video, records_[i].facts, {frames.begin(), frames.end()}});
      cameras.push_back(i);
    }
    LogDebug("{}: frames are decoded into {}", asked_for_.string(), decoded_.string());
    LF_ASSIGN_OR_RETURN(const std::vector<std::optional<Error>> errors,
                        DecodeFrames(wanted, decoded_));
    size_t fault_count = 0;
    for (size_t w = 0; w < wanted.size(); ++w) {
      if (!errors[w]) continue;
      if (++fault_count == wanted.size()) return *errors[w];
      LogWarning("{}; its LF image is missing", errors[w]->message);
    }
    if (is_beside) RemoveOldFrames(decoded_);
    return {};
  }

  // Returns the name of the image file of a camera in a slice, relative to the light field's
  // folder. A file that is missing has a name of its own.
  std::string NameOf(size_t camera, size_t slice) const {
    const std::optional<size_t> frame = frames_[slice][camera];
    if (HasVideos())
      return DecodedName(found_.cameras[camera].video,
                         frame.value_or(records_[camera].times_s.size() + slice));
    if (frame) return std::next(records_[camera].numbered.begin(), *frame)->second;
    const fs::path usual = found_.cameras[camera].frames.front();
    return (usual.parent_path() / fmt::format("missing-{:06}", slice)).string() +
           usual.extension().string();
  }

  std::vector<std::string> NamesOf(size_t slice) const {
    std::vector<std::string> names;
    for (size_t i = 0; i < records_.size(); ++i) names.push_back(NameOf(i, slice));
    return names;
  }

  fs::path ImagesFolder() const { return HasVideos() ? decoded_ : found_.folder; }

  // Returns the size of the first image that can be read, because the first one may be missing.
  ImageSizeSource SizeOfAny() const {
    return [this](const fs::path&) -> Result<std::array<int, 2>> {
      std::optional<Error> fault;
      for (size_t i = 0; i < records_.size(); ++i) {
        Result<std::array<int, 2>> size = ImageSizeInHeader(ImagesFolder() / NameOf(i, 0));
        if (size) return size;
        if (!fault) fault = size.error();
      }
      return *fault;
    };
  }

  // Returns the LF cameras of one slice, in the order of NamesOf(), and which of the cameras the
  // calibration has.
  Result<LightField> Calibrated(std::vector<size_t>* cameras) const {
    const std::vector<std::string> names = NamesOf(0);
    if (IsLlff()) {
      LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(found_.calibration, kMostPoseBytes));
      for (size_t i = 0; i < names.size(); ++i) cameras->push_back(i);
      return ParseLlff(bytes, found_.calibration, names, SizeOfAny(), ".");
    }
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(found_.calibration, kMostExportBytes));
    LF_ASSIGN_OR_RETURN(ExportedCameras models, ParseGoogleModels(text, found_.calibration));
    const size_t model_count = models.images.size();
    std::erase_if(models.images, [&](ExportedImage& model) {
      const auto own = std::find_if(
          found_.cameras.begin(), found_.cameras.end(),
          [&](const FilmingCamera& camera) { return camera.name == NameOfModel(model); });
      if (own == found_.cameras.end()) return true;
      const auto index = static_cast<size_t>(own - found_.cameras.begin());
      cameras->push_back(index);
      model.name = names[index];
      return false;
    });
    if (cameras->size() < model_count)
      LogWarning("{}: {} of its {} cameras have no video beside it, and are left out",
                 found_.calibration.string(), model_count - cameras->size(), model_count);
    models.folder = ImagesFolder();
    return FinishExport(std::move(models), found_.calibration, {});
  }

  Result<LightField> Build(const std::vector<double>& slices) const {
    std::vector<size_t> cameras;  // of the LF images of a slice, as indices in found_.cameras
    LF_ASSIGN_OR_RETURN(LightField light_field, Calibrated(&cameras));
    light_field.folder = ImagesFolder();
    const size_t count = light_field.size();
    light_field.times.assign(count, slices[0]);
    for (size_t s = 1; s < slices.size(); ++s)
      for (size_t k = 0; k < count; ++k) {
        const LfCamera camera = light_field.cameras[k];
        light_field.cameras.push_back(camera);
        light_field.image_names.push_back(NameOf(cameras[k], s));
        light_field.times.push_back(slices[s]);
      }
    light_field.slice_times = slices;
    light_field.video = facts_;
    light_field.video->camera_count = count;
    light_field.video->is_of_path = IsOfPath(options_);
    return light_field;
  }

  const VideoFolder& found_;
  const OpenOptions& options_;
  const fs::path& asked_for_;
  std::vector<CameraRecord> records_;  // like found_.cameras
  std::vector<double> times_;          // recording times of the light field, ascending
  VideoFacts facts_;
  std::vector<std::vector<std::optional<size_t>>> frames_;  // [slice][camera]
  fs::path decoded_;
};

Result<std::vector<double>> VideoOpener::SlicesOf(const OpenOptions& options, const fs::path& path,
                                                  const VideoFacts& facts,
                                                  std::span<const double> times) {
  std::vector<double> asked = options.path_times;
  if (options.time) asked = {*options.time};
  if (asked.empty() && options.takes_any_time) asked = {times.front()};
  const std::string span = TextOfSpan(facts);
  if (asked.empty()) {
    const std::string time = fmt::format("{:.6g}", times[times.size() / 2]);
    const std::string cameras =
        facts.camera_count > 0 ? fmt::format(" of {} cameras", facts.camera_count) : "";
    return UsageError(fmt::format(
        "{}: is a light field video{}, {}: say which time is shown, {}", path.string(), cameras,
        span,
        options.call_again
            ? "for instance by: " + options.call_again({CommandLineOption({"time"}), time})
            : fmt::format("such as {{time {}}}", time)));
  }
  const double half_step =
      times.size() > 1 ? 0.5 * (times[times.size() - 1] - times[times.size() - 2]) : 0;
  std::set<double> slices;
  for (const double time : asked) {
    const bool is_within = time >= times.front() - half_step && time <= times.back() + half_step;
    if (!is_within && !options.time)
      return UsageError(fmt::format(
          "the path shows the time {:.6g} (its key time), but {} is a light field video {}: change "
          "from, speed or the number of frames",
          time, path.string(), span));
    if (!is_within)
      return UsageError(
          fmt::format("{{time {:.6g}}}: {} is a light field video {}: give a time in it", time,
                      path.string(), span));
    slices.insert(times[NearestTime(times, time)]);
  }
  return std::vector<double>(slices.begin(), slices.end());
}

}  // namespace

Result<LightField> OpenVideoFolder(const VideoFolder& found, const OpenOptions& options,
                                   const fs::path& asked_for) {
  return VideoOpener(found, options, asked_for).Open();
}

Result<void> ChooseTimes(const OpenOptions& options, const fs::path& path,
                         LightField* light_field) {
  if (light_field->video) return {};
  const std::vector<double> times = DistinctTimes(light_field->times);
  const bool is_video = times.size() > 1 && times.size() < light_field->size();
  if (!is_video) {
    if (options.time || !options.path_times.empty())
      return UsageError(fmt::format(
          "{}: {} is no light field video, which has LF images of several cameras at each of "
          "several times: leave {} out",
          options.time ? "{time}" : "the path moves through time", path.string(),
          options.time ? "the option" : "its key time"));
    if (times.size() > 1)
      LogWarning(
          "{}: each LF image has another recording time: what has moved in the scene meanwhile is "
          "blurred or shown several times",
          path.string());
    return {};
  }
  for (double& time : light_field->times) time = times[NearestTime(times, time)];
  VideoFacts facts = {0,
                      times.size(),
                      times.front(),
                      times.back(),
                      RateOfTimes(times),
                      /*is_in_seconds=*/false};
  LF_ASSIGN_OR_RETURN(const std::vector<double> slices,
                      VideoOpener::SlicesOf(options, path, facts, times));
  std::vector<size_t> kept;
  for (size_t i = 0; i < light_field->size(); ++i)
    if (std::binary_search(slices.begin(), slices.end(), light_field->times[i])) kept.push_back(i);
  KeepImages(kept, light_field);
  light_field->slice_times = slices;
  light_field->video = facts;
  light_field->video->is_of_path = IsOfPath(options);
  return {};
}

}  // namespace lf
