#include "net/serialization/as_of.h"

#include <charconv>

#include "core/text/timestamp.h"
#include "net/api/addressed.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::net {

std::optional<protocol::At> as_of(const Request& request) {
  const auto found = request.query.find("at");
  if (found == request.query.end()) return std::nullopt;
  const std::string& text = found->second;
  std::int64_t sequence = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sequence);
  if (error == std::errc() && end == text.data() + text.size()) return sequence;
  return text;
}

Result<std::optional<std::int64_t>> find_sequence(const RouteContext& context,
                                                  const room::Room& room,
                                                  const std::optional<protocol::At>& at) {
  if (!at) return std::nullopt;
  if (const auto* sequence = std::get_if<std::int64_t>(&*at)) {
    if (*sequence >= 0 && *sequence <= room.edits().sequence()) return *sequence;
    return fail(ErrorCode::invalid, "Sequence out of range",
                "`at` must be a sequence from 0 to " + std::to_string(room.edits().sequence()) +
                    ", the newest sequence of this model.",
                "at");
  }
  const auto utc = utc_timestamp(std::get<std::string>(*at));
  if (!utc)
    return fail(ErrorCode::invalid, "Invalid time",
                "`at` must be a sequence of the model or a time such as 2026-05-04T12:00:00Z. "
                "Write the + of a time zone as %2B.",
                "at");
  auto sequence = context.store.journal().sequence_at(room.model().id, *utc);
  if (!sequence) return tl::unexpected(sequence.error());
  return *sequence;
}

Result<LayerQuery> LayerQuery::from(const RouteContext& context, const Request& request) {
  auto room = STRATA_TRY(open_room(context, request));
  auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  const auto at = STRATA_TRY(find_sequence(context, *room, as_of(request)));
  const auto sequence = at.value_or(room->edits().sequence());
  return LayerQuery{std::move(room), std::move(layer), at, sequence};
}

}  // namespace strata::net
