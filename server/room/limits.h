#pragma once

namespace strata::room {

constexpr int kMaxViews = 4;  // of one participant

}  // namespace strata::room
