// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/npy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstring>

#include "lf/pixels/files/npy_head.h"

namespace lf {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t kMaxDimensions = 4;

template <class T>
std::vector<double> Values(std::string_view bytes) {
  std::vector<double> values(bytes.size() / sizeof(T));
  for (size_t i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    values[i] = value;
  }
  return values;
}

}  // namespace

Result<NpyArray> ParseNpy(std::string_view bytes) {
  LF_ASSIGN_OR_RETURN(const NpyHead header, ParseNpyHead(bytes));
  const std::string_view values = bytes.substr(header.values_begin);
  if (header.shape.size() > kMaxDimensions)
    return InputError(fmt::format("holds an array of {} dimensions: expected at most {}",
                                  header.shape.size(), kMaxDimensions));
  if (header.descr != "<f8" && header.descr != "<f4")
    return InputError(fmt::format(
        "holds numbers of the type '{}': expected '<f8' or '<f4' (little-endian floats; convert it "
        "with array.astype('<f8'))",
        ShownNpyText(header.descr)));
  if (header.fortran_order)
    return InputError(
        "holds an array in Fortran order (column by column): expected C order (convert it with "
        "numpy.ascontiguousarray)");
  LF_ASSIGN_OR_RETURN(const size_t count, NpyValueCount(header.shape));
  const size_t value_size = header.descr == "<f8" ? 8 : 4;
  if (values.size() != count * value_size)
    return InputError(
        fmt::format("holds {} bytes of numbers: expected {} bytes for the shape ({}); copy or save "
                    "the file again",
                    values.size(), count * value_size, fmt::join(header.shape, ", ")));
  return NpyArray{header.shape, value_size == 8 ? Values<double>(values) : Values<float>(values)};
}

}  // namespace lf
