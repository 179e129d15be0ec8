// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/video.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/child_process.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/temporary_file.h"
#include "lf/film/develop/file_inputs.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns the frame rate as text for ffmpeg. A rate of television, N * 1000 / 1001, becomes this
// fraction even if it is rounded to two decimals or more: 29.97 becomes 30000/1001, and 23.976 and
// 23.98 become 24000/1001. Other rates, such as 24.97, stay as they are.
std::string RateForFfmpeg(double fps) {
  for (const int rate : {24, 30, 48, 60, 120, 240}) {
    const double exact = rate * 1000.0 / 1001;
    // Three decimals or more differ by a millionth at most, because 1000 / 1001 is 0.999 + 1e-6.
    if (std::abs(fps - exact) < 2e-6 * exact ||
        std::abs(fps - std::round(exact * 100) / 100) < 1e-9)
      return fmt::format("{}000/1001", rate);
  }
  return fmt::format("{:.9g}", fps);
}

constexpr const char* kConversion =
    "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int+full_chroma_inp,"
    "format=yuv420p";

std::vector<std::string> EncoderArguments(const fs::path& file, int width, int height, double fps) {
  const std::string rate = RateForFfmpeg(fps);
  return {"ffmpeg", "-hide_banner", "-nostats", "-loglevel", "error", "-y",  //
          "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size",
          fmt::format("{}x{}", width, height),
          // -framerate alone is a hint, which ffmpeg rounds to a usual rate, such as 120000/1001 to
          // 120; -r sets the times of the pictures.
          "-framerate", rate, "-r", rate, "-i", "pipe:0",
          // These tags must name the matrix of kConversion, or players shift the colours.
          "-vf", kConversion, "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc",
          "bt709", "-color_range", "tv",                         //
          "-c:v", "libx264", "-preset", "medium", "-crf", "16",  //
          "-movflags", "+faststart", "-f", "mp4", "file:" + file.string()};
}

Result<std::unique_ptr<ChildProcess>> StartFed(std::vector<std::string> words) {
  ChildProcess::Options options;
  options.words = std::move(words);
  options.has_input = true;
  return ChildProcess::Start(options);
}

}  // namespace

Result<void> CheckVideoTool() {
  constexpr double kPatience_s = 60;
  const auto advice = [](const Error& error) {
    return OutputError(error.message +
                       "; a video needs ffmpeg with libx264 (Debian: apt-get install ffmpeg)");
  };
  // Encodes one small picture, because an installed ffmpeg may lack libx264.
  auto ffmpeg = StartFed({"ffmpeg", "-hide_banner", "-nostats", "-loglevel", "error", "-f",
                          "rawvideo", "-pixel_format", "rgb24", "-video_size", "16x16", "-i",
                          "pipe:0", "-c:v", "libx264", "-f", "null", "-"});
  if (!ffmpeg) return advice(ffmpeg.error());
  const std::vector<uint8_t> picture(size_t{16} * 16 * 3);
  if (const auto written = (*ffmpeg)->Write(picture, kPatience_s); !written)
    return advice(written.error());
  if (const auto end = (*ffmpeg)->Finish(kPatience_s); !end) return advice(end.error());
  return {};
}

bool IsVideoName(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& letter : extension)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  return extension == ".mp4";
}

namespace {

// Returns true if the file is empty, or if its first bytes are those of an mp4 (ISO/IEC 14496-12,
// "ftyp").
bool IsEmptyOrVideo(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  file.read(head, sizeof head);
  return file.gcount() == 0 || std::string_view(head, sizeof head).substr(4) == "ftyp";
}

}  // namespace

Result<void> CheckVideoTarget(const fs::path& path, std::string_view option) {
  if (!IsVideoName(path))
    return UsageError(
        fmt::format("{} {}: expected a name that ends in .mp4", option, path.string()));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  // The video's folder must exist, because a render makes no folder but that of its frames.
  if (!fs::is_directory(folder, error))
    return OutputError(
        fmt::format("{} {}: the folder {} does not exist: make it, or give another name", option,
                    path.string(), folder.string()));
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    return OutputError(fmt::format("{} {}: is a folder or a device: give the name of a file",
                                   option, path.string()));
  if (fs::exists(path, error) && !IsEmptyOrVideo(path))
    return OutputError(
        fmt::format("{} {}: exists, and is not an mp4 video: give another name, or remove the file",
                    option, path.string()));
  return {};
}

struct VideoWriter::State {
  fs::path path;
  fs::path unfinished;
  int width = 0;  // size of the pictures, in pixels; the video is cropped to even sizes
  int height = 0;
  double patience_s = 0;
  size_t picture_count = 0;
  std::unique_ptr<ChildProcess> ffmpeg;
  std::vector<uint8_t> packed;

  Error Failure(const Error& error) const {
    return OutputError(
        fmt::format("{}: the video could not be written: {}", path.string(), error.message));
  }
};

