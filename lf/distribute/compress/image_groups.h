// SPDX-License-Identifier: Apache-2.0
// Groups of the LF images that are compressed. Internal to this folder.
#pragma once

#include <span>
#include <vector>

#include "lf/core/ids.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/pixels/prediction/plane_warp.h"
#include "lf/selection/reference_groups.h"

namespace lf {

// Returns groups of the LF images that are not left out. LF images share a group only if they have
// the same size and about the same exposure: a dark image does not predict a bright one.
// GroupMember::id is the id in the light field.
ReferenceGroups GroupsOf(const CompressSource& source);

// Returns some groups that are spread over all, ascending: enough for `image_count` LF images.
std::vector<size_t> SampleOf(const ReferenceGroups& groups, size_t image_count);

// Returns the LF camera of the pixels of an LF image that are encoded, as its prediction sees it:
// lens distortion is left out, because neighbouring LF images have nearly equal ones; squares of a
// mosaic are pixels.
PinholeView ViewToPredict(const CompressSource& source, LfImageId id);

}  // namespace lf
