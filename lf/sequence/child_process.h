// A program run beside ours: we feed its standard input, it may complain on standard error.
// Internal to this folder.
#pragma once

#include <sys/types.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Never blocks for ever, raises no SIGPIPE, leaves no zombie, and passes none of our files on. The
// program has a process group of its own: a Ctrl-C meant for us does not reach it.
class ChildProcess {
 public:
  // `arguments` begins with the program's name, looked up in PATH. kOutput if it cannot be run.
  static Result<std::unique_ptr<ChildProcess>> Start(const std::vector<std::string>& arguments);
  ~ChildProcess();  // kills it if it still runs

  // kOutput if the program has closed its input, or takes in nothing for patience_s.
  Result<void> Write(std::span<const uint8_t> bytes, double patience_s);

  // Ends the input and waits for the program. kOutput unless it ends with exit code 0 in time.
  Result<void> Finish(double patience_s);

 private:
  ChildProcess(std::string name, pid_t pid, int input, int complaints);
  Error Failure(const std::string& reason) const;
  void Kill();

  std::string name_;
  pid_t pid_;       // 0: has ended
  int input_;       // socket; -1: closed
  int complaints_;  // file with its standard error
};

}  // namespace lf
