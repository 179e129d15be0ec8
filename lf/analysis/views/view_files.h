// SPDX-License-Identifier: Apache-2.0
// Writes the views of a grid: a folder of images with Stanford names and a transforms.json, or one
// array of NumPy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lf/analysis/views/render_views.h"
#include "lf/analysis/views/view_grid.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// The values of views in files.
//   kSrgb8, kSrgb16  sRGB for display, with 8 or 16 bits
//   kLinear          linear light as 32-bit floats; NaN where no LF image shows anything
enum class ViewValues { kSrgb8, kSrgb16, kLinear };

// Returns the value of a linear light in kSrgb8 (most = 255) or kSrgb16 (most = 65535).
uint32_t DisplayNumber(float linear, uint32_t most);

// Returns the name of a view: out_VV_UU_Y_X.png (kLinear: .exr), where VV is its row, UU its
// column, and Y and X its position in millimetres, down and to the right (doc/formats/stanford.md).
std::string ViewName(const ViewGrid& grid, size_t view, double unit_m, ViewValues values);

// Returns the files that WriteViewFolder() writes: the views, transforms.json, and
// transforms.json.unfinished, which lists the views until all of them are written.
std::vector<std::filesystem::path> FilesOfViews(const ViewGrid& grid,
                                                const std::filesystem::path& folder, double unit_m,
                                                ViewValues values);

// Returns the views of another grid that WriteViewFolder() removes: those that transforms.json or
// transforms.json.unfinished lists, as WriteViewFolder() wrote it and nobody changed it since, and
// that FilesOfViews() does not.
std::vector<std::filesystem::path> OtherViews(const ViewGrid& grid,
                                              const std::filesystem::path& folder, double unit_m,
                                              ViewValues values);

// Views that were written.
struct WrittenViews {
  ViewsReport views;
  double gain = 1;  // light / gain was written
  // Shares of the pixels where no LF image shows anything, and of those whose light was clipped: at
  // the gain, which is 1 (display white) or at most EncodingOfLight().max_radiance.
  double unrecorded_share = 0, clipped_share = 0;
};

// Makes all views by `make`, which gets the sink that writes them, and writes
// - WriteViewFolder(): an image file for each view and, in the end, transforms.json, so that the
//   folder is a light field. Its cameras are in the world of `light_field`. Pixels where no LF
//   image shows anything are transparent, and are masked by this (lf_alpha). If light is brighter
//   than display white, sRGB values are those of light / gain, where gain (lf_gain) is the
//   brightest light, but no larger than recorded light can be; `make` is called twice then, because
//   the brightest light must be known first. OtherViews() and an older transforms.json are removed
//   before a view is written.
// - WriteViewArray(): one file of NumPy, [row][column][height][width][channel], which appears when
//   it is complete. sRGB values are clipped, and black where no LF image shows anything.
// Errors are those of `make`, and kOutput if a file cannot be written.
//   clips  true: sRGB values are clipped, and the gain is 1
using MakeAllViews = std::function<Result<ViewsReport>(const ViewSink& sink)>;
Result<WrittenViews> WriteViewFolder(const LightField& light_field, const ViewGrid& grid,
                                     const std::filesystem::path& folder, ViewValues values,
                                     bool clips, const MakeAllViews& make);
Result<WrittenViews> WriteViewArray(const ViewGrid& grid, const std::filesystem::path& file,
                                    ViewValues values, const MakeAllViews& make);

}  // namespace lf
