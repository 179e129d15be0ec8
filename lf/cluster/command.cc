#include "lf/cluster/command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr int kKeptAs = 3;  // first descriptor after standard input, output and error
// Enough for the output of squeue for four million tasks (Slurm's maximum) with 60 bytes each.
constexpr off_t kMostBytes = off_t{256} << 20;

// Runs in the child between fork and exec, where memory must not be allocated and locks must not be
// taken. If it fails, it writes errno to the descriptor `alarm`.
[[noreturn]] void Become(const Command::Options& options, char* const* argv, pid_t parent,
                         int nothing, int alarm) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(1);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  // The program must not inherit that this process ignores these signals.
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP, SIGUSR1})
    ::signal(signal, SIG_DFL);
  const bool is_ready =
      (options.working_folder.empty() || ::chdir(options.working_folder.c_str()) == 0) &&
      ::dup2(nothing, STDIN_FILENO) >= 0 &&
      ::dup2(options.output < 0 ? nothing : options.output, STDOUT_FILENO) >= 0 &&
      ::dup2(options.complaints < 0 ? nothing : options.complaints, STDERR_FILENO) >= 0;
  if (is_ready) {
    ::close_range(kKeptAs, ~0u, CLOSE_RANGE_CLOEXEC);
    if (options.kept >= 0) ::fcntl(options.kept, F_SETFD, 0);
    ::execvp(argv[0], argv);
  }
  const int reason = errno;
  [[maybe_unused]] const ssize_t told = ::write(alarm, &reason, sizeof(reason));
  ::_exit(127);
}

// Returns the contents of a file from its descriptor.
std::string TextOf(int file) {
  std::string text(static_cast<size_t>(std::max<off_t>(0, ::lseek(file, 0, SEEK_END))), '\0');
  const ssize_t count = ::pread(file, text.data(), text.size(), 0);
  text.resize(static_cast<size_t>(std::max<ssize_t>(0, count)));
  return text;
}

// Owns a file descriptor and closes it.
class OwnedFile {
 public:
  explicit OwnedFile(int fd) : fd_(fd) {}
  ~OwnedFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  OwnedFile(const OwnedFile&) = delete;
  OwnedFile& operator=(const OwnedFile&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

Result<std::unique_ptr<Command>> Command::Start(const Options& options) {
  LF_CHECK(!options.words.empty());
  const auto failure = [&](int reason) {
    return OutputError(
        fmt::format("{}: cannot be run: {}", options.words.front(), std::strerror(reason)));
  };
  std::error_code ignored;
  if (!options.working_folder.empty() &&
      !std::filesystem::is_directory(options.working_folder, ignored))
    return OutputError(fmt::format("{}: cannot be run in the folder {}: it is gone",
                                   options.words.front(), options.working_folder.string()));
  std::vector<char*> argv;
  for (const std::string& word : options.words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  int alarm[2] = {-1, -1};
  if (::pipe2(alarm, O_CLOEXEC) != 0) return failure(errno);
  const OwnedFile heard(alarm[0]);
  const OwnedFile nothing(::open("/dev/null", O_RDWR | O_CLOEXEC));
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) Become(options, argv.data(), parent, nothing.fd(), alarm[1]);
  const int reason = errno;
  ::close(alarm[1]);
  if (pid < 0) return failure(reason);
  std::unique_ptr<Command> command(new Command(pid));
  int exec_reason = 0;
  ssize_t count = 0;
  while ((count = ::read(heard.fd(), &exec_reason, sizeof(exec_reason))) < 0 && errno == EINTR)
    continue;
  if (count == sizeof(exec_reason)) return failure(exec_reason);
  return command;
}

Command::~Command() {
  if (end_) return;
  ::kill(-pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
}

std::optional<CommandEnd> Command::Poll() {
  int status = 0;
  if (end_) return end_;
  const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
  end_.emplace();
  if (ended < 0 || WIFSIGNALED(status))
    end_->signal = ended < 0 ? SIGKILL : WTERMSIG(status);
  else
    end_->exit_code = WEXITSTATUS(status);
  return end_;
}

void Command::Signal(int signal) {
  if (!end_) ::kill(pid_, signal);
}

Result<CommandAnswer> RunCommand(const std::vector<std::string>& words, double patience_s) {
  const OwnedFile output(::memfd_create("output", MFD_CLOEXEC));
  const OwnedFile complaints(::memfd_create("complaints", MFD_CLOEXEC));
  Command::Options options;
  options.words = words;
  options.output = output.fd();
  options.complaints = complaints.fd();
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<Command> command, Command::Start(options));
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (true) {
    if (const auto end = command->Poll()) {
      if (end->signal != 0)
        return OutputError(fmt::format("{}: died of signal {}", words.front(), end->signal));
      return CommandAnswer{end->exit_code, TextOf(output.fd()), TextOf(complaints.fd())};
    }
    for (const OwnedFile* file : {&output, &complaints})
      if (::lseek(file->fd(), 0, SEEK_END) > kMostBytes)
        return OutputError(
            fmt::format("{}: prints more than {} MiB", words.front(), kMostBytes >> 20));
    if (std::chrono::steady_clock::now() > give_up)
      return OutputError(
          fmt::format("{}: has not answered within {} s", words.front(), patience_s));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace lf
