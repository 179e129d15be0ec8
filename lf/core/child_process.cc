// SPDX-License-Identifier: Apache-2.0
#include "lf/core/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>
#include <utility>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr int kFirstOther = 3;  // first file descriptor after the three standard ones
// Limit of the output of a command: enough for a queue of four million tasks (Slurm's maximum) with
// 60 bytes each.
constexpr off_t kMostBytes = off_t{256} << 20;
constexpr auto kTick = std::chrono::milliseconds(5);

using Clock = std::chrono::steady_clock;

// Owns a file descriptor. The destructor closes it.
class OwnedFile {
 public:
  explicit OwnedFile(int fd) : fd_(fd) {}
  ~OwnedFile() { Close(); }
  OwnedFile(const OwnedFile&) = delete;
  OwnedFile& operator=(const OwnedFile&) = delete;
  int fd() const { return fd_; }
  void Close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

// Returns the last most_bytes bytes of a file in memory; all of them if it is shorter.
std::string TextOf(int file, off_t most_bytes = std::numeric_limits<off_t>::max()) {
  const off_t size = std::max<off_t>(0, ::lseek(file, 0, SEEK_END));
  std::string text(static_cast<size_t>(std::min(size, most_bytes)), '\0');
  const ssize_t count =
      ::pread(file, text.data(), text.size(), size - static_cast<off_t>(text.size()));
  text.resize(static_cast<size_t>(std::max<ssize_t>(0, count)));
  return text;
}

// All that a new process needs to become a program.
struct Launch {
  char* const* argv = nullptr;
  const char* working_folder = nullptr;  // folder in which it runs; nullptr: that of this process
  int input = -1, output = -1, complaints = -1;
  int kept = -1;  // descriptor that the program inherits; -1: none
  bool ends_with_parent = false;
};

// Lets the program inherit no open file except the standard files and `kept`.
void CloseOtherFilesAtExec(int kept) {
  if (::close_range(kFirstOther, ~0u, CLOSE_RANGE_CLOEXEC) != 0) {  // fails before Linux 5.11
    constexpr int kHighest = 65536;  // the limit of open files, which may be a billion, is not used
    for (int file = kFirstOther; file < kHighest; ++file) ::fcntl(file, F_SETFD, FD_CLOEXEC);
  }
  if (kept >= 0) ::fcntl(kept, F_SETFD, 0);
}

// Turns the new process into the program. Runs between vfork and exec, in the memory of the parent,
// where it may change nothing, allocate nothing and take no locks. If it fails, it writes the errno
// to the pipe `alarm`.
[[noreturn]] void Become(const Launch& launch, pid_t parent, int alarm) {
  ::setpgid(0, 0);
  if (launch.ends_with_parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(1);
  }
  // The program must not inherit the signals that we ignore, and our handlers must not run here.
  // SIGXFSZ stays as it is: while it is ignored, a program can say that its file grew too large.
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP, SIGUSR1}) ::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const bool is_ready = (!launch.working_folder || ::chdir(launch.working_folder) == 0) &&
                        ::dup2(launch.input, STDIN_FILENO) >= 0 &&
                        ::dup2(launch.output, STDOUT_FILENO) >= 0 &&
                        ::dup2(launch.complaints, STDERR_FILENO) >= 0;
  if (is_ready) {
    CloseOtherFilesAtExec(launch.kept);
    ::execvp(launch.argv[0], launch.argv);
  }
  const int reason = errno;
  [[maybe_unused]] const ssize_t told = ::write(alarm, &reason, sizeof(reason));
  ::_exit(127);
}

