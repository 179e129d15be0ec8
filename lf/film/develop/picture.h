// SPDX-License-Identifier: Apache-2.0
// The picture of a frame in memory, and how its file shows it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "lf/core/image.h"
#include "lf/film/develop/colour_space.h"
#include "lf/pixels/files/exr_compression.h"

namespace lf {

class DisplayView;  // display_view.h

// The picture of a frame. Its images have the width and the height of the frame; those that the
// frame does not need are empty.
struct DevelopedFrame {
  Image<float> rgb;  // [height][width][3] linear light, sRGB primaries
  // [height][width][3] number of rays; for a guarded plate, the number of recorded rays where there
  // are some
  Image<uint32_t> ray_count;
  Image<float> coverage;  // [height][width] share of the channels with a ray of their own
  // [height][width] in [0, 1]; empty for a plate without opacities, unless they were added
  // (DevelopOptions::adds_opacity). rgb is multiplied by it.
  Image<float> opacity = {};
  // [height][width] number of LF images of equal weight that would give the same noise; empty
  // without lens weights. Develop() leaves it empty: its callers, such as RenderFrame(), fill it.
  // With lens weights, ray_count holds sums of weights.
  Image<float> effective_count = {};
  // [height][width] share of each element that was interpolated from kept rays (completion.h);
  // empty without completion
  Image<float> interpolated = {};
  // [height][width] share of the collected light of each element that is of all LF images, virtual
  // ones included, instead of recorded LF images alone; empty unless the plate is guarded
  Image<float> densified = {};
  // [height][width] mean trust in the rays of all LF images, from 0 to 1: recorded rays have 1,
  // virtual ones what their LF images state (LfPixels::trust). It is 1 where the element is in
  // focus and therefore shows recorded light, and where no ray was collected; empty unless the
  // plate is guarded.
  Image<float> trust = {};
  // Number of elements that virtual light blurs (m > 1/2), but whose trust is below kDoubtfulTrust
  // (develop.h).
  uint64_t doubtful_count = 0;
  // [height][width] depth, along the optical axis, at which each element is in focus. Develop()
  // and RenderFrame() leave it empty; it is filled when a file with PictureOptions::has_focus_depth
  // is written.
  Image<float> focus_depth_w = {};
};

// The channels of EXR frames that hold the numbers of rays of R, G and B. No name has a dot, which
// would make it a channel of a layer: Blender's sequencer shows no file that has layers. No name
// ends in r, g, b or a, because Blender looks for colours by the last letter of a name.
inline constexpr std::array<const char*, 3> kCountChannels = {"count_red", "count_green",
                                                              "count_blue"};
// Their names in frames of earlier builds, which are still read.
inline constexpr std::array<const char*, 3> kLayeredCountChannels = {"count.R", "count.G",
                                                                     "count.B"};

// The format of the file of a frame.
enum class FrameFormat {
  // "exr": an EXR file with the channels R G B, kCountChannels and coverage. Opacities add A, by
  // which R G B are multiplied; lens weights add the channel effective, rebinned rays add
  // interpolated, guarded plates add densified and trust, and focus depths add Z. Counts are 32-bit
  // integers, Z is float, and all other channels are half.
  kExrHalf,
  kExrFloat,  // "exr-float": as "exr", with float instead of half
  kPng8,      // "png": sRGB, 8 bit; opacities add alpha, by which RGB is not multiplied
  kPng16,     // "png16": as "png", with 16 bit
};

// Parses "exr", "exr-float", "png" or "png16"; none for any other text.
std::optional<FrameFormat> ParseFrameFormat(std::string_view name);
const char* NameOf(FrameFormat format);
bool IsExr(FrameFormat format);

// The channels of the files of frames.
enum class FrameChannels {
  kAll,   // "all": all that FrameFormat names
  kRgba,  // "rgba": R, G, B and A. The frame must have opacities (DevelopOptions::adds_opacity).
  kRgb,   // "rgb": R, G and B
};

// Parses "all", "rgba" or "rgb"; none for any other text.
std::optional<FrameChannels> ParseFrameChannels(std::string_view name);
const char* NameOf(FrameChannels channels);

// How the file of a frame shows its picture.
struct PictureOptions {
  // Must be kRec709 for PNG files, whose values are sRGB.
  ColourSpace colours = ColourSpace::kRec709;
  // True: EXR files get the channel Z, the depth at which each element is in focus. Must be false
  // for PNG files.
  bool has_focus_depth = false;
  // The view that gives the values of PNG files; null: the sRGB curve. Must be null for EXR files.
  std::shared_ptr<const DisplayView> view = nullptr;
  // Channels of EXR files besides Z, which has_focus_depth adds to any. Must be kAll for PNG files.
  FrameChannels channels = FrameChannels::kAll;
  // Compression of EXR files. Must be kZip for PNG files.
  ExrCompression compression = ExrCompression::kZip;
  friend bool operator==(const PictureOptions&, const PictureOptions&) = default;
};

}  // namespace lf
