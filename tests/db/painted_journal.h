#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "core/text/timestamp.h"
#include "db/journal_painter.h"
#include "domain/layers/mask_texels.h"
#include "store/content/layers.h"
#include "store/journal/journal_merger.h"
#include "store/journal/journal_reads.h"
#include "store/nodes/nodes.h"

// A journal that several people paint, with the data that it must return.
namespace strata::test {

using namespace std::chrono_literals;
using namespace store;

// The texels that an edit wrote into a tile, recorded independently of the journal.
struct Written {
  TileMask mask;
  TileData after;
};
struct KnownEdit {
  std::int64_t sequence = 0;
  Uuid id, stroke;
  std::string user;
  LayerId layer = 0;
  std::map<TileAddress, Written> written;
  std::int64_t undone_by = 0;  // 0: in force
  nlohmann::json answer;
  Review review = Review::none;
  std::int64_t reviewed_by = 0;
};

// Two layers that several people paint, and the data that the journal must return for them.
class Painted {
 public:
  using Clock = std::chrono::system_clock;
  using Content = Painter::Content;

  // The first edit has the time `begin`, and each later one is `step` younger.
  Painted(Store& store, ModelId model, unsigned seed, Clock::time_point begin = Clock::now() - 24h,
          std::chrono::seconds step = 1s)
      : begin_(begin),
        step_(step),
        store_(store),
        model_(model),
        epoch_(store.nodes().begin_epoch(model).value()),
        random_(seed),
        writer_(store, {}) {
    for (const char* name : {"one", "two"})
      layers_.push_back(make_layer(store, model, ValueType::u8, name));
    for (const Layer& layer : layers_) states_[layer.id][0] = {};
  }

  bool has_reviews = true;

  // Saves `count` edits: batches of strokes, and sometimes a fill, an undo, a redo or a review.
  void paint(int count) {
    for (int i = 0; i < count; ++i) {
      // Usually the same person continues. Sometimes another person paints between the batches.
      if (pick(4) == 0) user_ = std::vector<std::string>{"Ada", "Ben", "Cleo"}[pick(3)];
      const std::string user = user_;
      const std::size_t layer = pick(2);
      switch (pick(20)) {
        case 0:
          end_stroke(user);
          write(layer, user, "fill", random_uuid());
          break;
        case 1:
        case 2:
          end_stroke(user);
          turn(layer, user, pick(3) == 0);
          break;
        case 3:
          if (has_reviews) review(layer, user);
          break;
        default: batch(user);
      }
    }
  }
  void end_all() {
    for (const char* user : {"Ada", "Ben", "Cleo"}) end_stroke(user);
  }

  // Called during an undo or redo, between two calls of the store. The merger can run there.
  enum class TurnStep { has_edits, has_tiles, is_computed };
  std::function<void(TurnStep)> in_turn;

  // Undoes the newest edit of the user, or redoes the last undo, as a room does.
  bool turn(std::size_t index, const std::string& user, bool redoes) {
    const Layer& layer = layers_[index];
    auto& journal = store_.journal();
    const auto edits = redoes ? journal.redoable(layer.id, user).value()
                              : journal.undoable(layer.id, user).value();
    if (edits.empty()) return false;
    if (in_turn) in_turn(TurnStep::has_edits);
    auto entry = this->entry(layer, redoes ? "redo" : "undo", user, random_uuid());
    change(layer, edits, entry, [&](PastRevision& revision) { revision.in_force = redoes; });
    (redoes ? entry.enable : entry.disable) = edits;
    // A merged edit has the sequence of its last batch, and represents all of its batches.
    const KnownEdit last = *std::ranges::find(known_, edits.back(), &KnownEdit::sequence);
    for (KnownEdit& known : known_)
      if (known.layer == layer.id && known.user == user && known.stroke == last.stroke &&
          known.undone_by == last.undone_by)
        known.undone_by = redoes ? 0 : entry.sequence;
    if (in_turn) in_turn(TurnStep::is_computed);
    submit(std::move(entry), layer, {});
    return true;
  }

