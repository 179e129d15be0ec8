// One finished frame as one file, and its picture for people.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/imageio/image_file.h"
#include "lf/sequence/develop.h"

namespace lf {

enum class FrameFormat {
  kExrHalf,   // exr: R G B count.R count.G count.B coverage; A, which R G B are multiplied with,
              // of plates with opacities; effective with lens weights, interpolated with rebinned
              // rays; colours half, counts 32-bit integers
  kExrFloat,  // exr-float: the same, colours float
  kPng8,      // png: sRGB; with opacities also alpha, which colours are divided by
  kPng16,     // png16: sRGB, 16 bit; likewise
};

// "exr", "exr-float", "png", "png16"; none for anything else.
std::optional<FrameFormat> ParseFrameFormat(std::string_view name);
const char* NameOf(FrameFormat format);

// DIR/frame_0001.exr
std::filesystem::path FramePath(const std::filesystem::path& folder, FrameId frame,
                                FrameFormat format);

// Atomic; metadata goes into the file (EXR attributes, PNG text).
//   is_interrupted  asked between some rows, if given
// kOutput: the folder, the disk. kInterrupted: nothing is written.
Result<void> WriteFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                        FrameFormat format, const ImageMetadata& metadata,
                        const std::function<bool()>& is_interrupted = {});

// A frame's picture as 8-bit sRGB, [height][width][3], for contact sheets and video; over black.
Image<uint8_t> DisplayImage(const DevelopedFrame& frame);

// The same from a frame's file of any format, so that a film can be made again later. kInput: as
// for ReadImage, or fewer than three channels.
Result<Image<uint8_t>> ReadDisplayImage(const std::filesystem::path& path);

}  // namespace lf
