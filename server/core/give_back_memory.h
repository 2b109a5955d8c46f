#pragma once

#include <malloc.h>

namespace strata {

// Long work and leaving viewers leave a gigabyte of small freed pieces in the allocator's lists,
// which keeps them for the process; the system can use them. Takes tens of milliseconds a gigabyte,
// in which other threads may wait for memory.
inline void give_back_memory() { ::malloc_trim(0); }

}  // namespace strata
