// SPDX-License-Identifier: Apache-2.0
// lffocus through: frames by a statistic over their lens, which see through leaves and rain.
#pragma once

namespace lf {

// Runs the command and returns the exit code.
//   argc, argv  the whole command line; argv[1] is the name of the command
int RunFocusThrough(int argc, char** argv);

}  // namespace lf
