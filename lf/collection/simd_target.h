// Which instruction set the kernels of this folder run on: the best that the processor has, unless
// a test or a benchmark wants another. The bits are the same on all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lf {

// Those that this program has and this processor can run, best first: "AVX3", "AVX2", ...,
// "SCALAR".
std::vector<std::string> SimdTargets();

// Of these, the kernels use `name` from now on; "" for the best. Not while kernels run.
// False if there is no such target here.
bool UseSimdTarget(std::string_view name);

}  // namespace lf
