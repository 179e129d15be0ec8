// SPDX-License-Identifier: Apache-2.0
// Splits texts into lines, and lines into fields that commas separate. Internal to this folder.
#pragma once

#include <string_view>
#include <vector>

namespace lf {

// Removes the next line from the text and returns it without its end.
std::string_view TakeLine(std::string_view* text);

// Returns a text without the blanks and quotation marks around it.
std::string_view TrimmedField(std::string_view text);

// Returns the fields of a line, each as TrimmedField() returns it; at most 200.
std::vector<std::string_view> CommaFields(std::string_view line);

}  // namespace lf
