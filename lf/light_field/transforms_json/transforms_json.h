// Reads and writes the native description of a light field: nerfstudio / instant-ngp
// transforms.json with the lf_* keys of doc/formats/transforms_json.md. Its axes are those of
// OpenGL (x right, y up, looking along -z, camera-to-world) and are converted on reading.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/raw_encoding.h"

namespace lf {

// Parses the content of a file.
//   text        the file's content
//   path        its name for messages; its folder becomes LightField::folder
//   image_size  called for an image if a frame has no "w" or "h", as in Blender's scenes;
//               if it is empty, a missing size is an error
//   raw_facts   called for what the keys do not state about camera raw files; may be empty
// kInput names the file, the frame and its key, the value found and what was expected.
Result<LightField> ParseTransformsJson(std::string_view text, const std::filesystem::path& path,
                                       const ImageSizeSource& image_size = {},
                                       const RawFactsSource& raw_facts = {});

// As ParseTransformsJson(), but reads the file in pieces, with the memory of the light field
// instead of that of the text. Missing sizes and missing facts of camera raw files come from the
// headers of image files.
Result<LightField> ReadTransformsJson(const std::filesystem::path& path);

// Writes `light_field` so that reading it gives the same cameras bit for bit, except that a
// radial-tangential distortion of zeros is read as none. Image names are written unchanged.
//   writer  the program; if given, its name and a checksum are written (lf_written_by)
// kOutput if the file cannot be written, or a name is not UTF-8.
Result<void> WriteTransformsJson(const LightField& light_field, const std::filesystem::path& path,
                                 std::string_view writer = {});

// The programs that write native folders (lf_written_by).
inline constexpr const char* kImportProgram = "lfimport";
inline constexpr const char* kSynthProgram = "lfsynth";

// Returns true if `writer` wrote the file and it was not changed since. kInput if it is unreadable.
Result<bool> IsAsWritten(const std::filesystem::path& path, std::string_view writer);

}  // namespace lf
