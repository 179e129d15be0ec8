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
#include "lf/film/develop/colour_space.h"
#include "lf/film/develop/develop.h"
#include "lf/film/develop/display_view.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

enum class FrameFormat {
  // "exr": an EXR file with the channels R G B count.R count.G count.B coverage. Opacities add A,
  // by which R G B are multiplied; lens weights add the channel effective, rebinned rays add
  // interpolated, guarded plates add densified, and focus depths add Z. Counts are 32-bit integers,
  // Z is float, and all other channels are half.
  kExrHalf,
  kExrFloat,  // "exr-float": as "exr", with float instead of half
  kPng8,      // "png": sRGB, 8 bit; opacities add alpha, by which RGB is not multiplied
  kPng16,     // "png16": as "png", with 16 bit
};

// Parses "exr", "exr-float", "png" or "png16"; none for any other text.
std::optional<FrameFormat> ParseFrameFormat(std::string_view name);
const char* NameOf(FrameFormat format);
bool IsExr(FrameFormat format);

// How the file of a frame shows its picture.
struct PictureOptions {
  // Must be kRec709 for PNG files, whose values are sRGB.
  ColourSpace colours = ColourSpace::kRec709;
  // True: EXR files get the channel Z, the depth at which each element is in focus. Must be false
  // for PNG files.
  bool has_focus_depth = false;
  // The view that gives the values of PNG files; null: the sRGB curve. Must be null for EXR files.
  std::shared_ptr<const DisplayView> view = nullptr;
  friend bool operator==(const PictureOptions&, const PictureOptions&) = default;
};

// Returns a path such as DIR/frame_0001.exr. The number has at least four digits.
std::filesystem::path FramePath(const std::filesystem::path& folder, FrameId frame,
                                FrameFormat format);

// Writes a frame atomically, with its metadata in the file (EXR attributes, PNG text).
//   is_interrupted  called every few rows; may be empty
//   view            value of PictureOptions::view
// kOutput: the folder or the disk cannot be written. kInterrupted: nothing is written.
Result<void> WriteFrame(const std::filesystem::path& path, const DevelopedFrame& frame,
                        FrameFormat format, const ImageMetadata& metadata,
                        const std::function<bool()>& is_interrupted = {},
                        const DisplayView* view = nullptr);

// Returns the picture in a frame's file of any format, composited over black, as 8-bit sRGB
// [height][width][3], for contact sheet and video. kInput: as for ReadImage(), or the file has
// fewer than three channels.
//   colours  colour space of the frame, if it is an EXR file
Result<Image<uint8_t>> ReadDisplayImage(const std::filesystem::path& path,
                                        ColourSpace colours = ColourSpace::kRec709);

}  // namespace lf
