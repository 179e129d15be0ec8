// SPDX-License-Identifier: Apache-2.0
// The base of the readers of pictures whose pixels lie in the file as they are: BMP, Netpbm and
// PFM. Internal to this folder.
#pragma once

#include <memory>
#include <utility>

#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/rows_in_file.h"

namespace lf {

// Reads the rows of a part only. A derived class sets info_ and rows_ in its constructor.
class RowsDecoder : public PictureDecoder {
 public:
  explicit RowsDecoder(const FileBytes& file) : file_(file) {}
  const ImageFileInfo& info() const final { return info_; }
  const RowsInFile& rows() const { return rows_; }
  bool has_rows_on_disk() const override { return true; }

  Result<void> Read(StoredImage* image) final {
    const Result<PixelRect> rect = ReadRect({0, 0, info_.width, info_.height}, image);
    return rect ? Result<void>() : rect.error();
  }
  Result<PixelRect> ReadPart(const PixelRect& wanted, StoredImage* image) final {
    return ReadRect(Intersection(wanted, {0, 0, info_.width, info_.height}), image);
  }

 protected:
  // Decodes at least the pixels `rect`, which lie in the picture, and returns what it decoded.
  virtual Result<PixelRect> ReadRect(const PixelRect& rect, StoredImage* image) = 0;

  const FileBytes& file_;
  ImageFileInfo info_;
  RowsInFile rows_;
};

}  // namespace lf
