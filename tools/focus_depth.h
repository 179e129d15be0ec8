// SPDX-License-Identifier: Apache-2.0
// lffocus depth and lffocus sharp: the depth of every element of a frame, and a picture in which
// everything is in focus.
#pragma once

namespace lf {

// These functions run the commands and return the exit code.
//   argc, argv  the whole command line; argv[1] is the name of the command
int RunFocusDepth(int argc, char** argv);
int RunFocusSharp(int argc, char** argv);

}  // namespace lf
