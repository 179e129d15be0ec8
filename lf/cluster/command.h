// Runs other programs: lfrenderer for as long as it takes, and the short commands of a batch system
// for their output.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct CommandEnd {
  int exit_code = 0;
  int signal = 0;  // the signal that killed the program; 0: it exited
};

// A running program. It has its own process group, so that a Ctrl-C for this process does not reach
// it. It gets SIGTERM if this process dies for any reason.
class Command {
 public:
  struct Options {
    std::vector<std::string> words;        // the program (searched in PATH) and its arguments
    std::filesystem::path working_folder;  // empty: that of this process
    int output = -1;                       // file descriptor for standard output; -1: /dev/null
    int complaints = -1;
    int kept = -1;  // a descriptor that stays open in the program, such as a lock; -1: none
  };
  // Starts a program. kOutput if it cannot be run. The thread that calls this must outlive the
  // program, because the program gets SIGTERM when this thread ends.
  static Result<std::unique_ptr<Command>> Start(const Options& options);
  ~Command();  // kills the program's process group if it still runs

  pid_t process() const { return pid_; }
  // Returns how the program ended; nullopt while it runs.
  std::optional<CommandEnd> Poll();
  void Signal(int signal);

 private:
  explicit Command(pid_t pid) : pid_(pid) {}
  pid_t pid_;
  std::optional<CommandEnd> end_;
};

struct CommandAnswer {
  int exit_code = 0;
  std::string output;
  std::string complaints;
};

// Runs a program and waits for its end. kOutput: the program cannot be run, is killed by a signal,
// takes longer than patience_s, or prints more than 256 MiB.
Result<CommandAnswer> RunCommand(const std::vector<std::string>& words, double patience_s);

}  // namespace lf