  // Makes a random decision about the strokes of a user, or about one of them, as a room does.
  void review(std::size_t index, const std::string& user) {
    const Layer& layer = layers_[index];
    const Decision decision =
        std::vector{Decision::accept, Decision::reject, Decision::reopen}[pick(3)];
    Reviewees which;
    which.user = user;
    if (pick(2) == 0) {
      // A client may name a batch that was merged since it has read the list.
      for (const KnownEdit& known : known_)
        if (known.layer == layer.id && known.user == user && pick(6) == 0 && which.edits.empty())
          which.edits.push_back(known.sequence);
    }
    const auto found = store_.journal().under_review(layer.id, decision, which);
    ASSERT_TRUE(found) << found.error().detail;
    if (found->edits.empty()) return;
    for (const auto& edit : found->edits) end_stroke(edit.user);
    const bool reopens = decision == Decision::reopen;
    std::vector<std::int64_t> edits;
    for (const auto& edit : found->edits) edits.push_back(edit.sequence);
    auto entry = this->entry(layer, std::string(name(decision)), "Dora", random_uuid());
    change(layer, edits, entry, [&](PastRevision& revision) {
      if (decision != Decision::accept) revision.in_force = reopens;
      revision.provisional = reopens;
    });
    if (decision != Decision::accept) (reopens ? entry.enable : entry.disable) = edits;
    entry.reviewed = {edits, outcome(decision)};
    for (const std::int64_t sequence : edits) {
      const KnownEdit last = *std::ranges::find(known_, sequence, &KnownEdit::sequence);
      for (KnownEdit& known : known_) {
        if (known.layer != layer.id || known.user != last.user || known.stroke != last.stroke ||
            known.undone_by != last.undone_by || known.review != last.review ||
            known.reviewed_by != last.reviewed_by)
          continue;
        if (decision != Decision::accept) known.undone_by = reopens ? 0 : entry.sequence;
        known.review = outcome(decision);
        known.reviewed_by = reopens ? 0 : entry.sequence;
      }
    }
    submit(std::move(entry), layer, {});
  }

  // Compares one of `every` of the states that must be exact, and some pairs of states.
  void check_states(int every = 1) {
    std::set<std::int64_t> exact = ends();
    exact.insert(named_.begin(), named_.end());
    for (const Layer& layer : layers_) {
      for (const std::int64_t at : exact) {
        if (pick(every) != 0) continue;
        const auto found = store_.journal().load_tiles(layer, at);
        ASSERT_TRUE(found) << found.error().detail;
        ASSERT_TRUE(content_of(*found) == state(layer.id, at)) << "at " << at;
      }
      const auto newest = store_.journal().load_tiles(layer).value();
      ASSERT_TRUE(content_of(newest) == contents_[layer.id]);
      for (const auto& near : near_)
        if (near.layer == layer.id)
          for (int i = 0; i < 3; ++i) {
            const std::int64_t at = *std::next(exact.begin(), pick(static_cast<int>(exact.size())));
            const auto found = store_.journal().load_tiles_near(layer, at, near.state).value();
            ASSERT_TRUE(content_of(found) == state(layer.id, at))
                << "at " << at << " from " << near.state.sequence;
          }
    }
  }

