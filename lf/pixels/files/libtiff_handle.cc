// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/libtiff_handle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <span>
#include <string_view>

namespace lf {
namespace {

bool ContainsAny(std::string_view message, std::span<const std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(), [&](std::string_view part) {
    return message.find(part) != std::string_view::npos;
  });
}

// True if a message names a tag that pixels depend on. libtiff guesses pixels without such a tag.
bool NamesTagOfPixels(std::string_view message) {
  constexpr std::string_view kTags[] = {
      "\"ImageWidth\"",       "\"ImageLength\"",      "\"BitsPerSample\"",
      "\"Compression\"",      "\"FillOrder\"",        "\"PhotometricInterpretation\"",
      "\"SamplesPerPixel\"",  "\"RowsPerStrip\"",     "\"StripOffsets\"",
      "\"StripByteCounts\"",  "\"TileWidth\"",        "\"TileLength\"",
      "\"TileOffsets\"",      "\"TileByteCounts\"",   "\"PlanarConfiguration\"",
      "\"Predictor\"",        "\"ColorMap\"",         "\"ExtraSamples\"",
      "\"SampleFormat\"",     "\"JPEGTables\"",       "\"Group3Options\"",
      "\"Group4Options\"",    "\"YCbCrSubsampling\"", "\"ReferenceBlackWhite\"",
      "\"YCbCrCoefficients\""};
  return ContainsAny(message, kTags);
}

// True if a message says that memory ran out. A failure to allocate an array of no elements is
// damage of the file, although libtiff reports it in the same words.
bool IsOutOfMemory(std::string_view message) {
  if (message.find("(0 elements") != std::string_view::npos) return false;
  constexpr std::string_view kParts[] = {
      "ut of memory",      "nsufficient memory", "ot enough memory", "o space for",
      "ailed to allocate", "annot allocate",     "nable to allocate"};
  return ContainsAny(message, kParts);
}

// True if libtiff decodes all pixels although it reports this error: another program gave a tag a
// value that is not allowed, for example the orientation 0.
bool IsHarmlessError(std::string_view message) {
  return message.find("Bad value") != std::string_view::npos && !NamesTagOfPixels(message);
}

// True if pixels are missing or guessed after this warning. Most warnings are about unknown tags.
bool IsHarmfulWarning(std::string_view module, std::string_view message) {
  // Fill bytes between the segments of a JPEG stream are the only harmless warning of libjpeg.
  if (module == "JPEGLib")
    return message.find("extraneous bytes before marker") == std::string_view::npos;
  constexpr std::string_view kParts[] = {
      "IO error",                  // a tag lies beyond the end of the file
      "Premature E",               // CCITT: the rest of a row or strip is white
      "Line length mismatch",      // CCITT: a row has too few or too many pixels
      "Improper JPEG strip/tile",  // the JPEG stream has fewer pixels than the strip
      "fractional scanline"};
  if (ContainsAny(message, kParts)) return true;
  return message.find("ignored") != std::string_view::npos && NamesTagOfPixels(message);
}

LibtiffHandle& HandleOf(void* handle) { return *static_cast<LibtiffHandle*>(handle); }

}  // namespace

tmsize_t LibtiffHandle::Read(thandle_t handle, void* to, tmsize_t size) noexcept {
  LibtiffHandle& self = HandleOf(handle);
  if (self.file_ == nullptr || size <= 0) return 0;
  try {
    const size_t count =
        self.file_->read(self.position_, {static_cast<uint8_t*>(to), static_cast<size_t>(size)});
    self.position_ += count;
    return static_cast<tmsize_t>(count);
  } catch (...) {
    self.thrown_ = std::current_exception();
    return 0;
  }
}

tmsize_t LibtiffHandle::Write(thandle_t handle, void* from, tmsize_t size) noexcept {
  LibtiffHandle& self = HandleOf(handle);
  if (self.bytes_ == nullptr || size <= 0) return 0;
  try {
    const uint64_t end = self.position_ + static_cast<uint64_t>(size);
    if (self.bytes_->size() < end) self.bytes_->resize(end);
    std::memcpy(self.bytes_->data() + self.position_, from, static_cast<size_t>(size));
    self.position_ = end;
    return size;
  } catch (...) {
    self.thrown_ = std::current_exception();
    return 0;
  }
}

