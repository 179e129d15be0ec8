// Chooses the instruction set that the kernels of this folder run on: the best that the processor
// has, unless a test or a benchmark wants another. The bits are the same on all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lf {

// Returns the instruction sets that this program has and this processor can run, best first:
// "AVX3", "AVX2", ..., "SCALAR".
std::vector<std::string> SimdTargets();

// Makes the kernels use the instruction set `name` from now on; "" for the best. Must not be called
// while kernels run. False if there is no such target here.
bool UseSimdTarget(std::string_view name);

}  // namespace lf
