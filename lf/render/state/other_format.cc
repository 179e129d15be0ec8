// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/other_format.h"

#include <cstddef>
#include <set>
#include <string>
#include <system_error>

#include "lf/core/log.h"

namespace lf {
namespace fs = std::filesystem;

void WarnOfOtherFormat(const fs::path& folder, std::span<const FrameId> frames,
                       FrameFormat format) {
  const FrameFormat other = IsExr(format) ? FrameFormat::kPng8 : FrameFormat::kExrHalf;
  const std::string extension = FramePath(folder, FrameId{1}, other).extension().string();
  // The folder is listed once, because a question for each frame is slow on network disks.
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == extension) names.insert(entry->path().filename().string());
  std::string first, last;
  size_t count = 0;
  for (const FrameId frame : frames) {
    std::string name = FramePath("", frame, other).string();
    if (!names.contains(name)) continue;
    if (++count == 1) first = name;
    last = std::move(name);
  }
  if (count == 1)
    LogWarning(
        "{}: {} has the name of a frame in another format, as an earlier render leaves it, and "
        "stays: take care not to mistake it for one of the new frames",
        folder.string(), first);
  else if (count > 1)
    LogWarning(
        "{}: {} files, {} to {}, have names of frames in another format, as an earlier render "
        "leaves them, and stay: take care not to mistake them for the new frames",
        folder.string(), count, first, last);
}

}  // namespace lf
