// The end of a render, when everything is written: LF images that were left out and frames below
// the required quality decide about its exit code.
#pragma once

#include "tools/common/allow_missing.h"

#include "lf/core/result.h"
#include "lf/record/report.h"

namespace lf {

// The LF images that the render left out. A percentage counts those of the pass that reads most.
//   advice  what to do about them
MissingImages MissingOf(const RenderReport& report, const std::string& advice);

// True if the limit accepts what the render left out. A number is of all packages together, each LF
// image counted once; a percentage is of each package by itself.
bool Accepts(const MissingLimit& limit, const RenderReport& report);

// Warns of LF images that were left out, if the limit accepts them. kBelowRequired if it does not,
// or if `required` is an error: the message then tells both.
//   required  CheckRequired()
Result<void> EndOfRender(const RenderReport& report, const MissingLimit& limit,
                         const Result<void>& required);

}  // namespace lf