// Starts a process and waits until it has become the program. Returns 0, or the errno of the
// failure. vfork, unlike fork, does not copy the page tables. In a large render the copy would take
// long, and might exceed the memory that the render may use.
int Spawn(const Launch& launch, pid_t* pid) {
  int alarm[2] = {-1, -1};
  if (::pipe2(alarm, O_CLOEXEC) != 0) return errno;
  const OwnedFile heard(alarm[0]);
  OwnedFile told(alarm[1]);
  const pid_t parent = ::getpid();
  sigset_t all, usual;
  ::sigfillset(&all);
  // Signals are blocked until Become() has reset our handlers.
  ::pthread_sigmask(SIG_SETMASK, &all, &usual);
  const pid_t child = ::vfork();  // NOLINT(clang-analyzer-security.insecureAPI.vfork)
  if (child == 0) Become(launch, parent, told.fd());  // NOLINT(clang-analyzer-unix.Vfork)
  const int reason = errno;
  ::pthread_sigmask(SIG_SETMASK, &usual, nullptr);
  if (child < 0) return reason;
  *pid = child;
  told.Close();
  int exec_reason = 0;
  ssize_t count = 0;
  while ((count = ::read(heard.fd(), &exec_reason, sizeof(exec_reason))) < 0 && errno == EINTR)
    continue;
  return count == sizeof(exec_reason) ? exec_reason : 0;
}

}  // namespace

Result<std::unique_ptr<ChildProcess>> ChildProcess::Start(const Options& options) {
  LF_CHECK(!options.words.empty());
  const std::string& name = options.words.front();
  const auto failure = [&](int reason) {
    return OutputError(fmt::format("{}: cannot be run: {}", name, std::strerror(reason)));
  };
  std::error_code ignored;
  if (!options.working_folder.empty() &&
      !std::filesystem::is_directory(options.working_folder, ignored))
    return OutputError(
        fmt::format("{}: cannot be run in {}: this folder does not exist any more; make it again",
                    name, options.working_folder.string()));
  std::vector<char*> argv;
  for (const std::string& word : options.words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  std::unique_ptr<ChildProcess> child(new ChildProcess(name));
  // The input is a pair of sockets instead of a pipe, because sending can then avoid SIGPIPE and
  // give up after a while. Standard error is a file in memory instead of a second pipe, because a
  // pipe that nobody reads fills up and then blocks the program.
  int input[2] = {-1, -1};
  if (options.has_input && ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) != 0)
    return failure(errno);
  child->input_ = input[0];
  const OwnedFile program_input(input[1]);
  if (options.complaints < 0 && (child->complaints_ = ::memfd_create("stderr", MFD_CLOEXEC)) < 0)
    return failure(errno);
  const OwnedFile nothing(::open("/dev/null", O_RDWR | O_CLOEXEC));
  Launch launch;
  launch.argv = argv.data();
  if (!options.working_folder.empty()) launch.working_folder = options.working_folder.c_str();
  launch.input = options.has_input ? program_input.fd() : nothing.fd();
  launch.output = options.output < 0 ? nothing.fd() : options.output;
  launch.complaints = options.complaints < 0 ? child->complaints_ : options.complaints;
  launch.kept = options.kept;
  launch.ends_with_parent = !options.has_input;
  if (const int reason = Spawn(launch, &child->pid_); reason != 0) return failure(reason);
  return child;
}

ChildProcess::~ChildProcess() {
  Kill();
  if (input_ >= 0) ::close(input_);
  if (complaints_ >= 0) ::close(complaints_);
}

void ChildProcess::Kill() {
  if (pid_ == 0 || end_) return;
  ::kill(-pid_, SIGKILL);  // kills the whole process group
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
  end_ = {.exit_code = 0, .signal = SIGKILL};
}

std::optional<ProcessEnd> ChildProcess::Poll() {
  if (end_) return end_;
  int status = 0;
  const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
  end_.emplace();
  if (ended < 0) lost_reason_ = errno;
  if (ended < 0 || WIFSIGNALED(status))
    end_->signal = ended < 0 ? SIGKILL : WTERMSIG(status);
  else
    end_->exit_code = WEXITSTATUS(status);
  return end_;
}