  // After thinning: the states up to `through` at the end of each period and the named states, and
  // all states after `through`, are exact. Another state is exact or no longer available.
  void check_thinned(std::int64_t through,
                     const std::function<std::int64_t(Clock::time_point)>& period, int every = 1) {
    std::set<std::int64_t> exact(named_.begin(), named_.end());
    std::int64_t gone = 0;
    for (std::int64_t at = 0; at <= sequence_; ++at)
      if (at >= through || period(time_of(at)) != period(time_of(at + 1))) exact.insert(at);
    const std::set<std::int64_t> ends = this->ends();
    for (const Layer& layer : layers_) {
      for (const std::int64_t at : ends) {
        if (pick(every) != 0) continue;
        const auto found = store_.journal().load_tiles(layer, at);
        if (!found) {
          ASSERT_EQ(found.error().code, ErrorCode::gone) << found.error().detail;
          ASSERT_FALSE(exact.contains(at)) << "at " << at;
          ++gone;
          continue;
        }
        ASSERT_TRUE(content_of(*found) == state(layer.id, at)) << "at " << at;
        for (const auto& near : near_) {
          if (near.layer != layer.id) continue;
          const auto same = store_.journal().load_tiles_near(layer, at, near.state).value();
          ASSERT_TRUE(content_of(same) == state(layer.id, at))
              << "at " << at << " from " << near.state.sequence;
        }
      }
      ASSERT_TRUE(content_of(store_.journal().load_tiles(layer).value()) == contents_[layer.id]);
    }
    if (every == 1) {
      EXPECT_GT(gone, 0);
    }
    // The state at a time is the last one before it that is still available.
    for (std::int64_t at = 1; at <= sequence_; at += 7) {
      const auto found = store_.journal().sequence_at(model_, utc_text(time_of(at))).value();
      ASSERT_LE(found, at);
      ASSERT_TRUE(store_.journal().layer_sequences(model_, found)) << "at " << found;
      if (exact.contains(at) && ends.contains(at)) {
        EXPECT_EQ(found, at);
      }
    }
  }

  // Every texel shows the newest edit in force that wrote it.
  void check_rule() {
    for (const Layer& layer : layers_) {
      Content expected;
      for (const KnownEdit& edit : known_)
        if (edit.layer == layer.id && edit.undone_by == 0)
          for (const auto& [tile, written] : edit.written) {
            TileData content = expected.contains(tile) ? expected.at(tile) : TileData(layer.type);
            copy_texels(written.after, written.mask, content);
            put(expected, tile, std::move(content));
          }
      ASSERT_TRUE(contents_[layer.id] == expected);
    }
  }

  // The texels that show an edit that waits for review, as a room reads them.
  void check_provisional() {
    for (const Layer& layer : layers_) {
      std::map<TileAddress, TileMask> expected, found;
      std::vector<std::int64_t> waiting;
      for (const KnownEdit& edit : known_)
        if (edit.layer == layer.id && edit.undone_by == 0)
          for (const auto& [tile, written] : edit.written)
            for (int w = 0; w < kMaskWords; ++w) {
              std::uint64_t& word = expected[tile].words[w];
              if (edit.review == Review::pending)
                word |= written.mask.words[w];
              else
                word &= ~written.mask.words[w];
            }
      std::erase_if(expected, [](const auto& tile) { return !tile.second.any(); });
      const auto under_review = store_.journal().under_review(layer.id, Decision::accept, {});
      for (const auto& edit : under_review.value().edits) waiting.push_back(edit.sequence);
      const auto written_tiles = store_.journal().written_by(layer, waiting).value();
      for (const auto& [tile, texels] : written_tiles) {
        std::optional<TileResolver> resolver;
        ASSERT_TRUE(store_.journal().tile_past(
            layer, tile, [&] { resolver.emplace(TileData(layer.type), texels); },
            [&](PastRevision& revision) {
              resolver->add(revision);
              return resolver->is_open();
            }));
        if (resolver->provisional().any()) found[tile] = resolver->provisional();
      }
      ASSERT_TRUE(found == expected);
    }
  }

  // Every edit is in the journal once, with its first response and its state.
  void check_ids() {
    std::vector<Uuid> ids;
    for (const KnownEdit& edit : known_) ids.push_back(edit.id);
    const auto found = store_.journal().state(model_, ids).value().known;
    ASSERT_EQ(found.size(), known_.size());
    std::map<Uuid, const JournalRow*> rows;
    for (const JournalRow& row : found) rows[row.id] = &row;
    for (const KnownEdit& edit : known_) {
      ASSERT_TRUE(rows.contains(edit.id));
      const JournalRow& row = *rows.at(edit.id);
      EXPECT_EQ(row.sequence, edit.sequence);
      EXPECT_EQ(row.user, edit.user);
      EXPECT_EQ(row.answer, edit.answer);
      if (row.op == "checkpoint") continue;
      EXPECT_EQ(row.stroke, edit.stroke);
      EXPECT_EQ(row.in_force, edit.undone_by == 0);
      EXPECT_EQ(row.review, edit.review);
    }
  }

