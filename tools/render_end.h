// SPDX-License-Identifier: Apache-2.0
// The end of a render, when everything is written: the exit code depends on LF images that were
// left out and on frames below the required quality.
#pragma once

#include "tools/common/allow_missing.h"

#include "lf/core/result.h"
#include "lf/render/state/report.h"

namespace lf {

// Returns the LF images that the render left out. `asked` is the number of LF images that the
// largest pass reads.
//   advice  remedy that the message gives to the user
MissingImages MissingOf(const RenderReport& report, const std::string& advice);

// Returns true if the limit accepts the LF images that the render left out. A limit that is a
// number holds for all packages together, in which each LF image counts once; a percentage holds
// for each package.
bool Accepts(const MissingLimit& limit, const RenderReport& report);

// Warns about LF images that were left out, if the limit accepts them. kBelowRequired if the limit
// does not accept them. Otherwise returns `required`. If both are faults, the message contains
// both.
//   required  the result of CheckRequired() or CheckRequiredNoise()
Result<void> EndOfRender(const RenderReport& report, const MissingLimit& limit,
                         const Result<void>& required);

}  // namespace lf
