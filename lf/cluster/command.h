// Runs other programs: lfrenderer, for as long as it takes, and those of a batch system, for an
// answer.
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
  int signal = 0;  // the signal that killed it; 0: it exited by itself
};

// A running program. It has a process group of its own, so that a Ctrl-C for us does not reach it,
// and gets SIGTERM if we die for any reason.
class Command {
 public:
  struct Options {
    std::vector<std::string> words;        // the program, searched in PATH, and its arguments
    std::filesystem::path working_folder;  // empty: ours
    int output = -1;                       // file descriptor; -1: /dev/null
    int complaints = -1;
    int kept = -1;  // a descriptor that stays open in the program as long as it lives
  };
  // kOutput if the program cannot be run. The thread that starts the program must outlive it.
  static Result<std::unique_ptr<Command>> Start(const Options& options);
  ~Command();  // kills the program if it still runs

  pid_t process() const { return pid_; }
  // Returns nullopt while the program runs.
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

// Runs a program and waits for its end. kOutput: it cannot be run, dies of a signal, takes longer
// than patience_s, or prints more than 256 MiB.
Result<CommandAnswer> RunCommand(const std::vector<std::string>& words, double patience_s);

}  // namespace lf
