// A library for LD_PRELOAD that causes faults of the machine in one process and its children: jumps
// of the wall clock, a slow or full disk, and a lost GL context.
//
// STRATA_TEST_FAULTS names a file with a `struct Faults`, which a test changes while the process
// runs (faulty_libc.py). Without a fault, each function calls the function of the C library.
//
// A full disk refuses writes that make a file of the folder larger, as a real one does. Writes of
// stdio are not seen, because the C library does not call its own functions through a table.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

struct Faults {
  volatile int64_t clock_ns;        // is added to the wall clock
  volatile int64_t write_delay_us;  // of each write and sync of a file in the folder
  volatile int64_t disk_full;       // 1: files in the folder cannot grow
  volatile int64_t gl_losses;       // each increment is one loss of the GL context
  char folder[992];
};

static const struct Faults kNone;
static const struct Faults* faults = &kNone;
static int64_t gl_losses_seen;

typedef void* (*Dlsym)(void*, const char*);

static Dlsym next_dlsym(void) {
  static Dlsym found;
  // the versions of x86-64 and arm64, newest first
  static const char* const versions[] = {"GLIBC_2.34", "GLIBC_2.17", "GLIBC_2.2.5"};
  for (unsigned i = 0; !found && i < sizeof versions / sizeof versions[0]; ++i)
    found = (Dlsym)dlvsym(RTLD_NEXT, "dlsym", versions[i]);
  if (!found) abort();
  return found;
}

// The next definition of a function, which is the one of the C library.
#define NEXT(name)                                                                     \
  ({                                                                                   \
    static __typeof__(&name) next_##name;                                              \
    if (!next_##name) next_##name = (__typeof__(&name))next_dlsym()(RTLD_NEXT, #name); \
    next_##name;                                                                       \
  })

__attribute__((constructor)) static void open_faults(void) {
  const char* path = getenv("STRATA_TEST_FAULTS");
  const int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  if (file < 0) return;
  void* at = mmap(NULL, sizeof(struct Faults), PROT_READ, MAP_SHARED, file, 0);
  close(file);
  if (at == MAP_FAILED) return;
  faults = at;
  gl_losses_seen = faults->gl_losses;
}

// --- the wall clock

static int64_t nanoseconds(int64_t seconds, int64_t rest) { return seconds * 1000000000 + rest; }

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int result = NEXT(clock_gettime)(clock, now);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) {
    const int64_t moved = nanoseconds(now->tv_sec, now->tv_nsec) + faults->clock_ns;
    now->tv_sec = moved / 1000000000;
    now->tv_nsec = moved % 1000000000;
  }
  return result;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  const int result = NEXT(gettimeofday)(now, zone);
  if (result == 0) now->tv_sec += faults->clock_ns / 1000000000;
  return result;
}

time_t time(time_t* result) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (result) *result = now.tv_sec;
  return now.tv_sec;
}

// --- the disk

static int is_in_folder(int file) {
  char link[32], path[PATH_MAX];
  const size_t length = strlen(faults->folder);
  strcpy(link, "/proc/self/fd/");
  char* end = link + strlen(link);
  char digits[12];
  int count = 0;
  for (int rest = file; rest > 0 || count == 0; rest /= 10) digits[count++] = '0' + rest % 10;
  while (count > 0) *end++ = digits[--count];
  *end = '\0';
  const ssize_t size = readlink(link, path, sizeof path - 1);
  if (size < 0 || (size_t)size <= length) return 0;
  return memcmp(path, faults->folder, length) == 0 && path[length] == '/';
}

// Returns 0, or -1 and ENOSPC if the write must fail. `offset` is -1 at the current position.
static int before_write(int file, int64_t offset, size_t size) {
  if (!faults->write_delay_us && !faults->disk_full) return 0;
  const int before = errno;
  struct stat facts;
  if (file < 0 || fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode) || !is_in_folder(file)) {
    errno = before;
    return 0;
  }
  if (faults->disk_full) {
    if (offset < 0)
      offset = fcntl(file, F_GETFL) & O_APPEND ? facts.st_size : lseek(file, 0, SEEK_CUR);
    if (offset + (int64_t)size > facts.st_size) {
      errno = ENOSPC;
      return -1;
    }
  }
  if (faults->write_delay_us) usleep((useconds_t)faults->write_delay_us);
  errno = before;
  return 0;
}

static size_t size_of(const struct iovec* parts, int count) {
  size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  return size;
}

ssize_t write(int file, const void* bytes, size_t size) {
  return before_write(file, -1, size) ? -1 : NEXT(write)(file, bytes, size);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  return before_write(file, -1, size_of(parts, count)) ? -1 : NEXT(writev)(file, parts, count);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset) {
  return before_write(file, offset, size) ? -1 : NEXT(pwrite)(file, bytes, size, offset);
}

ssize_t pwritev(int file, const struct iovec* parts, int count, off_t offset) {
  return before_write(file, offset, size_of(parts, count))
             ? -1
             : NEXT(pwritev)(file, parts, count, offset);
}

int posix_fallocate(int file, off_t offset, off_t size) {
  return before_write(file, offset, (size_t)size) ? ENOSPC
                                                  : NEXT(posix_fallocate)(file, offset, size);
}

// off_t has 64 bits on all machines of the tests
ssize_t pwrite64(int, const void*, size_t, off_t) __attribute__((alias("pwrite")));
ssize_t pwritev64(int, const struct iovec*, int, off_t) __attribute__((alias("pwritev")));
int posix_fallocate64(int, off_t, off_t) __attribute__((alias("posix_fallocate")));

int fsync(int file) { return before_write(file, 0, 0) ? -1 : NEXT(fsync)(file); }

int fdatasync(int file) { return before_write(file, 0, 0) ? -1 : NEXT(fdatasync)(file); }

// --- the GL context. libepoxy gets all functions from eglGetProcAddress, which it gets from dlsym.

typedef void (*Function)(void);
typedef Function (*GetProcAddress)(const char*);
typedef unsigned (*ResetStatus)(void);

static GetProcAddress next_get_proc_address;
static ResetStatus next_reset_status;

static unsigned reset_status(void) {
  const int64_t losses = faults->gl_losses;
  if (losses != gl_losses_seen) {
    gl_losses_seen = losses;
    return 0x8255;  // GL_UNKNOWN_CONTEXT_RESET
  }
  return next_reset_status();
}

static Function get_proc_address(const char* name) {
  const Function found = next_get_proc_address(name);
  static const char kName[] = "glGetGraphicsResetStatus";  // also with KHR, ARB or EXT at the end
  if (!found || strncmp(name, kName, sizeof kName - 1) != 0) return found;
  next_reset_status = (ResetStatus)found;
  return (Function)reset_status;
}

// The last statement must become a jump (-O2), because the result of RTLD_NEXT depends on the
// caller.
void* dlsym(void* restrict handle, const char* restrict name) {
  if (strcmp(name, "eglGetProcAddress") == 0) {
    next_get_proc_address = (GetProcAddress)next_dlsym()(handle, name);
    return next_get_proc_address ? (void*)get_proc_address : NULL;
  }
  return next_dlsym()(handle, name);
}
