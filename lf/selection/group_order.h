// SPDX-License-Identifier: Apache-2.0
// The order of LF images in which those of a group of neighbours (reference_groups.h) follow each
// other. Predicted LF images are decoded from reference images of their group, so that a film that
// takes all LF images in this order decodes each about once and keeps few decoded images in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the LF images of a light field, as LfImageId::value, group after group and within each in
// the order of decoding. The groups are in a spread order (OrderOfPoints()) of the means of their
// positions. The result depends on poses, image sizes, exposures, recording times and the seed
// alone.
//
// Recorded and virtual LF images have groups of their own, and the groups of both are merged, so
// that the order of recorded LF images is the same with and without virtual ones. LF images of
// different sizes, exposures (ExposureNumbers()) or recording times share no group.
//
// Takes 3 to 4 seconds for a million LF images.
std::vector<uint32_t> OrderByGroups(const LightField& light_field, uint64_t seed);

}  // namespace lf
