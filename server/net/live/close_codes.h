#pragma once

namespace strata::net {

// WebSocket close codes. Codes below 4000 are from RFC 6455. Codes from 4000 belong to the
// subprotocol.
constexpr int kCloseGoingAway = 1001;
constexpr int kClosePolicy = 1008;
constexpr int kCloseTryAgain = 1013;
constexpr int kCloseMoved = 4307;  // another node has the model; sent after the message `moved`

}  // namespace strata::net
