// A sensor plate as one file: what it was made from, how far it is, and every sum and count, exact
// (doc/formats/plate.md). Plates of a divided run are added from such files; an interrupted frame
// goes on from one.
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
#include "lf/plate/sensor_plate.h"

namespace lf {

namespace entry_file {
class Source;
}

// What a plate's file says of it, in the order written. Keys are words of [a-z0-9_.], each once;
// values hold no control characters.
using PlateEntries = std::vector<std::pair<std::string, std::string>>;

// The value of a key; null where there is none.
const std::string* FindEntry(const PlateEntries& entries, std::string_view key);

// Writes the plate atomically (core/file.h), compressed by the threads of `pool`. The bytes depend
// on the sums, counts and entries alone: not on how the plate keeps them, and not on the threads.
// kOutput: the folder, the disk.
Result<void> WritePlate(const std::filesystem::path& path, const PlateEntries& entries,
                        const SensorPlate& plate, ThreadPool& pool);

// Reads a plate's file: first what it says, then, if that is what was hoped for, its rays.
class PlateReader {
 public:
  static constexpr uint32_t kMaxSide = 1u << 16;       // elements
  static constexpr uint32_t kMaxTextBytes = 1u << 20;  // of the entries

  // kInput: cannot be read, no plate, of another version, too large, or damaged; the message names
  // file and reason.
  static Result<PlateReader> Open(const std::filesystem::path& path);
  // The same for a file in memory, which must outlive the reader; `name` is what messages call it.
  static Result<PlateReader> OpenBytes(std::string_view bytes, const std::string& name);
  PlateReader(PlateReader&&) noexcept;
  PlateReader& operator=(PlateReader&&) noexcept;
  ~PlateReader();

  int width() const { return width_; }
  int height() const { return height_; }
  bool has_opacity() const { return channels_ > SensorPlate::kChannels; }
  const PlateEntries& entries() const { return entries_; }

  // Adds all rays to a plate of this size and these channels; needs about a megabyte beside it. To
  // be called once. kInput: truncated or damaged; the plate then holds a part and is of no use.
  Result<void> AddTo(SensorPlate* plate);

 private:
  explicit PlateReader(std::unique_ptr<entry_file::Source> source);
  Result<void> ReadHead();
  Result<void> AddChunk(uint32_t chunk, SensorPlate* plate);
  Result<void> AddWide(SensorPlate* plate);

  std::unique_ptr<entry_file::Source> source_;
  int width_ = 0;
  int height_ = 0;
  int channels_ = SensorPlate::kChannels;
  int rows_per_chunk_ = 1;
  uint64_t wide_count_ = 0;
  PlateEntries entries_;
};

}  // namespace lf
