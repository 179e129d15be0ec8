// SPDX-License-Identifier: Apache-2.0
// Reads the statements of a picture's file about its colours, its film and its camera, and writes a
// picture with the same statements: for programs that join pictures.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

inline constexpr const char* kFrameRateText = "lf:fps";
// Key of the text in which a frame states the number of the first frame of its film.
inline constexpr const char* kFirstFrameText = "lf:first_frame";
// The text, or the attribute of an EXR file, that states what a file was made of
// (film/develop/file_inputs.h).
inline constexpr const char* kInputsText = "lf:inputs";

// The camera of a frame, in world coordinates: its position, and unit vectors ahead and up.
struct StatedCamera {
  std::array<double, 3> position = {}, forward = {}, up = {};
  friend bool operator==(const StatedCamera&, const StatedCamera&) = default;
};

struct ColourFacts {
  // Type of the values. kHalf if R, G, B and A of an EXR file are half; kFloat if some of them are
  // not, and for other files of floats.
  PixelType type = PixelType::kUint8;
  // EXR: x and y of red, green, blue and white.
  std::optional<std::array<float, 8>> chromaticities = {};
  // EXR: the attribute framesPerSecond. PNG: the text with this key, which must be a number above
  // 0.
  std::optional<double> frames_per_second = {};
  bool is_srgb = false;  // PNG: the file states that its values are sRGB
  // EXR and PNG: the camera of a frame that a renderer of ours has written. WriteStoredImage() does
  // not write it, because a joined picture has several cameras.
  std::optional<StatedCamera> camera = {};
  // EXR and PNG: the text with the key kFirstFrameText; unset unless it is a number of a frame. It
  // is not written, because a joined picture is a moment of its own.
  std::optional<uint32_t> first_frame = {};
  friend bool operator==(const ColourFacts&, const ColourFacts&) = default;
};

// Statements of an EXR file about the camera of its picture. Other files state none.
struct StatedProjection {
  // The attribute worldToNDC (doc/formats/frame.md), row by row, which row vectors are multiplied
  // by.
  std::optional<std::array<float, 16>> world_to_ndc = {};
  std::optional<double> unit_m = {};  // the attribute lf:unit_m: length of a world unit
  // Size of the display window, which the camera shows, and the first pixel of the picture in it.
  double display_width = 0, display_height = 0;
  double left = 0, top = 0;
};

struct PictureHeader {
  ImageFileInfo info;
  ColourFacts colours;
  StatedProjection projection = {};
};

// Reads the header alone. Errors as for ReadImageInfo().
Result<PictureHeader> ReadPictureHeader(const std::filesystem::path& path);
// Reads the header of a file that is in memory; messages call the file `name`.
Result<PictureHeader> ReadPictureHeaderBytes(std::string_view bytes, const std::string& name);

// Returns the text that a PNG file, or the first part of an EXR file, states under this key, such
// as kInputsText; "" if there is none. Reads the header alone. An EXR file may hold several
// pictures, such as a focus stack. Errors are otherwise as for ReadImageInfo().
Result<std::string> ReadStatedText(const std::filesystem::path& path, const char* key);

// Writes pixels as they are, atomically, as a file that states these facts; the extension of `path`
// chooses the format. Errors as for WriteImage().
//   pixels          of the type that colours.type stands for
//   channel_names   as for WriteImage()
//   metadata        further entries
//   is_interrupted  as for WriteImage()
Result<void> WriteStoredImage(const std::filesystem::path& path, const StoredImage& pixels,
                              const std::vector<std::string>& channel_names,
                              const ColourFacts& colours, const ImageMetadata& metadata = {},
                              const std::function<bool()>& is_interrupted = {});

}  // namespace lf
