// SPDX-License-Identifier: Apache-2.0
// A source of the pixels of LF images. It loads one LF image at a time, because a light field may
// take a terabyte.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// How mosaics are loaded: as recorded, or converted to RGB.
enum class Mosaics { kAsRecorded, kToRgb };

// The content that is loaded of LF images: their pixels, or also the depths of recorded ones and
// the trust in virtual ones (LfPixels::depths and trust) if the store has some.
enum class StoreContent { kPixels, kPixelsAndDepths };

// A function that a store calls, in the loading thread, when the first `row_count` rows of
// pixels->radiance are complete. All other members are complete at the first call. The function may
// change complete rows; in the last call, which has all rows, it may change all of *pixels.
using RowsLoaded = std::function<void(LfPixels* pixels, int row_count)>;

class LfImageStore {
 public:
  virtual ~LfImageStore() = default;

  // Loads at least the pixels `rect` of one LF image, as linear 16-bit radiance. Reuses the memory
  // of `pixels`. May be called by many threads at the same time. kInput, naming the file: the image
  // is missing, broken or of another size than the calibration says. kOutput: the machine lacks
  // something, such as memory. The caller decides whether to continue without the image.
  virtual Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const = 0;

  // Loads as Load() does, and calls rows_loaded() at least once. A store that completes rows early
  // also calls it for them.
  virtual Result<void> LoadByRows(LfImageId id, const PixelRect& rect, LfPixels* pixels,
                                  const RowsLoaded& rows_loaded) const {
    LF_RETURN_IF_ERROR(Load(id, rect, pixels));
    rows_loaded(pixels, pixels->radiance.height());
    return {};
  }

  // Loads a whole LF image as Load() does, or, if that is faster, reduced: each pixel is about the
  // mean of a square of LF pixels, and pixels that fill no square are cut off, as
  // WithLargerPixels() of camera/resolution.h says. The mean may be one of stored values instead of
  // light, which is for pictures that must be quick. Returns the number of LF pixels along each
  // side of a square, which divides `divisor`; 1 for a whole LF image.
  //   k  intrinsics of the LF image
  virtual Result<int> LoadReduced(LfImageId id, int /*divisor*/, const Intrinsics& k,
                                  LfPixels* pixels) const {
    LF_RETURN_IF_ERROR(Load(id, {0, 0, k.width_px, k.height_px}, pixels));
    return 1;
  }

  // Returns true if the file of the LF image, or its encoded image in a packed store, exists, even
  // if it is broken. The answer may change, for example if a disk is unmounted during the run.
  virtual bool IsThere(LfImageId /*id*/) const { return true; }

  // Returns true if pixels of LF images were left out on purpose when the store was made. Keeps()
  // then tells which.
  virtual bool IsPartial() const { return false; }
  // Returns false if some of the pixels `rect`, clipped to the image, were left out on purpose.
  virtual bool Keeps(LfImageId /*id*/, const PixelRect& /*rect*/) const { return true; }

  // Returns true if Load() loads the depths of recorded LF images and the trust in virtual ones:
  // the store is densified, and was opened for depths.
  virtual bool LoadsDepths() const { return false; }

  // Returns the number of bytes that loading reads: the size of the file, or of the encoded image
  // in a packed store; 0 if the image is missing or the size is not known.
  virtual uint64_t StoredBytes(LfImageId /*id*/) const { return 0; }

  // Returns the memory that the decoded reference images of all LF images take together
  // (pixels/codec/predicted_image.h); 0 if no LF image is predicted. A store that can keep less
  // decodes reference images again and again.
  virtual uint64_t ReferenceBytes() const { return 0; }
  // Sets the memory for decoded reference images that are kept from one call of Load() to later
  // ones. Not at the same time as other calls.
  virtual void LimitReferences(uint64_t /*most_bytes*/) {}

  // Announces that the image will be loaded soon, so that the disk may begin to read it. Does not
  // wait, and ignores failures, which Load() will report. May be called by many threads at the same
  // time.
  virtual void Announce(LfImageId /*id*/) const {}
};

// Calls store.Load() with the memory of `pixels`, and returns the loaded pixels. Exceptions of the
// store become errors, because an exception that leaves a thread ends the program: kOutput if there
// is not enough memory, otherwise KindOfReadFailure() of core/file.h.
//   name         name of the LF image, for messages
//   rows_loaded  null, or passed to store.LoadByRows(), which is called instead
Result<LfPixels> LoadWithoutThrowing(const LfImageStore& store, LfImageId id, const PixelRect& rect,
                                     const std::string& name, LfPixels pixels,
                                     const RowsLoaded& rows_loaded = nullptr);
// Calls store.LoadReduced() likewise.
Result<int> LoadReducedWithoutThrowing(const LfImageStore& store, LfImageId id, int divisor,
                                       const Intrinsics& k, const std::string& name,
                                       LfPixels* pixels);

// Remembers the first failure to load that is the machine's fault (out of memory, too many open
// files). A caller that leaves out LF images that cannot be loaded must call Check() at the end,
// because such an LF image may be intact. All functions may be called by many threads at the same
// time.
class MachineFailure {
 public:
  // Ignores errors of kinds other than kOutput, because these are faults of the LF image.
  void Note(const Error& error);
  // Returns the first error that was noted, which is kOutput; success if there is none.
  Result<void> Check() const;

 private:
  mutable std::mutex mutex_;
  std::optional<Error> first_;
};

}  // namespace lf
