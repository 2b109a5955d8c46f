// Works around a race in Mesa's llvmpipe (22.3 and the main branch of 2026). Its last drawing
// thread marks a scene as complete while it still holds the mutex of the scene's fence. Another
// thread reads the mark without the mutex and may free the fence. The drawing thread's unlock then
// writes 0 into freed memory, and a later allocation crashes.
//
// A program's own function of this name is used instead of the C library's, also by libraries that
// are loaded later. It waits until the thread inside the mutex has left; otherwise it does the
// same.

#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>
#include <ctime>

namespace {

// POSIX does not define the destruction of a locked mutex. A library that does it by mistake must
// not wait forever.
constexpr std::time_t kLongestWait_s = 1;

using Destroy = int(pthread_mutex_t*);

}  // namespace

extern "C" int pthread_mutex_destroy(pthread_mutex_t* mutex) noexcept {
  static auto* const destroy =
      reinterpret_cast<Destroy*>(dlsym(RTLD_NEXT, "pthread_mutex_destroy"));
  int locked = pthread_mutex_trylock(mutex);
  if (locked == EBUSY) {
    timespec until{};
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += kLongestWait_s;
    locked = pthread_mutex_clocklock(mutex, CLOCK_MONOTONIC, &until);
  }
  if (locked == EOWNERDEAD) locked = pthread_mutex_consistent(mutex);
  if (locked == 0) pthread_mutex_unlock(mutex);
  return destroy(mutex);
}
