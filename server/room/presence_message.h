#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "room/participants.h"

namespace strata::room {

// A part of the list of people who look at a model at one node. Nodes send it to each other as text
// (store/nodes/presence_channel.h). The length of a text is limited, so a list can have several
// parts.
struct PresenceMessage {
  Uuid node;
  ModelId model = 0;
  int part = 0;   // position in the list, from 0
  int parts = 1;  // of the list
  std::vector<Presence> people;
};

inline constexpr int kMaxPresenceParts = 12;

// Returns the parts of the list, at least one. If the list needs more than kMaxPresenceParts,
// leaves out the last people.
std::vector<std::string> presence_texts(const Uuid& node, ModelId model,
                                        std::span<const Presence> people);

// Returns an error for any other text. Checks people in the same way as the messages of the live
// connection (protocol/messages). Ignores further members of the message and of the people, because
// a newer version may send them.
Result<PresenceMessage> parse_presence(std::string_view text);

}  // namespace strata::room
