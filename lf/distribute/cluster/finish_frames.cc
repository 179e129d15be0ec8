// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/finish_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/ids.h"
#include "lf/render/pipeline/frame_range.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kFinishLimit_bytes = size_t{16} << 20;
constexpr const char* kFinishFormat = "lffinish 1";

Result<std::vector<FrameId>> ReadAll(const fs::path& path, const FrameNumbers& of_job) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::vector<FrameId>();
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kFinishLimit_bytes));
  std::string fault, frames;
  const Json json = ParseRecord(text, kFinishFormat, &fault);
  RecordFields(json, &fault).Get("frames", &frames);
  if (fault.empty()) {
    const auto parsed = ParseFrameRange(frames, of_job);
    if (parsed) return parsed;
    fault = parsed.error().message;
  }
  return InputError(
      fmt::format("{}: is damaged: {}; remove the file, and call {{lfsubmit finish}} again",
                  path.string(), fault));
}

// Returns the numbers from the first frame of the job to the last.
FrameNumbers FramesOf(const ClusterJob& job) {
  uint32_t first = kLargestFrameNumber, last = 0;
  for (const JobPackage& package : job.packages) {
    if (package.frames.empty()) continue;
    first = std::min(first, package.frames.front().value);
    last = std::max(last, package.frames.back().value);
  }
  return last < first ? FrameNumbers() : FrameNumbers{first, size_t{last - first} + 1};
}

bool Has(const std::vector<FrameId>& frames, FrameId frame) {
  return std::binary_search(frames.begin(), frames.end(), frame);
}

bool IsFinished(const ClusterJob& job, FrameId frame) {
  std::error_code ignored;
  return fs::exists(
      job.output_folder / fmt::format("frame_{:04}{}", frame.value, job.frame_extension), ignored);
}

// Returns true if the checkpoint of the package has rays of the frame: either a plate of the frame,
// or kept pixels or rebinned rays, which all frames of the package share.
bool HasRays(const ClusterJob& job, const JobPackage& package, FrameId frame) {
  const fs::path checkpoint = job.output_folder / "partial" / package.name;
  std::error_code ignored;
  if (fs::exists(checkpoint / fmt::format("frame_{:04}.plate", frame.value), ignored)) return true;
  for (const auto& entry : fs::directory_iterator(checkpoint, ignored))
    if (entry.path().extension() == ".rays" || entry.path().extension() == ".pixels") return true;
  return false;
}

}  // namespace

Result<size_t> AskToFinish(const ClusterJob& job, const std::string& frames_text) {
  LF_ASSIGN_OR_RETURN(const std::vector<FrameId> frames,
                      ParseFrameRange(frames_text, FramesOf(job), "{finish}"));
  size_t unfinished_count = 0;
  for (const FrameId frame : frames) {
    const auto package =
        std::find_if(job.packages.begin(), job.packages.end(),
                     [&](const JobPackage& one) { return Has(one.frames, frame); });
    if (package == job.packages.end())
      return UsageError(fmt::format(
          "{{finish}}: frame {} is not in any package of the job: give only frames of the job",
          frame.value));
    if (IsFinished(job, frame)) continue;
    ++unfinished_count;
    if (!HasRays(job, *package, frame))
      return UsageError(fmt::format(
          "{{finish}}: frame {} cannot be finished yet, because {} has not written a checkpoint "
          "with rays of this frame: try again when {}/partial/{} contains frame_{:04}.plate, or a "
          "file of kept rays (kept_*.pixels or rays_*.rays)",
          frame.value, package->name, job.output_folder.string(), package->name, frame.value));
  }
  if (unfinished_count == 0) return unfinished_count;
  LF_ASSIGN_OR_RETURN(const FileLock lock, FileLock::Take(job.Folder() / "finish_frames.lock"));
  LF_ASSIGN_OR_RETURN(const std::vector<FrameId> before,
                      ReadAll(job.FinishFramesFile(), FramesOf(job)));
  std::vector<FrameId> all;
  std::set_union(before.begin(), before.end(), frames.begin(), frames.end(),
                 std::back_inserter(all));
  const Json json = {{"format", kFinishFormat}, {"frames", FrameRangeText(all)}};
  LF_RETURN_IF_ERROR(WriteFileAtomically(job.FinishFramesFile(), RecordText(json)));
  return unfinished_count;
}

Result<std::vector<FrameId>> FramesToFinish(const ClusterJob& job, const JobPackage& package) {
  LF_ASSIGN_OR_RETURN(const std::vector<FrameId> all,
                      ReadAll(job.FinishFramesFile(), FramesOf(job)));
  std::vector<FrameId> frames;
  std::set_intersection(all.begin(), all.end(), package.frames.begin(), package.frames.end(),
                        std::back_inserter(frames));
  return frames;
}

}  // namespace lf
