// The native description of a light field: nerfstudio / instant-ngp transforms.json with the lf_*
// keys of doc/formats/transforms_json.md. OpenGL axes there (x right, y up, looking along -z,
// camera-to-world), converted on reading.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

// text  the file's content;  path  its name for messages; its folder becomes LightField::folder
// kInput names the file, the frame and its key, the value found and what was expected.
Result<LightField> ParseTransformsJson(std::string_view text, const std::filesystem::path& path);
Result<LightField> ReadTransformsJson(const std::filesystem::path& path);

// Writes `light_field` so that reading it gives the same cameras bit for bit. Image names are
// written as they are. kOutput.
Result<void> WriteTransformsJson(const LightField& light_field, const std::filesystem::path& path);

}  // namespace lf
