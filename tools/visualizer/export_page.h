// The page with its data as files, to be put on any web server.
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
  size_t image_count = 0;     // LF images, those that the film takes
  size_t missing_count = 0;   // of these, how many cannot be read and were left out
  std::string first_missing;  // why
};

// All that the page reads of the path: cameras, frames, what each takes, and LF images that the
// film takes, the first `most_images` of its order. Nothing can be edited there.
//   folder  new or empty
// kUsage: something is there. kOutput: the disk; a build without the page. kInterrupted.
Result<ExportFacts> ExportPage(PageScene& scene, const std::filesystem::path& folder,
                               size_t most_images, const std::atomic<bool>& interrupted,
                               const std::function<void(size_t done, size_t total)>& progress);

}  // namespace lf
