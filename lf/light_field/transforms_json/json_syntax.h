// SPDX-License-Identifier: Apache-2.0
// Makes error messages about files that are not JSON. Used by the readers of calibrations and
// camera paths.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// Returns the error "a/transforms.json: is not JSON: MESSAGE", with the message `what` of
// nlohmann's parser and, for the usual mistakes, advice.
Error IsNotJson(const std::filesystem::path& file, std::string_view what);

// Parses the stream again, after a parser found that it is not JSON. Returns kInput with the line
// and column of the first syntax error; with the reason why the stream cannot be read; or, if it is
// JSON now, with the statement that it has changed. The needed memory does not grow with the text
// or its nesting.
Error JsonSyntaxError(ByteStream* stream);

}  // namespace lf