toff_t LibtiffHandle::Seek(thandle_t handle, toff_t offset, int origin) noexcept {
  LibtiffHandle& self = HandleOf(handle);
  if (origin == SEEK_CUR) offset += self.position_;
  if (origin == SEEK_END) offset += Size(handle);
  self.position_ = offset;
  return offset;
}

toff_t LibtiffHandle::Size(thandle_t handle) noexcept {
  const LibtiffHandle& self = HandleOf(handle);
  return self.file_ != nullptr ? self.file_->size_bytes : self.bytes_->size();
}

void LibtiffHandle::Note(const char* message) noexcept {
  if (IsOutOfMemory(message)) is_out_of_memory_ = true;
  if (fault_[0] != 0) return;
  std::snprintf(fault_, sizeof fault_, "%s", message);
  std::replace(std::begin(fault_), std::end(fault_), '\n', ' ');
}

int LibtiffHandle::OnError(TIFF*, void* handle, const char*, const char* format,
                           va_list values) noexcept {
  char message[512];
  std::vsnprintf(message, sizeof message, format, values);
  if (!IsHarmlessError(message)) HandleOf(handle).Note(message);
  return 1;  // tells libtiff not to call the handlers of the process
}

int LibtiffHandle::OnWarning(TIFF*, void* handle, const char* module, const char* format,
                             va_list values) noexcept {
  char message[512];
  std::vsnprintf(message, sizeof message, format, values);
  if (IsOutOfMemory(message) || IsHarmfulWarning(module != nullptr ? module : "", message))
    HandleOf(handle).Note(message);
  return 1;
}

void LibtiffHandle::Open(const char* mode) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), OnError, this);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), OnWarning, this);
  tiff_ = TIFFClientOpenExt(
      "TIFF", mode, this, Read, Write, Seek, [](thandle_t) { return 0; }, Size, nullptr, nullptr,
      options.get());
}

void LibtiffHandle::Close() {
  if (tiff_ == nullptr) return;
  TIFFClose(tiff_);
  tiff_ = nullptr;
}

Error LibtiffHandle::ErrorOf(const std::string& reason) const {
  if (file_ == nullptr) return OutputError(fmt::format("{}: cannot be encoded: {}", name_, reason));
  return InputError(fmt::format("{}: truncated or damaged: {}", name_, reason));
}

Result<void> LibtiffHandle::Check(bool succeeded) const {
  if (thrown_) std::rethrow_exception(thrown_);
  if (is_out_of_memory_) throw std::bad_alloc();
  if (fault_[0] != 0) return ErrorOf(fault_);
  if (!succeeded) return ErrorOf("libtiff does not say why");
  return {};
}

Result<std::unique_ptr<LibtiffHandle>> LibtiffHandle::OpenToRead(const FileBytes& file) {
  std::unique_ptr<LibtiffHandle> handle(new LibtiffHandle(file.name));
  handle->file_ = &file;
  handle->Open("rm");  // m: the file is not mapped into memory
  LF_RETURN_IF_ERROR(handle->Check(handle->tiff_ != nullptr));
  return handle;
}

Result<std::unique_ptr<LibtiffHandle>> LibtiffHandle::OpenToWrite(const std::string& name,
                                                                  bool is_big, std::string* bytes,
                                                                  bool is_big_endian) {
  std::unique_ptr<LibtiffHandle> handle(new LibtiffHandle(name));
  handle->bytes_ = bytes;
  handle->Open((std::string("w") + (is_big_endian ? 'b' : 'l') + (is_big ? "8" : "4")).c_str());
  LF_RETURN_IF_ERROR(handle->Check(handle->tiff_ != nullptr));
  return handle;
}

}  // namespace lf
