#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Sends events about the layer's comment threads after its visibility has changed. Participants who
// can no longer see the layer are notified that its threads are gone. Participants who can now see
// it receive the threads.
void tell_threads(const RouteContext& context, const Layer& layer, Visibility before,
                  const std::string& user);

// Sends the event of a comment that another node has created or changed. Reads the comment. Does
// nothing if it no longer exists.
Result<void> tell_comment(store::Store& store, LiveSockets& sockets,
                          protocol::CommentEventEvent event, CommentId id, const std::string& user);

// Sends the event of a deleted comment.
void tell_comment_deleted(LiveSockets& sockets, ModelId model, CommentId id,
                          const std::string& user);

}  // namespace strata::net
