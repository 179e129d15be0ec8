// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace lf {

FileBytes FileInMemory(std::string_view bytes, const std::string& name) {
  const auto read = [bytes](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= bytes.size()) return 0;
    const std::string_view part = bytes.substr(offset, to.size());
    std::copy(part.begin(), part.end(), to.begin());
    return part.size();
  };
  return {read, bytes.size(), name, bytes};
}

std::string_view ContentOf(const FileBytes& file, std::string* read) {
  if (file.in_memory.data() != nullptr) return file.in_memory;
  *read = StartOf(file, file.size_bytes);
  return *read;
}

std::string StartOf(const FileBytes& file, size_t most) {
  std::string start(std::min<uint64_t>(most, file.size_bytes), '\0');
  start.resize(file.read(0, {reinterpret_cast<uint8_t*>(start.data()), start.size()}));
  return start;
}

// O_NONBLOCK is set because opening a named pipe would otherwise wait for its writer.
DiskFile::DiskFile(const std::filesystem::path& path)
    : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  struct stat status {};
  if (fd_ < 0 || ::fstat(fd_, &status) != 0)
    error_ = errno;
  else
    size_bytes_ = static_cast<uint64_t>(status.st_size);
}

DiskFile::~DiskFile() {
  if (fd_ >= 0) ::close(fd_);
}

// Repeats short reads, because the system may return fewer bytes than were requested, or be
// interrupted by a signal.
size_t DiskFile::Read(uint64_t offset, std::span<uint8_t> to) {
  size_t done = 0;
  while (done < to.size()) {
    const ssize_t count =
        ::pread(fd_, to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) error_ = errno;
    if (count <= 0) break;
    done += static_cast<size_t>(count);
  }
  return done;
}

}  // namespace lf
