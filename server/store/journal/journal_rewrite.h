#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/layers/tile.h"
#include "domain/layers/tile_segment.h"
#include "domain/layers/value_type.h"
#include "store/pg/pg.h"

// Parts of the transactions that replace rows of the journal, for JournalMerger and JournalThinner.
namespace strata::store {

using Statements = std::deque<PgConnection::Statement>;

// A rewrite can wait. Painting must not wait for it, also not while the rewrite has locked the
// model and waits for a row that a longer transaction has locked.
constexpr PgLimits kRewriteLimits{std::chrono::seconds(30), std::chrono::seconds(20),
                                  std::chrono::milliseconds(100)};

PgArray array_of(std::span<const std::int64_t> numbers);
// The number of a tile in `edits.tiles`.
std::int16_t number_of_tile(TileAddress tile);
TileAddress tile_of_number(std::int16_t number);
// Reads numbers of tiles that a query has joined with int2send.
std::vector<std::int16_t> read_tile_numbers(Bytes bytes);
// Reads y and x of a tile from the first two columns.
TileAddress address_of(const PgResult& rows, int i);

struct LayerState {
  ValueType type{};
  std::int64_t thinnings = 0;  // how often the thinner has replaced rows of the layer
};
// Returns nothing if the layer was deleted.
Result<std::optional<LayerState>> state_of(PgConnection& connection, LayerId layer);

// Begins a transaction whose commit need not be on disk immediately. If the server hangs, the
// database ends the transaction.
void begin_rewrite(Statements& out);
// Adds a query that returns a row if the thinner has not replaced rows of the layer since `state`
// was read. Must follow the statement that locks the layer.
void find_state(LayerId layer, const LayerState& state, Statements& out);

// Returns the error of a statement, or `conflict` if another transaction had locked a row: the
// rewrite is tried again later.
Error failed_statement(PgConnection& connection, Error problem);
// One damaged row must not stop the rewrites of all others. Writes it to the log, and returns other
// errors, after which the rewrite is tried again.
Result<void> skip_if_damaged(const Error& problem, const std::string& what);

// A segment of a tile in the stored format.
struct PackedSegment {
  TileAddress tile;
  std::vector<std::int64_t> sequences;  // of its revisions
  std::vector<std::uint8_t> content;
};
// Encodes a segment. Returns nothing if the format cannot contain it, or if the result does not
// contain the same revisions when it is decoded again.
std::optional<PackedSegment> pack(TileAddress tile, ValueType type, const TileSegment& segment);
void insert_segments(LayerId layer, std::span<const PackedSegment> segments, Statements& out);

}  // namespace strata::store
