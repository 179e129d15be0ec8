#include "lf/sequence/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

extern char** environ;

namespace lf {
namespace {

std::string SystemReason(int error) { return std::strerror(error); }

// The settings that the program starts with: three standard files, default signals, its own group.
class SpawnSettings {
 public:
  SpawnSettings(int input, int complaints) {
    ::posix_spawn_file_actions_init(&files_);
    ::posix_spawn_file_actions_adddup2(&files_, input, STDIN_FILENO);
    ::posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&files_, complaints, STDERR_FILENO);
    ::posix_spawn_file_actions_addclosefrom_np(&files_, STDERR_FILENO + 1);
    ::posix_spawnattr_init(&attributes_);
    sigset_t none, usual;  // the program must not inherit signals that we ignore or block
    ::sigemptyset(&none);
    ::sigemptyset(&usual);
    for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&usual, signal);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &usual);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    ::posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&files_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  // Returns 0, or the errno of the failure.
  int Spawn(const std::vector<std::string>& arguments, pid_t* pid) const {
    std::vector<char*> argv;
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    return ::posix_spawnp(pid, argv[0], &files_, &attributes_, argv.data(), environ);
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

}  // namespace

ChildProcess::ChildProcess(std::string name, pid_t pid, int input, int complaints)
    : name_(std::move(name)), pid_(pid), input_(input), complaints_(complaints) {}

Result<std::unique_ptr<ChildProcess>> ChildProcess::Start(
    const std::vector<std::string>& arguments) {
  // The input is a pair of sockets instead of a pipe, because sending can then avoid SIGPIPE and
  // give up after a while. Standard error is a file in memory instead of a second pipe, because it
  // cannot fill up unread.
  int sockets[2] = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0)
    return OutputError(fmt::format("{}: cannot be run: {}", arguments[0], SystemReason(errno)));
  const int complaints = ::memfd_create("stderr", MFD_CLOEXEC);
  pid_t pid = 0;
  const int error =
      complaints < 0 ? errno : SpawnSettings(sockets[1], complaints).Spawn(arguments, &pid);
  ::close(sockets[1]);
  std::unique_ptr<ChildProcess> child(
      new ChildProcess(arguments[0], error == 0 ? pid : 0, sockets[0], complaints));
  if (error != 0)
    return OutputError(fmt::format("{}: cannot be run: {}", arguments[0], SystemReason(error)));
  return child;
}

ChildProcess::~ChildProcess() {
  Kill();
  if (input_ >= 0) ::close(input_);
  if (complaints_ >= 0) ::close(complaints_);
}

void ChildProcess::Kill() {
  if (pid_ == 0) return;
  ::kill(-pid_, SIGKILL);  // its whole group
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
  pid_ = 0;
}

// Returns an error with the last lines on standard error, which say why the program failed.
Error ChildProcess::Failure(const std::string& reason) const {
  constexpr off_t kMostBytes = 600;
  std::array<char, kMostBytes> last;
  const off_t size = std::max<off_t>(::lseek(complaints_, 0, SEEK_END), 0);
  const ssize_t count =
      ::pread(complaints_, last.data(), last.size(), std::max<off_t>(size - kMostBytes, 0));
  std::string words(last.data(), static_cast<size_t>(std::max<ssize_t>(count, 0)));
  while (!words.empty() && std::isspace(static_cast<unsigned char>(words.back()))) words.pop_back();
  std::replace(words.begin(), words.end(), '\n', ';');
  return OutputError(fmt::format("{} {}{}{}", name_, reason, words.empty() ? "" : ": ", words));
}

Result<void> ChildProcess::Write(std::span<const uint8_t> bytes, double patience_s) {
  if (input_ < 0) return Failure("takes in no more");
  timeval patience{};
  patience.tv_sec = static_cast<time_t>(patience_s);
  patience.tv_usec = static_cast<suseconds_t>(1e6 * (patience_s - std::floor(patience_s)));
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
      return Failure(fmt::format("has taken in nothing for {} s and was ended", patience_s));
    }
    const Result<void> end = Finish(patience_s);  // says why the program ended
    if (!end) return end;
    return Failure(fmt::format("takes in no more: {}", SystemReason(error)));
  }
  return {};
}

Result<void> ChildProcess::Finish(double patience_s) {
  if (input_ >= 0) ::close(input_);
  input_ = -1;
  if (pid_ == 0) return Failure("has ended before");
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  int status = 0;
  while (true) {
    const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) break;
    if (ended < 0 && errno != EINTR) {
      pid_ = 0;
      return Failure(fmt::format("is lost: {}", SystemReason(errno)));
    }
    if (std::chrono::steady_clock::now() > give_up) {
      Kill();
      return Failure(fmt::format("did not end within {} s and was ended", patience_s));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  pid_ = 0;
  if (WIFSIGNALED(status)) return Failure(fmt::format("died of signal {}", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0)
    return Failure(fmt::format("failed with exit code {}", WEXITSTATUS(status)));
  return {};
}

}  // namespace lf
