// SPDX-License-Identifier: Apache-2.0
// Files that do not have their final names yet, and the leftovers of programs that were killed.
//
// While FILE.EXT is written it is called .FILE.PROCESS-HOST.tmp.EXT, in the same folder. The
// extension is kept because libraries choose the format by it. PROCESS is the process number. HOST
// is eight hexadecimal digits: a hash of the machine's name and of the PID namespace, because
// process numbers of a container mean nothing outside it.
#pragma once

#include <filesystem>
#include <string>

namespace lf {

// Returns the temporary name that this process gives to `path`, in the same folder.
std::filesystem::path TemporaryPath(const std::filesystem::path& path);

// Removes the temporary files that dead processes of this host have left for `path`. Files of other
// hosts and of living processes stay. This process lists each folder only once, when the function
// is called for the first file in it. May be called at the same time from any thread.
void RemoveLeftovers(const std::filesystem::path& path);

// True if the name (without a folder) has the form that TemporaryPath() gives, for any file and any
// process.
bool IsTemporaryName(const std::string& name);

// A temporary file. The destructor removes the file, even if memory has run out, unless Keep() was
// called.
class TemporaryFile {
 public:
  // Removes leftovers of `final_path`. Creates no file.
  explicit TemporaryFile(const std::filesystem::path& final_path);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Must be called after the file has been renamed to its final name.
  void Keep() { is_kept_ = true; }

 private:
  std::filesystem::path path_;
  bool is_kept_ = false;
};

}  // namespace lf
