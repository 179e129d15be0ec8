// SPDX-License-Identifier: Apache-2.0
// Arrays of views in HDF5 files (.h5), such as lf.h5 of the first light field benchmark of the HCI:
// the dataset LF, or the dataset "views" that Python's lf.views() writes. libhdf5 is loaded when
// the first such file is opened (core/loaded_library.h). The pixels of a view are read without the
// others, unless the chunks of the file hold several views. All functions may be called by many
// threads at once; one of them reads at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/pixels/files/view_array.h"

namespace lf {

// The numbers that a file states about its views by name, such as dH.
using Hdf5Attributes = std::map<std::string, double, std::less<>>;

// The head of a dataset.
struct Hdf5Dataset {
  std::vector<size_t> shape;
  char kind = 'u';            // 'u' or 'i', a whole number without or with a sign; 'f' a float; '?'
  size_t value_bytes = 1;     // of a number in the file
  std::vector<size_t> chunk;  // shape of the chunks; empty: the numbers lie one after the other
};

// Returns true if a file of this name may be an HDF5 file: its extension is .h5 or .hdf5.
bool HasHdf5Name(const std::filesystem::path& file);
// Returns true if these are the first bytes of an HDF5 file.
bool IsHdf5Start(std::string_view start);

// Returns the array that a dataset is. kInput: errors of SetShapeOfViews(); numbers of another type
// than uint8, uint16, float32 or float64; chunks of more than kMostHdf5ChunkBytes. Sets
// ViewArray::cache_bytes.
//   name  of the file, for messages
inline constexpr size_t kMostHdf5ChunkBytes = size_t{1} << 28;
Result<ViewArray> ViewArrayOfDataset(const Hdf5Dataset& dataset, const std::string& name);

// Reads the head of the file. kInput: errors of ViewArrayOfDataset(); the file cannot be read, is
// damaged or truncated, or holds neither of the datasets; the program was built without libhdf5, or
// it is not installed where the program runs.
Result<ViewArray> ReadHdf5Array(const std::filesystem::path& file);

// Reads the attributes of the file and of its dataset that are one number, of a few known names. An
// attribute that is an array of one number counts as well. kInput as ReadHdf5Array(), or if an
// attribute of such a name is no number.
Result<Hdf5Attributes> ReadHdf5Attributes(const std::filesystem::path& file);

// Reads the wanted pixels of a view, as ReadArrayPart() does.
Result<void> ReadHdf5Part(const std::filesystem::path& file, int row, int column,
                          const WantedPixels& wanted, ImagePart* part);

// Closes the file that is kept open for further views.
void CloseHdf5File();

}  // namespace lf
