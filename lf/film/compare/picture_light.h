// SPDX-License-Identifier: Apache-2.0
// Reads any picture as linear light, for programs that compare pictures of different files.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

struct PictureLight {
  // [height][width][3]: R, G, B in linear light with the primaries of sRGB, composited over black.
  // 1 is display white; brighter, negative and undefined values stay.
  Image<float> rgb;
  // Channel `coverage` of a frame (doc/formats/frame.md), [height][width][1], if the file has it.
  std::optional<Image<float>> coverage;
};

// Integers are sRGB values. Floats are linear light: those of an EXR file in the primaries that the
// file states, otherwise in those of sRGB. The only channel of a grey picture is R, G and B. Alpha
// of integers is not multiplied into the colours yet, that of floats is (as OpenEXR has it).
// kInput: errors of ReadImage(); a mosaic of a camera raw file; two channels that are not grey and
// alpha, or more channels without R, G and B among their names.
Result<PictureLight> ReadPictureLight(const std::filesystem::path& path);

// Returns the light of an image in memory by the same rules: one channel is grey, two are grey and
// alpha, three are R, G and B, four are these and alpha. Floats have the primaries of sRGB.
// kInput: the image has more channels.
Result<PictureLight> PictureLightOf(const StoredImage& image);

}  // namespace lf
