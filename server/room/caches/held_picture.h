#pragma once

#include "core/memory_ledger.h"
#include "media/picture.h"

namespace strata::room {

// A decoded image, and the memory that is reserved for it and for halving it.
struct HeldPicture {
  Picture picture;
  MemoryLedger::Share memory;
};

}  // namespace strata::room
