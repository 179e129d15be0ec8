// Chooses the instruction set that the kernels of this folder run on: the best one that the
// processor has, unless a test or a benchmark chooses another. Results are bit-identical on all of
// them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lf {

// Returns the instruction sets that this program was compiled for and that this processor has, best
// first: "AVX3", "AVX2", ..., "SCALAR" (with clang "EMU128", which also needs no vectors).
std::vector<std::string> SimdTargets();

// Makes the kernels use the instruction set `name` from now on; "" means the best one. Must not be
// called while kernels run. Returns false if `name` is not one of SimdTargets(); the kernels then
// use the best one.
bool UseSimdTarget(std::string_view name);

}  // namespace lf