namespace {

// Returns the last number of pictures in the lines KEY=VALUE of ffmpeg's -progress; 0 if there is
// none.
size_t CountIn(std::string_view progress) {
  constexpr std::string_view kKey = "frame=";
  size_t count = 0;
  while (!progress.empty()) {
    const std::string_view line = progress.substr(0, progress.find('\n'));
    progress.remove_prefix(std::min(line.size() + 1, progress.size()));
    if (line.starts_with(kKey))
      std::from_chars(line.data() + kKey.size(), line.data() + line.size(), count);
  }
  return count;
}

// Reads all pictures of a finished video as a player does, but without decoding them. kOutput if
// the file is not whole or does not have picture_count pictures. The file is read because ffmpeg 5
// exits with 0 although it could not write the end of a file, such as its index. ffmpeg reads it,
// and not ffprobe, because CheckVideoTool() has tried ffmpeg alone.
Result<void> ReadBack(const fs::path& file, size_t picture_count, double patience_s) {
  constexpr double kSlowDisk = 20e6;  // bytes per second
  std::error_code error;
  const auto size_bytes = fs::file_size(file, error);
  if (error) return OutputError(fmt::format("it cannot be read back: {}", error.message()));
  LF_ASSIGN_OR_RETURN(const CommandAnswer answer,
                      RunCommand({"ffmpeg", "-hide_banner", "-nostats", "-loglevel", "error",
                                  "-xerror", "-i", "file:" + file.string(), "-map", "0:v:0", "-c",
                                  "copy", "-f", "null", "-progress", "pipe:1", "-"},
                                 patience_s + static_cast<double>(size_bytes) / kSlowDisk));
  const size_t found = answer.exit_code == 0 ? CountIn(answer.output) : 0;
  if (found == picture_count) return {};
  return OutputError(fmt::format("only {} of its {} pictures can be read back{}{}", found,
                                 picture_count, answer.complaints.empty() ? "" : ": ",
                                 answer.complaints.substr(0, answer.complaints.find('\n'))));
}

void WarnOfOddSize(const fs::path& path, int width, int height) {
  const bool loses_column = width % 2 != 0, loses_row = height % 2 != 0;
  if (!loses_column && !loses_row) return;
  LogWarning(
      "{}: the last {} of each picture {} missing in the video, because videos have even sizes: it "
      "has {} x {} pixels, and the pictures {} x {}",
      path.string(),
      !loses_row      ? "column"
      : !loses_column ? "row"
                      : "column and the last row",
      loses_row && loses_column ? "are" : "is", width / 2 * 2, height / 2 * 2, width, height);
}

}  // namespace

VideoWriter::VideoWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}

VideoWriter::~VideoWriter() {
  state_->ffmpeg.reset();
  ::unlink(state_->unfinished.c_str());
}

Result<std::unique_ptr<VideoWriter>> VideoWriter::Open(const fs::path& path, int width, int height,
                                                       double fps, double patience_s) {
  constexpr double kSlowest = 1e-3, kFastest = 1e6;  // as in paths
  if (width < 2 || height < 2 || !(fps >= kSlowest && fps <= kFastest))
    return OutputError(fmt::format(
        "{}: a video of {} x {} pixels at {} frames per second cannot be written: expected at "
        "least 2 x 2 pixels and 0.001 to 1000000 frames per second",
        path.string(), width, height, fps));
  WarnOfOddSize(path, width, height);
  auto state = std::make_unique<State>();
  state->path = path;
  const fs::path unfinished =
      fs::absolute(path).parent_path() / (path.stem().string() + ".unfinished.mp4");
  RemoveLeftovers(unfinished);
  state->unfinished = TemporaryPath(unfinished);
  state->width = width;
  state->height = height;
  state->patience_s = patience_s;
  auto ffmpeg = StartFed(EncoderArguments(state->unfinished, width / 2 * 2, height / 2 * 2, fps));
  if (!ffmpeg) return state->Failure(ffmpeg.error());
  state->ffmpeg = *std::move(ffmpeg);
  return std::unique_ptr<VideoWriter>(new VideoWriter(std::move(state)));
}

Result<void> VideoWriter::Add(const Image<uint8_t>& picture) {
  LF_CHECK(picture.width() == state_->width && picture.height() == state_->height &&
           picture.channels() == 3);
  const size_t row_bytes = static_cast<size_t>(state_->width / 2 * 2) * 3;
  const int rows = state_->height / 2 * 2;
  state_->packed.resize(row_bytes * rows);
  for (int y = 0; y < rows; ++y)
    std::memcpy(state_->packed.data() + row_bytes * y, picture.row(y), row_bytes);
  if (const auto written = state_->ffmpeg->Write(state_->packed, state_->patience_s); !written)
    return state_->Failure(written.error());
  ++state_->picture_count;
  return {};
}

Result<void> VideoWriter::Close(std::string_view inputs) {
  if (const auto end = state_->ffmpeg->Finish(state_->patience_s); !end)
    return state_->Failure(end.error());
  if (state_->picture_count == 0) return state_->Failure(OutputError("it has no frames"));
  if (const auto whole = ReadBack(state_->unfinished, state_->picture_count, state_->patience_s);
      !whole) {
    const std::string words = state_->ffmpeg->Complaints();
    return state_->Failure(words.empty() ? whole.error() : OutputError("ffmpeg: " + words));
  }
  if (!inputs.empty())
    if (const auto stated = AppendInputs(state_->unfinished, inputs); !stated)
      return state_->Failure(stated.error());
  return WriteAtomically(state_->path, [&](const fs::path& temporary) -> Result<void> {
    if (::rename(state_->unfinished.c_str(), temporary.c_str()) == 0) return {};
    return OutputError(fmt::format("{}: cannot be renamed: {}", state_->unfinished.string(),
                                   std::strerror(errno)));
  });
}

}  // namespace lf
