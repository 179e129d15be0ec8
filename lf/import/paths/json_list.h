// SPDX-License-Identifier: Apache-2.0
// Reads a JSON file that is one long list of frames and a few keys beside it. Internal to this
// folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/transforms_json/json_fields.h"
#include "lf/light_field/transforms_json/json_object.h"

namespace lf {

using ReadFields = std::function<Result<void>(const JsonFields&)>;

// A text that is a list itself is read as an object with this list alone.
//
// Calls read_top() with the top level without the entries of the list with the key `list_key`, and
// then read_entry() for each of these entries. Memory holds one entry at a time.
//   file  for messages
// kInput: the text is not JSON, or has no such list; the list is empty, has more than kMostFrames
// entries, or an entry that is no object; the first error of a function.
Result<void> ReadJsonList(std::string_view text, const std::filesystem::path& file,
                          const char* list_key, const ReadFields& read_top,
                          const ReadFields& read_entry);

// Reads the top level of a JSON file without the entries of the list `list_key`. Reads the file in
// pieces, of which at most kMostHeldBytes (frame_cutter.h) are held. kInput if it cannot be read or
// is not JSON.
Result<void> ReadTopLevel(const std::filesystem::path& file, const char* list_key, JsonObject* top);

}  // namespace lf
