// The journal before and after its strokes are merged: the texels at the end of every stroke, undo
// and redo, the responses to edits that are sent again, and faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "db/journal_painter.h"
#include "domain/layers/mask_texels.h"
#include "domain/layers/tile_difference.h"
#include "store/content/layers.h"
#include "store/journal/journal_merger.h"
#include "store/journal/journal_reads.h"
#include "store/nodes/nodes.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::save;
using Content = test::Painter::Content;
using Clock = std::chrono::system_clock;

constexpr int kTiles = 2;  // a layer has kTiles × kTiles painted tiles

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
  Painted(Store& store, ModelId model, unsigned seed)
      : store_(store),
        model_(model),
        epoch_(store.nodes().begin_epoch(model).value()),
        random_(seed),
        writer_(store, {}) {
    for (const char* name : {"one", "two"})
      layers_.push_back(test::make_layer(store, model, ValueType::u8, name));
    for (const Layer& layer : layers_) states_[layer.id][0] = {};
  }

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
        case 3: review(layer, user); break;
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
      EXPECT_EQ(row.stroke, edit.stroke);
      EXPECT_EQ(row.answer, edit.answer);
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

  Result<JournalMerger::Done> merge(JournalMerger& merger, Clock::time_point ended_before) {
    return merger.merge(model_, epoch_, ended_before, [] { return true; });
  }
  Clock::time_point time() const { return kBegin + sequence_ * 1s; }
  // Of the newest saved edit. May be called on any thread.
  Clock::time_point time_of_saved() const { return kBegin + saved_.load() * 1s; }
  std::int64_t sequence() const { return sequence_; }
  std::int64_t epoch() const { return epoch_; }
  // Claims the model again, as another server would. Later edits have the new epoch.
  void claim_again() { epoch_ = store_.nodes().begin_epoch(model_).value(); }

 private:
  inline static const Clock::time_point kBegin = Clock::now() - 24h;

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
      open->second = {random_uuid(), pick(2), 0, 1 + static_cast<std::uint32_t>(pick(90)), 0,
                      pick(2) == 0};
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
    if (open ? open->waits : pick(3) == 0) known.review = entry.review = Review::pending;
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
    const auto saved = save(writer_, std::move(entry));
    ASSERT_TRUE(saved) << saved.error().detail;
    saved_ = sequence_;
  }

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

