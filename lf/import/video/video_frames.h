// SPDX-License-Identifier: Apache-2.0
// Decodes single frames of videos by ffmpeg into PNG files, and keeps these files for other calls
// (doc/formats/light_field_video.md, "Decoded frames").
//
// The files of a video lie in a folder of its own, whose name holds a hash of the video's name,
// size and time of change: a video that was changed is decoded again. A file is decoded under a
// temporary name. Processes may use a folder at the same time, and any file may be removed at any
// time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/import/video/video_facts.h"

namespace lf {

// The frames of one video that are wanted.
struct WantedFrames {
  std::filesystem::path file;  // the video
  RecordedVideo facts;
  std::vector<size_t> frames;  // indices in facts.shown_s, ascending
};

// Returns the name of the PNG file of a frame, relative to the folder of all decoded frames:
// "cam00-0123456789abcdef/000012.png". If the video is not there, its size and time count as 0.
std::string DecodedName(const std::filesystem::path& video, size_t frame);

// Decodes those of the frames that are not in `folder` yet: 8-bit RGB, or 16-bit if the video has
// more than 8 bits, in full range. Colours are converted by the matrix and range that the video
// states; without a matrix, it is that of BT.709 for heights from 720 on, otherwise that of BT.601.
// The rotation that a video states is applied. Marks the time of use of all files.
// Returns an error of kInput for each video that is damaged, or whose frames cannot be decoded, and
// nullopt for the others, in the order of `videos`.
// kOutput: ffmpeg cannot be run, or a file cannot be written.
Result<std::vector<std::optional<Error>>> DecodeFrames(std::span<const WantedFrames> videos,
                                                       const std::filesystem::path& folder);

// Returns the folder of decoded frames beside a light field: FOLDER.frames. kOutput if no file may
// be made there, because the folder around it cannot be written or belongs to another user.
Result<std::filesystem::path> DecodedFramesBeside(const std::filesystem::path& light_field);

// Removes the files that were not used for the longest time, until the folder has at most
// `most_bytes`. Files that were used within the last day stay.
inline constexpr uint64_t kMostDecodedBytes = uint64_t{16} << 30;
void RemoveOldFrames(const std::filesystem::path& folder, uint64_t most_bytes = kMostDecodedBytes);

}  // namespace lf
