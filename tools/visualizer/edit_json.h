// SPDX-License-Identifier: Apache-2.0
// Parses the bodies of edits: JSON objects with a few keys.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lf {

// Returns the object, with only those keys that an edit has (page_edits.h). The result is not an
// object if the text is not one, or if it contains a list or another object. Takes no more memory
// than the text: a full tree of 9 million brackets would take 700 MB.
nlohmann::ordered_json ReadEdit(const std::string& text);

}  // namespace lf
