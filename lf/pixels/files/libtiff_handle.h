// SPDX-License-Identifier: Apache-2.0
// Opens TIFF files with libtiff, and collects its errors and warnings. Internal to this folder.
//
// libtiff continues after most errors. It reports them to a handler that belongs to one file here,
// so many threads can use libtiff at once, and nothing is printed.
#pragma once

#include <tiffio.h>

#include <exception>
#include <memory>
#include <string>

#include "lf/core/result.h"
#include "lf/pixels/files/picture_decoder.h"

namespace lf {

class LibtiffHandle {
 public:
  // Reads the header and the first directory. `file` must outlive the handle. kInput: the file is
  // truncated or damaged.
  static Result<std::unique_ptr<LibtiffHandle>> OpenToRead(const FileBytes& file);
  // Starts a file whose bytes become `bytes`, which must outlive the handle. The file is complete
  // after Close().
  //   is_big  makes a BigTIFF file, which can have more than 4 GiB
  static Result<std::unique_ptr<LibtiffHandle>> OpenToWrite(const std::string& name, bool is_big,
                                                            std::string* bytes,
                                                            bool is_big_endian = false);
  ~LibtiffHandle() { Close(); }
  LibtiffHandle(const LibtiffHandle&) = delete;
  LibtiffHandle& operator=(const LibtiffHandle&) = delete;

  // Returns libtiff's object for the file; null after Close().
  TIFF* tiff() const { return tiff_; }
  // Frees libtiff's memory. A file to write must have been completed by TIFFWriteDirectory().
  void Close();

  // Returns an error if `succeeded`, the result of the last call of libtiff, is false, or if
  // libtiff has reported in any call that pixels are missing or guessed: kInput when reading,
  // kOutput when writing. Throws std::bad_alloc if memory ran out, and rethrows an exception of the
  // ByteSource.
  Result<void> Check(bool succeeded) const;

 private:
  explicit LibtiffHandle(const std::string& name) : name_(name) {}
  void Open(const char* mode);
  Error ErrorOf(const std::string& reason) const;

  // libtiff calls these functions. They do not throw, because an exception must not pass through C.
  static tmsize_t Read(thandle_t handle, void* to, tmsize_t size) noexcept;
  static tmsize_t Write(thandle_t handle, void* from, tmsize_t size) noexcept;
  static toff_t Seek(thandle_t handle, toff_t offset, int origin) noexcept;
  static toff_t Size(thandle_t handle) noexcept;
  static int OnError(TIFF*, void* handle, const char*, const char* format, va_list) noexcept;
  static int OnWarning(TIFF*, void* handle, const char* module, const char* format,
                       va_list) noexcept;
  // Keeps the first message as fault_, and notes whether a message says that memory ran out.
  void Note(const char* message) noexcept;

  std::string name_;
  const FileBytes* file_ = nullptr;  // the file to read; null when writing
  std::string* bytes_ = nullptr;     // bytes of the file to write; null when reading
  uint64_t position_ = 0;
  TIFF* tiff_ = nullptr;
  char fault_[512] = {};  // first message about missing or guessed pixels; empty: none
  bool is_out_of_memory_ = false;
  std::exception_ptr thrown_;  // exception of the ByteSource or of `bytes_`; null: none
};

}  // namespace lf
