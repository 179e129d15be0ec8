// SPDX-License-Identifier: Apache-2.0
// The parts of hdf5_array.h that need no libhdf5.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "lf/pixels/files/hdf5_array.h"
#include "lf/pixels/files/views_shape.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns how many of `size` parts of an axis lie in different chunks.
size_t Chunks(size_t size, size_t chunk) { return (size + chunk - 1) / chunk; }

// Returns the bytes of the chunks that one view touches, at most kMostHdf5ChunkBytes if each chunk
// is smaller; 0 if there are no chunks.
Result<size_t> CacheBytes(const Hdf5Dataset& dataset, const std::string& name) {
  const std::vector<size_t>& chunk = dataset.chunk;
  if (chunk.size() != dataset.shape.size()) return 0;
  size_t bytes = dataset.value_bytes;
  for (const size_t size : chunk) {
    if (size == 0 || size > kMostHdf5ChunkBytes / bytes)
      return InputError(
          fmt::format("{}: its chunks hold more than {} MiB each, or nothing: write the array with "
                      "a chunk for each view",
                      name, kMostHdf5ChunkBytes >> 20));
    bytes *= size;
  }
  for (size_t axis = 2; axis < chunk.size(); ++axis) {
    const size_t count = Chunks(dataset.shape[axis], chunk[axis]);
    bytes = count > kMostHdf5ChunkBytes / bytes ? kMostHdf5ChunkBytes : bytes * count;
  }
  return bytes;
}

}  // namespace

bool HasHdf5Name(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".h5" || extension == ".hdf5";
}

bool IsHdf5Start(std::string_view start) { return start.starts_with("\x89HDF\r\n\x1a\n"); }

Result<ViewArray> ViewArrayOfDataset(const Hdf5Dataset& dataset, const std::string& name) {
  ViewArray array;
  LF_RETURN_IF_ERROR(SetShapeOfViews(dataset.shape, /*is_fortran=*/false, name, &array));
  const std::pair<char, size_t> type = {dataset.kind, dataset.value_bytes};
  constexpr std::pair<char, size_t> kTypes[] = {{'u', 1}, {'u', 2}, {'f', 4}, {'f', 8}};
  if (std::find(std::begin(kTypes), std::end(kTypes), type) == std::end(kTypes)) {
    const char* const kind = type.first == 'u'   ? "unsigned whole numbers"
                             : type.first == 'i' ? "whole numbers with a sign"
                             : type.first == 'f' ? "floats"
                                                 : "values that are no numbers";
    return InputError(
        fmt::format("{}: holds {} of {} bits: expected uint8, uint16, float32 or float64; convert "
                    "the array with astype",
                    name, kind, 8 * type.second));
  }
  array.value_bytes = static_cast<int>(type.second);
  array.info.is_float = type.first == 'f';
  array.info.bits = array.info.is_float ? 32 : 8 * array.value_bytes;
  LF_ASSIGN_OR_RETURN(array.cache_bytes, CacheBytes(dataset, name));
  return array;
}

}  // namespace lf