class Merger : public ::testing::Test {
 protected:
  std::int64_t count(const std::string& what) {
    return PgConnection::connect(dsn_)->query_once("SELECT count(*) FROM " + what)->integer(0, 0);
  }
  void run(const std::string& sql) { ASSERT_TRUE(PgConnection::connect(dsn_)->script(sql)); }
  void name_state(std::int64_t sequence) {
    run("INSERT INTO snapshots (model_id, slug, name, content, user_name) VALUES (" +
        to_string(model_.id) + ", 's', 's', '{\"sequence\": " + std::to_string(sequence) +
        "}', 'Ada')");
  }
  // Saves a stroke of some batches. Each of them paints another square into the same two tiles.
  // `states` gets the texels of the layer before the stroke and after each batch.
  void save_stroke(const Layer& layer, int batches, std::vector<Content>* states = nullptr) {
    JournalWriter writer(*store_, {});
    Content& content = contents_[layer.id];
    if (states) states->push_back(content);
    const Uuid stroke = random_uuid();
    for (int n = 0; n < batches; ++n) {
      JournalEntry entry = test::Painter(layer, 1).entry(++sequence_);
      entry.stroke = stroke;
      entry.record = {{"op", "stroke"}, {"n", n}, {"path", {{n, 1}, {n + 1, 1}}}};
      for (const TileAddress tile : {TileAddress{0, 0}, TileAddress{1, 0}}) {
        const TileData before = content.contains(tile) ? content.at(tile) : TileData(layer.type);
        TileMask written;
        TileData after = before;
        for (int texel = 0; texel < 9; ++texel) {
          written.set(static_cast<int>(100 * sequence_) % kTexelsPerTile + texel);
          after.write(static_cast<int>(100 * sequence_) % kTexelsPerTile + texel,
                      1 + static_cast<std::uint32_t>(sequence_ % 99));
        }
        entry.revisions.push_back(
            {tile, encode_revision(make_revision(tile, before, after, written)), {}});
        content[tile] = std::move(after);
      }
      ASSERT_TRUE(save(writer, std::move(entry)));
      if (states) states->push_back(content);
    }
  }
  // Merges all strokes, because enough time has passed. A merger that has just started also packs
  // layers with few new revisions.
  void merge_all(Painted& painted) {
    JournalMerger merger(store_->journal());
    const auto done = painted.merge(merger, painted.time() + 1h);
    ASSERT_TRUE(done) << done.error().detail;
  }
  void check_all(Painted& painted, int every = 1) {
    painted.check_states(every);
    painted.check_ids();
    painted.check_rule();
    painted.check_provisional();
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Model model_ = test::make_model(*store_);
  JournalMerger merger_{store_->journal()};
  std::int64_t sequence_ = 0;
  std::map<LayerId, Content> contents_;  // of save_stroke
};

TEST_F(Merger, random_journals_give_the_same_texels_and_responses) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const Model model = test::make_model(*store_, "pot " + std::to_string(seed));
    Painted painted(*store_, model.id, seed);
    for (int part = 0; part < 4; ++part) {
      painted.paint(110);
      painted.keep_near();
      if (part == 1) {
        painted.name_state();
        run("INSERT INTO snapshots (model_id, slug, name, content, user_name) VALUES (" +
            to_string(model.id) +
            ", 's', 's', '{\"sequence\": " + std::to_string(painted.sequence()) + "}', 'Ada')");
      }
      // While people paint, only strokes that have ended are merged.
      ASSERT_TRUE(painted.merge(merger_, painted.time() - 20s));
      check_all(painted, 4);
      if (HasFatalFailure()) return;
    }
    painted.end_all();
    merge_all(painted);
    check_all(painted);
    if (HasFatalFailure()) return;
    // Merging again changes nothing.
    const auto again = painted.merge(merger_, painted.time() + 1h);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->edits + again->revisions, 0);
    // Undo and redo of merged and packed edits.
    for (int i = 0; i < 60; ++i) {
      const std::string user = std::vector<std::string>{"Ada", "Ben", "Cleo"}[i % 3];
      painted.turn(static_cast<std::size_t>(i / 3) % 2, user, i % 7 == 0);
      if (i % 10 == 0) painted.check_rule();
      if (HasFatalFailure()) return;
    }
    merge_all(painted);
    check_all(painted);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(count("edit_batches"), 50);
  EXPECT_GT(count("tile_segments"), 4);
}

TEST_F(Merger, a_long_journal_is_merged_in_several_windows) {
  Painted painted(*store_, model_.id, 11);
  painted.paint(420);
  painted.end_all();
  JournalMerger merger(store_->journal(), 130);
  int windows = 0;
  for (bool more = true; more; ++windows) {
    ASSERT_LT(windows, 40);
    const auto done = painted.merge(merger, painted.time() + 1h);
    ASSERT_TRUE(done) << done.error().detail;
    more = done->more;
    check_all(painted, 4);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(windows, 3);
  EXPECT_GT(count("edit_batches"), 50);
  check_all(painted);
}

TEST_F(Merger, a_stroke_becomes_one_edit_with_the_whole_path_and_the_sums) {
  test::Painter painter(test::make_layer(*store_, model_.id), 4);
  const Uuid stroke = random_uuid();
  std::vector<JournalEntry> entries;
  {
    JournalWriter writer(*store_, {});
    for (int n = 0; n < 4; ++n) {
      auto entry = painter.paint(n + 1, 2, 2);
      entry.stroke = stroke;
      entry.record = {{"op", "stroke"}, {"value", 7}, {"n", n}, {"path", {{n, 1}, {n + 1, 1}}}};
      if (n > 1) entry.record["widths"] = {1, 0.5};
      entry.answer = {{"sequence", n + 1}, {"texels_changed", 10 * n}, {"area_m2", 0.5}};
      entries.push_back(entry);
      ASSERT_TRUE(save(writer, std::move(entry)));
    }
  }
  const auto strokes = [&] {
    return store_->journal().timeline(model_.id, {{painter.layer().id}, {}, {}, 1})->edits;
  };
  EXPECT_EQ(strokes(), 1);
  const auto done = merger_.merge(model_.id, store_->journal().state(model_.id, {})->epoch,
                                  Clock::now() + 1h, [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->edits, 3);
  EXPECT_EQ(strokes(), 1);
  const auto history = store_->journal().history(painter.layer().id, 10, 0).value();
  ASSERT_EQ(history.total, 1);
  const JournalRow& row = history.rows.at(0);
  EXPECT_EQ(row.sequence, 4);
  EXPECT_EQ(row.id, entries.back().id);
  EXPECT_LT(std::chrono::abs(row.time - entries.back().time), 1us);
  EXPECT_EQ(row.answer,
            (nlohmann::json{{"sequence", 4}, {"texels_changed", 60}, {"area_m2", 2.0}}));
  // Lists do not read the path.
  EXPECT_EQ(row.record, (nlohmann::json{{"op", "stroke"}, {"value", 7}, {"n", 3}}));
  const auto whole = store_->journal().state(model_.id, std::vector{row.id}).value().known;
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].record,
            (nlohmann::json{{"op", "stroke"},
                            {"value", 7},
                            {"n", 3},
                            {"path", {{0, 1}, {1, 1}, {2, 1}, {3, 1}, {3, 1}, {4, 1}}},
                            {"widths", {1, 1, 1, 0.5, 1, 0.5}}}));
  EXPECT_TRUE(content_of(store_->journal().load_tiles(painter.layer()).value()) ==
              painter.content());
  const auto steps = store_->journal().timeline_steps(model_.id, {painter.layer().id}, 9, true, 5);
  ASSERT_EQ(steps->steps.size(), 1u);
  EXPECT_EQ(steps->steps[0].first, 1);
  EXPECT_EQ(steps->steps[0].last, 4);
  EXPECT_EQ(steps->steps[0].texels, 60u);
}

