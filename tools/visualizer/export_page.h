// SPDX-License-Identifier: Apache-2.0
// Exports the page and its data as files for any web server.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "tools/visualizer/page_scene.h"

#include "lf/core/result.h"

namespace lf {

struct ExportFacts {
  size_t file_count = 0;
  uint64_t byte_count = 0;
  size_t image_count = 0;     // number of LF images to be exported
  size_t missing_count = 0;   // number of these that were left out, because they cannot be read
  std::string first_missing;  // reason why the first of them cannot be read
  size_t live_count = 0;      // number of exported LF images for live pictures
  uint64_t live_bytes = 0;    // size of their files
};

// Exports the page, and the data that it can show without a server: the LF cameras, the shown
// frames of the path (lf/view/shown_frames.h; a warning counts them if they are not all), what each
// uses, the points of depth files, and the large pictures of LF images that the film uses: at most
// `most_images`, spread evenly. For live pictures, shrunken LF images of about `most_live_bytes`
// are exported as well. An exported path cannot be edited.
//
// Data are written as scripts, NAME.js, because a page that is opened from the disk may load
// scripts and pictures, but no other files.
//   folder    new or empty
//   progress  called with numbers of steps: two for each shown frame, and one for each LF image
// kUsage: the folder is not empty. kOutput: the disk fails, another program writes into the folder,
// or the program was built without the page. kInterrupted: `interrupted` is true.
Result<ExportFacts> ExportPage(PageScene& scene, const std::filesystem::path& folder,
                               size_t most_images, size_t most_live_bytes,
                               const std::atomic<bool>& interrupted,
                               const std::function<void(size_t done, size_t total)>& progress);

}  // namespace lf
