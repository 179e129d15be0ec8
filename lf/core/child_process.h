// Runs other programs as child processes: lfrenderer, for as long as it takes; those of a batch
// system, for an answer; and ffmpeg, which is fed with pictures.
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
  int signal = 0;  // the signal that killed it; 0: it exited by itself
};

// A program that runs as a child process. It has a process group of its own, so that a Ctrl-C for
// us does not reach it, and inherits neither our open files nor the signals that we catch, block or
// ignore (except SIGXFSZ). It leaves no zombie. For one thread at a time.
class ChildProcess {
 public:
  struct Options {
    std::vector<std::string> words;        // the program, searched in PATH, and its arguments
    std::filesystem::path working_folder;  // empty: ours
    int output = -1;                       // file descriptor; -1: /dev/null
    int complaints = -1;     // -1: a file in memory, whose last lines the errors below quote
    int kept = -1;           // a descriptor that stays open in the program as long as it lives
    bool has_input = false;  // Write() feeds its standard input; false: /dev/null
  };
  // kOutput if the program cannot be run. A program without an input gets SIGTERM if the thread
  // that started it ends for any reason. A program with an input sees the end of its input instead.
  static Result<std::unique_ptr<ChildProcess>> Start(const Options& options);
  ~ChildProcess();  // kills the program and its process group if it still runs

  pid_t process() const { return pid_; }
  // Returns nullopt while the program runs.
  std::optional<ProcessEnd> Poll();
  void Signal(int signal);

  // Writes to the program's input, and raises no SIGPIPE. kOutput if the program has closed it, or
  // reads nothing for patience_s, after which it is killed.
  Result<void> Write(std::span<const uint8_t> bytes, double patience_s);

  // Closes the input and waits for the program. kOutput unless it exits with code 0 within
  // patience_s, after which it is killed.
  Result<void> Finish(double patience_s);

 private:
  explicit ChildProcess(std::string name) : name_(std::move(name)) {}
  Error Failure(const std::string& reason) const;
  void Kill();

  std::string name_;
  pid_t pid_ = 0;                  // 0: not started
  std::optional<ProcessEnd> end_;  // the process exists no longer
  int lost_reason_ = 0;            // errno of the wait that could not tell the end
  int input_ = -1;                 // socket; -1: closed
  int complaints_ = -1;            // file in memory; -1: they go elsewhere
};

struct CommandAnswer {
  int exit_code = 0;
  std::string output;
  std::string complaints;
};

// Runs a program and waits for its end. kOutput: it cannot be run, dies of a signal, takes longer
// than patience_s, or prints more than 256 MiB.
Result<CommandAnswer> RunCommand(const std::vector<std::string>& words, double patience_s);

}  // namespace lf
