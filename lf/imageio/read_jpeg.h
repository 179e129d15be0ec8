// JPEG files, decoded by libjpeg-turbo, whole or in part: the only place with libjpeg. Internal to
// imageio.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/image_probe.h"

namespace lf {

// A file at its header, decoded once. Not to be used by several threads at the same time.
class JpegReader {
 public:
  // Reads the header. `source` must outlive the reader; ProbeImage() has looked at it.
  // kInput: truncated or damaged; neither colour nor grey (CMYK).
  static Result<JpegReader> Open(const ByteSource& source, const std::string& name);
  JpegReader(JpegReader&&) noexcept;
  ~JpegReader();

  const ImageFileInfo& info() const;

  // Decodes at least the pixels of `wanted`, which holds some: where this saves time they and some
  // around them, else all. Gives which, with `image` as large; its memory is used again. The pixels
  // are those of the whole picture, bit for bit, whatever is wanted. All of the file is read, for
  // whether it is damaged must not depend on what is wanted: a part saves the transforms alone.
  // kInput: whatever libjpeg could only guess, or more than kMaxScans.
  Result<PixelRect> Read(const PixelRect& wanted, Image<uint8_t>* image);

  // Progressive files of more claim hours of work with few bytes; encoders write about ten.
  static constexpr int kMaxScans = 200;

 private:
  struct State;
  explicit JpegReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
