// SPDX-License-Identifier: Apache-2.0
// Computes gains of LF images from the exposures that their files state.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/pixels/files/exposure_facts.h"

namespace lf {

struct StatedExposure {
  LfImageId id;
  ExposureFacts facts;
  std::string fault;  // reason why the file cannot be read; "": the file was read
};

// Reads the headers of the files of `ids` in parallel. Returns one entry for each, in their order.
std::vector<StatedExposure> ReadStatedExposures(const LightField& light_field,
                                                std::span<const LfImageId> ids, ThreadPool& pool);

// Returns the light that the camera recorded from a scene, in arbitrary units: time * iso /
// f_number^2. NaN if time or sensitivity is not stated. A missing f-number counts as 1.
double LightOf(const ExposureFacts& facts);

// Facts about the gains that GainFromExif() set.
struct ExifGains {
  size_t image_count = 0;
  float least_gain = 1, most_gain = 1;
  bool has_f_numbers = true;  // false: no file states an f-number, and all are assumed equal
  LfImageId reference;        // LF image of the median exposure; its gain is 1
};

// Sets the gain of each LF image to the value that makes it as bright as the LF image with the
// median exposure (for an even number of images, the darker of the two in the middle), and raises
// max_radiance as MakeRoomForGains() does. Previous gains are replaced.
//   stated  exposures of all LF images, in their order
// kInput: a file that cannot be read or does not state its whole exposure (the message names what
// is missing); f-numbers in only some of the files; gains outside 1e-6 to 1e6.
Result<ExifGains> GainFromExif(std::span<const StatedExposure> stated, LightField* light_field);

}  // namespace lf
