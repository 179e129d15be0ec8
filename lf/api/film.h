// SPDX-License-Identifier: Apache-2.0
// Opens a light field and a film of it, and renders the film into a folder: what lfrenderer does,
// with the same defaults and the same bits.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/import/paths/open_path.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Prints "error: " and the message to stderr. Returns the exit code of the error (ErrorKind).
int Report(const Error& error);

// Opens any LIGHTFIELD: a calibration, a folder that holds one, or a packed store (doc/inputs.md).
// Errors are those of OpenLightField(), which this function calls.
Result<LightField> Open(const std::filesystem::path& light_field, const OpenOptions& options = {});

// A light field, a camera path, and what is said of the frames. All members may be changed before a
// frame is rendered.
struct Film {
  LightField light_field;
  CameraPath path;  // with the focal surfaces and transmissions of its lenses
  FilmSettings settings;
  WorkSettings work;
  // The file of the path and those that it names, which no output may replace.
  std::vector<std::filesystem::path> files;
};

// Opens any PATH for a light field: our own YAML, that of another program, or the cameras of a
// calibration (doc/formats/path.md, doc/formats/foreign_paths.md). Focal surfaces and transmissions
// that the path names are read, for all frames.
//   options  values that replace those of the file, or for which it has no place; those that
//            describe the light field are set by this function
// Errors are those of OpenPath() and AddFocalSurfaces().
Result<Film> OpenFilm(LightField light_field, const std::filesystem::path& path,
                      PathOptions options = {});

// Makes a renderer of some frames of the film, for programs that look at unfinished frames
// (render/pipeline/film_renderer.h says how). The film is copied; the pool must outlive the
// renderer.
//   frames  ascending; empty: all frames of the path, which must fit in the memory together
// Errors are those of PackageOfFilm() and FilmRenderer::Open().
Result<std::unique_ptr<FilmRenderer>> OpenRenderer(const Film& film, std::vector<FrameId> frames,
                                                   ThreadPool& pool);

// Renders the film into folder.output_folder, as `lfrenderer LIGHTFIELD PATH -o FOLDER` does:
// frame_0001.exr ..., contact_sheet.png and report.json. Render() states errors, and what is kept
// if the work is interrupted.
//   folder    {.output_folder = "frames"}; its `inputs` and `version` are completed
//   frames    some frames of the path, ascending; empty: all
//   signals   requests to the render while it runs; may be null
//   progress  called now and then; may be empty
Result<RenderReport> RenderFilm(const Film& film, FolderOptions folder,
                                std::vector<FrameId> frames = {}, RenderSignals* signals = nullptr,
                                const std::function<void(const RenderProgress&)>& progress = {});

}  // namespace lf
