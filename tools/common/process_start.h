// SPDX-License-Identifier: Apache-2.0
// Handlers that are active from the first moment of a program on: before main(), and before the
// constructors of its libraries, some of which start threads.
#pragma once

namespace lf {

// Called before the constructors of libraries, if the system supports that, and by Program::Run().
// A second call changes nothing.
// - Standard files (stdin, stdout, stderr) that the parent process closed are opened as /dev/null
//   for reading. No file that is written can then get their descriptors and receive messages, and a
//   report to stdout still fails.
// - SIGINT, SIGTERM and SIGHUP end the program with exit code 5 and a last line, unless the parent
//   process made the program ignore them, as nohup does. Programs with a checkpoint catch them
//   later (interrupt.h). SIGUSR1, which asks for a checkpoint, is ignored, because there is nothing
//   to save yet.
// - An uncaught exception, even of a library's constructor, ends the program with its reason as the
//   last line, and exit code 4 if the machine lacks memory or threads. Files that are being written
//   keep their temporary names.
void StartProcess();

// Prints "error: interrupted" as the last line, and ends the program with exit code 5, without
// destructors: files that are being written keep their temporary names. Signal handlers may call
// it.
[[noreturn]] void EndInterrupted();

// Prints the reason of the current exception as the last line. To be called in a catch block or in
// the handler of uncaught exceptions. Returns the exit code.
int TellException();

}  // namespace lf
