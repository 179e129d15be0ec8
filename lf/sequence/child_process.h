// A program that runs as a child process: we write to its standard input, and it may write messages
// to standard error. Internal to this folder.
#pragma once

#include <sys/types.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Never blocks forever, raises no SIGPIPE, leaves no zombie, and passes none of our open files to
// the program. The program has its own process group, so that a Ctrl-C for us does not reach it.
class ChildProcess {
 public:
  // Starts a program. `arguments` begins with its name, which is looked up in PATH. kOutput if it
  // cannot be run.
  static Result<std::unique_ptr<ChildProcess>> Start(const std::vector<std::string>& arguments);
  ~ChildProcess();  // kills it if it still runs

  // Writes to the program's input. kOutput if the program has closed it, or reads nothing for
  // patience_s.
  Result<void> Write(std::span<const uint8_t> bytes, double patience_s);

  // Closes the input and waits for the program. kOutput unless it exits with code 0 within
  // patience_s.
  Result<void> Finish(double patience_s);

 private:
  ChildProcess(std::string name, pid_t pid, int input, int complaints);
  Error Failure(const std::string& reason) const;
  void Kill();

  std::string name_;
  pid_t pid_;       // 0: the program has ended
  int input_;       // socket; -1: closed
  int complaints_;  // file with its standard error
};

}  // namespace lf
