// SPDX-License-Identifier: Apache-2.0
// Functions that the readers of arrays of views in files of NumPy and HDF5 share. Internal to this
// folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lf/core/result.h"
#include "lf/pixels/files/view_array.h"

namespace lf {

// Sets rows, columns and the header of each view, but not the type of the numbers. kInput: another
// shape than (rows, columns, height, width) or (rows, columns, height, width, channels) with up to
// 4 channels; more than 2^32 numbers; views that are larger than ReadImage() allows.
//   is_fortran  the first index runs fastest, which is kInput
//   name        of the file, for messages
Result<void> SetShapeOfViews(std::span<const size_t> shape, bool is_fortran,
                             const std::string& name, ViewArray* array);

// Sets the header and the rectangle of the part that becomes the wanted pixels of a view. kInput:
// errors of `wanted`; the array has no such row or column.
Result<PixelRect> BeginArrayPart(const ViewArray& array, int row, int column,
                                 const std::string& name, const WantedPixels& wanted,
                                 ImagePart* part);

}  // namespace lf
