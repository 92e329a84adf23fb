/* Preloaded: makes the system fail where a test wants it.
 *
 * UMOV_FAULT=CALL:N:ERRNO  the N-th call (from 1) of CALL fails with ERRNO, and so do those after it
 *                          unless N ends in "!"; CALL: write (files under UMOV_FAULT_UNDER), sync,
 *                          rename, open (for writing), mkdir, read, thread, clock (set back by a day),
 *                          alloc (of memory, from main on)
 *                          ERRNO below 0: that signal is sent instead, before the call
 * UMOV_FAULT_UNDER         prefix of the names of the files that are meant
 * UMOV_FAULT_COUNT=FILE    the numbers of all calls are added to FILE at the end of each process
 * UMOV_POISON=3:crash,7:hang,9:memory
 *                          the process that begins a file of rows of that shard crashes, never ends
 *                          it, or has taken all memory that it can get
 */
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
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

enum { WRITE, SYNC, RENAME, OPEN, MKDIR, READ, THREAD, CLOCK, ALLOC, KINDS };
static const char *const names[KINDS] = {"write", "sync", "rename", "open", "mkdir", "read", "thread", "clock", "alloc"};
static atomic_long counts[KINDS];
static long at = 0;
static int kind = -1, code = 0, once = 0, has_begun = 0;
static char under[4096];
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

__attribute__((constructor)) static void start(void) {
  const char *fault = getenv("UMOV_FAULT"), *where = getenv("UMOV_FAULT_UNDER");
  if (where)
    snprintf(under, sizeof under, "%s", where);
  char name[16];
  char mark = 0;
  if (!fault || sscanf(fault, "%15[a-z]:%ld%c%d", name, &at, &mark, &code) != 4)
    return;
  once = mark == '!';
  for (int k = 0; k < KINDS; ++k)
    if (!strcmp(name, names[k]))
      kind = k;
}

__attribute__((destructor)) static void tell(void) {
  const char *file = getenv("UMOV_FAULT_COUNT");
  FILE *out = file ? fopen(file, "a") : NULL;
  if (!out)
    return;
  for (int k = 0; k < KINDS; ++k)
    fprintf(out, "%s %ld\n", names[k], (long)counts[k]);
  fclose(out);
}

