// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/views_shape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "lf/pixels/files/npy_head.h"
#include "lf/pixels/files/picture_decoder.h"

namespace lf {

Result<void> SetShapeOfViews(std::span<const size_t> shape, bool is_fortran,
                             const std::string& name, ViewArray* array) {
  const size_t channels = shape.size() == 5 ? shape[4] : 1;
  if ((shape.size() != 4 && shape.size() != 5) || is_fortran || channels > 4)
    return InputError(fmt::format(
        "{}: holds an array of the shape ({}){}: expected the views of a grid of cameras, (rows, "
        "columns, height, width) or (rows, columns, height, width, channels) in C order with up to "
        "4 channels",
        name, fmt::join(shape, ", "), is_fortran ? " in Fortran order" : ""));
  const Result<size_t> count = NpyValueCount({shape.begin(), shape.end()});
  if (!count) return InputError(fmt::format("{}: {}", name, count.error().message));
  LF_RETURN_IF_ERROR(CheckPictureSize(static_cast<int64_t>(shape[3]),
                                      static_cast<int64_t>(shape[2]),
                                      static_cast<int64_t>(channels), name));
  array->rows = static_cast<int>(shape[0]);
  array->columns = static_cast<int>(shape[1]);
  array->info.height = static_cast<int>(shape[2]);
  array->info.width = static_cast<int>(shape[3]);
  array->info.channels = static_cast<int>(channels);
  array->info.channel_names = channels < 3 ? std::vector<std::string>{"Y", "A"}
                                           : std::vector<std::string>{"R", "G", "B", "A"};
  array->info.channel_names.resize(channels);
  return {};
}

Result<PixelRect> BeginArrayPart(const ViewArray& array, int row, int column,
                                 const std::string& name, const WantedPixels& wanted,
                                 ImagePart* part) {
  if (row >= array.rows || column >= array.columns)
    return InputError(fmt::format(
        "{}: has {} rows and {} columns of views, but row {} and column {}, counted from 0, are "
        "asked for: is it another array than when the calibration was written?",
        name, array.rows, array.columns, row, column));
  LF_ASSIGN_OR_RETURN(const PixelRect asked, wanted(array.info));
  part->info = array.info;
  part->icc_profile.clear();
  part->rect = Intersection(asked, {0, 0, array.info.width, array.info.height});
  return part->rect;
}

}  // namespace lf
