// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/memory_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "lf/core/byte_text.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/image_files.h"
#include "lf/render/collect/collected_frame.h"
#include "lf/render/collect/defocus.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {
namespace {

constexpr size_t kMiB = size_t{1} << 20;

// The program's code, its libraries and small allocations. Measured: 16 MiB.
constexpr size_t kProgramBytes = 24 * kMiB;

// Memory to develop a frame, for each element: picture, counts, tables for filling, file buffers.
// Measured: 58 bytes.
constexpr size_t kDevelopBytesPerElement = 64;
// Additional memory to develop a frame with opacity, for each element: opacity, its counts and
// tables.
constexpr size_t kOpacityBytes = 16;
// Additional memory to develop a guarded frame, for each element: the channels `densified` and
// `trust`.
constexpr size_t kGuardBytes = 8;
constexpr size_t kSheetBytesPerElement = 3;  // 8-bit RGB picture of the contact sheet
constexpr size_t kMostSheetPictures = 12;

// Memory while one LF image is decoded, for each pixel: the file, its stored values, and the
// decoder's own memory. The second number is for float files.
constexpr size_t kDecodeBytesPerPixel = 16;
constexpr size_t kDecodeFloatBytesPerPixel = 32;
// Additional memory to decode a predicted LF image, for each pixel: reference images that are
// decoded before it and are not kept, and the squares of mosaics.
constexpr size_t kDecodePredictedBytesPerPixel = 18;
constexpr size_t kReferenceTableBytes = 64;  // of a store with predicted LF images, for each of all
// Upper bound of the lens weights of one lens, which FrameWeights keeps for each LF camera around
// it: nodes (selection/lens_weights/frame_weights.h) and their bytes.
constexpr size_t kMostWeightNodes = 48 * 48;
constexpr size_t kReferenceShare = 3;  // reference images get at most this part of free memory
constexpr size_t kTileBytes = kMiB;    // sums of the tile that one thread works on

// Limits of the number of LF images in a batch (PlanMemory()). In a batch that reaches them, adding
// the tiles to the plates and waiting for the last task take little time compared with collecting
// the rays. Larger batches would cost time, because the first use of memory can take as long as
// decoding an LF image into it. Where few frames share a batch, decoding its LF images takes most
// of the time, so that kBatchBytesPerFrame, or one LF image for each thread, suffices.
constexpr size_t kRaysPerElement = 8;
constexpr size_t kEnoughBatchImages = 16;
constexpr size_t kBatchBytesPerFrame = 256 * kMiB;
constexpr size_t kMostBatchImages = 64;
constexpr size_t kMostPlanBytes = 64 * kMiB;

// Memory that the largest LF image needs.
struct ImageNeed {
  size_t pixels = 1;
  size_t kept_bytes = 1;    // its radiance, mask, opacity or trust, and ideal pixels
  size_t decode_bytes = 1;  // memory to decode it, in one thread
  // The plan of its rays in one frame, with their defocus if the plate is guarded.
  size_t plan_bytes = 1;
};

ImageNeed NeedOf(const LightField& light_field, Estimator estimator, int plate_width,
                 int plate_height, bool is_guarded, size_t instants, const FocalSurface* surface) {
  // kBilinear needs RGB, so mosaics are demosaicked.
  const bool is_rgb =
      light_field.encoding.bayer == BayerPattern::kNone || estimator == Estimator::kBilinear;
  const size_t decode_bytes_per_pixel = DefaultMaxRadiance(light_field.image_names) > 1
                                            ? kDecodeFloatBytesPerPixel
                                            : kDecodeBytesPerPixel;
  constexpr size_t kNearbyDepthsBytes = 2 * sizeof(uint16_t);
  constexpr size_t kTrustBytes = sizeof(uint8_t);
  constexpr size_t kPatchBytesPerPixel = 1;  // table of ideal pixels (camera/ideal_pixels.h)
  ImageNeed need;
  for (const Intrinsics& k : light_field.intrinsics) {
    const size_t pixels = static_cast<size_t>(k.width_px) * k.height_px;
    const size_t bytes_per_pixel =
        (is_rgb ? LfPixels::kRgbLanes * sizeof(uint16_t) : sizeof(uint16_t) + 1) +
        (light_field.encoding.HasOpacity() || is_guarded ? LfPixels::kRgbLanes * sizeof(uint16_t)
                                                         : 0) +
        (k.has_distortion() ? kPatchBytesPerPixel : 0) +
        (is_guarded ? kNearbyDepthsBytes + kTrustBytes : 0);
    need.pixels = std::max(need.pixels, pixels);
    need.kept_bytes = std::max(need.kept_bytes, pixels * bytes_per_pixel);
    need.decode_bytes = std::max(need.decode_bytes, pixels * decode_bytes_per_pixel);
    const size_t plan_bytes = instants * PlanBytes(estimator, k.has_distortion(), k.width_px,
                                                   k.height_px, plate_width, plate_height, surface);
    need.plan_bytes = std::max(
        need.plan_bytes,
        is_guarded ? 2 * plan_bytes + DefocusBytes({0, 0, k.width_px, k.height_px}) : plan_bytes);
  }
  return need;
}

// Number of LF images of a group (selection/reference_groups.h), about six of which are reference
// images.
constexpr uint64_t kGroupImages = 16;
// Number of groups whose reference images are in use at once for each thread in the order kGroups,
// because two groups follow each other.
constexpr uint64_t kGroupsInUse = 2;

// Memory for reference images.
struct ReferenceRoom {
  size_t least = 0;   // bytes of the references of one group for each thread
  size_t enough = 0;  // more would gain nothing
};

ReferenceRoom RoomFor(const ReferenceNeed& references, const LightField& light_field,
                      int thread_count) {
  const uint64_t all = references.all_bytes;
  const uint64_t mean = all / std::max<size_t>(1, light_field.size());
  const auto of_groups = [&](uint64_t count) {
    return static_cast<size_t>(std::min(all, count * mean * kGroupImages));
  };
  const auto threads = static_cast<uint64_t>(thread_count);
  return {of_groups(threads),
          references.in_groups ? of_groups(kGroupsInUse * threads) : static_cast<size_t>(all)};
}

// Returns the most bytes of the stored values of all LF images: those of predicted LF images have
// at most 16 bits, because floats are stored as half floats.
uint64_t MostStoredBytes(const LightField& light_field) {
  const std::vector<Intrinsics>& intrinsics =
      light_field.reduction ? light_field.reduction->recorded_intrinsics : light_field.intrinsics;
  const BayerPattern bayer =
      light_field.reduction ? light_field.reduction->recorded_bayer : light_field.encoding.bayer;
  const uint64_t channels = bayer == BayerPattern::kNone ? 3 : 1;
  uint64_t bytes = 0;
  for (const LfCamera& camera : light_field.cameras) {
    const Intrinsics& k = intrinsics[camera.intrinsics_index];
    bytes += channels * sizeof(uint16_t) * static_cast<uint64_t>(k.width_px) *
             static_cast<uint64_t>(k.height_px);
  }
  return bytes;
}

}  // namespace

