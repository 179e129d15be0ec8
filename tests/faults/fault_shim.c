// SPDX-License-Identifier: Apache-2.0
// A preload library that makes one system call or allocation fail: the k-th of a kind, on files
// whose path contains a word. tests/faults/faults_test.py judges what programs then do. For Linux and
// glibc; one fault per process.
//
//   FAULT_PROGRAM  only in the program of this name
//   FAULT_PATH     only on paths that contain this word
//   FAULT_KIND     open read write fsync rename unlink mkdir stat mmap thread malloc
//   FAULT_K        which call of the kind, from 1; with FAULT_ALWAYS=1, also every later one
//   FAULT_ONCE     1: no call fails if FAULT_LOG exists, so that programs started by others add no
//                  fault
//   FAULT_ERRNO    a number; "kill": kills the process; "short": half is read or written
//   FAULT_LOG      file for the fault that happened
//   FAULT_TRACE    file for every call: KIND K FUNCTION PATH
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

enum Kind { OPEN, READ, WRITE, FSYNC, RENAME, UNLINK, MKDIR, STAT, MMAP, THREAD, MALLOC, KINDS };
static const char* const kNames[KINDS] = {"open",  "read", "write", "fsync",  "rename", "unlink",
                                          "mkdir", "stat", "mmap",  "thread", "malloc"};
// Smaller allocations never fail: no program can continue without them.
static const size_t kLargeBytes = 65536;

static atomic_long counts[KINDS];
static int fault_kind = -1, fault_errno = 0, is_kill = 0, is_short = 0, is_always = 0, is_once = 0,
           is_ready = 0;
static long fault_k = -1;
static const char* path_word = "";
static char log_path[512], trace_path[512];

static void append(const char* file, const char* kind, long k, const char* function,
                   const char* path) {
  char line[1400];
  const int size =
      snprintf(line, sizeof line, "%s %ld %s %s\n", kind, k, function, path ? path : "-");
  const int fd = (int)syscall(SYS_openat, AT_FDCWD, file,
                              O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0) return;
  if (syscall(SYS_write, fd, line, size < (int)sizeof line ? size : (int)sizeof line) < 0) abort();
  syscall(SYS_close, fd);
}

__attribute__((constructor)) static void begin(void) {
  const char* value = getenv("FAULT_PROGRAM");
  if (value) {
    char program[512];
    const ssize_t size = readlink("/proc/self/exe", program, sizeof program - 1);
    if (size < 0) return;
    program[size] = 0;
    const char* const slash = strrchr(program, '/');
    if (strcmp(slash ? slash + 1 : program, value) != 0) return;
  }
  if ((value = getenv("FAULT_KIND")))
    for (int i = 0; i < KINDS; ++i)
      if (strcmp(value, kNames[i]) == 0) fault_kind = i;
  if ((value = getenv("FAULT_K"))) fault_k = atol(value);
  if ((value = getenv("FAULT_ALWAYS"))) is_always = atoi(value);
  if ((value = getenv("FAULT_ONCE"))) is_once = atoi(value);
  if ((value = getenv("FAULT_ERRNO"))) {
    is_kill = strcmp(value, "kill") == 0;
    is_short = strcmp(value, "short") == 0;
    fault_errno = atoi(value);
  }
  if ((value = getenv("FAULT_PATH"))) path_word = value;
  if ((value = getenv("FAULT_LOG"))) snprintf(log_path, sizeof log_path, "%s", value);
  if ((value = getenv("FAULT_TRACE"))) snprintf(trace_path, sizeof trace_path, "%s", value);
  is_ready = 1;
}
__attribute__((destructor)) static void end(void) { is_ready = 0; }

static int is_watched(enum Kind kind) {
  return is_ready && ((int)kind == fault_kind || trace_path[0]);
}

// Counts a call. Returns 1 if it is the one that fails.
static int hit(enum Kind kind, const char* function, const char* path) {
  const long k = ++counts[kind];
  if (trace_path[0]) append(trace_path, kNames[kind], k, function, path);
  if ((int)kind != fault_kind || fault_k < 1) return 0;
  if (k != fault_k && !(is_always && k > fault_k)) return 0;
  if (is_once && syscall(SYS_faccessat, AT_FDCWD, log_path, F_OK) == 0) return 0;
  if (log_path[0]) append(log_path, kNames[kind], k, function, path);
  if (is_kill) {
    syscall(SYS_kill, getpid(), SIGKILL);
    for (;;) pause();
  }
  return 1;
}

static int path_hit(enum Kind kind, const char* function, const char* path) {
  if (!is_watched(kind) || !path) return 0;
  char whole[1024];
  if (path[0] != '/') {
    char folder[512];
    if (!getcwd(folder, sizeof folder)) return 0;
    snprintf(whole, sizeof whole, "%s/%s", folder, path);
    path = whole;
  }
  return strstr(path, path_word) && hit(kind, function, path);
}

static int fd_hit(enum Kind kind, const char* function, int fd) {
  if (!is_watched(kind)) return 0;
  char link[64], path[1024];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t size = syscall(SYS_readlinkat, AT_FDCWD, link, path, sizeof path - 1);
  if (size < 0) return 0;
  path[size] = 0;
  return strstr(path, path_word) && hit(kind, function, path);
}

#define REAL(name)                     \
  static __typeof__(&name) real = 0;   \
  if (!real) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)
#define FAIL_BY(value)    \
  do {                    \
    errno = fault_errno;  \
    return value;         \
  } while (0)

