// SPDX-License-Identifier: Apache-2.0
// The files that a render reads and writes, for the rule of core/output_files.h.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/output_files.h"
#include "lf/core/result.h"
#include "lf/film/develop/frame_file.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/render.h"

namespace lf {

// Returns the files of a light field that was opened from the file or folder `opened`: the image
// files and masks or, if it is a packed store, the file of the store; its transforms.json; and the
// mp4 files beside it if it is a light field video.
std::vector<std::filesystem::path> FilesOfLightField(const LightField& light_field,
                                                     const std::filesystem::path& opened);

// Returns the files that a film has in its folder: frames, contact sheets and reports.
//   parts  names of the packages or shards, each of which has a report of its own
std::vector<OutputFile> OutputsOfFilm(const std::filesystem::path& folder,
                                      const std::vector<FrameId>& frames, FrameFormat format,
                                      const std::vector<std::string>& parts = {});

// Returns the outputs of a film, its video added to them if there is one. kUsage: two outputs are
// the same file, or the video lies in the state of the render or of a job, in the folder of the
// film; and errors of CheckVideoTarget() for a video that exists. kOutput: other errors of
// CheckVideoTarget().
Result<OutputFiles> MakeFilmOutputs(std::vector<OutputFile> outputs,
                                    const std::filesystem::path& folder,
                                    const std::optional<std::filesystem::path>& video);

// Checks the files that the render writes, the video included. kUsage: one of them is an LF image
// or a mask of the package, a recorded video, or one of options.folder.inputs; and errors of
// MakeFilmOutputs().
Result<void> CheckOutputs(const Package& package, const RenderOptions& options);

}  // namespace lf
