// SPDX-License-Identifier: Apache-2.0
// Writes a scene's photographs to disk with their exact calibration: a light field that every
// program reads (doc/formats/transforms_json.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/synthetic/scene.h"

namespace lf {

enum class LfImageFormat : uint8_t {
  kExr,    // radiance as half floats
  kPng,    // 8-bit sRGB; light brighter than 1 is clipped
  kPng16,  // 16-bit linear radiance, up to max_radiance
  kBayer,  // 16-bit RGGB mosaic as of a raw converter: black level 1024, not white balanced
};

// Returns how images of this format store radiance up to max_radiance. kPng stores only up to 1.
RadianceEncoding EncodingOf(LfImageFormat format, double max_radiance);

// Returns the calibration of photographs images/0000.exr ... (or .png) taken from `poses`. Writes
// nothing.
LightField DescribeLightField(const std::vector<RigidTransform>& poses,
                              const Intrinsics& intrinsics, LfImageFormat format,
                              double max_radiance, const std::filesystem::path& folder);

// Returns one value per pixel, as a sensor with the colour filters of encoding.bayer records the
// picture [height][width][3]: with black level and before white balance. The standard deviation of
// the noise is noise * sqrt(radiance + 0.01), in units of radiance (photon noise and some
// electronic noise). Its random numbers depend only on `seed` and position.
Image<uint16_t> Mosaic(ImageView<const float> picture, const RadianceEncoding& encoding,
                       double noise, uint64_t seed);

struct WriteLightFieldOptions {
  LfImageFormat format = LfImageFormat::kExr;
  int samples = 4;    // rays per pixel at edges of the picture (Photograph())
  double noise = 0;   // strength of the noise, as for Mosaic(); used for kBayer only
  uint64_t seed = 0;  // determines the noise
  // Called after every image, by any thread, but by only one thread at a time. Returns false to
  // stop the work. May be empty.
  std::function<bool(size_t images_done)> keep_going;
};

// Photographs the scene with every camera of `light_field` and writes the images, then
// light_field.folder/transforms.json; a folder that contains this file is therefore complete. If
// encoding.AlphaIsLight() is true, surroundings are transparent (photograph.h) and images have
// alpha; this is not allowed for mosaics. Existing images are replaced, each atomically; an
// existing transforms.json is removed first. The bytes do not depend on the number of threads.
// kOutput: a folder or file cannot be written. kInterrupted: keep_going stopped the work.
Result<void> WriteLightField(const Scene& scene, const LightField& light_field,
                             const WriteLightFieldOptions& options, ThreadPool& pool);

}  // namespace lf
