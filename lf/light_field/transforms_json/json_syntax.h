// SPDX-License-Identifier: Apache-2.0
// Makes error messages about files that are not JSON. Used by the readers of calibrations and
// camera paths.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// Returns the error "a/transforms.json: is not JSON: MESSAGE", with the message `what` of
// nlohmann's parser and, for the usual mistakes, advice.
Error IsNotJson(const std::filesystem::path& file, std::string_view what);

// Returns the text with quotation marks around each word NaN and Infinity, and its sign, outside of
// strings. Python's json module writes these words, which are not JSON, for numbers that a program
// could not compute. As strings they do no harm under keys that nobody reads, and every reader of a
// number refuses them.
std::string WithQuotedNan(std::string_view text);

// Parses the stream again, after a parser found that it is not JSON. Returns kInput with the line
// and column of the first syntax error; with the reason why the stream cannot be read; or, if it is
// JSON now, with the statement that it has changed. The needed memory does not grow with the text
// or its nesting.
Error JsonSyntaxError(ByteStream* stream);

}  // namespace lf
