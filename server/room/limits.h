#pragma once

namespace strata::room {

constexpr int kMaxViews = 4;  // per participant

}  // namespace strata::room
