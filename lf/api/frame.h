// SPDX-License-Identifier: Apache-2.0
// Renders one frame of a film in memory, and writes it to a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "lf/api/film.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/film/develop/frame_file.h"
#include "lf/render/collect/collect.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/report.h"

namespace lf {

struct Frame {
  DevelopedFrame picture;             // picture.rgb is [height][width][3], linear light
  FrameReport report;                 // such as the numbers of LF images and of rays
  std::vector<SkippedImage> skipped;  // missing and broken LF images, whose rays the frame lacks
  PlateNotes notes;                   // what its file states, such as the camera
};

// Renders a frame of the film, by all threads. The bits are those of lfrenderer with the same
// settings. With a mode that rebins, which rays are kept depends on all frames that are rendered
// together; RenderFilm() renders those.
//   number  of the frame, from 1
// kUsage: the path has no such frame. kInput: no LF image contributes to the frame, or all that do
// are broken. Other errors are those of OpenRenderer() and FilmRenderer::Step().
Result<Frame> RenderFrame(const Film& film, uint32_t number);

// Writes a frame with its metadata, under a temporary name until it is whole. The bytes are those
// of lfrenderer's file.
//   format  unset: "exr" or "png", by the suffix of `file`
// kUsage: the suffix is neither .exr nor .png, or is that of another format. Other errors are those
// of WritePicture().
Result<void> SaveFrame(const Frame& frame, const std::filesystem::path& file,
                       std::optional<FrameFormat> format = {}, const PictureOptions& picture = {});

}  // namespace lf
