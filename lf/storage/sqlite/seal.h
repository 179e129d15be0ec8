// SPDX-License-Identifier: Apache-2.0
// Writes and checks a checksum footer behind the last page of an SQLite file, where SQLite does not
// read. The footer covers every byte, including numbers, words and SQLite's own structures.
// Checking reads the whole file, so the footer is for files that are read completely in any case.
#pragma once

#include <filesystem>

#include "lf/core/result.h"

namespace lf {

// Appends the footer to a file that is complete and closed. kOutput if the file cannot be written.
Result<void> SealFile(const std::filesystem::path& path);

// Checks a file against its footer. kInput: the file is shorter or longer than it was, or one of
// its bytes has changed.
//   what  name of this kind of file in messages: "package"
Result<void> CheckSeal(const std::filesystem::path& path, const char* what);

}  // namespace lf