// A person names a state in the middle of a stroke after the merger has read the journal.
TEST_F(Merger, a_state_that_is_named_during_a_merge_stays_exact) {
  std::vector<Content> states;
  const Layer layer = test::make_layer(*store_, model_.id);
  save_stroke(layer, 4, &states);
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto merge = [&](const JournalMerger::Continue& go_on) {
    return merger_.merge(model_.id, epoch, Clock::now() + 1h, go_on);
  };
  bool is_named = false;
  const auto disturbed = merge([&] {
    if (!std::exchange(is_named, true)) name_state(2);
    return true;
  });
  ASSERT_TRUE(is_named);
  ASSERT_FALSE(disturbed);
  EXPECT_EQ(disturbed.error().code, ErrorCode::conflict);
  EXPECT_EQ(count("edits"), 4);
  // The next plan includes the state.
  ASSERT_TRUE(merge([] { return true; }));
  EXPECT_EQ(count("edits"), 2);
  EXPECT_TRUE(content_of(store_->journal().load_tiles(layer, 2).value()) == states.at(2));
  EXPECT_TRUE(content_of(store_->journal().load_tiles(layer).value()) == states.at(4));
}

TEST_F(Merger, a_damaged_revision_does_not_stop_the_merges_of_others) {
  const Layer damaged = test::make_layer(*store_, model_.id, ValueType::u8, "damaged"),
              other = test::make_layer(*store_, model_.id, ValueType::u8, "other");
  save_stroke(damaged, 3);
  save_stroke(other, 3);
  run("UPDATE tile_revisions SET difference = '\\x00' WHERE sequence = 2");
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto done = merger_.merge(model_.id, epoch, Clock::now() + 1h, [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(done->edits, 2);
  EXPECT_EQ(count("edits WHERE layer_id = " + to_string(damaged.id)), 3);
  EXPECT_EQ(count("edits WHERE layer_id = " + to_string(other.id)), 1);
  EXPECT_EQ(count("merged_journals WHERE sequence = 6"), 1) << "the window would be read again";
}

TEST_F(Merger, a_damaged_tile_does_not_stop_the_packing_of_others) {
  const Layer layer = test::make_layer(*store_, model_.id);
  for (int i = 0; i < JournalMerger::kRevisionsPerSegment; ++i) save_stroke(layer, 1);
  run("UPDATE tile_revisions SET difference = '\\x00' WHERE sequence = 5 AND tile_y = 0 AND tile_x = 0");
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto done = merger_.merge(model_.id, epoch, Clock::now() + 1h, [] { return true; });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(count("tile_segments"), 1);
  EXPECT_EQ(count("tile_segments WHERE tile_y = 0 AND tile_x = 0"), 0);
  EXPECT_EQ(count("tile_revisions WHERE tile_y = 0 AND tile_x = 0"),
            JournalMerger::kRevisionsPerSegment);
}

// Undo would not find these revisions.
TEST_F(Merger, revisions_of_an_edit_without_a_list_of_tiles_are_not_packed) {
  const Layer layer = test::make_layer(*store_, model_.id);
  for (int i = 0; i < JournalMerger::kRevisionsPerSegment; ++i) save_stroke(layer, 1);
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto done = merger_.merge(model_.id, epoch, Clock::now() + 1h, [&] {
    if (count("merged_journals") > 0) run("UPDATE edits SET tiles = NULL WHERE sequence = 7");
    return true;
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::conflict);
  EXPECT_EQ(count("tile_segments"), 0);
  EXPECT_EQ(count("tile_revisions"), 2 * JournalMerger::kRevisionsPerSegment);
}

// The merge has locked the model while it waits for the layer, so painting would wait, too.
TEST_F(Merger, a_merge_gives_up_soon_if_another_change_has_locked_the_layer) {
  const Layer layer = test::make_layer(*store_, model_.id);
  save_stroke(layer, 3);
  const auto epoch = store_->journal().state(model_.id, {})->epoch;
  const auto merge = [&] {
    return merger_.merge(model_.id, epoch, Clock::now() + 1h, [] { return true; });
  };
  PgConnection other = PgConnection::connect(dsn_).value();
  {
    const Transaction change = Transaction::begin(other).value();
    ASSERT_TRUE(other.query("SELECT 1 FROM all_layers FOR UPDATE"));
    const auto refused = merge();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::conflict) << refused.error().detail;
    EXPECT_EQ(count("edits"), 3);
  }
  ASSERT_TRUE(merge());
  EXPECT_EQ(count("edits"), 1);
}

TEST_F(Merger, a_review_finds_a_stroke_by_each_of_its_batches) {
  const Layer layer = test::make_layer(*store_, model_.id);
  test::Painter painter(layer, 4);
  JournalWriter writer(*store_, {});
  const Uuid stroke = random_uuid();
  for (int n = 0; n < 3; ++n) {
    auto entry = painter.paint(n + 1, 1, 1);
    entry.stroke = stroke;
    entry.review = Review::pending;
    entry.record = {{"op", "stroke"}, {"n", n}, {"path", {{n, 1}, {n + 1, 1}}}};
    entry.answer["area_m2"] = 0.5;
    ASSERT_TRUE(save(writer, std::move(entry)));
  }
  const auto before = store_->journal().review_queue(layer.id, {}, 9, 0).value();
  ASSERT_TRUE(merger_.merge(model_.id, store_->journal().state(model_.id, {})->epoch,
                            Clock::now() + 1h, [] { return true; }));
  ASSERT_EQ(count("edits"), 1);
  const auto after = store_->journal().review_queue(layer.id, {}, 9, 0).value();
  EXPECT_EQ(after.total, 1);
  EXPECT_EQ(after.strokes.at(0).sequence, before.strokes.at(0).sequence);
  EXPECT_EQ(after.strokes.at(0).texels, before.strokes.at(0).texels);
  EXPECT_EQ(after.strokes.at(0).begun, before.strokes.at(0).begun);
  for (const std::int64_t named : {1, 2, 3}) {
    const auto found = store_->journal().under_review(layer.id, Decision::accept, {{named}, {}});
    ASSERT_TRUE(found) << found.error().detail;
    ASSERT_EQ(found->edits.size(), 1u) << named;
    EXPECT_EQ(found->edits[0].sequence, 3);
    EXPECT_EQ(found->named, std::vector<std::int64_t>{3});
  }
  EXPECT_TRUE(store_->journal().under_review(layer.id, Decision::accept, {{4}, {}})->edits.empty());
}

TEST_F(Merger, a_server_that_lost_the_model_merges_nothing) {
  Painted painted(*store_, model_.id, 5);
  painted.paint(120);
  painted.end_all();
  const auto edits = count("edits"), revisions = count("tile_revisions");
  ASSERT_TRUE(store_->nodes().begin_epoch(model_.id));  // another server
  const auto done = painted.merge(merger_, painted.time() + 1h);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::moved);
  EXPECT_EQ(count("edits"), edits);
  EXPECT_EQ(count("tile_revisions"), revisions);
  EXPECT_EQ(count("merged_journals"), 0);
  painted.check_states();
  // The new owner merges.
  ASSERT_TRUE(
      merger_.merge(model_.id, painted.epoch() + 1, painted.time() + 1h, [] { return true; }));
  EXPECT_LT(count("edits"), edits);
  check_all(painted);
}

// The database ends the session of the merger in the middle of its transaction, at several rows.
TEST_F(Merger, a_merge_that_is_cut_off_changes_nothing) {
  Painted painted(*store_, model_.id, 6);
  painted.paint(400);
  painted.end_all();
  run("CREATE SEQUENCE merges; CREATE FUNCTION cut_off() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN "
      "IF nextval('merges') % 7 = 0 THEN PERFORM pg_terminate_backend(pg_backend_pid()); END IF; "
      "RETURN NULL; END $$; "
      "CREATE TRIGGER cut_off AFTER INSERT ON edit_batches FOR EACH STATEMENT EXECUTE FUNCTION cut_off(); "
      "CREATE TRIGGER cut_off AFTER INSERT ON tile_segments FOR EACH STATEMENT EXECUTE FUNCTION cut_off(); "
      "CREATE TRIGGER cut_off AFTER INSERT OR UPDATE ON merged_journals FOR EACH STATEMENT EXECUTE FUNCTION cut_off()");
  int failures = 0;
  for (int i = 0; i < 100; ++i) {
    const auto done = painted.merge(merger_, painted.time() + 1h);
    painted.check_ids();
    if (i % 5 == 0) painted.check_states(4);
    if (HasFatalFailure()) return;
    if (done && done->edits + done->revisions == 0) break;
    if (done) continue;
    ++failures;
    painted.paint(5);  // without new edits, packing is not tried again
    painted.end_all();
  }
  EXPECT_GT(failures, 2);
  EXPECT_GT(count("edit_batches"), 0);
  EXPECT_GT(count("tile_segments"), 0);
  check_all(painted);
  painted.paint(40);
  check_all(painted, 4);
}

// A room reads the edits of a stroke, computes an undo or redo of them and saves it. The merger may
// replace these edits after each of these steps.
TEST_F(Merger, an_undo_is_complete_if_its_edits_are_merged_in_the_meantime) {
  using enum Painted::TurnStep;
  unsigned seed = 20;
  for (const auto when : {has_edits, has_tiles, is_computed}) {
    const Model model = test::make_model(*store_, "pot " + std::to_string(seed));
    Painted painted(*store_, model.id, ++seed);
    std::int64_t merged = 0;
    painted.in_turn = [&](Painted::TurnStep step) {
      if (step != when) return;
      const auto done = painted.merge(merger_, painted.time() + 1h);
      ASSERT_TRUE(done) << done.error().detail;
      merged += done->edits;
    };
    for (int i = 0; i < 16; ++i) {
      painted.paint(15);
      painted.end_all();
      painted.turn(i % 2, std::vector<std::string>{"Ada", "Ben", "Cleo"}[i % 3], i % 4 == 3);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(merged, 0);
    check_all(painted);
    if (HasFatalFailure()) return;
  }
}

// The merger runs on its own thread all the time, also while another server claims the model.
TEST_F(Merger, people_paint_while_the_journal_is_merged) {
  Painted painted(*store_, model_.id, 9);
  std::atomic<std::int64_t> epoch = painted.epoch();
  std::atomic<bool> ends = false;
  std::atomic<int> merges = 0, deposed = 0;
  std::vector<std::string> problems;
  std::thread merging([&] {
    while (!ends) {
      const auto done = merger_.merge(model_.id, epoch, painted.time_of_saved() - 20s,
                                      [&] { return !ends.load(); });
      if (done)
        merges += done->edits > 0 ? 1 : 0;
      else if (done.error().code == ErrorCode::moved)
        ++deposed;
      else if (done.error().code != ErrorCode::conflict)  // of an undo at the same time
        problems.push_back(done.error().detail);
    }
  });
  // Paints until the condition is true. The limit ends a test whose merger does nothing.
  const auto paint_until = [&](const auto& condition) {
    for (int i = 0; i < 100 && !condition() && !HasFatalFailure(); ++i) painted.paint(20);
  };
  paint_until([&] { return merges >= 3; });
  painted.check_states(8);
  painted.claim_again();
  paint_until([&] { return deposed > 0; });
  const int of_first_claim = merges;
  epoch = painted.epoch();
  paint_until([&] { return merges >= of_first_claim + 3; });
  ends = true;
  merging.join();
  EXPECT_THAT(problems, ::testing::IsEmpty());
  EXPECT_GT(deposed, 0);
  EXPECT_GE(merges, of_first_claim + 3);
  painted.end_all();
  check_all(painted, 3);
  merge_all(painted);
  check_all(painted, 3);
}

TEST_F(Merger, it_stops_between_two_transactions) {
  Painted painted(*store_, model_.id, 7);
  painted.paint(150);
  painted.end_all();
  const auto edits = count("edits");
  int steps = 0;
  ASSERT_TRUE(
      merger_.merge(model_.id, painted.epoch(), painted.time() + 1h, [&] { return ++steps <= 2; }));
  EXPECT_LT(count("edits"), edits);
  EXPECT_EQ(count("merged_journals"), 0);
  check_all(painted);
  merge_all(painted);
  EXPECT_EQ(count("merged_journals"), 1);
  check_all(painted);
}

TEST_F(Merger, widening_and_erasing_a_layer_include_its_segments) {
  Painted painted(*store_, model_.id, 8);
  painted.paint(400);
  painted.end_all();
  merge_all(painted);
  const Layer layer = store_->layers().find(model_.id, "one", Role::owner).value();
  ASSERT_GT(count("tile_segments WHERE layer_id = " + to_string(layer.id)), 0);
  const auto narrow = store_->journal().load_tiles(layer, painted.sequence() / 2).value();
  const Layer wide = store_->layers().widen(layer, ValueType::u16).value();
  const auto widened_tiles = store_->journal().load_tiles(wide, painted.sequence() / 2).value();
  ASSERT_EQ(widened_tiles.tiles.size(), narrow.tiles.size());
  for (const auto& [address, tile] : narrow.tiles)
    EXPECT_TRUE(*widened_tiles.tiles.at(address) == widened(*tile, ValueType::u16));
  ASSERT_TRUE(store_->layers().remove(layer.id));
  for (const char* table : {"tile_segments", "edit_batches", "tile_revisions", "edits"})
    EXPECT_EQ(count(std::string(table) + " WHERE layer_id = " + to_string(layer.id)), 0) << table;
}

TEST_F(Merger, it_waits_for_nodes_of_other_versions_and_marks_the_database) {
  const auto readable_from = [&] {
    return PgConnection::connect(dsn_)
        ->query("SELECT readable_from IS NULL FROM schema_migrations WHERE version = '000047'")
        ->boolean(0, 0);
  };
  const auto may_merge = [&](std::chrono::milliseconds after_mark) {
    return merger_.may_merge("0.0.2", after_mark).value();
  };
  EXPECT_FALSE(readable_from());
  const Uuid other = random_uuid();
  ASSERT_TRUE(store_->nodes().join({other, "http://127.0.0.1:1", "0.0.1", ""}));
  EXPECT_FALSE(may_merge(0ms)) << "an older node could not read the result";
  EXPECT_FALSE(readable_from());
  // A paused node renews its lease when it continues, and does not check the database again.
  run("UPDATE nodes SET lease_until = clock_timestamp() - interval '50 minutes'");
  EXPECT_FALSE(may_merge(0ms));
  EXPECT_FALSE(readable_from());
  ASSERT_TRUE(store_->nodes().leave(other));
  EXPECT_FALSE(may_merge(1h)) << "a node that has just started may join yet";
  EXPECT_TRUE(readable_from());
  // Another server, or the same one after a restart, waits for the same mark.
  JournalMerger another(store_->journal());
  EXPECT_FALSE(another.may_merge("0.0.2", 1h).value());
  run("UPDATE schema_migrations SET unreadable_since = unreadable_since - interval '61 minutes'");
  EXPECT_TRUE(another.may_merge("0.0.2", 1h).value());
  EXPECT_TRUE(may_merge(0ms));
}

TEST_F(Merger, nodes_that_ended_long_ago_do_not_delay_merges) {
  ASSERT_TRUE(store_->nodes().join({random_uuid(), "http://127.0.0.1:1", "0.0.1", ""}));
  run("UPDATE nodes SET lease_until = clock_timestamp() - interval '61 minutes'");
  EXPECT_TRUE(merger_.may_merge("0.0.2", 0ms).value());
}

}  // namespace
}  // namespace strata::store
