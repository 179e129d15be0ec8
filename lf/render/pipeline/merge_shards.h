// SPDX-License-Identifier: Apache-2.0
// Makes frames from plate files. If a render was divided into shards, adds the plates of all shards
// of a frame: the frames are bit-identical to those of an undivided render. Also develops the
// plates of lfrenderer --keep-plates again, with other options. Frames of hybrids are completed
// from the gaps in their plates; if plates of a hybrid have none, the frames have collected rays
// alone, and a warning says so.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/state/report.h"

namespace lf {

struct MergeOptions {
  std::filesystem::path output_folder;
  std::vector<std::filesystem::path> kept_files;  // files that no output may replace
  FrameFormat format = FrameFormat::kExrHalf;
  PictureOptions picture;
  bool adds_opacity = false;                   // value of FilmSettings::adds_opacity
  std::optional<std::filesystem::path> video;  // path of an mp4 of the frames to write
  bool contact_sheet = true;
  bool resume = false;     // true: keeps frames of an earlier merge (MergeShards())
  bool overwrite = false;  // true: replaces frames that exist already
  RenderSignals* signals = nullptr;
};

struct MergeProgress {
  size_t plate_count = 0;  // number of plates that are done
  size_t plate_total = 0;
  size_t frame_count = 0;
  size_t frame_total = 0;
};

// Merges plates into frames. First reads and compares the entries (doc/formats/plate.md) of all
// plate files. Then makes frames one by one, which needs the memory of one plate, the gaps of its
// lens and its picture.
// The file of a frame appears only when the frame is done. The report names the LF images that were
// skipped when the plates were rendered, as far as the plates name them (plate_notes.h).
// RenderReport::selected_image_count is the largest number of LF images that have a ray in a frame
// or were skipped for it.
// With `resume`, the frame of an earlier merge is kept if its file is whole, the earlier report
// names it, and the film and the render camera are the same.
//   plates  plate files and folders, in any order; the files *.plate anywhere below a folder are
//           read
//
// kUsage: a frame exists already, and neither resume nor overwrite is set; resume is set, but the
// video would lose frames; an output would replace a plate or one of kept_files; the same plate
// file is listed twice. kInput: there are no plates; a plate has no notes
// (render/state/plate_notes.h) or is damaged; a shard of a frame is missing or exists twice, or the
// shards are of different renders or have different gaps (the message names them); every frame is
// black. kOutput: the disk or ffmpeg failed, or another process writes frames into the folder.
// kInterrupted: frames that were written before are kept.
Result<RenderReport> MergeShards(const std::vector<std::filesystem::path>& plates,
                                 const MergeOptions& options, ThreadPool& pool,
                                 const std::function<void(const MergeProgress&)>& progress);

}  // namespace lf
