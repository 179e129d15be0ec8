// SPDX-License-Identifier: Apache-2.0
// A preload library that logs what a disk is told: names that are made, renamed and removed, and
// the content of files when they are flushed. tests/faults/power_failure_test.py replays the log. For
// Linux and glibc.
//
//   WRITTEN_PATH  only paths that contain this word
//   WRITTEN_LOG   the log: one line per event, written after the system call has succeeded
//
// Fields of the lines are separated by tabs:
//   make PATH               a new file was opened
//   cut PATH                an existing file was emptied
//   flush PATH N            the file is on the disk, with the content that WRITTEN_LOG.N has
//   flush_folder PATH       the names of a folder are on the disk
//   rename FROM TO, remove PATH, folder PATH
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { kPathSize = 4096 };
static const char* path_word = NULL;
static char log_path[512];
static atomic_long flushes;

__attribute__((constructor)) static void begin(void) {
  const char* const log = getenv("WRITTEN_LOG");
  if (!log) return;
  snprintf(log_path, sizeof log_path, "%s", log);
  path_word = getenv("WRITTEN_PATH");
}

static int sys_open(const char* path, int flags) {
  return (int)syscall(SYS_openat, AT_FDCWD, path, flags | O_CLOEXEC, 0666);
}

static void log_event(const char* event, const char* first, const char* second) {
  const int saved = errno;
  char line[3 * kPathSize];
  const int size = snprintf(line, sizeof line, "%s\t%s\t%s\n", event, first, second);
  const int fd = sys_open(log_path, O_WRONLY | O_CREAT | O_APPEND);
  if (fd < 0 || syscall(SYS_write, fd, line, size) != size) abort();
  syscall(SYS_close, fd);
  errno = saved;
}

// Computes the absolute name of a path. Returns 1 if it is to be logged.
static int is_ours(int folder, const char* path, char* whole) {
  if (!path_word) return 0;
  if (path[0] == '/') {
    snprintf(whole, kPathSize, "%s", path);
  } else {
    char link[64] = "/proc/self/cwd", at[kPathSize / 2];
    if (folder != AT_FDCWD) snprintf(link, sizeof link, "/proc/self/fd/%d", folder);
    const ssize_t size = syscall(SYS_readlinkat, AT_FDCWD, link, at, sizeof at - 1);
    if (size < 0) return 0;
    at[size] = 0;
    snprintf(whole, kPathSize, "%s/%s", at, path);
  }
  return strstr(whole, path_word) != NULL;
}

static int is_there(int folder, const char* path) {
  const int saved = errno;
  const int is = syscall(SYS_faccessat, folder, path, F_OK) == 0;
  errno = saved;
  return is;
}

static void log_opened(int is_open, const char* whole, int was_there, int is_cut) {
  if (!is_open) return;
  if (!was_there) log_event("make", whole, "");
  if (was_there && is_cut) log_event("cut", whole, "");
}

#define REAL(name)                   \
  static __typeof__(&name) real = 0; \
  if (!real) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

#define OPEN_BODY(folder, call)                                                 \
  char whole[kPathSize];                                                        \
  const int is = (flags & (O_CREAT | O_TRUNC)) && is_ours(folder, path, whole); \
  const int was_there = is && is_there(folder, path);                           \
  mode_t mode = 0;                                                              \
  if (flags & (O_CREAT | O_TMPFILE)) {                                          \
    va_list list;                                                               \
    va_start(list, flags);                                                      \
    mode = va_arg(list, mode_t);                                                \
    va_end(list);                                                               \
  }                                                                             \
  const int fd = call;                                                          \
  if (is) log_opened(fd >= 0, whole, was_there, flags & O_TRUNC);               \
  return fd
#define OPEN_CALL(name)                           \
  int name(const char* path, int flags, ...) {    \
    REAL(name);                                   \
    OPEN_BODY(AT_FDCWD, real(path, flags, mode)); \
  }
#define OPENAT_CALL(name)                                  \
  int name(int folder, const char* path, int flags, ...) { \
    REAL(name);                                            \
    OPEN_BODY(folder, real(folder, path, flags, mode));    \
  }
