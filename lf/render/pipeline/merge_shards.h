// Makes frames from plates: adds the plates of the shards of a divided render, which gives the bits
// of a render that was not divided, and develops kept plates again.
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
  std::vector<std::filesystem::path> kept_files;  // no output may replace them
  FrameFormat format = FrameFormat::kExrHalf;
  std::optional<std::filesystem::path> video;
  bool contact_sheet = true;
  bool resume = false;     // keep frames that are there
  bool overwrite = false;  // replace frames that are there
  RenderSignals* signals = nullptr;
};

struct MergeProgress {
  size_t plate_count = 0;  // plates that are added
  size_t plate_total = 0;
  size_t frame_count = 0;
  size_t frame_total = 0;
};

// Merges plates into frames. The entries of all plates are read and compared first. Then frames are
// made one by one, which needs the memory of one plate and its picture. The file of a frame appears
// when the frame is done, and not before. The report names the LF images that the plates' renders
// skipped, as far as the plates name them (plate_notes.h). Its selected_image_count is the largest
// number of LF images of a frame, skipped ones included.
// With resume, frames of an earlier merge are kept if they are whole and were made of the same
// film.
//   plates  plate files, and folders with such files anywhere below them, in any order
//
// kUsage: frames are there, and neither resume nor overwrite is set; an output would replace a
//   plate or one of kept_files; a plate is given twice.
// kInput: there are no plates; a plate has no notes (render/state/plate_notes.h) or is damaged; a
//   frame's shards are not complete, are there twice, or are of different renders (the message
//   names them); every frame is black.
// kOutput: the disk or ffmpeg failed, or another program writes frames into the folder.
// kInterrupted: frames that are written stay.
Result<RenderReport> MergeShards(const std::vector<std::filesystem::path>& plates,
                                 const MergeOptions& options, ThreadPool& pool,
                                 const std::function<void(const MergeProgress&)>& progress);

}  // namespace lf
