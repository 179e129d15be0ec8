// SPDX-License-Identifier: Apache-2.0
// Renders a package, that is a light field and a camera path (render/package/package.h), as an
// image sequence into a folder (thesis 4.3). film_renderer.h renders in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/folder_options.h"
#include "lf/render/settings/film_settings.h"
#include "lf/render/state/report.h"

namespace lf {

class FilmSource;

// If FilmSettings::shard is set, the render writes plates for MergeShards() instead of frames and a
// contact sheet.
struct RenderOptions {
  std::vector<FrameId> frames;       // some frames of the package, ascending; empty: all
  FilmSettings film;                 // what the frames are made of
  WorkSettings work;                 // how the work is done; `signals` replaces its flags
  FolderOptions folder;              // where the frames are written
  RenderSignals* signals = nullptr;  // requests to this render, read often; may be null
  // The maker of the frames (frame_source.h); null: FilmRenderer, which collects their rays.
  FilmSource* source = nullptr;
};

// Checks the options of the film (CheckFilmSettings()) and of the folder. Render() calls this
// before it starts; a program may call it before a job waits in a queue. kUsage: the options are
// not compatible; an output would replace a file that the render reads; the lens of a frame is a
// pinhole, but lens weights by area need its area.
Result<void> CheckRenderOptions(const Package& package, const RenderOptions& options);

// Returns a whole light field and a path as one package for these options: with the order, the seed
// and the largest angle of FilmSettings.
// kUsage: the options are not compatible (CheckRenderOptions()). kInterrupted: RenderSignals::stop
// or WorkSettings::stop is set.
Result<Package> PackageOfFilm(LightField light_field, CameraPath path, const RenderOptions& options,
                              ThreadPool& pool);

// Renders the frames into output_folder: frame_0001.exr ..., contact_sheet.png, report.json, and
// the video. A package with a name has the report report-NAME.json and its own state, so that
// several packages may be rendered into one folder at the same time. A file appears under its final
// name only when it is whole. The bits of the frames depend neither on the number of threads, nor
// on the memory (with one exception, see WorkSettings), nor on how often the render was
// interrupted, killed and resumed. A kill loses at most the work since the last checkpoint.
//   kUsage        the options are not compatible; the folder has an unfinished render, and neither
//                 FolderOptions::resume nor overwrite is set; resume is set, but the state has
//                 other inputs; a report of another package or shard there has other inputs
//                 (run_state.h)
//   kInput        no LF image contributes to any frame, or no frame gets a ray (both only if the
//                 package has no name and there is no shard); broken LF images (collect.h); a
//                 damaged state; the packed store lacks pixels (FilmSetup::Make())
//   kOutput       the disk or the memory does not suffice: the state on the disk is that of the
//                 last checkpoint; or ffmpeg is missing, or failed after the frames were written
//   kInterrupted  finished frames are kept, and the state of the others is written
Result<RenderReport> Render(Package package, const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
