// SPDX-License-Identifier: Apache-2.0
// Kept pixels as one file: entries that state the inputs and the progress of a render, and all
// kept LF pixels (doc/formats/kept_pixels.md). An interrupted render resumes from such a file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/plate_file.h"
#include "lf/rebinning/kept_pixels.h"

namespace lf {

// Writes the pixels atomically (core/file.h). The bytes depend only on the entries and the kept
// pixels, not on the order in which these were added, max_pixels() or the number of threads. Needs
// 100 bytes per LF image at most in addition to the pixels. The entries have the same form as in
// plate files. kOutput: the folder or the disk cannot be written.
Result<void> WriteKept(const std::filesystem::path& path, const PlateEntries& entries,
                       const KeptPixels& pixels, ThreadPool& pool);

struct KeptFile {
  PlateEntries entries;
  KeptPixels pixels;
};

// Reads a file of WriteKept() with the threads of `pool`. If max_pixels is the same as for the
// pixels that were written, the pixels behave like those from then on: adding LF images leads to
// the same bits. Needs hardly more memory than the pixels. kInput: the file cannot be read, is not
// of this kind or version, is damaged, or has more pixels than max_pixels. The message names file
// and reason.
//   check  is called with the entries before the pixels are read; its error is returned
Result<KeptFile> ReadKept(const std::filesystem::path& path, size_t max_pixels, ThreadPool& pool,
                          const std::function<Result<void>(const PlateEntries&)>& check = {});
// Reads a file of WriteKept() from bytes in memory; messages call the file `name`.
Result<KeptFile> ReadKeptOfBytes(std::string_view bytes, const std::string& name, size_t max_pixels,
                                 ThreadPool& pool);

}  // namespace lf
