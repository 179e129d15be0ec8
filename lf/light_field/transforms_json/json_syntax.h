// Error messages about files that are not JSON. For the readers of calibrations.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// "a/transforms.json: is not JSON: " + what nlohmann's parser says
Error IsNotJson(const std::filesystem::path& file, std::string_view what);

// Reads the whole stream. Returns kInput with line and column of its first fault, or with the
// reason why it cannot be read. Memory does not grow with the text or its nesting.
Error JsonSyntaxError(ByteStream* stream);

}  // namespace lf
