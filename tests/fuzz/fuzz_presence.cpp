// Fuzzes the reader of lists of people that nodes send each other. A list that was read must stay
// the same when it is sent again.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "room/presence_message.h"
#include "store/nodes/presence_channel.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

bool is_same(const room::Presence& a, const room::Presence& b) {
  if (a.pointer.has_value() != b.pointer.has_value()) return false;
  const bool same_pointer = !a.pointer || (a.pointer->position == b.pointer->position &&
                                           a.pointer->radius == b.pointer->radius);
  return same_pointer && a.session == b.session && a.user == b.user && a.full_name == b.full_name &&
         a.color == b.color && a.leading == b.leading && a.following == b.following &&
         a.camera == b.camera;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto message = room::parse_presence({reinterpret_cast<const char*>(data), size});
  if (!message) {
    demand(!is_server_failure(message.error().code) && !message.error().title.empty());
    return 0;
  }
  demand(message->part >= 0 && message->part < message->parts);
  demand(message->parts <= room::kMaxPresenceParts);
  std::size_t received = 0;
  for (const auto& text : room::presence_texts(message->node, message->model, message->people)) {
    demand(text.size() <= store::PresenceChannel::kMaxBytes);
    const auto again = room::parse_presence(text);
    demand(again.has_value());
    for (const room::Presence& person : again->people)
      demand(received < message->people.size() && is_same(person, message->people[received++]));
  }
  demand(received == message->people.size());
  return 0;
}
