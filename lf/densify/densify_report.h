// SPDX-License-Identifier: Apache-2.0
// The report of lfdensify.
#pragma once

#include <string>

#include "lf/densify/densify.h"

namespace lf {

// Returns the report: depths, virtual LF images, how right they are, speed, and the next command.
//   total_s  elapsed time of the call
//   next     line that advises the next command; "": none
std::string DensifyText(const DensifyReport& report, const DensifyOptions& options, double total_s,
                        const std::string& next);
std::string DensifyJson(const DensifyReport& report, const DensifyOptions& options, double total_s);

// Returns text such as "a.lfs: 3 of 25 LF images were not used, because they are missing or broken;
// the first: ..."; "" if all were used.
std::string MissingText(const DensifyReport& report, const DensifyOptions& options);

}  // namespace lf
