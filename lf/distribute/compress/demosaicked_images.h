// SPDX-License-Identifier: Apache-2.0
// RGB LF images that are made of the mosaics of a light field, in the form in which packed stores
// keep them. A store of these renders as any RGB light field, with the colours of the mosaics.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/demosaic/joint_demosaicker.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

// Returns the encoding of RGB LF images that hold the radiance of the mosaics: linear, 16 bits,
// with room for values below black. Gains and falloff of the LF cameras remain, as do white balance
// and colour matrix.
RadianceEncoding RgbEncodingOf(const LightField& mosaics);

class DemosaickedImages {
 public:
  //   mosaics              CheckForJoint() must have succeeded
  //   measures_footprint   true: Prepare() measures the footprint of the RGB LF images, because the
  //                        mosaics hardly tell it
  DemosaickedImages(LightField mosaics, bool measures_footprint);

  // Returns words that a packed store records, so that it is resumed only with equal pixels.
  static std::string Words();

  // Must have succeeded before Read() is called. Errors of JointDemosaicker::Make() and
  // MeasureFootprint().
  //   tell  called with the number of LF images that were examined; may be empty
  Result<void> Prepare(ThreadPool& pool, const std::atomic<bool>* interrupted,
                       const std::function<void(size_t done, size_t total)>& tell);

  // Returns the footprint of the RGB LF images. Prepare() must have succeeded.
  std::optional<PixelFootprint> footprint() const { return encoding_.footprint; }

  // Returns the pixels `rect`, clipped to the image, as stored values of RgbEncodingOf(). Each call
  // demosaics the LF image again. May be called by many threads at the same time. Errors of
  // JointDemosaicker::Demosaic().
  Result<RecordedImage> Read(LfImageId id, const PixelRect& rect);

  // Returns the errors of all LF images that were read, each counted once.
  GuardErrors Errors() const;

 private:
  const LightField mosaics_;
  const bool measures_footprint_;
  RadianceEncoding encoding_;  // RgbEncodingOf()
  std::unique_ptr<JointDemosaicker> joint_;

  mutable std::mutex mutex_;                        // guards errors_
  std::vector<std::optional<GuardErrors>> errors_;  // [id]
};

// Returns all LF images of a light field of mosaics as RGB. It may be a packed store, whose encoded
// images are then decoded. The footprint in its encoding has no meaning until
// DemosaickedImages::Prepare() has succeeded. Errors of CheckForJoint() and SourceOfAll().
Result<CompressSource> DemosaickedJointly(LightField mosaics);

}  // namespace lf
