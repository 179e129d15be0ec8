// SPDX-License-Identifier: Apache-2.0
// Tells whether a process of which a file speaks still lives. Numbers of processes are given anew,
// and mean nothing on another machine, or in another container of this one.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lf {

struct ProcessIdentity {
  pid_t process = 0;
  uint64_t start = 0;  // when it started, in clock ticks since the machine did; 0: unknown
  std::string system;  // the machine since it started, and the namespace of processes; "": unknown
  std::string host;    // name of the machine, for people

  bool operator==(const ProcessIdentity&) const = default;
};

// Returns the identity of a living process of this machine. `start` is 0 if /proc does not tell it.
ProcessIdentity IdentityOf(pid_t process);

// Returns the identity as one line, which begins with the number of the process, without a line
// break; and reads it. nullopt: the line is no identity.
std::string TextOf(const ProcessIdentity& identity);
std::optional<ProcessIdentity> ReadIdentity(std::string_view line);

// kUnknown: it runs, or ran, on another machine, in another container, or before this machine was
// started last. A process that has ended and was not waited for is kEnded.
enum class ProcessLife { kLives, kEnded, kUnknown };
ProcessLife LifeOf(const ProcessIdentity& identity);

}  // namespace lf