OPEN_CALL(open)
OPEN_CALL(open64)
OPENAT_CALL(openat)
OPENAT_CALL(openat64)

#define FOPEN_CALL(name)                                                           \
  FILE* name(const char* restrict path, const char* restrict mode) {               \
    REAL(name);                                                                    \
    char whole[kPathSize];                                                         \
    const int is = strpbrk(mode, "wa") != NULL && is_ours(AT_FDCWD, path, whole);  \
    const int was_there = is && is_there(AT_FDCWD, path);                          \
    FILE* const file = real(path, mode);                                           \
    if (is) log_opened(file != NULL, whole, was_there, strchr(mode, 'w') != NULL); \
    return file;                                                                   \
  }
FOPEN_CALL(fopen)
FOPEN_CALL(fopen64)

// Copies the content of a descriptor into a file beside the log. Returns the number of the copy.
static long copy_content(const char* link) {
  const long number = ++flushes;
  char name[600], buffer[1 << 14];
  snprintf(name, sizeof name, "%s.%ld", log_path, number);
  const int from = sys_open(link, O_RDONLY), to = sys_open(name, O_WRONLY | O_CREAT | O_TRUNC);
  if (from < 0 || to < 0) abort();
  for (ssize_t size; (size = syscall(SYS_read, from, buffer, sizeof buffer)) != 0;)
    if (size < 0 || syscall(SYS_write, to, buffer, size) != size) abort();
  syscall(SYS_close, from);
  syscall(SYS_close, to);
  return number;
}

static int flushed(int fd, int (*real)(int)) {
  char link[64], path[kPathSize], number[32] = "";
  struct stat status;
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t size =
      path_word ? syscall(SYS_readlinkat, AT_FDCWD, link, path, sizeof path - 1) : -1;
  if (size < 0 || fstat(fd, &status) != 0) return real(fd);
  path[size] = 0;
  const int is_folder = S_ISDIR(status.st_mode);
  if (!strstr(path, path_word) || (!is_folder && !S_ISREG(status.st_mode))) return real(fd);
  if (!is_folder) snprintf(number, sizeof number, "%ld", copy_content(link));
  const int result = real(fd);
  if (result == 0) log_event(is_folder ? "flush_folder" : "flush", path, number);
  return result;
}
int fsync(int fd) {
  REAL(fsync);
  return flushed(fd, real);
}
int fdatasync(int fd) {
  REAL(fdatasync);
  return flushed(fd, real);
}

static int renamed(int result, int from_folder, const char* from, int to_folder, const char* to) {
  char whole_from[kPathSize], whole_to[kPathSize];
  const int is_from = is_ours(from_folder, from, whole_from);
  if (result == 0 && is_ours(to_folder, to, whole_to) && is_from)
    log_event("rename", whole_from, whole_to);
  return result;
}
int rename(const char* from, const char* to) {
  REAL(rename);
  return renamed(real(from, to), AT_FDCWD, from, AT_FDCWD, to);
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  REAL(renameat);
  return renamed(real(from_folder, from, to_folder, to), from_folder, from, to_folder, to);
}

static int noted(const char* event, int result, int folder, const char* path) {
  char whole[kPathSize];
  if (result == 0 && is_ours(folder, path, whole)) log_event(event, whole, "");
  return result;
}
#define REMOVE_CALL(name)                               \
  int name(const char* path) {                          \
    REAL(name);                                         \
    return noted("remove", real(path), AT_FDCWD, path); \
  }
REMOVE_CALL(unlink)
REMOVE_CALL(remove)
REMOVE_CALL(rmdir)
int unlinkat(int folder, const char* path, int flags) {
  REAL(unlinkat);
  return noted("remove", real(folder, path, flags), folder, path);
}
int mkdir(const char* path, mode_t mode) {
  REAL(mkdir);
  return noted("folder", real(path, mode), AT_FDCWD, path);
}
int mkdirat(int folder, const char* path, mode_t mode) {
  REAL(mkdirat);
  return noted("folder", real(folder, path, mode), folder, path);
}
