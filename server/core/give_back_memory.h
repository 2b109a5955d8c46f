#pragma once

#include <malloc.h>

namespace strata {

// Returns freed memory to the system: after long work and after viewers leave, the allocator keeps
// up to a gigabyte in small pieces. Takes tens of milliseconds per gigabyte, in which other threads
// may wait for memory.
inline void give_back_memory() { ::malloc_trim(0); }

}  // namespace strata
