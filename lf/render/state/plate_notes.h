// SPDX-License-Identifier: Apache-2.0
// The notes in a finished plate: entries in its file that suffice to develop the plate without the
// light field and the path (doc/formats/plate.md, keys "plate.").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/film/plate/plate_file.h"
#include "lf/render/collect/collect.h"
#include "lf/render/settings/shard.h"
#include "lf/render/state/run_inputs.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {

struct PlateNotes {
  FrameId frame;
  RenderCamera camera;
  double fps = 0;
  uint32_t first_frame = 1;                            // number of the first frame of the film
  std::optional<FrameShutter> shutter = std::nullopt;  // unset if the path has none
  // FocalSurface::Digest() of the frame's focal surface, in notes that were read from a plate,
  // which names the surface but does not hold it (camera.surface is null). Empty: there is none.
  std::string focal_surface = {};
  std::string FocalSurface() const {
    return camera.surface ? camera.surface->Digest() : focal_surface;
  }
  Estimator estimator = Estimator::kBilinear;
  std::string version;  // version of the program
  FrameRays rays;       // rays in the plate
  // If set, the frame was finished early: its plate has only the LF images before this rank of the
  // order.
  std::optional<uint32_t> ranks_done = std::nullopt;
  // Number and names of the LF images that the frame should have, but that are missing or broken.
  // TextOf() writes only the first names, up to 256 KiB.
  uint64_t skipped_count = 0;
  std::vector<std::string> skipped = {};
  // How to develop the plate. DevelopFrame() sets the members that are not stored: `transparent`,
  // `opaque`, `completion` and `is_interrupted`.
  DevelopOptions develop;

  // Facts about lens weights (render/collect/frame_lens.h); unset if there are no lens weights.
  struct Weighed {
    double hat_share = 0;
    LensCoverage coverage;
    Image<float> effective_counts;
  };
  std::optional<Weighed> weighed;
};

// Returns the notes as the entries that are stored in the file of the plate.
PlateEntries TextOf(const PlateNotes& notes);

// Reads the entries that TextOf() returned. Numbers have the same bits as in the original notes.
//   width_px, height_px  size of the plate
// kInput: a key is missing, its value is invalid, or the plate has another kRayModelVersion. The
// message begins with `name`.
Result<PlateNotes> PlateNotesOf(const PlateEntries& entries, int width_px, int height_px,
                                const std::string& name);

// Returns the shard whose rays a finished plate has: 1/1 unless the entries state another one.
// kInput: the shard is invalid. The message begins with `name`.
Result<Shard> ShardIn(const PlateEntries& entries, const std::string& name);

// Returns those entries of a finished plate that the plates of all shards of its frame have in
// common. Plates may be added only if these entries are equal (FirstDifference()).
PlateEntries SharedEntries(const PlateEntries& entries);

}  // namespace lf
