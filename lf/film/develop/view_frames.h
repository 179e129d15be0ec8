// SPDX-License-Identifier: Apache-2.0
// Finds the frames of a film of views, and divides them into moments.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/pixels/files/picture_header.h"

namespace lf {

// The frames of all views at one moment of a film.
struct ViewMoment {
  int number = 1;                            // of the moment in the film
  std::vector<std::filesystem::path> files;  // one for each view, left to right
};

// Returns the moments of a film whose frames are in the order that lfpath gives them: all views of
// the first moment, then those of the second, and so on. The first moment has the number of the
// first frame of the film, which frames state if it is not 1.
//   paths       a folder, whose files frame_0001.png or frame_0001.exr, ... are taken; or the files
//               of the frames, in their order
//   view_count  views of each moment
// Frames of a folder may begin and end with any moment. kInput: there are no frames, a frame of a
// view is missing, or a folder has frames of both formats. kUsage: several folders, folders beside
// files, files that are no .png and no .exr, or of both, or a number of files that is no multiple
// of view_count.
Result<std::vector<ViewMoment>> FindViewMoments(std::span<const std::filesystem::path> paths,
                                                int view_count);

// Reads the headers of all frames, and returns the header of the first. kInput: a file cannot be
// read, or differs from the first in size, type, channels or colours; or the frames state their
// cameras, and these are not those of the views of a moment: parallel, side by side on the right
// axis, at equal distances, and not continued by the next moment. A wrong number of views is so
// found even if it divides the number of frames.
Result<PictureHeader> CommonHeader(std::span<const ViewMoment> moments, ThreadPool& pool);

}  // namespace lf