static mode_t mode_of(int flags, va_list list) {
  return flags & (O_CREAT | O_TMPFILE) ? va_arg(list, mode_t) : 0;
}
#define OPEN_CALL(name)                             \
  int name(const char* path, int flags, ...) {      \
    REAL(name);                                     \
    va_list list;                                   \
    va_start(list, flags);                          \
    const mode_t mode = mode_of(flags, list);       \
    va_end(list);                                   \
    if (path_hit(OPEN, #name, path)) FAIL_BY(-1);   \
    return real(path, flags, mode);                 \
  }
OPEN_CALL(open)
OPEN_CALL(open64)
#define OPENAT_CALL(name)                                 \
  int name(int folder, const char* path, int flags, ...) { \
    REAL(name);                                           \
    va_list list;                                         \
    va_start(list, flags);                                \
    const mode_t mode = mode_of(flags, list);             \
    va_end(list);                                         \
    if (path_hit(OPEN, #name, path)) FAIL_BY(-1);         \
    return real(folder, path, flags, mode);               \
  }
OPENAT_CALL(openat)
OPENAT_CALL(openat64)
FILE* fopen(const char* path, const char* mode) {
  REAL(fopen);
  if (path_hit(OPEN, "fopen", path)) FAIL_BY(NULL);
  return real(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  REAL(fopen64);
  if (path_hit(OPEN, "fopen64", path)) FAIL_BY(NULL);
  return real(path, mode);
}

static size_t half(size_t size) { return size > 1 ? size / 2 : size; }
ssize_t read(int fd, void* to, size_t size) {
  REAL(read);
  if (!fd_hit(READ, "read", fd)) return real(fd, to, size);
  if (is_short) return real(fd, to, half(size));
  FAIL_BY(-1);
}
ssize_t write(int fd, const void* from, size_t size) {
  REAL(write);
  if (!fd_hit(WRITE, "write", fd)) return real(fd, from, size);
  if (is_short) return real(fd, from, half(size));
  FAIL_BY(-1);
}
#define PREAD_CALL(name, offset_type)                                 \
  ssize_t name(int fd, void* to, size_t size, offset_type offset) {   \
    REAL(name);                                                       \
    if (!fd_hit(READ, #name, fd)) return real(fd, to, size, offset);  \
    if (is_short) return real(fd, to, half(size), offset);            \
    FAIL_BY(-1);                                                      \
  }
PREAD_CALL(pread, off_t)
PREAD_CALL(pread64, __off64_t)
#define PWRITE_CALL(name, offset_type)                                      \
  ssize_t name(int fd, const void* from, size_t size, offset_type offset) { \
    REAL(name);                                                             \
    if (!fd_hit(WRITE, #name, fd)) return real(fd, from, size, offset);     \
    if (is_short) return real(fd, from, half(size), offset);                \
    FAIL_BY(-1);                                                            \
  }
PWRITE_CALL(pwrite, off_t)
PWRITE_CALL(pwrite64, __off64_t)

#define FSYNC_CALL(name)                        \
  int name(int fd) {                            \
    REAL(name);                                 \
    if (fd_hit(FSYNC, #name, fd)) FAIL_BY(-1);  \
    return real(fd);                            \
  }
FSYNC_CALL(fsync)
FSYNC_CALL(fdatasync)
int rename(const char* from, const char* to) {
  REAL(rename);
  if (path_hit(RENAME, "rename", to)) FAIL_BY(-1);
  return real(from, to);
}
int unlink(const char* path) {
  REAL(unlink);
  if (path_hit(UNLINK, "unlink", path)) FAIL_BY(-1);
  return real(path);
}
int mkdir(const char* path, mode_t mode) {
  REAL(mkdir);
  if (path_hit(MKDIR, "mkdir", path)) FAIL_BY(-1);
  return real(path, mode);
}
#define STAT_CALL(name, type)                                         \
  int name(const char* restrict path, struct type* restrict status) { \
    REAL(name);                                                       \
    if (path_hit(STAT, #name, path)) FAIL_BY(-1);                     \
    return real(path, status);                                        \
  }
STAT_CALL(stat, stat)
STAT_CALL(lstat, stat)
STAT_CALL(stat64, stat64)
void* mmap(void* at, size_t size, int protection, int flags, int fd, off_t offset) {
  REAL(mmap);
  if (fd >= 0 && fd_hit(MMAP, "mmap", fd)) FAIL_BY(MAP_FAILED);
  return real(at, size, protection, flags, fd, offset);
}
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                   void* argument) {
  REAL(pthread_create);
  if (is_watched(THREAD) && hit(THREAD, "pthread_create", NULL)) return fault_errno;
  return real(thread, attributes, run, argument);
}

extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);
static int malloc_hit(const char* function, size_t size) {
  return size >= kLargeBytes && is_watched(MALLOC) && hit(MALLOC, function, NULL);
}
void* malloc(size_t size) {
  if (malloc_hit("malloc", size)) FAIL_BY(NULL);
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  size_t bytes = 0;
  if (!__builtin_mul_overflow(count, size, &bytes) && malloc_hit("calloc", bytes)) FAIL_BY(NULL);
  return __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
  if (malloc_hit("realloc", size)) FAIL_BY(NULL);
  return __libc_realloc(old, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  if (malloc_hit("aligned_alloc", size)) FAIL_BY(NULL);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** result, size_t alignment, size_t size) {
  if (malloc_hit("posix_memalign", size)) return ENOMEM;
  *result = __libc_memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}
