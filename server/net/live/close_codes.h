#pragma once

namespace strata::net {

// WebSocket close codes. The first ones are those of RFC 6455. Codes from 4000 belong to the
// subprotocol.
constexpr int kCloseGoingAway = 1001;
constexpr int kClosePolicy = 1008;
constexpr int kCloseTryAgain = 1013;
constexpr int kCloseMoved = 4307;  // another node has the model; the message `moved` comes before

}  // namespace strata::net
