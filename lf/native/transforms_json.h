// The native description of a light field: nerfstudio / instant-ngp transforms.json with the lf_*
// keys of doc/formats/transforms_json.md. OpenGL axes there (x right, y up, looking along -z,
// camera-to-world), converted on reading.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/capture/image_files.h"
#include "lf/capture/light_field.h"
#include "lf/capture/raw_encoding.h"
#include "lf/core/result.h"

namespace lf {

// text        the file's content
// path        its name for messages; its folder becomes LightField::folder
// image_size  asked for the first image where a frame has no "w" or "h", as in Blender's scenes;
//             without it that is an error
// raw_facts   asked for what the keys do not say of camera raw files; without it nobody is asked
// kInput names the file, the frame and its key, the value found and what was expected.
Result<LightField> ParseTransformsJson(std::string_view text, const std::filesystem::path& path,
                                       const ImageSizeSource& image_size = {},
                                       const RawFactsSource& raw_facts = {});

// The same for a file, which is read in pieces: it takes the memory of the light field, not that of
// the text. A missing size, and what is not said of camera raw files, come from the header of the
// first image file.
Result<LightField> ReadTransformsJson(const std::filesystem::path& path);

// Writes `light_field` so that reading it gives the same cameras bit for bit (but that a
// radial-tangential distortion of zeros reads as none). Image names are written as they are.
//   writer  the program, if its name and a checksum are to be written too (lf_written_by)
// kOutput.
Result<void> WriteTransformsJson(const LightField& light_field, const std::filesystem::path& path,
                                 std::string_view writer = {});

// The writers of native folders (lf_written_by).
inline constexpr const char* kImportProgram = "lfimport";
inline constexpr const char* kSynthProgram = "lfsynth";

// Whether the file was written by `writer`, and nobody changed it since. kInput: unreadable.
Result<bool> IsAsWritten(const std::filesystem::path& path, std::string_view writer);

}  // namespace lf
