// SPDX-License-Identifier: Apache-2.0
#include "lf/import/video/video_frames.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "lf/core/child_process.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/temporary_file.h"
#include "lf/light_field/model/value_hasher.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// A change of the code that gives decoded frames other pixels raises it.
constexpr double kDecodingVersion = 1;
// ffmpeg uses several threads for each video.
constexpr size_t kVideosTogether = 4;
// The largest number of ranges of frames in one call of ffmpeg, whose words have a limited length.
constexpr size_t kMostRanges = 1000;

// A range [begin, end) of frames.
struct FrameRange {
  size_t begin = 0, end = 0;
};

std::vector<FrameRange> RangesOf(std::span<const size_t> frames) {
  std::vector<FrameRange> ranges;
  for (const size_t frame : frames) {
    if (!ranges.empty() && ranges.back().end == frame)
      ++ranges.back().end;
    else
      ranges.push_back({frame, frame + 1});
  }
  return ranges;
}

// Returns the filter that converts colours, after `select` has chosen frames.
std::string FilterOf(const RecordedVideo& video, const std::string& select) {
  constexpr int kHd = 720;
  std::string matrix;
  if (video.matrix == "unknown" || video.matrix == "reserved")
    matrix = video.height_px >= kHd ? ":in_color_matrix=bt709" : ":in_color_matrix=bt601";
  return fmt::format(
      "select='{}',scale=out_range=pc{}:flags=bicubic+accurate_rnd+full_chroma_int+full_chroma_inp,"
      "format={}",
      select, matrix, IsDeep(video) ? "rgb48be" : "rgb24");
}

// Returns the words that choose ranges of frames by their times. The bounds lie in the middle
// between neighbouring frames, so that rounded times do not matter.
std::string SelectByTime(const RecordedVideo& video, std::span<const FrameRange> ranges) {
  constexpr double kFar_s = 1e9, kLeastGap_s = 1e-3;
  const std::vector<double>& shown = video.shown_s;
  std::string words;
  for (const FrameRange& range : ranges) {
    const double first =
        range.begin == 0 ? -kFar_s : 0.5 * (shown[range.begin - 1] + shown[range.begin]);
    const double last = range.end == shown.size() ? shown[range.end - 1] + kLeastGap_s
                                                  : 0.5 * (shown[range.end - 1] + shown[range.end]);
    words += fmt::format("{}between(t,{:.7f},{:.7f})", words.empty() ? "" : "+", first, last);
  }
  return words;
}

std::string SelectByNumber(std::span<const FrameRange> ranges) {
  std::string words;
  for (const FrameRange& range : ranges)
    words +=
        fmt::format("{}between(n,{},{})", words.empty() ? "" : "+", range.begin, range.end - 1);
  return words;
}

// Returns the time to which ffmpeg seeks before it decodes a frame, from the beginning of the file:
// that of the key frame before the last one, because frames may refer to frames before the last key
// frame. nullopt: the video is decoded from its beginning.
std::optional<double> SeekTime(const RecordedVideo& video, size_t frame) {
  const auto after = std::upper_bound(video.keys.begin(), video.keys.end(), frame);
  if (after - video.keys.begin() < 3) return std::nullopt;
  return video.shown_s[*(after - 2)] - video.begin_s;
}

// Decodes frames of one video.
class VideoDecoder {
 public:
  VideoDecoder(const WantedFrames& video, const fs::path& folder)
      : video_(video), folder_(folder) {}

  Result<void> Decode() {
    std::vector<size_t> missing;
    for (const size_t frame : video_.frames) {
      std::error_code error;
      if (!fs::exists(FileOf(frame), error)) missing.push_back(frame);
    }
    if (!missing.empty()) LF_RETURN_IF_ERROR(CreateFolder(FileOf(missing[0]).parent_path()));
    while (!missing.empty()) {
      std::vector<FrameRange> ranges = RangesOf(missing);
      if (ranges.size() > kMostRanges) ranges.resize(kMostRanges);
      const auto next = std::lower_bound(missing.begin(), missing.end(), ranges.back().end);
      LF_RETURN_IF_ERROR(DecodeSome({missing.begin(), next}, ranges));
      missing.erase(missing.begin(), next);
    }
    for (const size_t frame : video_.frames)  // the time of use
      ::utimensat(AT_FDCWD, FileOf(frame).c_str(), nullptr, 0);
    return {};
  }

