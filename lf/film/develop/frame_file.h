// Writes the file of a finished frame, and reads a picture for display from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

enum class FrameFormat {
  // "exr": an EXR file with the channels R G B count.R count.G count.B coverage. Plates with
  // opacities add A, by which R G B are multiplied; lens weights add the channel effective, and
  // rebinned rays the channel interpolated, guarded plates the channel densified. Counts are 32-bit
  // integers, all other channels half.
  kExrHalf,
  kExrFloat,  // "exr-float": as "exr", with float instead of half
  kPng8,      // "png": sRGB, 8 bit; plates with opacities add alpha, by which RGB is not multiplied
  kPng16,     // "png16": as "png", with 16 bit
};

// Parses "exr", "exr-float", "png" or "png16"; none for any other text.
std::optional<FrameFormat> ParseFrameFormat(std::string_view name);
const char* NameOf(FrameFormat format);

// Returns a path such as DIR/frame_0001.exr. The number has at least four digits.
std::filesystem::path FramePath(const std::filesystem::path& folder, FrameId frame,
                                FrameFormat format);

// Writes a frame atomically, with its metadata in the file (EXR attributes, PNG text).
//   is_interrupted  called every few rows; may be empty
// kOutput: the folder or the disk cannot be written. kInterrupted: nothing is written.
Result<void> WriteFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                        FrameFormat format, const ImageMetadata& metadata,
                        const std::function<bool()>& is_interrupted = {});

// Returns the picture in a frame's file of any format, composited over black, as 8-bit sRGB
// [height][width][3], for contact sheet and video. kInput: as for ReadImage(), or the file has
// fewer than three channels.
Result<Image<uint8_t>> ReadDisplayImage(const std::filesystem::path& path);

}  // namespace lf
