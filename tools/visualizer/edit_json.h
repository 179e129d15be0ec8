// The bodies of edits: JSON objects of a few keys.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lf {

// Returns the object, with those of its keys that an edit has (page_edits.h); not an object if the
// text is none, or if it holds a list or another object. Takes no more memory than the text has,
// nor more time than reading it does: a tree of 9 million brackets would take 700 MB.
nlohmann::ordered_json ReadEdit(const std::string& text);

}  // namespace lf
