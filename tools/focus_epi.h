// SPDX-License-Identifier: Apache-2.0
// lffocus epi LIGHTFIELD --row Y | --column X: the epipolar picture of a row or a column of LF
// cameras.
#pragma once

namespace lf {

// Runs the command and returns the exit code.
//   argc, argv  the whole command line; argv[1] is "epi"
int RunFocusEpi(int argc, char** argv);

}  // namespace lf
