// SPDX-License-Identifier: Apache-2.0
#include "lf/core/temporary_file.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/hash.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kMark = ".tmp";
constexpr size_t kHostDigits = 8;

// Returns a hash of the machine's name and of our PID namespace, because a process number has a
// meaning only within one namespace. The first namespace of a machine has the same number after
// each reboot.
std::string HostName() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) name.fill('\0');
  struct stat processes {};
  const uint64_t number = ::stat("/proc/self/ns/pid", &processes) == 0 ? processes.st_ino : 0;
  return fmt::format("{:08x}", static_cast<uint32_t>(HashBytes(name.data(), number)));
}

const std::string& Host() {
  static const std::string host = HostName();
  return host;
}

// The parts of a temporary name.
struct NameParts {
  std::string file;  // final name of the file
  pid_t process = 0;
  std::string host;
};

std::optional<NameParts> PartsOf(std::string_view name) {
  if (!name.starts_with('.')) return std::nullopt;
  const size_t mark = name.rfind(kMark);
  if (mark == std::string_view::npos || mark < 2) return std::nullopt;
  const std::string_view extension = name.substr(mark + kMark.size());
  if (!extension.empty() &&
      (extension.size() < 2 || extension.front() != '.' || extension.rfind('.') != 0))
    return std::nullopt;
  const size_t writer = name.rfind('.', mark - 1);
  if (writer == 0 || writer == std::string_view::npos) return std::nullopt;
  NameParts parts;
  const char* const end = name.data() + mark;
  const auto [rest, error] = std::from_chars(name.data() + writer + 1, end, parts.process);
  if (error != std::errc{} || parts.process <= 0 || rest == end || *rest != '-')
    return std::nullopt;
  parts.host = std::string(rest + 1, end);
  if (parts.host.size() != kHostDigits ||
      parts.host.find_first_not_of("0123456789abcdef") != std::string::npos)
    return std::nullopt;
  parts.file = fmt::format("{}{}", name.substr(1, writer - 1), extension);
  return parts;
}

bool IsDead(pid_t process) { return ::kill(process, 0) != 0 && errno == ESRCH; }

fs::path FolderOf(const fs::path& path) {
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const fs::path absolute = fs::absolute(folder, error);
  return error ? folder : absolute.lexically_normal();
}

// The temporary files in one folder that other processes of this host have made, listed under the
// final names of the files.
using Leftovers = std::map<std::string, std::vector<fs::path>>;

Leftovers LeftoversIn(const fs::path& folder) {
  Leftovers leftovers;
  std::error_code error;
  for (auto entry = fs::directory_iterator(folder, error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const auto parts = PartsOf(entry->path().filename().string());
    if (parts && parts->host == Host() && parts->process != ::getpid())
      leftovers[parts->file].push_back(entry->path());
  }
  return leftovers;
}

}  // namespace

fs::path TemporaryPath(const fs::path& path) {
  return path.parent_path() / fmt::format(".{}.{}-{}{}{}", path.stem().string(), ::getpid(), Host(),
                                          kMark, path.extension().string());
}

bool IsTemporaryName(const std::string& name) { return PartsOf(name).has_value(); }

void RemoveLeftovers(const fs::path& path) {
  static std::mutex mutex;
  static auto* const folders = new std::map<fs::path, Leftovers>;  // never destroyed
  const std::lock_guard lock(mutex);
  const fs::path folder = FolderOf(path);
  auto known = folders->find(folder);
  if (known == folders->end()) known = folders->emplace(folder, LeftoversIn(folder)).first;
  const auto found = known->second.find(path.filename().string());
  if (found == known->second.end()) return;
  std::erase_if(found->second, [](const fs::path& file) {
    const auto parts = PartsOf(file.filename().string());
    return parts && IsDead(parts->process) && (::unlink(file.c_str()) == 0 || errno == ENOENT);
  });
  if (found->second.empty()) known->second.erase(found);
}

TemporaryFile::TemporaryFile(const fs::path& final_path) : path_(TemporaryPath(final_path)) {
  RemoveLeftovers(final_path);
}
TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : path_(std::move(other.path_)), is_kept_(std::exchange(other.is_kept_, true)) {}
TemporaryFile::~TemporaryFile() {
  if (!is_kept_) ::unlink(path_.c_str());
}

}  // namespace lf
