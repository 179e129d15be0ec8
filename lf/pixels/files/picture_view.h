// SPDX-License-Identifier: Apache-2.0
// Views: images that are parts of one larger picture, such as a mosaic. Their paths are those of
// the picture with the part behind a '#':
//
//   mosaic.png#160x120+320+240      the rectangle of 160 x 120 pixels at column 320, row 240
//   lenslets.png#every-14x14+3+4    every 14th pixel of every 14th row, from column 3, row 4 on
//   views.npy#view+3+4              the view in row 3, column 4 of an array (view_array.h)
//
// ReadImageInfo(), ReadImagePart() and all other functions of image_file.h that take paths read
// views as they read files. The picture is decoded once and kept for other views, until another
// picture is needed or ForgetSharedPicture() is called; the pixels of arrays and of Netpbm, PFM and
// BMP files are read from the disk instead (an HDF5 file is kept open). All functions may be called
// by many threads at once.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

struct PictureView {
  std::filesystem::path file;  // the picture
  int x = 0, y = 0;            // its first pixel
  // Columns and rows from one pixel of the view to the next; 1: the view is a rectangle.
  int step_x = 1, step_y = 1;
  bool is_of_array = false;  // x and y are the column and row of the view in an array
  // Size of a rectangle. If it is of an array, or if steps are not 1, the view reaches to the end
  // of the picture, and both are 0.
  int width = 0, height = 0;
};

// Returns the view that a path states; nullopt if it is the path of a file.
std::optional<PictureView> PictureViewOf(const std::filesystem::path& image);

// Returns the path of the file that holds an image: without the view, if it states one.
std::filesystem::path FileOfImage(const std::filesystem::path& image);

// Returns what stands behind the path of the file, with the '#'; "" if the path states no view.
std::string ViewSuffix(const std::filesystem::path& image);

// Returns the path of a view, which PictureViewOf() reads.
std::filesystem::path PathOfView(const PictureView& view);

// Reads the header of the picture, and returns that of the view: its width and height, no
// orientation. kInput: errors of ReadImageInfo(); the view does not lie within the picture; the
// picture is a camera raw file.
Result<ImageFileInfo> ReadViewInfo(const PictureView& view);

// Reads the wanted pixels of a view, as ReadImagePart() does.
Result<void> ReadViewPart(const PictureView& view, const WantedPixels& wanted, ImagePart* part);

// Returns the bytes that the picture of a view takes, decoded and as its file, which is in memory
// while it is decoded; of an HDF5 file, the chunks that are kept; 0 if nothing is kept.
size_t SharedPictureBytes(const PictureView& view);

// Frees the picture that is kept, and closes the HDF5 file that is kept open.
void ForgetSharedPicture();

}  // namespace lf
