// SPDX-License-Identifier: Apache-2.0
// Any head of a dataset, with any attributes, must give an error that names the file, or an array
// and a geometry that can be used. The bytes are the head: the number of dimensions, the type, its
// size, then eight bytes for each size of the shape and of the chunks; the rest are attributes: a
// byte that chooses the name, and the eight bytes of a number.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "lf/core/check.h"
#include "lf/import/formats/hci_archive.h"

namespace {

template <class T>
T Take(std::span<const uint8_t>* bytes) {
  T value{};
  const size_t count = std::min(sizeof value, bytes->size());
  std::memcpy(&value, bytes->data(), count);
  *bytes = bytes->subspan(count);
  return value;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* begin, size_t size_bytes) {
  std::span<const uint8_t> bytes(begin, size_bytes);
  lf::Hdf5Dataset dataset;
  const size_t dimensions = Take<uint8_t>(&bytes) % 8;
  dataset.kind = "uif?"[Take<uint8_t>(&bytes) % 4];
  dataset.value_bytes = Take<uint8_t>(&bytes);
  for (size_t i = 0; i < dimensions; ++i)
    dataset.shape.push_back(static_cast<size_t>(Take<uint64_t>(&bytes)));
  if (Take<uint8_t>(&bytes) % 2 == 1)
    for (size_t i = 0; i < dimensions; ++i)
      dataset.chunk.push_back(static_cast<size_t>(Take<uint64_t>(&bytes)));
  const auto array = lf::ViewArrayOfDataset(dataset, "fuzz");
  if (!array) {
    LF_CHECK(array.error().message.starts_with("fuzz: "));
    return 0;
  }
  LF_CHECK(array->rows >= 1 && array->columns >= 1 && array->info.channels <= 4);
  LF_CHECK(array->cache_bytes <= lf::kMostHdf5ChunkBytes);
  constexpr std::array kNames = {"dH",   "dV",   "focalLength", "shift",
                                 "hRes", "vRes", "xRes",        "channels"};
  lf::Hdf5Attributes attributes;
  while (bytes.size() >= 9) {
    const char* const name = kNames[Take<uint8_t>(&bytes) % kNames.size()];
    attributes[name] = Take<double>(&bytes);
  }
  const auto archive = lf::HciArchiveOf(attributes, *array, "fuzz");
  if (!archive) {
    LF_CHECK(archive.error().message.starts_with("fuzz: "));
    return 0;
  }
  if (archive->pitch_w) LF_CHECK(archive->pitch_w->minCoeff() > 0);
  if (archive->focal_px) LF_CHECK(std::isfinite(*archive->focal_px) && *archive->focal_px > 0);
  if (archive->plane_distance_w)
    LF_CHECK(*archive->plane_distance_w > 0 && *archive->plane_distance_w <= 1e9);
  return 0;
}
