// Mends a race in Mesa's llvmpipe (22.3 and the main branch of 2026). Its last drawing thread says
// that a scene is complete while it still holds the mutex of the scene's fence; whoever asks reads
// that without the mutex, and may free the fence. The unlock of the drawing thread then writes 0
// into freed memory, and a later allocation crashes.
//
// A program's own function of this name comes before that of the C library, also for libraries that
// it loads later. It lets the thread inside the mutex leave; otherwise it changes nothing.

#include <dlfcn.h>
#include <pthread.h>

#include <ctime>

namespace {

// POSIX does not define the destruction of a locked mutex: whoever does it by mistake must not wait
// forever.
constexpr std::time_t kLongestWait_s = 10;

using Destroy = int(pthread_mutex_t*);

}  // namespace

extern "C" int pthread_mutex_destroy(pthread_mutex_t* mutex) noexcept {
  static auto* const destroy =
      reinterpret_cast<Destroy*>(dlsym(RTLD_NEXT, "pthread_mutex_destroy"));
  timespec until{};
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_sec += kLongestWait_s;
  if (pthread_mutex_clocklock(mutex, CLOCK_MONOTONIC, &until) == 0) pthread_mutex_unlock(mutex);
  return destroy(mutex);
}
