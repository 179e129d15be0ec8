// SPDX-License-Identifier: Apache-2.0
// Runs other programs as child processes: lfrenderer; the commands of a batch system, whose output
// is read; and ffmpeg, which reads pictures from its standard input.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct ProcessEnd {
  int exit_code = 0;
  int signal = 0;  // the signal that killed the process; 0: no signal did
};

// A program that runs as a child process. It has a process group of its own, so that a Ctrl-C in
// our terminal does not reach it. It inherits none of our open files except its three standard
// files and Options::kept, and no blocked signals. Of the signals that we ignore, it ignores only
// SIGXFSZ. It leaves no zombie. An object may be used by one thread at a time.
class ChildProcess {
 public:
  struct Options {
    std::vector<std::string> words;        // the program, searched in PATH, and its arguments
    std::filesystem::path working_folder;  // empty: the same as ours
    int output = -1;                       // descriptor of standard output; -1: /dev/null
    int complaints = -1;     // descriptor of standard error; -1: a file in memory, quoted in errors
    int kept = -1;           // a descriptor that the program inherits; -1: none
    bool has_input = false;  // true: standard input is fed by Write(); false: /dev/null
  };
  // Starts the program. kOutput if it cannot be run. A program without an input gets SIGTERM if the
  // thread that started it ends for any reason. A program with an input gets no signal, but sees
  // the end of its input when this process ends.
  static Result<std::unique_ptr<ChildProcess>> Start(const Options& options);
  ~ChildProcess();  // kills the program and its process group if it still runs

  pid_t process() const { return pid_; }
  // Returns how the program ended; nullopt while it runs.
  std::optional<ProcessEnd> Poll();
  void Signal(int signal);

  // Returns the end of what the program has written to its standard error, in one line. Empty if it
  // has written nothing, or if Options::complaints is given.
  std::string Complaints() const;

  // Writes to the program's input, and raises no SIGPIPE. kOutput if the program has closed its
  // input, or if it has read nothing for patience_s. The program is killed in the
  // second case, and in the first if it still runs after patience_s.
  Result<void> Write(std::span<const uint8_t> bytes, double patience_s);

  // Closes the input and waits for the program, which is killed if it still runs after patience_s.
  // kOutput unless the program exits with code 0.
  Result<void> Finish(double patience_s);

 private:
  explicit ChildProcess(std::string name) : name_(std::move(name)) {}
  Error Failure(const std::string& reason) const;
  void Kill();

  std::string name_;
  pid_t pid_ = 0;                  // process id of the program; 0: not started
  std::optional<ProcessEnd> end_;  // how the program ended; nullopt while it runs
  int lost_reason_ = 0;            // errno if waitpid() failed and `end_` is a guess; else 0
  int input_ = -1;                 // socket that feeds the program's input; -1: none, or closed
  int complaints_ = -1;            // the program's standard error, if that is a file in memory
};

struct CommandAnswer {
  int exit_code = 0;
  std::string output;
  std::string complaints;
};

// Runs a program and waits for its end. kOutput if it cannot be run, dies of a signal, takes longer
// than patience_s, or prints more than 256 MiB. In the last two cases the program is killed.
Result<CommandAnswer> RunCommand(const std::vector<std::string>& words, double patience_s);

}  // namespace lf
