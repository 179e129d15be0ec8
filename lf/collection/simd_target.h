// SPDX-License-Identifier: Apache-2.0
// Chooses the instruction set for all code of the program that is compiled with Highway, in every
// folder: the best one that the processor has, unless a test or a benchmark chooses another.
// Results are bit-identical on all instruction sets.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lf {

// Returns the instruction sets that this program was compiled for and that this processor has, best
// first: "AVX3", "AVX2", ... The last one needs no vector instructions: "SCALAR", or "EMU128" with
// clang.
std::vector<std::string> SimdTargets();

// Selects the instruction set `name` from now on; "" means the best one. Must not be called while
// code compiled with Highway runs. Returns false if `name` is not one of SimdTargets(); the best
// one is then selected.
bool UseSimdTarget(std::string_view name);

}  // namespace lf
