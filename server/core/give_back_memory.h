#pragma once

#include <malloc.h>

namespace strata {

// Returns freed memory to the system. After long work, and after viewers leave, the allocator still
// holds up to a gigabyte in small pieces. The call takes tens of milliseconds per gigabyte, and
// other threads that allocate memory may wait for that time.
inline void give_back_memory() { ::malloc_trim(0); }

}  // namespace strata