static int fails(int what) {
  const long n = ++counts[what];
  if (what != kind || n < at || (once && n > at))
    return 0;
  if (code < 0) {
    kill(getpid(), -code);
    return 0;
  }
  errno = code;
  return 1;
}
/* "/somewhere/tmp/00000007.rows.part-...": number and deed as UMOV_POISON has them. */
static void poison(const char *path) {
  const char *deeds = getenv("UMOV_POISON"), *name = strstr(path, "/tmp/0");
  int length = 0;
  long index = -1;
  if (!deeds || !name || sscanf(name, "/tmp/%8ld.rows%n", &index, &length) != 1 || length == 0)
    return;
  char wanted[32];
  snprintf(wanted, sizeof wanted, ",%ld:", index);
  char all[512];
  snprintf(all, sizeof all, ",%s", deeds);
  const char *deed = strstr(all, wanted);
  if (!deed)
    return;
  deed += strlen(wanted);
  if (!strncmp(deed, "crash", 5))
    kill(getpid(), SIGSEGV);
  while (!strncmp(deed, "hang", 4))
    pause();
  for (size_t size = strncmp(deed, "memory", 6) ? 0 : 16 << 20; size >= 16; size /= 16)
    for (void *block = malloc(size); block; block = malloc(size))
      memset(block, 1, size);
}
static int is_meant(const char *name) { return strncmp(name, under, strlen(under)) == 0; }
static int is_meant_fd(int fd) {
  char link[64], name[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const int saved = errno;
  const ssize_t size = readlink(link, name, sizeof name - 1);
  errno = saved;
  if (size <= 0)
    return 0;
  name[size] = 0;
  return name[0] == '/' && is_meant(name);
}
static int is_meant_at(const char *path) {
  char name[8192];
  if (path[0] == '/')
    return is_meant(path);
  if (!getcwd(name, 4096))
    return 0;
  strcat(name, "/");
  strncat(name, path, 4000);
  return is_meant(name);
}

ssize_t write(int fd, const void *data, size_t size) {
  if (is_meant_fd(fd) && fails(WRITE))
    return -1;
  return REAL(write)(fd, data, size);
}
ssize_t pwrite64(int fd, const void *data, size_t size, off64_t offset) {
  if (is_meant_fd(fd) && fails(WRITE))
    return -1;
  return REAL(pwrite64)(fd, data, size, offset);
}
ssize_t pwrite(int fd, const void *data, size_t size, off_t offset) { return pwrite64(fd, data, size, offset); }
ssize_t writev(int fd, const struct iovec *parts, int count) {
  if (is_meant_fd(fd) && fails(WRITE))
    return -1;
  return REAL(writev)(fd, parts, count);
}
size_t fwrite(const void *data, size_t size, size_t count, FILE *file) {
  if (is_meant_fd(fileno(file)) && fails(WRITE))
    return 0;
  return REAL(fwrite)(data, size, count, file);
}
int fsync(int fd) { return is_meant_fd(fd) && fails(SYNC) ? -1 : REAL(fsync)(fd); }
int rename(const char *from, const char *to) {
  return is_meant_at(from) && fails(RENAME) ? -1 : REAL(rename)(from, to);
}
int renameat2(int a, const char *from, int b, const char *to, unsigned flags) {
  return is_meant_at(from) && fails(RENAME) ? -1 : REAL(renameat2)(a, from, b, to, flags);
}
int mkdir(const char *path, mode_t mode) { return is_meant_at(path) && fails(MKDIR) ? -1 : REAL(mkdir)(path, mode); }
#define OPENS(name)                                                                                                   \
  int name(const char *path, int flags, ...) {                                                                        \
    va_list rest;                                                                                                     \
    va_start(rest, flags);                                                                                            \
    const mode_t mode = va_arg(rest, mode_t);                                                                         \
    va_end(rest);                                                                                                     \
    if ((flags & O_ACCMODE) != O_RDONLY)                                                                              \
      poison(path);                                                                                                   \
    if ((flags & O_ACCMODE) != O_RDONLY && is_meant_at(path) && fails(OPEN))                                          \
      return -1;                                                                                                      \
    return REAL(name)(path, flags, mode);                                                                             \
  }
OPENS(open)
OPENS(open64)
ssize_t read(int fd, void *data, size_t size) {
  if (is_meant_fd(fd) && fails(READ))
    return -1;
  return REAL(read)(fd, data, size);
}
int pthread_create(pthread_t *thread, const pthread_attr_t *how, void *(*work)(void *), void *with) {
  if (fails(THREAD))
    return code;
  return REAL(pthread_create)(thread, how, work, with);
}
int clock_gettime(clockid_t clock, struct timespec *out) {
  const int done = (int)syscall(SYS_clock_gettime, clock, out);
  if (clock == CLOCK_REALTIME && fails(CLOCK))
    out->tv_sec -= 86400;
  return done;
}

/* glibc's own, which need no looking up: that would ask for memory itself. */
extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t),
    *__libc_memalign(size_t, size_t);
/* Global objects are made before main, of libraries too: nothing there could say what is missing. */
static int (*real_main)(int, char **, char **);
static int begin(int argc, char **argv, char **environment) {
  has_begun = 1;
  return real_main(argc, argv, environment);
}
int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end) {
  real_main = main;
  int (*const start)(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void),
                     void *) = dlsym(RTLD_NEXT, "__libc_start_main");
  return start(begin, argc, argv, init, fini, rtld_fini, stack_end);
}
static int has_no_memory(void) { return has_begun && fails(ALLOC); }
void *malloc(size_t size) { return has_no_memory() ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return has_no_memory() ? NULL : __libc_calloc(count, size); }
void *realloc(void *old, size_t size) { return has_no_memory() ? NULL : __libc_realloc(old, size); }
void *memalign(size_t to, size_t size) { return has_no_memory() ? NULL : __libc_memalign(to, size); }
void *aligned_alloc(size_t to, size_t size) { return memalign(to, size); }
int posix_memalign(void **out, size_t to, size_t size) {
  const int saved = errno;
  void *const got = memalign(to, size);
  errno = saved;
  if (got)
    *out = got;
  return got ? 0 : ENOMEM;
}
