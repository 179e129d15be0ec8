// Programs that we run: lfrenderer, for as long as it takes, and those of a batch system, for an
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
  int signal = 0;  // that it died of; 0: it ended by itself
};

// Has a process group of its own, so that a Ctrl-C meant for us does not reach it, and gets SIGTERM
// when we die, whatever of.
class Command {
 public:
  struct Options {
    std::vector<std::string> words;        // the program, looked up in PATH, and its arguments
    std::filesystem::path working_folder;  // empty: ours
    int output = -1;                       // descriptors; -1: /dev/null
    int complaints = -1;
    int kept = -1;  // a descriptor that it keeps open, as long as it lives
  };
  // kOutput if it cannot be run. The thread that starts it must outlive it.
  static Result<std::unique_ptr<Command>> Start(const Options& options);
  ~Command();  // kills it if it still runs

  pid_t process() const { return pid_; }
  // None while it runs.
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

// Waits for it. kOutput: it cannot be run, died of a signal, takes longer than patience_s, or
// prints more than 256 MiB.
Result<CommandAnswer> RunCommand(const std::vector<std::string>& words, double patience_s);

}  // namespace lf