  // Keeps the present states, which may contain a part of a stroke, to load others from them.
  void keep_near() {
    for (const Layer& layer : layers_)
      near_.push_back({layer.id, store_.journal().load_tiles(layer).value()});
  }
  void name_state() { named_.push_back(sequence_); }
  const std::vector<Layer>& layers() const { return layers_; }

  Result<JournalMerger::Done> merge(JournalMerger& merger, Clock::time_point ended_before) {
    return merger.merge(model_, epoch_, ended_before, [] { return true; });
  }
  Clock::time_point time() const { return time_of(sequence_); }
  Clock::time_point time_of(std::int64_t sequence) const { return begin_ + sequence * step_; }
  // Of the newest saved edit. May be called on any thread.
  Clock::time_point time_of_saved() const { return time_of(saved_.load()); }
  std::int64_t sequence() const { return sequence_; }
  std::int64_t epoch() const { return epoch_; }
  // Claims the model again, as another server would. Later edits have the new epoch.
  void claim_again() { epoch_ = store_.nodes().begin_epoch(model_).value(); }

 private:
  static constexpr int kTiles = 2;  // a layer has kTiles × kTiles painted tiles

  struct OpenStroke {
    Uuid id;
    std::size_t layer = 0;
    int n = 0;
    std::uint32_t bits = 0;
    double x = 0;
    bool waits = false;  // for review
  };
  struct Near {
    LayerId layer = 0;
    TileMirror::Snapshot state;
  };

  std::size_t pick(int below) { return random_() % static_cast<unsigned>(below); }
  static void put(Content& content, TileAddress tile, TileData after) {
    if (after.valid.any())
      content[tile] = std::move(after);
    else
      content.erase(tile);
  }
  const Content& state(LayerId layer, std::int64_t at) {
    return std::prev(states_[layer].upper_bound(at))->second;
  }
  // Sequences at which strokes and other edits end.
  std::set<std::int64_t> ends() const {
    std::map<Uuid, std::int64_t> last;
    for (const auto& [sequence, stroke] : stroke_of_) last[stroke] = sequence;
    std::set<std::int64_t> found{0};
    for (const auto& [stroke, sequence] : last) found.insert(sequence);
    return found;
  }

  // Adds the revisions that the texels of the edits get after `turn` has changed their state.
  void change(const Layer& layer, const std::vector<std::int64_t>& edits, JournalEntry& entry,
              const std::function<void(PastRevision&)>& turn) {
    auto& journal = store_.journal();
    Content& content = contents_[layer.id];
    const auto written = journal.written_by(layer, edits).value();
    if (in_turn) in_turn(TurnStep::has_tiles);
    for (const auto& [tile, texels] : written) {
      const TileData before = content.contains(tile) ? content.at(tile) : TileData(layer.type);
      std::optional<TileResolver> resolver;
      EXPECT_TRUE(journal.tile_past(
          layer, tile, [&] { resolver.emplace(before, texels); },
          [&](PastRevision& revision) {
            if (std::ranges::binary_search(edits, revision.sequence)) turn(revision);
            resolver->add(revision);
            return true;
          }));
      TileData after = std::move(*resolver).finish();
      if (after == before) continue;
      entry.revisions.push_back(
          {tile, encode_revision(make_revision(tile, before, after, texels)), {}});
      put(content, tile, std::move(after));
    }
  }

  JournalEntry entry(const Layer& layer, const std::string& op, const std::string& user,
                     const Uuid& stroke) {
    JournalEntry entry;
    entry.model_id = model_;
    entry.layer_id = layer.id;
    entry.sequence = ++sequence_;
    entry.epoch = epoch_;
    entry.id = random_uuid();
    entry.stroke = stroke;
    entry.user = user;
    entry.op = op;
    entry.record = {{"op", op}};
    entry.answer = {{"sequence", sequence_}, {"texels_changed", sequence_ % 7}, {"area_m2", 0.25}};
    entry.time = time();
    return entry;
  }

  void end_stroke(const std::string& user) { open_.erase(user); }

