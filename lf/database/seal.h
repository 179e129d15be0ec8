// A checksum of a whole file behind its end, where SQLite does not look: every byte counts, also of
// numbers, words and what SQLite itself writes. For files that are read whole anyway.
#pragma once

#include <filesystem>

#include "lf/core/result.h"

namespace lf {

// Adds the seal to a file that is complete and closed. kOutput.
Result<void> SealFile(const std::filesystem::path& path);

// kInput: the file is shorter or longer than it was, or a byte has changed.
//   what  as messages call such a file: "package"
Result<void> CheckSeal(const std::filesystem::path& path, const char* what);

}  // namespace lf
