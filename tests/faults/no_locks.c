// SPDX-License-Identifier: Apache-2.0
// A preload library for a disk without locks, such as Lustre that is mounted without flock:
// flock() and the locks of fcntl() fail with the errno NO_LOCKS on every file. For Linux and glibc.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/file.h>

static int fails(void) {
  const char* const reason = getenv("NO_LOCKS");
  errno = reason ? atoi(reason) : ENOSYS;
  return -1;
}

int flock(int fd, int operation) {
  (void)fd;
  (void)operation;
  return fails();
}

#define FCNTL(name)                                                                       \
  int name(int fd, int command, ...) {                                                    \
    static int (*real)(int, int, void*) = 0;                                              \
    if (!real) real = (int (*)(int, int, void*))dlsym(RTLD_NEXT, #name);                  \
    va_list list;                                                                         \
    va_start(list, command);                                                              \
    void* const argument = va_arg(list, void*);                                           \
    va_end(list);                                                                         \
    if (command == F_SETLK || command == F_SETLKW || command == F_GETLK ||                \
        command == F_OFD_SETLK || command == F_OFD_SETLKW || command == F_OFD_GETLK)      \
      return fails();                                                                     \
    return real(fd, command, argument);                                                   \
  }
FCNTL(fcntl)
FCNTL(fcntl64)
