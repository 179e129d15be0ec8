// SPDX-License-Identifier: Apache-2.0
// Opens a light field and a film of it, and renders the film into a folder: what lfrenderer does,
// with the same defaults and the same bits.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/import/paths/path_options.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/pipeline/folder_options.h"
#include "lf/render/settings/film_settings.h"
#include "lf/render/state/report.h"

namespace lf {

// Prints "error: " and the message to stderr, with settings by their keys, without
// braces. Returns the exit code of the error (ErrorKind).
int Report(const Error& error);

// Opens any LIGHTFIELD: a calibration, a folder that holds one, or a packed store (doc/inputs.md).
// The pixels are read later, by the functions that render.
//   options  what the calibration does not state, such as the folder of the images
// Errors are those of OpenLightField(), which this function calls.
Result<LightField> Open(const std::filesystem::path& light_field, const OpenOptions& options = {});

// A light field, a camera path, and what is said of the frames. All members may be changed before a
// frame is rendered.
struct Film {
  LightField light_field = {};
  CameraPath path = {};        // with the focal surfaces and transmissions of its lenses
  FilmSettings settings = {};  // what the frames are made of
  WorkSettings work = {};      // memory, threads and other things that change no bit
  // The file of the path and those that it names, which no output may replace.
  std::vector<std::filesystem::path> files = {};
};

// Opens any PATH for a light field: our own YAML, that of another program, or the cameras of a
// calibration (doc/formats/path.md, doc/formats/foreign_paths.md). Focal surfaces and transmissions
// that the path names are read, for all frames.
//   options  values that replace those of the file, or for which it has no place; those that
//            describe the light field are set by this function
// kInput: a file cannot be read, or is damaged; a camera is of another type than perspective; the
// file states another unit_m than the light field has. kUsage: an option that the form of the file
// does not allow. The message names the file, the line or the key, and what was expected.
Result<Film> OpenFilm(LightField light_field, const std::filesystem::path& path,
                      PathOptions options = {});

// Renders the film into folder.output_folder, as `lfrenderer LIGHTFIELD PATH -o FOLDER` does:
// frame_0001.exr ..., contact_sheet.png, report.json, and a video if one is asked for. A file
// appears under its final name only when it is whole. A kill loses at most the work since the last
// checkpoint (FolderOptions::dump_every_s).
//   folder    {.output_folder = "frames"}; `version` is set, files of the film join `inputs`
//   frames    some frames of the path, ascending, such as {FrameId{1}, FrameId{5}}; empty: all
//   signals   requests to the render while it runs; may be null
//   progress  called now and then, by the calling thread; may be empty
// kUsage: settings contradict each other; an output would replace a file that the render reads; the
// folder has an unfinished render, and neither `resume` nor `overwrite` is set, or it was begun
// with other inputs. kInput: no LF image contributes to any frame; all LF images are broken, or one
// is and WorkSettings::strict is set; a damaged state. kOutput: the disk or the memory does not
// suffice, or ffmpeg is missing or failed. kInterrupted: RenderSignals::stop was set; finished
// frames are kept, and so are the rays of the others, which `resume` continues from.
Result<RenderReport> RenderFilm(const Film& film, FolderOptions folder,
                                std::vector<FrameId> frames = {}, RenderSignals* signals = nullptr,
                                const std::function<void(const RenderProgress&)>& progress = {});

}  // namespace lf
