// SPDX-License-Identifier: Apache-2.0
// Arrays of views in files of NumPy (.npy) and HDF5 (hdf5_array.h): [row][column][y][x] or
// [row][column][y][x][channel], in C order, of uint8, uint16, float32 or float64. The pixels of a
// view are read without the others.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

struct ViewArray {
  int rows = 0, columns = 0;  // of the cameras
  ImageFileInfo info;         // header of each view
  int value_bytes = 1;        // of a number in the file
  bool is_big_endian = false;
  uint64_t values_begin = 0;  // offset of the first number
  // Bytes of an HDF5 file's chunks that are kept in memory for further views.
  size_t cache_bytes = 0;
};

// Returns true if a file is a .npy file of four or five dimensions, as arrays of views have them.
bool HoldsViewArray(const std::filesystem::path& file);

// Parses the head of a .npy file, from its first bytes. kInput as ReadViewArray(), naming the file.
Result<ViewArray> ParseViewArray(std::string_view start, uint64_t size_bytes,
                                 const std::string& name);

// Reads the head of the file. kInput: it cannot be read, is damaged or truncated, or holds no array
// of views; the message says which.
Result<ViewArray> ReadViewArray(const std::filesystem::path& file);

// Reads the wanted pixels of a view, as ReadImagePart() does. kInput also if the array has no such
// row or column.
Result<void> ReadArrayPart(const std::filesystem::path& file, int row, int column,
                           const WantedPixels& wanted, ImagePart* part);

}  // namespace lf
