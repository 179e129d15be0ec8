// SPDX-License-Identifier: Apache-2.0
// Assertions that reveal our own bugs. LF_CHECK is on in release builds also: if the condition is
// false, it prints file and line, and ends the program with exit code 1. LF_DCHECK, for inner
// loops, is on in debug builds only.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace lf {

[[noreturn]] inline void CheckFailed(const char* file, int line, const char* condition) {
  std::fprintf(stderr,
               "error: internal: %s:%d: %s does not hold; this is a bug, please report it\n", file,
               line, condition);
  std::fflush(stderr);
  std::_Exit(1);
}

}  // namespace lf

#define LF_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::lf::CheckFailed(__FILE__, __LINE__, #condition))

#ifdef NDEBUG
#define LF_DCHECK(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#else
#define LF_DCHECK(condition) LF_CHECK(condition)
#endif