void ChildProcess::Signal(int signal) {
  if (!end_) ::kill(pid_, signal);
}

std::string ChildProcess::Complaints() const {
  constexpr off_t kQuotedBytes = 600;
  std::string words = complaints_ < 0 ? "" : TextOf(complaints_, kQuotedBytes);
  while (!words.empty() && std::isspace(static_cast<unsigned char>(words.back()))) words.pop_back();
  std::replace(words.begin(), words.end(), '\n', ';');
  return words;
}

// Returns an error with the end of the program's standard error, which says why it failed.
Error ChildProcess::Failure(const std::string& reason) const {
  const std::string words = Complaints();
  return OutputError(fmt::format("{} {}{}{}", name_, reason, words.empty() ? "" : ": ", words));
}

Result<void> ChildProcess::Write(std::span<const uint8_t> bytes, double patience_s) {
  if (input_ < 0) return Failure("has no open input");
  constexpr int64_t kMicroseconds = 1'000'000;
  // A time of 0 would mean that send() waits for ever.
  const int64_t wait_us = std::max<int64_t>(1, std::llround(kMicroseconds * patience_s));
  timeval patience{};
  patience.tv_sec = wait_us / kMicroseconds;
  patience.tv_usec = wait_us % kMicroseconds;
  ::setsockopt(input_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  while (!bytes.empty()) {
    const ssize_t sent = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<size_t>(sent));
      continue;
    }
    const int error = errno;
    if (error == EINTR) continue;
    if (error == EAGAIN || error == EWOULDBLOCK) {
      Kill();
      return Failure(fmt::format("has read nothing for {} s and was killed", patience_s));
    }
    const Result<void> end = Finish(patience_s);  // says why the program ended
    if (!end) return end;
    return Failure(fmt::format("reads no more input: {}", std::strerror(error)));
  }
  return {};
}

Result<void> ChildProcess::Finish(double patience_s) {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  const auto give_up = Clock::now() + std::chrono::duration<double>(patience_s);
  while (!Poll()) {
    if (Clock::now() > give_up) {
      Kill();
      return Failure(fmt::format("did not end within {} s and was killed", patience_s));
    }
    std::this_thread::sleep_for(kTick);
  }
  if (lost_reason_ != 0)
    return Failure(fmt::format("cannot be waited for: {}", std::strerror(lost_reason_)));
  if (end_->signal != 0) return Failure(fmt::format("was killed by signal {}", end_->signal));
  if (end_->exit_code != 0)
    return Failure(fmt::format("failed with exit code {}", end_->exit_code));
  return {};
}

Result<CommandAnswer> RunCommand(const std::vector<std::string>& words, double patience_s) {
  const OwnedFile output(::memfd_create("output", MFD_CLOEXEC));
  const OwnedFile complaints(::memfd_create("complaints", MFD_CLOEXEC));
  ChildProcess::Options options;
  options.words = words;
  options.output = output.fd();
  options.complaints = complaints.fd();
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<ChildProcess> child, ChildProcess::Start(options));
  const auto give_up = Clock::now() + std::chrono::duration<double>(patience_s);
  while (true) {
    if (const auto end = child->Poll()) {
      if (end->signal != 0)
        return OutputError(fmt::format("{}: was killed by signal {} ({})", words.front(),
                                       end->signal, ::strsignal(end->signal)));
      return CommandAnswer{end->exit_code, TextOf(output.fd()), TextOf(complaints.fd())};
    }
    for (const OwnedFile* file : {&output, &complaints})
      if (::lseek(file->fd(), 0, SEEK_END) > kMostBytes)
        return OutputError(fmt::format("{}: prints more than the {} MiB that are expected",
                                       words.front(), kMostBytes >> 20));
    if (Clock::now() > give_up)
      return OutputError(fmt::format("{}: has not ended within {} s", words.front(), patience_s));
    std::this_thread::sleep_for(kTick);
  }
}

}  // namespace lf
