// SPDX-License-Identifier: Apache-2.0
// The rule for the files that a call writes: an output is no file that the call reads, no two
// outputs are one file, and the files of two calls that work at the same time are never mixed.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/file_lock.h"
#include "lf/core/result.h"

namespace lf {

// A file that a call writes, replaces or removes. The texts must be constants.
struct OutputFile {
  // NOLINTNEXTLINE(google-explicit-constructor): most outputs are nothing but a path
  OutputFile(std::filesystem::path file, std::string_view kind = "an output",
             std::string_view by = "-o")
      : path(std::move(file)), what(kind), option(by) {}

  std::filesystem::path path;
  std::string_view what;    // such as "a frame", for messages
  std::string_view option;  // the option that gives it another name
};

// The outputs of one call. Outputs are compared by their canonical paths: links are followed, and a
// file need not exist. (Two hard links are two outputs, because an output is renamed to its name.)
// An output is compared with an input by device and inode.
class OutputFiles {
 public:
  // kUsage if two outputs are the same file. Each output costs a few accesses to the disk.
  static Result<OutputFiles> Make(std::vector<OutputFile> files);

  // True if one of the outputs exists. Otherwise none of them can be an input.
  bool AnyExists() const { return !numbers_.empty(); }

  // kUsage if an output is one of the files. Each costs one access to the disk, or none if
  // AnyExists() is false.
  //   what  names the files in the message, such as "an input file"
  Result<void> CheckReplacesNone(const std::vector<std::filesystem::path>& inputs,
                                 std::string_view what = "an input file") const;
  // As above, for files in a folder. Empty names are left out. Links to folders are followed. Links
  // to files are followed only if there are at most 20,000 names: otherwise the disk is accessed
  // once for each folder, not for each file.
  Result<void> CheckReplacesNone(const std::filesystem::path& folder,
                                 const std::vector<std::string>& names,
                                 std::string_view what) const;

 private:
  const OutputFile* FindByNumber(const std::filesystem::path& input) const;

  std::vector<OutputFile> files_;
  // Indices in files_: numbers_ finds existing files by device and inode, paths_ finds all files by
  // canonical path.
  std::map<std::pair<dev_t, ino_t>, size_t> numbers_;
  std::map<std::string, size_t> paths_;
  std::set<std::string, std::less<>> names_;  // file names of paths_
};

// Checks a few outputs against any number of inputs. kUsage as for OutputFiles.
Result<void> CheckOutputFiles(std::vector<OutputFile> outputs,
                              const std::vector<std::filesystem::path>& inputs);

// True if the path, which need not exist, is the folder or lies in it at any depth. Links to
// folders are followed first.
bool LiesIn(const std::filesystem::path& path, const std::filesystem::path& folder);

// Takes the lock of a folder that several files are written into, FOLDER/.outputs.lock. Creates the
// folder if it is missing. The lock file is removed in the end. Errors of FileLock::Take().
Result<FileLock> LockOutputFolder(const std::filesystem::path& folder);

// Takes the lock of an output and of the files that are named after it, .NAME.lock beside the
// output. The lock file is removed in the end. Errors of FileLock::Take().
Result<FileLock> LockOutput(const std::filesystem::path& output);

// Takes the locks of outputs that are written one after the other. Takes none for a single output,
// because it is written in one step (core/file.h): of two calls, the later one stays.
Result<std::vector<FileLock>> LockOutputs(const std::vector<std::filesystem::path>& outputs);

}  // namespace lf
