// SPDX-License-Identifier: Apache-2.0
// Asks ffprobe about a video: its size, how its colours are stored, and when each of its frames is
// shown. No pixels are decoded.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct RecordedVideo {
  int width_px = 0, height_px = 0;
  std::string pixel_format;  // ffmpeg's word, such as "yuv420p"
  // The tags of the colours, in ffmpeg's words, such as "bt709" and "tv"; "unknown" without a tag.
  std::string matrix = "unknown", transfer = "unknown", range = "unknown";
  double begin_s = 0;  // the time at which the file begins, from which seeking counts
  // The time at which each frame is shown, as the file states it, ascending.
  std::vector<double> shown_s;
  // The frames, as indices in shown_s, from which decoding may begin; ascending.
  std::vector<size_t> keys;
};

// Returns true if a channel has more than 8 bits.
bool IsDeep(const RecordedVideo& video);

// Returns the time of each frame in seconds from the first frame.
std::vector<double> SecondsFromFirst(const RecordedVideo& video);

// Returns true if the name ends like that of a video that ffmpeg reads, in small letters or
// capitals.
bool IsRecordedVideoName(std::string_view file_name);

// Parses what ffprobe prints in the form "compact" about packets, stream and format.
//   video  for messages
// kInput: there is no video stream; a size outside 1 to 65536; no frame, or more than 2^24; a frame
// without a time; light that is coded for displays of high dynamic range (PQ, HLG), which is not
// converted.
Result<RecordedVideo> ParseVideoFacts(std::string_view text, const std::filesystem::path& video);

// Asks ffprobe about a video. kInput as ParseVideoFacts(), and if ffprobe cannot read the file.
// kOutput: ffprobe cannot be run; the message says what to install.
Result<RecordedVideo> ReadVideoFacts(const std::filesystem::path& video);

// Returns the end of a message about ffmpeg or ffprobe that cannot be run.
inline constexpr const char* kFfmpegAdvice =
    "; videos are read by ffmpeg and ffprobe (Debian: apt-get install ffmpeg)";

}  // namespace lf
