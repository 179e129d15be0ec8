// SPDX-License-Identifier: Apache-2.0
// Frames of another film that an earlier render left in the output folder. They would look like
// frames of the film that is rendered now.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/render/state/report.h"
#include "lf/render/state/run_inputs.h"

namespace lf {

// Returns the reports of renders in a folder: report.json, report-package-0000.json, ...
std::vector<std::filesystem::path> ReportsIn(const std::filesystem::path& folder);

// The film that a render writes into a folder.
struct FilmInFolder {
  const CameraPath& path;
  const RunInputs& inputs;          // of all frames: InputsOfRays() and InputsOfPicture()
  std::span<const FrameId> frames;  // ascending: the frames that the render writes
  std::function<std::filesystem::path(FrameId)> file_of;
};

// The frames of earlier renders whose files exist and are not written by the render.
struct FramesThatStay {
  // Frames of the same film, in the report that they were found in.
  std::optional<RenderReport> same;
  // Says how many frames are of another film, and what differs, such as "2 files are frames of
  // another film; the first, frame_0003.exr, was rendered with seed 1, this call has seed 2"; empty
  // if there are none.
  std::string others;
};

// Compares the frames of an earlier report with the film. (A whole render and a package of one film
// are compared without kFilmOfPackage.) Errors of ReadReport().
Result<FramesThatStay> FindFramesThatStay(const std::filesystem::path& report,
                                          const FilmInFolder& film);

// Adds the frames of a report to another of the same film, and the LF images that they left out.
void AddFrames(const RenderReport& from, RenderReport* to);

}  // namespace lf
