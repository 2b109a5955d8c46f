// Works around a race in Mesa's llvmpipe (22.3, and the main branch of 2026). The last drawing
// thread marks a scene as complete while it still holds the mutex of the scene's fence. Another
// thread reads the mark without the mutex and may free the fence. The drawing thread then unlocks
// the mutex, which writes 0 into freed memory, and a later allocation crashes.
//
// If a program defines pthread_mutex_destroy, this function replaces the function of the C library,
// also for libraries that are loaded later. The function below waits until no thread holds the
// mutex. Then it calls the function of the C library.

#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>
#include <ctime>

namespace {

// POSIX does not define the destruction of a locked mutex. A library that destroys one by mistake
// must not wait forever.
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
