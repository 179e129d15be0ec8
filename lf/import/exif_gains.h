// Gains of LF images from the exposures that their files state.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/imageio/exposure_facts.h"

namespace lf {

struct StatedExposure {
  LfImageId id;
  ExposureFacts facts;
  std::string fault;  // why the file cannot be read; "": it can
};

// Reads the headers of the files of `ids`, in parallel.
std::vector<StatedExposure> ReadStatedExposures(const LightField& light_field,
                                                std::span<const LfImageId> ids, ThreadPool& pool);

// Returns the light that the camera let in, in units of their own: time * iso / f_number^2. NaN
// where time or sensitivity is not stated. A missing f-number is taken for 1.
double LightOf(const ExposureFacts& facts);

// What GainFromExif() found.
struct ExifGains {
  size_t image_count = 0;
  float least_gain = 1, most_gain = 1;
  bool has_f_numbers = true;  // false: no file states one, and all are taken for equal
  LfImageId reference;        // an LF image whose gain is 1
};

// Writes into each LF image the gain that makes it as bright as the one with the median exposure
// (of an even number, the darker of the two in the middle), in place of the gain it had, and
// raises max_radiance as MakeRoomForGains() does.
//   stated  of all LF images, in their order
// kInput: a file that cannot be read or does not state its exposure, which is named with what is
// missing; f-numbers of some files but not of all; gains beyond 1e-6 to 1e6.
Result<ExifGains> GainFromExif(std::span<const StatedExposure> stated, LightField* light_field);

}  // namespace lf
