// Camera raw files, decoded by LibRaw: the only place with it. Internal to imageio.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/imageio/exposure_facts.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/image_probe.h"

namespace lf {

// A file at its header, decoded once. Not to be used by several threads at the same time; each has
// a LibRaw of its own, which starts no threads.
class RawReader {
 public:
  // Reads the header. `source` must outlive the reader.
  // kInput: LibRaw does not know the file; it holds no Bayer or monochrome pixels as the sensor
  // recorded them (the message says what it holds, and what to do); more pixels than are read, or
  // than a file of its length can hold.
  static Result<RawReader> Open(const ByteSource& source, uint64_t size_bytes,
                                const std::string& name);
  RawReader(RawReader&&) noexcept;
  ~RawReader();

  // Before Read(), the black level is known of DNG files alone: LibRaw measures that of others on
  // the covered pixels of the sensor.
  const ImageFileInfo& info() const;

  // The exposure that the camera states.
  ExposureFacts exposure() const;

  // Decodes the visible pixels; the memory of `image` is used again. kInput: truncated or damaged,
  // as far as LibRaw notices. Throws std::bad_alloc.
  Result<void> Read(Image<uint16_t>* image);

 private:
  struct State;
  explicit RawReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
