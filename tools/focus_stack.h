// SPDX-License-Identifier: Apache-2.0
// lffocus stack LIGHTFIELD PATH -o OUT: pictures of one camera that differ in their focus distance.
#pragma once

namespace lf {

// Runs the command and returns the exit code.
//   argc, argv  the whole command line; argv[1] is "stack"
int RunFocusStack(int argc, char** argv);

}  // namespace lf
