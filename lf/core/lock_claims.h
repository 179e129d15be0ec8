// SPDX-License-Identifier: Apache-2.0
// Internal to this folder. Locks for disks on which flock() does not work (Lustre mounted without
// flock, NFS without its lock service): files that say which process works there.
//
// The claims to the lock FOLDER/lock are files in FOLDER/lock.claims/. A process creates a file
// with a name of its own, and only then lists the folder: it has the lock if no other claim there
// lives. Of two processes that do so at once at least one therefore sees the other. A claim of a
// dead process is removed by name, and no name is used twice; two processes that find it at once
// cannot remove a living claim by mistake, as they could if all claims had one name.
//
// A claim lives as long as one of the processes that it names lives. Of processes of other machines
// only the age of the file tells: the owner refreshes it every `refresh_s`, as long as it has it.
// Once the file is `stale_s` old and is not refreshed in the next `watch_s` either, the claim is
// dead. The ages are differences of times that the disk gives, so that the clocks of machines may
// differ; and a claim that is refreshed is never dead, whatever the clocks say.
//
// A process whose claim was taken nevertheless, because it stood still for long, ends at once with
// exit code 4: it must not write into a folder in which another process works.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>

#include "lf/core/result.h"

namespace lf {

struct ClaimTimes {
  double refresh_s = 10, stale_s = 90, watch_s = 20;
};

class LockClaim {
 public:
  // Returns the folder of the claims to the lock `path`.
  static std::filesystem::path FolderOf(const std::filesystem::path& path);
  // Claims the lock `path`, whose folder must exist. kOutput: another claim lives (the message
  // names machine, process and age, and says what to do), or the claim cannot be written. Waits a
  // few tenths of a second for other processes that claim it now, and `watch_s` for an old claim of
  // another machine.
  static Result<std::unique_ptr<LockClaim>> Take(const std::filesystem::path& path,
                                                 const ClaimTimes& times = {});
  // Returns an error like that of Take() if any claim to the lock lives, after `watch_s` if it is
  // old and of another machine. Removes dead ones. Costs one access to the disk if there is none.
  static Result<void> CheckNone(const std::filesystem::path& path, const ClaimTimes& times = {});
  // Returns true if any claim to the lock lives, as far as its age tells now.
  static bool IsAny(const std::filesystem::path& path, const ClaimTimes& times = {});
  ~LockClaim();  // releases the lock
  LockClaim(const LockClaim&) = delete;
  LockClaim& operator=(const LockClaim&) = delete;

  // From now on the claim lives as long as this process or `process`, a process of this machine.
  Result<void> ShareWith(pid_t process);

 private:
  LockClaim(std::filesystem::path file, pid_t owner) : file_(std::move(file)), owner_(owner) {}
  std::filesystem::path file_;
  pid_t owner_;
};

}  // namespace lf
