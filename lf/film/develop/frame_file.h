// SPDX-License-Identifier: Apache-2.0
// Writes the file of a finished frame, and reads a picture for display from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/picture.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Returns a path such as DIR/frame_0001.exr. The number has at least four digits.
std::filesystem::path FramePath(const std::filesystem::path& folder, FrameId frame,
                                FrameFormat format);

// Writes a frame atomically, with its metadata in the file (EXR attributes, PNG text).
//   is_interrupted  called every few rows; may be empty
//   options         the view, the channels and the compression; its other members are those of the
//                   caller, who converts the colours and adds the depths
// kOutput: the folder or the disk cannot be written. kInterrupted: nothing is written.
Result<void> WriteFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                        FrameFormat format, const ImageMetadata& metadata,
                        const std::function<bool()>& is_interrupted = {},
                        const PictureOptions& options = {});

// Returns the picture in a frame's file of any format, composited over black, as 8-bit sRGB
// [height][width][3], for contact sheet and video. kInput: as for ReadImage(), or the file has
// fewer than three channels.
//   colours  colour space of the frame, if it is an EXR file
Result<Image<uint8_t>> ReadDisplayImage(const std::filesystem::path& path,
                                        ColourSpace colours = ColourSpace::kRec709);

}  // namespace lf
