// Plates in, frames out: those of the shards of a divided render are added, to the bits of one that
// was not divided; a plate that was kept is developed again.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/pipeline/render.h"
#include "lf/record/report.h"

namespace lf {

struct MergeOptions {
  std::filesystem::path output_folder;
  std::vector<std::filesystem::path> kept_files;  // no output may replace them
  FrameFormat format = FrameFormat::kExrHalf;
  std::optional<std::filesystem::path> video;
  bool contact_sheet = true;
  bool resume = false;     // keep the frames that are there
  bool overwrite = false;  // replace them
  RenderSignals* signals = nullptr;
};

struct MergeProgress {
  size_t plate_count = 0;  // added
  size_t plate_total = 0;
  size_t frame_count = 0;
  size_t frame_total = 0;
};

//   plates  files, or folders with such files somewhere below them, in any order
// What all plates say is read first, and compared; then frame by frame: needs the memory of one
// plate and its picture. Each frame has its file when it is done, and not before. The report names
// the LF images that the plates' renders left out (as many as the plates do: frame_sheet.h); its
// selected_image_count is that of the frame that takes most, with those.
// With resume, frames of an earlier merge are kept if they are whole and were made of the same
// film.
//
// kUsage: frames are there, and neither resume nor overwrite is set; a frame would replace one of
//   kept_files; a video without all frames.
// kInput: no plates; plates without a sheet (record/frame_sheet.h); a frame whose shards are not
//   all there, or there twice, or are of different renders: the message names them; a damaged
//   plate; every frame is black.
// kOutput: the disk, ffmpeg, another program that writes frames into the folder.
// kInterrupted: frames that are written stay.
Result<RenderReport> MergeShards(const std::vector<std::filesystem::path>& plates,
                                 const MergeOptions& options, ThreadPool& pool,
                                 const std::function<void(const MergeProgress&)>& progress);

}  // namespace lf
