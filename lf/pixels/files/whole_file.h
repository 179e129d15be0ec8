// SPDX-License-Identifier: Apache-2.0
// Checks that a picture file is complete. An encoding library may not report that memory ran out,
// and a frame of an earlier run may have been truncated by a copy or a disk. Such files look like
// pictures until somebody decodes their last rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "lf/core/result.h"

namespace lf {

// kInput, naming what is missing, unless the file passes the check of its format. Pixels are not
// decoded.
//   EXR   the table of offsets has an entry for every block of rows, and each block lies in the
//         file. Only scanlines in one part, as WriteExr() writes them; other kinds are an error
//   PNG   the chunks reach the end mark
//   JPEG  the last two bytes are the end mark
//   TIFF  the first directory begins in the file
//   other an error, because this project writes none
//   source  copies the bytes from `offset` on into `to`; returns how many it copied
//   name    name of the file, for messages
Result<void> CheckIsWhole(
    const std::function<size_t(uint64_t offset, std::span<uint8_t> to)>& source,
    uint64_t size_bytes, const std::string& name);

// Checks a file on disk, reading no more of it than necessary. kInput also if it cannot be read.
Result<void> CheckFileIsWhole(const std::filesystem::path& path);

}  // namespace lf
