// SPDX-License-Identifier: Apache-2.0
// lffocus views LIGHTFIELD --grid COLUMNSxROWS -o OUT: the light field as a regular grid of views.
#pragma once

namespace lf {

// Runs the command and returns the exit code.
//   argc, argv  the whole command line; argv[1] is "views"
int RunFocusViews(int argc, char** argv);

}  // namespace lf