 private:
  fs::path FileOf(size_t frame) const { return folder_ / DecodedName(video_.file, frame); }

  // Returns the name under which ffmpeg writes the i-th frame of a call.
  fs::path UnfinishedFile(size_t i) const {
    return TemporaryPath(FileOf(0).parent_path() / fmt::format("{:06}.png", i));
  }

  // Removes what a call of ffmpeg has written, in this process or in one that died.
  void RemoveUnfinished(size_t count) const {
    for (size_t i = 0; i < count; ++i) {
      const fs::path file = UnfinishedFile(i);
      RemoveLeftovers(FileOf(0).parent_path() / fmt::format("{:06}.png", i));
      std::error_code ignored;
      fs::remove(file, ignored);
    }
  }

  Result<void> DecodeSome(const std::vector<size_t>& frames,
                          std::span<const FrameRange> ranges) const {
    RemoveUnfinished(frames.size());
    const std::optional<double> seek_s = SeekTime(video_.facts, frames.front());
    Result<size_t> count = Run(seek_s, SelectByTime(video_.facts, ranges), frames.size());
    // Seeking is exact for nearly all files; counting from the first frame is exact for all.
    if (!count ? count.error().kind == ErrorKind::kInput : *count != frames.size()) {
      RemoveUnfinished(frames.size());
      count = Run(std::nullopt, SelectByNumber(ranges), frames.size());
    }
    if (!count || *count != frames.size()) RemoveUnfinished(frames.size());
    if (!count) return count.error();
    if (*count != frames.size())
      return InputError(fmt::format(
          "{}: only {} of the {} frames from frame {} on can be decoded: the video is damaged",
          video_.file.string(), *count, frames.size(), frames.front()));
    std::vector<Renaming> names;
    for (size_t i = 0; i < frames.size(); ++i)
      names.push_back({UnfinishedFile(i), FileOf(frames[i])});
    return RenameFlushed(names);
  }

  // Runs ffmpeg. Returns the number of frames that it has written.
  Result<size_t> Run(const std::optional<double>& seek_s, const std::string& select,
                     size_t count) const {
    constexpr double kPatience_s = 7200;
    std::string pattern = UnfinishedFile(0).string();
    const std::string folder = FileOf(0).parent_path().string();
    // The name of the folder may hold a % of its own.
    std::string escaped;
    for (const char letter : folder) escaped += letter == '%' ? "%%" : std::string(1, letter);
    std::string name = pattern.substr(folder.size());
    name.replace(name.find("000000"), 6, "%06d");
    // -xerror: a frame that is damaged, and would be concealed, is an error.
    std::vector<std::string> words = {"ffmpeg",    "-hide_banner", "-nostdin", "-nostats",
                                      "-loglevel", "error",        "-xerror",  "-copyts"};
    if (seek_s) words.insert(words.end(), {"-ss", fmt::format("{:.6f}", std::max(0.0, *seek_s))});
    for (std::string& word : std::vector<std::string>{"-i",
                                                      "file:" + video_.file.string(),
                                                      "-map",
                                                      "0:v:0",
                                                      "-an",
                                                      "-sn",
                                                      "-dn",
                                                      "-vf",
                                                      FilterOf(video_.facts, select),
                                                      "-fps_mode",
                                                      "passthrough",
                                                      "-frames:v",
                                                      fmt::format("{}", count),
                                                      "-c:v",
                                                      "png",
                                                      "-compression_level",
                                                      "3",
                                                      "-start_number",
                                                      "0",
                                                      "-f",
                                                      "image2",
                                                      "-y",
                                                      "file:" + escaped + name})
      words.push_back(std::move(word));
    const Result<CommandAnswer> answer = RunCommand(words, kPatience_s);
    if (!answer) return OutputError(answer.error().message + kFfmpegAdvice);
    if (answer->exit_code != 0) {
      const std::string why = OneLine(answer->complaints.substr(0, answer->complaints.find('\n')));
      for (const char* const of_disk : {"No space left", "Permission denied", "File too large",
                                        "Disk quota", "Read-only file system"})
        if (answer->complaints.find(of_disk) != std::string::npos)
          return OutputError(fmt::format("{}: frames of {} cannot be written: {}", folder,
                                         video_.file.string(), why));
      return InputError(fmt::format("{}: frame {} cannot be decoded: {}", video_.file.string(),
                                    video_.frames.front(), why.empty() ? "ffmpeg fails" : why));
    }
    size_t written = 0;
    std::error_code error;
    while (written < count && fs::exists(UnfinishedFile(written), error)) ++written;
    return written;
  }

