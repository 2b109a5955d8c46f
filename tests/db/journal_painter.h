#pragma once

#include <future>
#include <map>
#include <random>

#include "core/ids.h"
#include "domain/layers/revision.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/journal/journal_writer.h"
#include "support/test_cluster.h"

namespace strata::test {

inline Model make_model(store::Store& store, const std::string& name = "pot") {
  store::NewModel fresh;
  fresh.model.project_id = 1;
  fresh.model.name = name;
  fresh.geometry = {1, 2, 3};
  return store.models().create(fresh, {}).value();
}

inline Layer make_layer(store::Store& store, ModelId model_id, ValueType type = ValueType::u8,
                        const std::string& name = "layer") {
  Layer layer;
  layer.model_id = model_id;
  layer.name = name;
  layer.type = type;
  layer.palette = default_palette(type, false);
  return store.layers().create(layer).value();
}

// Paints a layer in memory, and makes the journal entries that a room would make.
class Painter {
 public:
  Painter(Layer layer, std::uint32_t seed, int key_every = 64)
      : layer_(std::move(layer)), random_(seed), key_every_(key_every) {}

  using Content = std::map<TileAddress, TileData>;  // only tiles with a valid texel

  store::JournalEntry entry(std::int64_t sequence, const std::string& op = "stroke",
                            const std::string& user = "Ada") const {
    store::JournalEntry entry;
    entry.model_id = layer_.model_id;
    entry.layer_id = layer_.id;
    entry.sequence = sequence;
    entry.id = random_uuid();
    entry.stroke = entry.id;
    entry.user = user;
    entry.op = op;
    entry.record = {{"op", op}, {"value", 0.1}, {"path", {{1.5, 2.25}, {3, 4}}}};
    entry.answer = {{"sequence", sequence}, {"texels_changed", 12}};
    entry.time = std::chrono::system_clock::now();
    return entry;
  }

  // Paints some random tiles: writes values, erases values, and writes values that do not change.
  store::JournalEntry paint(std::int64_t sequence, int tiles, int tile_range) {
    store::JournalEntry entry = this->entry(sequence);
    std::map<TileAddress, TileMask> touched;
    for (int i = 0; i < tiles; ++i) {
      const TileAddress address{pick(tile_range), pick(tile_range)};
      if (touched.contains(address)) continue;
      TileMask& written = touched[address];
      const auto current = content_.find(address);
      const TileData before = current == content_.end() ? TileData(layer_.type) : current->second;
      TileData after = before;
      const bool erase = random_() % 6 == 0;
      const int x0 = random_() % 100, y0 = random_() % 100, size = 1 + random_() % 28;
      const std::uint32_t bits = random_() & 0x7f;
      for (int y = y0; y < y0 + size; ++y)
        for (int x = x0; x < x0 + size; ++x) {
          const int texel = y * kTileSize + x;
          written.set(texel);
          if (erase)
            after.clear(texel);
          else
            after.write(texel, bits + (x == x0 ? random_() & 0x7f : 0));
        }
      entry.revisions.push_back(revision(address, before, after, written));
      if (after.valid.any())
        content_[address] = after;
      else
        content_.erase(address);
    }
    return entry;
  }

  store::JournalEntry::Revision revision(TileAddress address, const TileData& before,
                                         const TileData& after, const TileMask& written) {
    store::JournalEntry::Revision revision;
    revision.tile = address;
    revision.difference = encode_revision(make_revision(address, before, after, written));
    if (++revisions_of_[address] % key_every_ == 0) revision.key_tile = encode_tile(after);
    return revision;
  }

  const Content& content() const { return content_; }
  const Layer& layer() const { return layer_; }
  std::uint32_t random() { return random_(); }

 private:
  std::uint16_t pick(int range) { return static_cast<std::uint16_t>(random_() % range); }
  Layer layer_;
  std::mt19937 random_;
  int key_every_;
  Content content_;
  std::map<TileAddress, int> revisions_of_;
};

inline Painter::Content content_of(const TileMirror::Snapshot& snapshot) {
  Painter::Content content;
  for (const auto& [address, tile] : snapshot.tiles) content.emplace(address, *tile);
  return content;
}

// Submits the entry and waits for the result.
inline Result<void> save(store::JournalWriter& writer, store::JournalEntry entry) {
  auto answer = std::make_shared<std::promise<Result<void>>>();
  auto future = answer->get_future();
  if (!writer.submit(std::move(entry),
                     [answer](Result<void> result) { answer->set_value(std::move(result)); }))
    return fail(ErrorCode::unavailable, "Not accepted", "The writer takes no edits now.");
  return future.get();
}

}  // namespace strata::test
