// SPDX-License-Identifier: Apache-2.0
// Judges whether the images of a light field and the poses of its LF cameras belong together, and
// finds what would make them agree if they do not.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/import/agreement/pose_repair.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

enum class Verdict : uint8_t { kAgree, kNotSure, kDisagree };

// How well poses and intrinsics explain where LF images show the same places. The error of a place
// is the distance, in pixels of an LF image, between where an LF image shows the place and where it
// should, for the depth in front of the cameras that explains three quarters of the LF images best.
struct Fit {
  double error_px = 0;  // median over the places
  double share = 0;     // of the places whose error is within their tolerance (place_errors.h)
};

struct Agreement {
  Verdict verdict = Verdict::kNotSure;
  Fit fit;
  size_t place_count = 0;
  size_t pair_count = 0;   // number of pairs of LF images that show places in common
  size_t image_count = 0;  // number of LF images that were read
  std::string reason;      // if the verdict is kNotSure: why
  // If the verdict is kAgree: false if wrong focal lengths or principal points would agree, too.
  // The scene of parallel cameras, for example, then only becomes longer or shorter.
  bool tells_intrinsics = false;
  // If the verdict is kAgree: false if another order of the names would agree, too. Rings of
  // cameras at equal steps, for example, turn as a whole if names are shifted by one.
  bool tells_order = false;
  // Set if the verdict is kDisagree: the repair with which images and poses agree. Without one, the
  // verdict is kNotSure, because repeated patterns are also matched wrongly.
  std::optional<Repair> repair;
  Fit repaired;        // fit of the repair
  std::string clause;  // the mistake that the repair supposes: "the matrices were inverted"
};

// Returns the agreement of images and poses. It compares corners of at most 150 reduced LF images,
// however many there are (find_places.h). The verdict is kNotSure if there is too little texture or
// parallax to tell, or if the answer is neither clearly yes nor clearly no.
// kOutput: the machine lacks memory or open files. kInterrupted: `interrupted` is true.
//   store        a store with Mosaics::kToRgb
//   interrupted  true ends the comparison early; null: never
Result<Agreement> JudgeAgreement(const LightField& light_field, const LfImageStore& store,
                                 ThreadPool& pool, const std::atomic<bool>* interrupted = nullptr);

// Returns the word of a verdict for programs: agree, not-sure, disagree.
const char* NameOf(Verdict verdict);

// Returns the agreement as a sentence: "images agree with the poses: 0.41 px at 153 places of 40
// pairs (97 %)".
std::string TextOf(const Agreement& agreement);

}  // namespace lf
