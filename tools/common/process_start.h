// Handlers that hold from the first moment of a program on, before the constructors of its
// libraries, some of which start threads, and before main().
#pragma once

namespace lf {

// Called before the constructors of libraries, where the system can do that, and by Program::Run().
// Calling it twice changes nothing.
// - Standard files that the caller closed are /dev/null, open for reading: no file that is written
//   gets their numbers and with them the messages, and a report to stdout still fails.
// - SIGINT, SIGTERM and SIGHUP end the program with exit code 5 and a last line, unless the caller
//   ignores them. Programs that keep a state catch them later (interrupt.h). SIGUSR1 asks for a
//   state that is not there yet, and does nothing.
// - An exception that nobody catches, also of a library's constructor, ends the program with its
//   reason as the last line, and exit code 4 where the machine lacks memory or threads. Files that
//   are being written keep their temporary names.
void StartProcess();

// Tells what was thrown, as the last line. To be called in a handler. Returns the exit code.
int TellException();

}  // namespace lf