ReferenceNeed ReferenceNeedOf(const LfImageStore& store, const LightField& light_field,
                              bool in_groups) {
  const uint64_t all = store.ReferenceBytes();
  return {all == 0 ? 0 : std::min(all, MostStoredBytes(light_field)), in_groups};
}

Result<MemoryPlan> PlanMemory(size_t memory_bytes, const LightField& light_field,
                              const RayReading& reading, int plate_width, int plate_height,
                              size_t frame_count, int thread_count, size_t bytes_per_frame,
                              bool is_guarded, size_t instants, const FocalSurface* surface,
                              const ReferenceNeed& references) {
  const size_t element_count = static_cast<size_t>(plate_width) * plate_height;
  const ImageNeed need = NeedOf(light_field, reading.estimator, plate_width, plate_height,
                                is_guarded, instants, surface);
  MemoryPlan plan;
  const bool has_opacity = light_field.encoding.HasOpacity();
  const auto channels = static_cast<size_t>(PlateKindOf(light_field.encoding, is_guarded));
  const size_t develop_bytes =
      kDevelopBytesPerElement + (has_opacity ? kOpacityBytes : 0) + (is_guarded ? kGuardBytes : 0);
  plan.plate_bytes = element_count * channels * sizeof(uint64_t);
  plan.image_bytes = need.kept_bytes;

  const size_t sheet_pictures = std::min(frame_count, kMostSheetPictures);
  const size_t set_aside =
      kProgramBytes + SharedPictureBytes(light_field) +
      light_field.size() * (sizeof(LfCamera) + 128) +
      (references.all_bytes > 0 ? light_field.size() * kReferenceTableBytes : 0) +
      element_count * (develop_bytes + sheet_pictures * kSheetBytesPerElement) +
      static_cast<size_t>(thread_count) *
          (need.decode_bytes + kTileBytes +
           (references.all_bytes > 0 ? need.pixels * kDecodePredictedBytesPerPixel : 0));
  // Memory for one LF image in each of the two batches, for its filtered copy in one of them, and
  // for one plan.
  const size_t copies = reading.Prefilters() ? (instants > 1 ? 4 : 3) : 2;
  const size_t pair_bytes = copies * need.kept_bytes + need.plan_bytes;
  const size_t weights_bytes =
      std::min(light_field.size() * kMostWeightNodes, FrameWeights::kMostShares) * sizeof(uint16_t);
  const size_t frame_bytes = plan.plate_bytes + bytes_per_frame + (instants - 1) * weights_bytes;
  const ReferenceRoom room = RoomFor(references, light_field, thread_count);
  const size_t least = set_aside + room.least + frame_bytes + pair_bytes;
  plan.pair_bytes = pair_bytes;
  plan.develop_bytes = element_count * develop_bytes;
  plan.least_bytes = least;
  if (memory_bytes < least)
    return OutputError(fmt::format(
        "{{memory {}}} is too small: the sums of a frame of {} x {} elements{} two LF images{} "
        "need at least {} MiB",
        ByteText(memory_bytes), plate_width, plate_height, room.least > 0 ? "," : " and",
        room.least > 0 ? " and the reference images from which they are predicted" : "",
        least / kMiB + 1));

  if (room.enough > 0) {
    const size_t others = frame_bytes + static_cast<size_t>(thread_count) * pair_bytes;
    const size_t all_free = memory_bytes - set_aside;
    plan.reference_bytes =
        std::clamp(std::min(all_free / kReferenceShare, all_free - std::min(all_free, others)),
                   room.least, room.enough);
    plan.enough_bytes = set_aside + std::max(kReferenceShare * room.enough, room.enough + others);
  }
  const size_t free_bytes = memory_bytes - set_aside - plan.reference_bytes;
  const size_t enough =
      std::max({std::min(kEnoughBatchImages, frame_count * kBatchBytesPerFrame / need.kept_bytes),
                static_cast<size_t>(thread_count),
                std::min(kMostBatchImages, kRaysPerElement * element_count / need.pixels)});
  plan.batch_image_count = std::clamp<size_t>(
      std::min(free_bytes / 4, free_bytes - frame_bytes) / pair_bytes, 1, enough);
  // Memory for more plans than one frame needs lets several frames be planned together: threads
  // then wait less often for the last task of a frame.
  const size_t batches_bytes = plan.batch_image_count * copies * need.kept_bytes;
  const size_t spare_bytes = free_bytes - std::min(free_bytes, frame_bytes + batches_bytes);
  plan.plan_bytes = std::max(plan.batch_image_count * need.plan_bytes,
                             std::min({kMostPlanBytes, free_bytes / 16, spare_bytes}));
  const size_t images_bytes = batches_bytes + plan.plan_bytes;
  plan.frames_finished_at_once =
      std::min<size_t>(static_cast<size_t>(thread_count),
                       1 + (images_bytes - plan.plan_bytes) / (element_count * develop_bytes));
  const size_t plates_bytes = free_bytes - std::min(free_bytes, images_bytes);
  plan.frames_per_pass =
      std::clamp<size_t>(plates_bytes / frame_bytes, 1, std::max<size_t>(1, frame_count));
  plan.batches_bytes = images_bytes;
  plan.total_bytes =
      set_aside + plan.reference_bytes + images_bytes + plan.frames_per_pass * frame_bytes;
  return plan;
}

}  // namespace lf
