#pragma once

namespace strata::net {

// WebSocket close codes (RFC 6455).
constexpr int kCloseGoingAway = 1001;
constexpr int kClosePolicy = 1008;
constexpr int kCloseTryAgain = 1013;

}  // namespace strata::net
