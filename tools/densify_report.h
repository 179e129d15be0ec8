// The report of lfdensify.
#pragma once

#include <string>

#include "lf/densify/densify.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the report: depths, virtual LF images, how right they are, speed, and the next command.
//   total_s  elapsed time of the call
std::string DensifyText(const DensifyReport& report, const LightField& light_field,
                        const DensifyOptions& options, double total_s);
std::string DensifyJson(const DensifyReport& report, const LightField& light_field,
                        const DensifyOptions& options, double total_s);

}  // namespace lf
