// Notes in a finished plate: entries in its file from which a picture can be made anywhere,
// without the light field and the path (doc/formats/plate.md, keys "sheet.").
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
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {

struct PlateNotes {
  FrameId frame;
  RenderCamera camera;
  double fps = 0;
  Estimator estimator = Estimator::kBilinear;
  std::string version;  // of the program
  FrameRays rays;       // in the plate
  // If set, the frame was finished early, with the LF images before this place of the order.
  std::optional<uint32_t> places_done = std::nullopt;
  // Number and names of the LF images that the frame takes, and that are missing or broken. A file
  // has only as many names as fit in 256 KiB.
  uint64_t skipped_count = 0;
  std::vector<std::string> skipped = {};
  DevelopOptions develop;  // without completion and is_interrupted

  // Facts about lens weights (render/collect/frame_lens.h); none without them.
  struct Weighed {
    double hat_share = 0;
    LensCoverage coverage;
    Image<float> effective_counts;
  };
  std::optional<Weighed> weighed;
};

// Returns the entries of the notes.
PlateEntries TextOf(const PlateNotes& notes);

// Returns the notes of the entries. Numbers have the same bits as before TextOf().
//   width_px, height_px  of the plate
// kInput: a key is missing, or its value is invalid. The message begins with `name`.
Result<PlateNotes> PlateNotesOf(const PlateEntries& entries, int width_px, int height_px,
                                const std::string& name);

}  // namespace lf
