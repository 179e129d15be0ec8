#include "lf/pipeline/memory_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/plate/sensor_plate.h"

namespace lf {
namespace {

constexpr size_t kMiB = size_t{1} << 20;
constexpr size_t kProgramBytes = 160 * kMiB;  // code, libraries, spans of a batch
constexpr size_t kDevelopBytesPerElement =
    160;  // picture, counts, tables for filling, file buffers, sheet
constexpr size_t kMostBatchImages = 64;

size_t LargestImageBytes(const LightField& light_field) {
  // 16-bit radiance, the stored pixels while they are decoded (float at worst), a mask.
  const size_t channels = light_field.encoding.bayer == BayerPattern::kNone ? 4 : 1;
  const size_t bytes_per_pixel = channels * (2 + 4) + 1;
  // Of its ideal positions, while it is collected (camera/ideal_pixels.h).
  constexpr size_t kPatchBytesPerPixel = 1;
  size_t largest = 1;
  for (const Intrinsics& k : light_field.intrinsics)
    largest =
        std::max(largest, static_cast<size_t>(k.width_px) * k.height_px *
                              (bytes_per_pixel + (k.has_distortion() ? kPatchBytesPerPixel : 0)));
  return largest;
}

}  // namespace

Result<MemoryPlan> PlanMemory(size_t memory_bytes, const LightField& light_field, int plate_width,
                              int plate_height, size_t frame_count) {
  const size_t element_count = static_cast<size_t>(plate_width) * plate_height;
  MemoryPlan plan;
  plan.plate_bytes = element_count * SensorPlate::kChannels * sizeof(uint64_t);
  plan.image_bytes = LargestImageBytes(light_field);

  const size_t set_aside = kProgramBytes + light_field.size() * (sizeof(LfCamera) + 128) +
                           element_count * kDevelopBytesPerElement;
  const size_t least = set_aside + plan.plate_bytes + 2 * plan.image_bytes;
  if (memory_bytes < least)
    return OutputError(fmt::format(
        "--memory {} MiB is not enough for one {}x{} plate and two LF images: at least {} MiB",
        memory_bytes / kMiB, plate_width, plate_height, least / kMiB + 1));

  const size_t free_bytes = memory_bytes - set_aside;
  const size_t image_slots =
      std::clamp<size_t>(memory_bytes / 4 / plan.image_bytes, 2, 2 * kMostBatchImages);
  plan.batch_image_count = image_slots / 2;
  const size_t plates_bytes =
      std::max(plan.plate_bytes, free_bytes - std::min(free_bytes, image_slots * plan.image_bytes));
  plan.frames_per_pass =
      std::clamp<size_t>(plates_bytes / plan.plate_bytes, 1, std::max<size_t>(1, frame_count));
  return plan;
}

}  // namespace lf
