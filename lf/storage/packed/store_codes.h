// SPDX-License-Identifier: Apache-2.0
// Reads the tables that list the encoded images of a packed store. Internal to this folder.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

// Returns for each LF image below `image_count` if the table, which has one column of ids, lists
// it; empty if the store has no such table.
Result<std::vector<bool>> ReadMarks(OpenedStore* store, const std::string& table,
                                    size_t image_count);

// Returns an entry for each LF image of the store, indexed by its id. An LF image without an
// encoded image has an entry that is not listed.
Result<std::vector<PackedCode>> ReadCodes(OpenedStore* store);

}  // namespace lf
