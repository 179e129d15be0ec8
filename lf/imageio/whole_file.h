// Whether a picture file is whole. A library that encodes may swallow that memory ran out, and a
// frame that an earlier run left may have been cut by a copy or a disk: both look like pictures
// until somebody decodes their last rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "lf/core/result.h"

namespace lf {

// kInput, and what is missing, unless the file is as long as its format says; pixels are not
// decoded.
//   EXR   the table of offsets has an entry for every block of rows, and each block lies in the
//         file. Scanlines in one part, as WriteExr() writes them; others are an error
//   PNG   the chunks reach the end mark
//   JPEG  the last two bytes are the end mark
//   TIFF  the first directory lies in the file
//   raw   an error: nobody writes these
//   source  copies bytes from `offset` on into `to`; gives how many there were
//   name    what messages call it
Result<void> CheckIsWhole(
    const std::function<size_t(uint64_t offset, std::span<uint8_t> to)>& source,
    uint64_t size_bytes, const std::string& name);

// The same of a file on disk, of which no more is read than is needed. kInput also where it cannot
// be read.
Result<void> CheckFileIsWhole(const std::filesystem::path& path);

}  // namespace lf
