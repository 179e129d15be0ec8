// SPDX-License-Identifier: Apache-2.0
// Joins the pictures of the views of one moment into one picture.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/develop/view_layout.h"
#include "lf/pixels/files/picture_header.h"

namespace lf {

// The arrangement of the views, and the kind of the joined picture.
struct JoinOptions {
  ViewLayout layout = ViewLayout::kQuilt;  // not kLeftRight, unless the pictures are for display
  TileCounts grid = {};                    // of a quilt
  // True: the joined picture is 8-bit sRGB, composited over black, for a video or for the PNG file
  // of EXR frames. False: it has the type and the colours of the views.
  bool is_for_display = false;
  // Size of a tile of a quilt, into which views are squeezed; none: that of the views, which are
  // then copied. Must not exceed theirs.
  std::optional<ViewSize> tile = {};
};

// Returns the names of the channels of the joined picture: R, G, B and, if the views have it, A of
// EXR files, whose other channels describe single views; all channels of PNG files. kInput: an EXR
// file has no R, G and B; or, for anaglyphs and for display, there are fewer than three channels;
// or an anaglyph is asked for views with alpha, which has no meaning for one channel.
//   name  name of the file, for messages
Result<std::vector<std::string>> JoinedChannels(const PictureHeader& header,
                                                const JoinOptions& options,
                                                const std::string& name);

// Returns the joined picture of the views.
//   files    one for each view, left to right; each has this header
//   on_view  called when a view has been placed, from any thread; may be empty. If it returns
//            false, the others are left out and the result is kInterrupted
// kInput: a file cannot be read, or is of another kind than the header says.
Result<StoredImage> JoinViews(std::span<const std::filesystem::path> files,
                              const PictureHeader& header, const JoinOptions& options,
                              ThreadPool& pool, const std::function<bool()>& on_view);

// Returns the properties in which joined pictures must agree, such as "64 x 48 pixels of 8 bits in
// the channels R G B".
std::string KindOf(const PictureHeader& header);

}  // namespace lf
