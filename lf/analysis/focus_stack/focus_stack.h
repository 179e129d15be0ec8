// SPDX-License-Identifier: Apache-2.0
// Renders a focus stack: pictures of one camera that differ only in their focus distance. It is a
// film whose frames are the planes of the stack, so that each LF image is read once for all planes
// that fit in the memory together, and each picture has the bits of a single render.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/state/report.h"
#include "lf/render/state/run_inputs.h"
#include "lf/selection/image_order.h"

namespace lf {

// How a focus stack is written.
//   kFolder  frames in a folder as Render() writes them, and planes.json, which lists the planes
//   kExr     one EXR file with a part for each plane: focus_0001, focus_0002, ... Parts have the
//            attributes of the EXR file of a frame, with the focus distance in metres (focus) and
//            in world units (lf:focus_distance_w).
//   kVideo   an mp4 in which the focus moves from the first plane to the last
enum class FocusStackForm { kFolder, kExr, kVideo };

// Returns the form that the extension of the output stands for: .exr, .mp4, or any other for a
// folder.
FocusStackForm FormOfStack(const std::filesystem::path& output);

// Returns the folder that holds the frames and the state of an unfinished render: the output itself
// or, if it is a file, FILE.partial beside it.
std::filesystem::path StackFolder(const std::filesystem::path& output);

struct FocusStackOptions {
  std::filesystem::path output;
  FrameId frame = FrameId{1};  // frame of the path that the camera was taken from, for planes.json
  // True: the video goes back from the last plane to the first, so that it can be repeated. Used by
  // kVideo.
  bool back_and_forth = false;
  // Inputs that decide the file (StackInputs()). It states them (film/develop/file_inputs.h), so
  // that IsFinishedStack() finds that a call asks for another stack.
  RunInputs inputs = {};
  // Options of the render. RenderFocusStack() sets folder.output_folder, folder.complete and, for
  // a file, folder.contact_sheet. `frames` must be empty. For a file, folder.video must be unset,
  // folder.keep_plates false, and folder.format an EXR format (kExr) or kPng8 (kVideo).
  RenderOptions render;
};

// Checks the output before any work, which RenderFocusStack() does as well.
// kUsage: a file of this name exists, and neither overwrite is set nor is an unfinished render of
// it resumed; the output would replace a file that the render reads; FILE.partial is a folder of
// something else. kOutput: ffmpeg is missing.
Result<void> CheckFocusStack(const LightField& light_field, const FocusStackOptions& options);

// Returns the inputs that decide the pictures of a stack: the light field, the cameras, and the
// options as they are given. "auto" is not resolved, because this takes a look at the LF images.
//   light_field  as opened, before it is densified
//   stack        path of FocusStackPath()
//   options      options.render.film and options.render.folder are used
//   densifies    true: the stack is rendered from the densified light field
// kInput: the packed store of the light field cannot be read.
Result<RunInputs> StackInputs(const LightField& light_field, const CameraPath& stack,
                              const FocusStackOptions& options, bool densifies);

// Returns true if `resume` is set, the output is a file that exists, and no render of it is
// unfinished: there is nothing left to do. kUsage: it is an EXR file with other planes than the
// stack, made with other `inputs`, or of something else.
//   stack  path of FocusStackPath()
Result<bool> IsFinishedStack(const CameraPath& stack, const FocusStackOptions& options);

// Renders the frames of the package, whose path is that of FocusStackPath(), and writes the stack.
// A file appears under its name only when it is complete, and FILE.partial is then removed. Results
// and errors are those of Render() and CheckFocusStack(), and kOutput if the output cannot be
// written.
Result<RenderReport> RenderFocusStack(Package package, const FocusStackOptions& options,
                                      ThreadPool& pool,
                                      const std::function<void(const RenderProgress&)>& progress);

// Returns the list of the planes as JSON (doc/focus.md): frame and unit_m, and for each plane its
// frame, the name of its file or part, and its focus distance in world units and millimetres.
//   stack  path of FocusStackPath()
std::string FocusPlanesJson(const CameraPath& stack, const FocusStackOptions& options);

}  // namespace lf