  const WantedFrames& video_;
  const fs::path& folder_;
};

}  // namespace

std::string DecodedName(const fs::path& video, size_t frame) {
  struct stat status {};
  ValueHasher hasher;
  hasher.Add(kDecodingVersion);
  hasher.Add(video.filename().string());
  if (::stat(video.c_str(), &status) == 0)
    for (const double value :
         {static_cast<double>(status.st_size), static_cast<double>(status.st_mtim.tv_sec),
          static_cast<double>(status.st_mtim.tv_nsec)})
      hasher.Add(value);
  return fmt::format("{}-{}/{:06}.png", video.stem().string(), hasher.Text(), frame);
}

Result<std::vector<std::optional<Error>>> DecodeFrames(std::span<const WantedFrames> videos,
                                                       const fs::path& folder) {
  // Temporary names of a file differ between processes, and not between threads.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  std::vector<std::optional<Error>> errors(videos.size());
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t i = next++; i < videos.size(); i = next++)
      if (const Result<void> decoded = VideoDecoder(videos[i], folder).Decode(); !decoded) {
        errors[i] = decoded.error();
        if (decoded.error().kind != ErrorKind::kInput) next = videos.size();
      }
  };
  std::vector<std::thread> threads;
  for (size_t i = 0; i < std::min(kVideosTogether, videos.size()); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  for (const std::optional<Error>& error : errors)
    if (error && error->kind != ErrorKind::kInput) return *error;
  return errors;
}

Result<fs::path> DecodedFramesBeside(const fs::path& light_field) {
  std::error_code error;
  const fs::path place = fs::canonical(light_field, error);
  const fs::path around = place.parent_path();
  struct stat status {};
  if (error || !place.has_filename() || ::stat(around.c_str(), &status) != 0 ||
      status.st_uid != ::geteuid() || ::access(around.c_str(), W_OK | X_OK) != 0)
    return OutputError(fmt::format(
        "{}: frames of its videos cannot be decoded beside it, because {} cannot be written or "
        "belongs to another user: name a folder for them ({{frame_cache}})",
        light_field.string(), around.string()));
  return fs::path(place) += ".frames";
}

void RemoveOldFrames(const fs::path& folder, uint64_t most_bytes) {
  struct OldFile {
    fs::file_time_type used;
    uint64_t size_bytes;
    fs::path path;
  };
  constexpr auto kStays = std::chrono::hours(24);
  const fs::file_time_type now = fs::file_time_type::clock::now();
  std::vector<OldFile> old;
  uint64_t sum_bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    const uint64_t size_bytes = it->file_size(ignored);
    const fs::file_time_type used = it->last_write_time(ignored);
    if (ignored) continue;
    sum_bytes += size_bytes;
    if (it->path().extension() == ".png" && now - used > kStays)
      old.push_back({used, size_bytes, it->path()});
  }
  std::sort(old.begin(), old.end(),
            [](const OldFile& a, const OldFile& b) { return a.used < b.used; });
  for (const OldFile& file : old) {
    if (sum_bytes <= most_bytes) break;
    std::error_code ignored;
    if (fs::remove(file.path, ignored)) sum_bytes -= file.size_bytes;
    fs::remove(file.path.parent_path(), ignored);  // fails unless it is empty
  }
}

}  // namespace lf
