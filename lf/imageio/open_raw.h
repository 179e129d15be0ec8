// Camera raw files through OpenImageIO, which reads them by LibRaw. Internal to this folder.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/raw_mosaic.h"

namespace lf {

// Bytes under a name in the file system, without a disk: OpenImageIO 2.4 opens raw files only by
// name.
class NamedBytes {
 public:
  // kOutput if the system gives no memory for them.
  static Result<NamedBytes> Create(std::string_view bytes);
  NamedBytes(NamedBytes&& other) noexcept : file_(other.file_) { other.file_ = -1; }
  NamedBytes& operator=(NamedBytes&&) = delete;
  ~NamedBytes();

  std::string path() const;

 private:
  explicit NamedBytes(int file) : file_(file) {}
  int file_;
};

struct OpenRaw {
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  RawFacts facts;
};

// The mosaic at `path`, at the start of its pixels.
//   name    what messages call it
//   mosaic  what its tags say
// kInput: LibRaw does not know it, or would give something else than this mosaic.
Result<OpenRaw> OpenRawFile(const std::string& path, const RawMosaic& mosaic,
                            const std::string& name);

}  // namespace lf
