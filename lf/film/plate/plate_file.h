// SPDX-License-Identifier: Apache-2.0
// A sensor plate as a file: what it was made from, its progress, and every sum and count, exact
// (doc/formats/plate.md). The plates of a divided render are read from such files and added, and an
// interrupted frame is resumed from such a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {

namespace entry_file {
class Source;
}

// Keys and values that describe the plate, in the order in which its file holds them. Keys are
// words of [a-z0-9_.], and none occurs twice; values have no control characters.
using PlateEntries = std::vector<std::pair<std::string, std::string>>;

// Returns the value of a key; null if no entry has this key.
const std::string* FindEntry(const PlateEntries& entries, std::string_view key);

// Writes the plate atomically (core/file.h), compressed by the threads of `pool`. The bytes depend
// on the sums, counts and entries alone, not on how the plate stores them, and not on the threads.
// kOutput if the folder or the disk fails.
Result<void> WritePlate(const std::filesystem::path& path, const PlateEntries& entries,
                        const SensorPlate& plate, ThreadPool& pool);

// Reads a plate's file in two steps: first its entries, then, if the caller wants the plate, its
// rays.
class PlateReader {
 public:
  static constexpr uint32_t kMaxSide = 1u << 16;       // largest width and height, in elements
  static constexpr uint32_t kMaxTextBytes = 1u << 20;  // largest size of the entries as text

  // Opens a file and reads its head and entries. kInput if the file cannot be read, is no plate,
  // has another version, is too large, or is damaged; the message names file and reason.
  static Result<PlateReader> Open(const std::filesystem::path& path);
  // As Open(), for a file in memory, which must outlive the reader; messages call it `name`.
  static Result<PlateReader> OpenBytes(std::string_view bytes, const std::string& name);
  PlateReader(PlateReader&&) noexcept;
  PlateReader& operator=(PlateReader&&) noexcept;
  ~PlateReader();

  int width() const { return width_; }
  int height() const { return height_; }
  PlateKind kind() const { return kind_; }
  const PlateEntries& entries() const { return entries_; }

  // Adds all rays to a plate of the file's size and kind. Takes about a megabyte of memory
  // beside the plate. Must be called only once. kInput if the file is truncated or damaged; the
  // plate then holds a part of the rays and must not be used. kInterrupted, with such a plate:
  // is_interrupted, which is called every few rows and may be empty, returned true.
  Result<void> AddTo(SensorPlate* plate, const std::function<bool()>& is_interrupted = {});

 private:
  explicit PlateReader(std::unique_ptr<entry_file::Source> source);
  Result<void> ReadHead();
  Result<void> AddChunk(uint32_t chunk, SensorPlate* plate);
  Result<void> AddWide(SensorPlate* plate);

  std::unique_ptr<entry_file::Source> source_;
  int width_ = 0;
  int height_ = 0;
  PlateKind kind_ = PlateKind::kColours;
  int rows_per_chunk_ = 1;
  uint64_t wide_count_ = 0;
  PlateEntries entries_;
};

}  // namespace lf
