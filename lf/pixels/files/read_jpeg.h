// SPDX-License-Identifier: Apache-2.0
// Decodes JPEG files, whole or in part, with libjpeg-turbo. No other reader uses libjpeg. Internal
// to this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/image_probe.h"

namespace lf {

// A file whose header has been read. Its pixels can be decoded once. One thread at a time may use
// it.
class JpegReader {
 public:
  // Reads the header. `source` must outlive the reader and must have passed ProbeImage(). kInput:
  // the file is truncated or damaged, or neither colour nor grey (CMYK).
  static Result<JpegReader> Open(const ByteSource& source, const std::string& name);
  JpegReader(JpegReader&&) noexcept;
  ~JpegReader();

  const ImageFileInfo& info() const;
  // Returns the colour profile (ICC) that the file states; "" if there is none, or a part of it is
  // missing.
  std::string IccProfile();

  // Decodes at least the pixels of `wanted`, which must contain a pixel of the picture. If it saves
  // time, only these pixels and some around them are decoded, otherwise all. Returns the decoded
  // rectangle, and resizes `image` to it, in the same memory if possible. The pixels equal those of
  // the whole picture, bit for bit. The whole file is read in any case, so that the detection of
  // damage does not depend on `wanted`; decoding a part saves only inverse transforms. kInput:
  // libjpeg had to guess pixels, or the file has more than kMaxScans scans.
  Result<PixelRect> Read(const PixelRect& wanted, Image<uint8_t>* image);

  // Decodes the whole picture, reduced: a pixel of `image` is about the mean of a square of
  // reduction x reduction stored values, as the coefficients of low frequencies give it. The
  // picture is ceil(width / reduction) wide, and so on. Takes a fraction of the time of Read().
  //   reduction  2, 4 or 8
  // kInput as Read().
  Result<void> ReadReduced(int reduction, Image<uint8_t>* image);

  // Largest number of scans in a progressive file. Encoders write about ten; a small file with very
  // many scans could demand hours of work.
  static constexpr int kMaxScans = 200;

 private:
  struct State;
  explicit JpegReader(std::unique_ptr<State> state);
  void ReadRows(const PixelRect& part, Image<uint8_t>* image);
  std::unique_ptr<State> state_;
};

}  // namespace lf
