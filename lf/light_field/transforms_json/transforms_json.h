// SPDX-License-Identifier: Apache-2.0
// Reads and writes the native description of a light field: a transforms.json of nerfstudio or
// instant-ngp with the lf_* keys of doc/formats/transforms_json.md. Its poses are camera-to-world
// matrices with OpenGL's axes (x right, y up, looking along -z), which are converted on reading.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/raw_encoding.h"

namespace lf {

// Parses the content of a file.
//   text        the file's content
//   path        the file's name for messages; its folder becomes LightField::folder
//   image_size  called for up to 15 images if "w" or "h" of a frame is stated neither in the
//               frame nor at the top level, as in Blender's scenes; the most frequent size is used.
//               If image_size is empty, a missing size is an error
//   raw_facts   called for facts about camera raw files that the keys do not state; may be empty
// kInput if the content is wrong. The message names the file, the frame and its key, the value
// found and what was expected.
Result<LightField> ParseTransformsJson(std::string_view text, const std::filesystem::path& path,
                                       const ImageSizeSource& image_size = {},
                                       const RawFactsSource& raw_facts = {});

// Reads a file as ParseTransformsJson() does, but in pieces, so that memory holds the light field
// and not the whole text. A text that cannot be JSON is refused at the first byte that shows it,
// and no more than kMostHeldBytes (frame_cutter.h) of text are held. Missing sizes and missing
// facts of camera raw files are read from image files. If sizes are missing, the files are found by
// FindImageFiles() first, with the given folder of images, and the result has their names.
Result<LightField> ReadTransformsJson(
    const std::filesystem::path& path,
    const std::optional<std::filesystem::path>& images_folder = std::nullopt);

// Writes `light_field` such that reading the file returns bit-identical cameras, except that
// distortion models whose parameters bend no ray may be read as kNone. Image names are written
// unchanged. No LF image may be virtual.
//   writer  name of the program; it is written with a checksum (lf_written_by) unless it is empty
// kOutput: the file cannot be written; a name is not UTF-8, or an image name has no extension.
Result<void> WriteTransformsJson(const LightField& light_field, const std::filesystem::path& path,
                                 std::string_view writer = {});

// Names of the programs that write native folders (lf_written_by).
inline constexpr const char* kImportProgram = "lfimport";
inline constexpr const char* kSynthProgram = "lfsynth";

// Returns true if `writer` wrote the file and nobody changed it since. kInput if it cannot be read.
Result<bool> IsAsWritten(const std::filesystem::path& path, std::string_view writer);

}  // namespace lf
