// Where the pixels of LF images come from. A terabyte is never in memory: one image at a time.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "lf/capture/lf_pixels.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

// What becomes of mosaics.
enum class Mosaics { kAsRecorded, kToRgb };

class LfImageStore {
 public:
  virtual ~LfImageStore() = default;

  // The pixels of one LF image, at least those of `rect` (pixels of the LF image), as linear
  // 16-bit radiance. The memory of `pixels` is used again. May be called by many threads at the
  // same time.
  // kInput: missing, broken or of another size than the calibration says; the message names the
  // file. The caller decides whether the run goes on without it.
  virtual Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const = 0;

  // Whether the file is there, whatever it holds: a disk may be unmounted during a night's work.
  virtual bool IsThere(LfImageId /*id*/) const { return true; }

  // Returns whether pixels of LF images were left out on purpose when the store was made: then
  // Keeps() tells which.
  virtual bool IsPartial() const { return false; }
  // Returns false if some of these pixels, cut to the image, were left out on purpose.
  virtual bool Keeps(LfImageId /*id*/, const PixelRect& /*rect*/) const { return true; }

  // What loading reads: the size of the file, or of the code in a packed store; 0: not there, or
  // not known.
  virtual uint64_t StoredBytes(LfImageId /*id*/) const { return 0; }

  // The image will be loaded soon: the disk may begin to read it. Does not wait; failing is silent,
  // for Load() will say what is wrong. May be called by many threads at the same time.
  virtual void Announce(LfImageId /*id*/) const {}
};

// store.Load() into the memory of `pixels`, which are the answer. What a store throws, for want of
// memory (kOutput) or otherwise (kInput), becomes the image's error: an exception that leaves a
// thread ends the program.
Result<LfPixels> LoadWithoutThrowing(const LfImageStore& store, LfImageId id, const PixelRect& rect,
                                     const std::string& name, LfPixels pixels);

// The first failure to load that is the machine's (no memory, no open files). Whoever leaves out LF
// images that cannot be loaded asks it in the end: other images were as good as those that are
// left. All functions may be called by many threads at the same time.
class MachineFailure {
 public:
  // Ignores errors of the image itself, which are not kOutput.
  void Note(const Error& error);
  // Returns the first error that was noted, which is kOutput.
  Result<void> Check() const;

 private:
  mutable std::mutex mutex_;
  std::optional<Error> first_;
};

}  // namespace lf
