// A scene's photographs on disk, with their exact calibration: a light field that every program
// reads (doc/formats/transforms_json.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/synthetic/scene.h"

namespace lf {

enum class LfImageFormat : uint8_t {
  kExr,    // half floats: radiance itself
  kPng,    // 8-bit sRGB; light brighter than 1 is clipped
  kPng16,  // 16 bits, linear, up to max_radiance
  kBayer,  // 16-bit RGGB mosaic as from a raw converter: black level 1024, colours unbalanced
};

// How images of this format store radiance up to max_radiance.
RadianceEncoding EncodingOf(LfImageFormat format, double max_radiance);

// The calibration of photographs images/0000.exr ... taken from `poses`; nothing is written.
LightField DescribeLightField(const std::vector<RigidTransform>& poses,
                              const Intrinsics& intrinsics, LfImageFormat format,
                              double max_radiance, const std::filesystem::path& folder);

// One value per pixel, as a sensor under the filters of encoding.bayer records the picture
// [height][width][3]: black level, white balance not yet applied, and noise of standard deviation
// noise * sqrt(radiance + 0.01) radiance (photons and a little of the electronics), random by
// `seed` and position alone.
Image<uint16_t> Mosaic(ImageView<const float> picture, const RadianceEncoding& encoding,
                       double noise, uint64_t seed);

struct WriteLightFieldOptions {
  LfImageFormat format = LfImageFormat::kExr;
  int samples = 4;    // Photograph()
  double noise = 0;   // Mosaic(); kBayer only
  uint64_t seed = 0;  // of the noise
  // Called after every image, by any thread, one at a time; false stops the work.
  std::function<bool(size_t images_done)> keep_going;
};

// Photographs the scene with every camera of `light_field` and writes the images: with transparent
// surroundings (photograph.h) and alpha if its encoding.AlphaIsLight(), which no mosaic has; then
// light_field.folder/transforms.json: a folder with one is complete. Images in the way are
// replaced, each at once; an older transforms.json is removed first. The same bytes for any thread
// count.
// kOutput: folder, disk, no permission. kInterrupted: stopped by keep_going.
Result<void> WriteLightField(const Scene& scene, const LightField& light_field,
                             const WriteLightFieldOptions& options, ThreadPool& pool);

}  // namespace lf