  void batch(const std::string& user) {
    if (pick(8) == 0) end_stroke(user);
    auto [open, is_new] = open_.try_emplace(user);
    if (is_new)
      open->second = {random_uuid(),
                      pick(2),
                      0,
                      1 + static_cast<std::uint32_t>(pick(90)),
                      0,
                      pick(2) == 0 && has_reviews};
    OpenStroke& stroke = open->second;
    write(stroke.layer, user, "stroke", stroke.id, &stroke);
  }

  void write(std::size_t index, const std::string& user, const std::string& op, const Uuid& stroke,
             OpenStroke* open = nullptr) {
    const Layer& layer = layers_[index];
    auto entry = this->entry(layer, op, user, open ? stroke : Uuid{});
    if (open) {
      entry.record["value"] = open->bits;
      entry.record["n"] = open->n;
      entry.record["path"] = {{open->x, 1.5}, {open->x + 3, 1.5}};
      ++open->n;
      open->x += 3;
    } else {
      entry.stroke = entry.id;
    }
    KnownEdit known{entry.sequence, entry.id, entry.stroke, user, layer.id, {}, 0, entry.answer,
                    Review::none,   0};
    if (open ? open->waits : pick(3) == 0 && has_reviews)
      known.review = entry.review = Review::pending;
    const std::uint32_t bits = open ? open->bits : 1 + static_cast<std::uint32_t>(pick(90));
    const bool erases = !open && pick(4) == 0;
    Content& content = contents_[layer.id];
    for (std::size_t n = 1 + pick(3); n > 0; --n) {
      const TileAddress tile{static_cast<std::uint16_t>(pick(kTiles)),
                             static_cast<std::uint16_t>(pick(kTiles))};
      if (known.written.contains(tile)) continue;
      const TileData before = content.contains(tile) ? content.at(tile) : TileData(layer.type);
      Written written{{}, before};
      const int x0 = static_cast<int>(pick(90)), y0 = static_cast<int>(pick(90)),
                size = 1 + static_cast<int>(pick(37));
      for (int y = y0; y < y0 + size; ++y)
        for (int x = x0; x < x0 + size; ++x) {
          written.mask.set(y * kTileSize + x);
          if (erases)
            written.after.clear(y * kTileSize + x);
          else
            written.after.write(y * kTileSize + x, bits);
        }
      if (written.after == before) continue;  // the journal has no revision without a change
      JournalEntry::Revision revision{
          tile, encode_revision(make_revision(tile, before, written.after, written.mask)), {}};
      if (++revisions_[{layer.id, tile}] % 9 == 0) revision.key_tile = encode_tile(written.after);
      entry.revisions.push_back(std::move(revision));
      put(content, tile, written.after);
      known.written.emplace(tile, std::move(written));
    }
    submit(std::move(entry), layer, std::move(known));
  }

  void submit(JournalEntry entry, const Layer& layer, std::optional<KnownEdit> known) {
    stroke_of_[entry.sequence] = known ? entry.stroke : entry.id;
    states_[layer.id][entry.sequence] = contents_[layer.id];
    if (known) known_.push_back(std::move(*known));
    const auto saved = test::save(writer_, std::move(entry));
    ASSERT_TRUE(saved) << saved.error().detail;
    saved_ = sequence_;
  }

  const Clock::time_point begin_;
  const std::chrono::seconds step_;
  Store& store_;
  const ModelId model_;
  std::int64_t epoch_;
  std::mt19937 random_;
  std::string user_ = "Ada";
  JournalWriter writer_;
  std::vector<Layer> layers_;
  std::int64_t sequence_ = 0;
  std::atomic<std::int64_t> saved_ = 0;     // the newest sequence that the journal has
  std::map<std::string, OpenStroke> open_;  // by user
  std::vector<KnownEdit> known_;            // without undos and redos
  std::map<std::int64_t, Uuid> stroke_of_;  // of every edit
  std::map<LayerId, Content> contents_;
  std::map<LayerId, std::map<std::int64_t, Content>> states_;  // after each edit
  std::map<std::pair<LayerId, TileAddress>, int> revisions_;
  std::vector<Near> near_;
  std::vector<std::int64_t> named_;
};

}  // namespace strata::test
