// SPDX-License-Identifier: Apache-2.0
// Renders frames of a path by a statistic over the lens (lens_statistics.h) into a folder, with the
// files, the report and the interruptions of a render (render/pipeline/render.h).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "lf/analysis/lens_statistics/lens_statistics.h"
#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/state/report.h"

namespace lf {

struct StatisticFilmOptions {
  LensStatisticOptions statistic;  // may_be_black is not used: frames may be black, but not all
  std::vector<FrameId> frames;     // frames of the path, ascending; empty: all
  // dump_every_s is not used, because a frame that is interrupted is begun again. keep_plates must
  // be false and finish_early empty: a statistic has no sums that could be continued.
  FolderOptions folder;
};

struct StatisticFilmProgress {
  size_t frame_count = 0;  // number of finished frames
  size_t frame_total = 0;
  // LF images of the present frame, counted once for each part that the frame is made in.
  size_t image_count = 0;
  size_t image_total = 0;
};

// Renders the frames one after another into folder.output_folder: frame_0001.exr ...,
// contact_sheet.png, report.json, and the video. Each frame has the bits of MakeStatisticFrame(),
// and reads its LF images anew. A frame is finished when its file and its record are on the disk:
// after an interruption or a kill, folder.resume continues with the frame that was being made.
//   kUsage        options out of range, a mosaic filter, a lens with a transmission, a path with a
//                 shutter; an output would replace a file that is read; the folder has an
//                 unfinished render, and neither resume nor overwrite is set; resume is set, but
//                 the state has other inputs
//   kInput        no frame has a ray; broken LF images with `strict`; a damaged state
//   kOutput       the disk or the memory does not suffice; or ffmpeg is missing or failed
//   kInterrupted  *statistic.stop became true. Finished frames are kept
Result<RenderReport> RenderStatisticFilm(
    LightField light_field, const CameraPath& path, const StatisticFilmOptions& options,
    ThreadPool& pool, const std::function<void(const StatisticFilmProgress&)>& progress);

}  // namespace lf
