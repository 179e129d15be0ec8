// SPDX-License-Identifier: Apache-2.0
#include "lf/import/video/video_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "lf/core/child_process.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostVideoFrames = size_t{1} << 24;
constexpr double kMostVideoTime_s = 1e9;

// Reads the fields KEY=VALUE of a line SECTION|KEY=VALUE|KEY=VALUE.
class ProbeLine {
 public:
  explicit ProbeLine(std::string_view line) : line_(line) {}

  std::string_view section() const { return line_.substr(0, line_.find('|')); }

  // Returns the value of a key; "" if it is missing.
  std::string_view Value(std::string_view key) const {
    std::string_view rest = line_;
    while (true) {
      const size_t bar = rest.find('|');
      if (bar == rest.npos) return {};
      rest.remove_prefix(bar + 1);
      const std::string_view field = rest.substr(0, rest.find('|'));
      if (field.size() > key.size() && field.starts_with(key) && field[key.size()] == '=')
        return field.substr(key.size() + 1);
    }
  }

  std::string Word(std::string_view key, const char* otherwise) const {
    const std::string_view value = Value(key);
    return value.empty() || value == "N/A" ? otherwise : std::string(value);
  }

 private:
  std::string_view line_;
};

struct ShownFrame {
  double time_s = 0;
  bool is_key = false;
};

std::optional<double> TimeOf(std::string_view word) {
  const std::optional<double> time_s = ParseNumber(word);
  if (!time_s || !(std::abs(*time_s) <= kMostVideoTime_s)) return std::nullopt;
  return time_s;
}

Result<void> CheckFacts(const RecordedVideo& video, const fs::path& path) {
  constexpr int kMostSide_px = 65536;
  const auto is_side = [](int side) { return side >= 1 && side <= kMostSide_px; };
  if (!is_side(video.width_px) || !is_side(video.height_px))
    return InputError(fmt::format(
        "{}: has frames of {} x {} pixels: expected a video with 1 to {} pixels on each side",
        path.string(), video.width_px, video.height_px, kMostSide_px));
  if (video.shown_s.empty())
    return InputError(fmt::format("{}: holds no frame: expected a video", path.string()));
  for (const char* const of_displays : {"smpte2084", "arib-std-b67"})
    if (video.transfer == of_displays)
      return InputError(fmt::format(
          "{}: its light is coded for displays of high dynamic range ({}), which is not converted: "
          "convert the video to BT.709 first, or decode its frames to EXR files",
          path.string(), video.transfer));
  return {};
}

}  // namespace

bool IsDeep(const RecordedVideo& video) {
  // The formats of packed pixels with few bits end in the order of their bytes, as deep ones do.
  const std::string& format = video.pixel_format;
  for (const char* const shallow : {"rgb444", "bgr444", "rgb555", "bgr555", "rgb565", "bgr565"})
    if (format.starts_with(shallow)) return false;
  return format.ends_with("le") || format.ends_with("be");
}

std::vector<double> SecondsFromFirst(const RecordedVideo& video) {
  std::vector<double> times = video.shown_s;
  for (double& time : times) time -= video.shown_s.front();
  return times;
}

bool IsRecordedVideoName(std::string_view file_name) {
  constexpr std::array kEndings = {".mp4", ".m4v",  ".mov", ".mkv", ".webm", ".avi",
                                   ".mts", ".m2ts", ".ts",  ".mpg", ".mpeg", ".mxf",
                                   ".wmv", ".ogv",  ".flv", ".3gp", ".y4m",  ".nut"};
  if (file_name.starts_with('.') || file_name.find('.') == file_name.npos) return false;
  std::string ending(file_name.substr(file_name.rfind('.')));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

Result<RecordedVideo> ParseVideoFacts(std::string_view text, const fs::path& path) {
  RecordedVideo video;
  bool has_stream = false;
  std::vector<ShownFrame> frames;
  while (!text.empty()) {
    const ProbeLine line(text.substr(0, text.find('\n')));
    text.remove_prefix(
        std::min(text.size(), text.find('\n') == text.npos ? text.size() : text.find('\n') + 1));
    if (line.section() == "stream" && !has_stream) {
      has_stream = true;
      video.width_px = ParseWhole<int>(line.Value("width")).value_or(0);
      video.height_px = ParseWhole<int>(line.Value("height")).value_or(0);
      video.pixel_format = line.Word("pix_fmt", "");
      video.range = line.Word("color_range", "unknown");
      video.matrix = line.Word("color_space", "unknown");
      video.transfer = line.Word("color_transfer", "unknown");
    } else if (line.section() == "format") {
      video.begin_s = TimeOf(line.Value("start_time")).value_or(0);
    } else if (line.section() == "packet") {
      const std::string_view flags = line.Value("flags");
      // A packet with this flag is decoded for the sake of others, and not shown.
      if (flags.find('D') != flags.npos) continue;
      const std::optional<double> time_s = TimeOf(line.Value("pts_time"));
      if (!time_s)
        return InputError(fmt::format(
            "{}: its frame {} has no time: put the stream into a file that states times, for "
            "instance an mp4",
            path.string(), frames.size()));
      if (frames.size() == kMostVideoFrames)
        return InputError(fmt::format("{}: holds more than {} frames: divide it", path.string(),
                                      kMostVideoFrames));
      frames.push_back({*time_s, flags.find('K') != flags.npos});
    }
  }
  if (!has_stream)
    return InputError(fmt::format("{}: holds no video: expected one", path.string()));
  // Packets come in the order of decoding.
  std::stable_sort(frames.begin(), frames.end(),
                   [](const ShownFrame& a, const ShownFrame& b) { return a.time_s < b.time_s; });
  for (const ShownFrame& frame : frames) {
    if (!video.shown_s.empty() && frame.time_s == video.shown_s.back()) continue;
    if (frame.is_key) video.keys.push_back(video.shown_s.size());
    video.shown_s.push_back(frame.time_s);
  }
  LF_RETURN_IF_ERROR(CheckFacts(video, path));
  return video;
}

Result<RecordedVideo> ReadVideoFacts(const fs::path& path) {
  constexpr double kPatience_s = 600;
  const Result<CommandAnswer> answer = RunCommand(
      {"ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
       "packet=pts_time,flags:stream=width,height,pix_fmt,color_range,color_space,color_transfer:"
       "format=start_time",
       "-of", "compact", "file:" + path.string()},
      kPatience_s);
  if (!answer) return OutputError(answer.error().message + kFfmpegAdvice);
  if (answer->exit_code != 0) {
    const std::string& words = answer->complaints;
    return InputError(
        fmt::format("{}: cannot be read as a video: {}", path.string(),
                    words.empty() ? "ffprobe fails" : OneLine(words.substr(0, words.find('\n')))));
  }
  return ParseVideoFacts(answer->output, path);
}

}  // namespace lf
