// SPDX-License-Identifier: Apache-2.0
// Decodes camera raw files with LibRaw. No other reader uses it. Internal to this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/pixels/files/exposure_facts.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/image_probe.h"

namespace lf {

// A file whose header has been read. Its pixels can be decoded once. One thread at a time may use
// it. Each reader has its own LibRaw object, which starts no threads.
class RawReader {
 public:
  // Reads the header. `source` must outlive the reader. kInput: LibRaw does not know the file, or
  // finds it damaged; the file holds no Bayer or monochrome pixels as the sensor recorded them (the
  // message says what it holds, and what to do); it has more pixels than kMaxImagePixels, or than a
  // file of its length can hold.
  static Result<RawReader> Open(const ByteSource& source, uint64_t size_bytes,
                                const std::string& name);
  RawReader(RawReader&&) noexcept;
  ~RawReader();

  // Before Read(), raw->black_level is set only for DNG files. For other files LibRaw measures the
  // black level on the pixels of the sensor that are covered from light.
  const ImageFileInfo& info() const;

  // Returns the exposure that the file states.
  ExposureFacts exposure() const;

  // Decodes the visible pixels into `image`, whose memory is reused. kInput: the file is truncated
  // or damaged; small damage within compressed pixels may not be noticed. Throws std::bad_alloc if
  // LibRaw lacks memory.
  Result<void> Read(Image<uint16_t>* image);

 private:
  struct State;
  explicit RawReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
