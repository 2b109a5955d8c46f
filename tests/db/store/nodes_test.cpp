// The ownership of models: claims, leases, and the fence in the commit of the journal.
#include "store/nodes/nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <map>
#include <thread>

#include "db/journal_painter.h"
#include "store/content/models.h"
#include "store/content/trash.h"
#include "store/journal/journal_commit.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

NewNode node_at(const std::string& url) { return {random_uuid(), url, "1.0", "llvmpipe"}; }

class OwnershipOfModels : public ::testing::Test {
 protected:
  void script(const std::string& sql) {
    const auto done = connection_.script(sql);
    ASSERT_TRUE(done) << done.error().detail;
  }
  // A lease that a test does not end lasts for the whole test, also on a slow machine.
  void keep_lease(const Uuid& node) {
    script("UPDATE nodes SET lease_until = clock_timestamp() + interval '1 hour' WHERE id = '" +
           to_string(node) + "'");
  }
  Result<void> join(const NewNode& node) {
    auto joined = nodes_.join(node);
    if (joined) keep_lease(node.id);
    return joined;
  }
  Result<void> renew(const Uuid& node, const NodeLoad& load = {}) {
    auto renewed = nodes_.renew(node, load);
    if (renewed) keep_lease(node);
    return renewed;
  }
  // Ends the lease now, so the test need not wait for its end.
  void end_lease(const Uuid& node) {
    script("UPDATE nodes SET lease_until = clock_timestamp() - interval '1 second' WHERE id = '" +
           to_string(node) + "'");
  }
  std::int64_t epoch() { return store_->journal().state(model_.id, {})->epoch; }
  tl::expected<void, CommitFailure> commit(JournalEntry entry, std::int64_t at_epoch) {
    entry.epoch = at_epoch;
    const JournalEntry* one = &entry;
    return commit_entries(connection_, std::span(&one, 1));
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Nodes& nodes_ = store_->nodes();
  Model model_ = test::make_model(*store_);
  Layer layer_ = test::make_layer(*store_, model_.id);
  test::Painter painter_{layer_, 3};
  PgConnection connection_ = std::move(PgConnection::connect(dsn_).value());
  const NewNode a_ = node_at("https://site.example/node/a"), b_ = node_at("http://b.example:8080");
};

TEST_F(OwnershipOfModels, a_node_claims_a_model_that_no_node_has) {
  ASSERT_TRUE(join(a_));
  EXPECT_EQ(nodes_.claim(model_.id, a_.id).value(), 1);
  const auto owner = nodes_.owner_of(model_.slug);
  ASSERT_TRUE(owner && *owner);
  EXPECT_EQ((*owner)->id, a_.id);
  EXPECT_EQ((*owner)->url, a_.url);
  EXPECT_EQ(nodes_.owner_of(to_string(model_.id)).value()->id, a_.id);
  EXPECT_FALSE(nodes_.owner_of("no-such-model").value());
  EXPECT_EQ(nodes_.claim(999999, a_.id).error().code, ErrorCode::not_found);
}

TEST_F(OwnershipOfModels, a_claim_is_refused_while_the_owner_has_a_lease) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_TRUE(nodes_.claim(model_.id, a_.id));
  const auto refused = nodes_.claim(model_.id, b_.id);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::moved);
  EXPECT_EQ(refused.error().location, a_.url);
  EXPECT_EQ(epoch(), 1);
  EXPECT_EQ(nodes_.claim(model_.id, a_.id).value(), 2) << "the owner itself may claim again";
}

TEST_F(OwnershipOfModels, a_server_that_is_alone_respects_a_lease) {
  EXPECT_EQ(nodes_.claim(model_.id, std::nullopt).value(), 1);
  EXPECT_EQ(nodes_.claim(model_.id, std::nullopt).value(), 2);
  ASSERT_TRUE(join(a_));
  EXPECT_EQ(nodes_.claim(model_.id, a_.id).value(), 3) << "a claim without a node has no owner";
  const auto refused = nodes_.claim(model_.id, std::nullopt);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::moved);
  EXPECT_THAT(refused.error().detail, ::testing::HasSubstr("--node-url"));
  end_lease(a_.id);
  EXPECT_EQ(nodes_.claim(model_.id, std::nullopt).value(), 4);
}

TEST_F(OwnershipOfModels, a_model_is_free_after_the_lease_of_its_owner) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_TRUE(nodes_.claim(model_.id, a_.id));
  end_lease(a_.id);
  EXPECT_FALSE(nodes_.owner_of(model_.slug).value());
  EXPECT_EQ(nodes_.claim(model_.id, a_.id).error().code, ErrorCode::unavailable)
      << "a node without a lease claims nothing";
  EXPECT_EQ(nodes_.claim(model_.id, b_.id).value(), 2);
}

// A node that is stopped in the middle of a batch leaves its transaction open.
TEST_F(OwnershipOfModels, a_claim_ends_the_transaction_of_an_owner_that_hangs) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_TRUE(nodes_.claim(model_.id, a_.id));
  auto hanging = std::move(PgConnection::connect(with_sessions_of(a_.id, dsn_)).value());
  ASSERT_TRUE(hanging.script("BEGIN; UPDATE models SET sequence = sequence"));
  EXPECT_EQ(nodes_.claim(model_.id, b_.id).error().code, ErrorCode::moved);
  EXPECT_TRUE(hanging.script("SELECT 1")) << "the lease of this owner is not over";
  end_lease(a_.id);
  EXPECT_EQ(nodes_.claim(model_.id, b_.id).value(), 2);
  EXPECT_FALSE(hanging.script("COMMIT"));
}

TEST_F(OwnershipOfModels, a_claim_ends_no_session_of_others) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_TRUE(nodes_.claim(model_.id, a_.id));
  end_lease(a_.id);
  auto reading = std::move(PgConnection::connect(with_sessions_of(a_.id, dsn_)).value());
  ASSERT_TRUE(reading.script("BEGIN; SELECT FROM models"));
  auto other = std::move(PgConnection::connect(dsn_).value());
  ASSERT_TRUE(other.script("BEGIN; UPDATE models SET sequence = sequence"));
  EXPECT_EQ(nodes_.claim(model_.id, b_.id).error().code, ErrorCode::busy);
  EXPECT_TRUE(other.script("COMMIT"));
  EXPECT_TRUE(reading.script("COMMIT"));
  EXPECT_EQ(nodes_.claim(model_.id, b_.id).value(), 2);
}

TEST_F(OwnershipOfModels, an_owner_cannot_join_again_while_its_model_is_being_claimed) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_TRUE(nodes_.claim(model_.id, a_.id));
  end_lease(a_.id);
  // Node b waits for this lock, as for that of a frozen owner.
  auto holder = std::move(PgConnection::connect(dsn_).value());
  ASSERT_TRUE(holder.script("BEGIN; UPDATE models SET sequence = sequence"));
  const auto may_join = [&] {
    return connection_
        .query("SELECT FROM nodes WHERE id = $1 FOR UPDATE NOWAIT", Params().uuid(a_.id))
        .has_value();
  };
  ASSERT_TRUE(may_join());
  std::atomic<bool> ends = false;
  std::thread claims([&] {
    while (!ends) (void)nodes_.claim(model_.id, b_.id);
  });
  bool waits = false;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!waits && std::chrono::steady_clock::now() < deadline) waits = !may_join();
  ends = true;
  EXPECT_TRUE(holder.script("ROLLBACK"));
  claims.join();
  EXPECT_TRUE(waits);
}

TEST_F(OwnershipOfModels, after_an_outage_the_store_uses_no_earlier_connection) {
  const Uuid node = random_uuid();
  const auto store = test::open_store(with_sessions_of(node, dsn_));
  const auto sessions = [&] {
    const auto rows = connection_.query(
        "SELECT coalesce(string_agg(pid::text, ' ' ORDER BY pid), '') FROM pg_stat_activity "
        "WHERE application_name = $1",
        Params().text("strata-" + to_string(node)));
    return rows ? rows->text(0, 0) : rows.error().detail;
  };
  ASSERT_TRUE(store->nodes().all());
  const std::string before = sessions();
  ASSERT_TRUE(store->nodes().all());
  ASSERT_EQ(sessions(), before) << "an idle connection is used again";
  ASSERT_NE(before, "");
  store->nodes().drop_connections();
  // PostgreSQL ends the sessions soon after.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (sessions() != "" && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(sessions(), "");
  ASSERT_TRUE(store->nodes().all());
  EXPECT_NE(sessions(), "");
}

TEST(WithSessionsOf, names_the_sessions_of_both_kinds_of_connection_strings) {
  const Uuid node = *parse_uuid("00000000-0000-4000-8000-00000000000a");
  const std::string named = "application_name=strata-00000000-0000-4000-8000-00000000000a";
  EXPECT_EQ(with_sessions_of(node, "host=db application_name=x"),
            "host=db application_name=x " + named);
  EXPECT_EQ(with_sessions_of(node, "strata"), "dbname='strata' " + named);
  EXPECT_EQ(with_sessions_of(node, "it's"), "dbname='it\\'s' " + named);
  EXPECT_EQ(with_sessions_of(node, "postgresql://db/strata"), "postgresql://db/strata?" + named);
  EXPECT_EQ(with_sessions_of(node, "postgres://db/strata?sslmode=require"),
            "postgres://db/strata?sslmode=require&" + named);
}

TEST_F(OwnershipOfModels, a_model_of_a_draining_node_is_free_at_once) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_TRUE(nodes_.claim(model_.id, a_.id));
  ASSERT_TRUE(nodes_.begin_drain(a_.id));
  EXPECT_TRUE(renew(a_.id)) << "a draining node keeps its lease";
  EXPECT_EQ(nodes_.claim(model_.id, a_.id).error().code, ErrorCode::unavailable);
  EXPECT_EQ(nodes_.claim(model_.id, b_.id).value(), 2);
}

TEST_F(OwnershipOfModels, a_released_model_is_free_and_keeps_its_epoch) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_EQ(nodes_.claim(model_.id, a_.id).value(), 1);
  ASSERT_TRUE(nodes_.release(model_.id, 1));
  EXPECT_EQ(epoch(), 1);
  ASSERT_EQ(nodes_.claim(model_.id, b_.id).value(), 2);
  ASSERT_TRUE(nodes_.release(model_.id, 1));  // has no effect on the newer claim
  EXPECT_EQ(nodes_.owner_of(model_.slug).value()->id, b_.id);
  ASSERT_TRUE(nodes_.leave(b_.id));
  EXPECT_EQ(nodes_.claim(model_.id, a_.id).value(), 3);
}

TEST_F(OwnershipOfModels, a_renewal_after_the_end_of_the_lease_is_refused) {
  ASSERT_TRUE(join(a_));
  EXPECT_TRUE(renew(a_.id, {3, 14, 1.5F}));
  const auto all = nodes_.all().value();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].lives);
  EXPECT_EQ(all[0].load.open_models, 3);
  EXPECT_EQ(all[0].load.participants, 14);
  EXPECT_EQ(all[0].load.processor_share, 1.5F);
  EXPECT_EQ(all[0].gpu, a_.gpu);
  end_lease(a_.id);
  EXPECT_EQ(renew(a_.id).error().code, ErrorCode::gone);
  EXPECT_FALSE(nodes_.all().value()[0].lives);
  ASSERT_TRUE(join(a_));
  EXPECT_TRUE(renew(a_.id));
  EXPECT_EQ(renew(random_uuid()).error().code, ErrorCode::gone);
}

TEST_F(OwnershipOfModels, nodes_are_forgotten_an_hour_after_their_lease) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  ASSERT_TRUE(nodes_.claim(model_.id, a_.id));
  end_lease(a_.id);
  ASSERT_TRUE(nodes_.forget_ended());
  EXPECT_EQ(nodes_.all().value().size(), 2u);
  script("UPDATE nodes SET lease_until = lease_until - interval '61 minutes' WHERE id = '" +
         to_string(a_.id) + "'");
  ASSERT_TRUE(nodes_.forget_ended());
  const auto left = nodes_.all().value();
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].id, b_.id);
  EXPECT_EQ(epoch(), 1);
}

TEST_F(OwnershipOfModels, the_node_with_the_fewest_models_is_proposed) {
  const NewNode c = node_at("http://c.example");
  for (const NewNode& node : {a_, b_, c}) ASSERT_TRUE(join(node));
  ASSERT_TRUE(renew(b_.id, {7, 0, 0}));
  ASSERT_TRUE(renew(c.id, {2, 0, 0}));
  EXPECT_EQ(nodes_.another(a_.id).value()->url, c.url);
  ASSERT_TRUE(nodes_.begin_drain(c.id));
  EXPECT_EQ(nodes_.another(a_.id).value()->url, b_.url);
  end_lease(b_.id);
  EXPECT_FALSE(nodes_.another(a_.id).value());
}

TEST_F(OwnershipOfModels, a_deposed_server_cannot_commit) {
  ASSERT_TRUE(join(a_));
  ASSERT_TRUE(join(b_));
  const auto first = nodes_.claim(model_.id, a_.id).value();
  ASSERT_TRUE(commit(painter_.paint(1, 1, 4), first));
  end_lease(a_.id);
  const auto second = nodes_.claim(model_.id, b_.id).value();

  const auto next = commit(painter_.entry(2), first);
  ASSERT_FALSE(next);
  EXPECT_EQ(next.error().problem.code, ErrorCode::moved);
  EXPECT_EQ(next.error().problem.location, b_.url);
  EXPECT_FALSE(next.error().transient);

  // The new owner has already saved this sequence, so the insert fails as well.
  ASSERT_TRUE(commit(painter_.entry(2), second));
  const auto same = commit(painter_.entry(2), first);
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().problem.code, ErrorCode::moved);
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 2);

  const auto gap = commit(painter_.entry(4), second);
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().problem.code, ErrorCode::conflict) << "the owner still gets a conflict";
}

TEST_F(OwnershipOfModels, the_writer_refuses_only_the_model_that_moved) {
  const Model other = test::make_model(*store_, "jug");
  const Layer other_layer = test::make_layer(*store_, other.id);
  test::Painter other_painter(other_layer, 4);
  const auto epoch = nodes_.claim(model_.id, std::nullopt).value();
  const auto other_epoch = nodes_.claim(other.id, std::nullopt).value();
  ASSERT_TRUE(nodes_.claim(model_.id, std::nullopt));  // another server
  std::map<std::pair<ModelId, std::int64_t>, std::optional<ErrorCode>> answers;
  {
    JournalWriter writer(*store_, {});
    for (std::int64_t sequence = 1; sequence <= 3; ++sequence)
      for (auto* painter : {&painter_, &other_painter}) {
        auto entry = painter->entry(sequence);
        entry.epoch = painter == &painter_ ? epoch : other_epoch;
        const auto key = std::pair(entry.model_id, sequence);
        ASSERT_TRUE(writer.submit(std::move(entry), [&answers, key](const Result<void>& result) {
          answers[key] = result ? std::nullopt : std::optional(result.error().code);
        }));
      }
  }
  for (std::int64_t sequence = 1; sequence <= 3; ++sequence) {
    EXPECT_EQ((answers.at({model_.id, sequence})), ErrorCode::moved);
    EXPECT_EQ((answers.at({other.id, sequence})), std::nullopt);
  }
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 0);
  EXPECT_EQ(store_->journal().last_sequence(other.id).value(), 3);
}

TEST_F(OwnershipOfModels, code_without_a_room_begins_an_epoch) {
  ASSERT_TRUE(join(a_));
  const auto held = nodes_.claim(model_.id, a_.id).value();
  EXPECT_EQ(nodes_.begin_epoch(model_.id).value(), held + 1);
  EXPECT_FALSE(nodes_.owner_of(model_.slug).value());
  EXPECT_EQ(commit(painter_.entry(1), held).error().problem.code, ErrorCode::moved);
  EXPECT_EQ(nodes_.begin_epoch(999999).error().code, ErrorCode::not_found);
}

TEST_F(OwnershipOfModels, restoring_a_model_keeps_its_epoch) {
  ASSERT_EQ(nodes_.claim(model_.id, std::nullopt).value(), 1);
  ASSERT_TRUE(store_->trash().put_model(model_.id, {}));
  EXPECT_EQ(nodes_.claim(model_.id, std::nullopt).error().code, ErrorCode::not_found);
  script("UPDATE all_models SET binned = NULL, binned_by = NULL, binned_bytes = NULL");
  EXPECT_EQ(nodes_.claim(model_.id, std::nullopt).value(), 2);
}

// Three nodes and four models: random steps, compared with a small model of the rules.
TEST_F(OwnershipOfModels, no_two_nodes_ever_commit_in_one_epoch) {
  const char* given = std::getenv("STRATA_SEED");
  const std::uint32_t seed = given ? static_cast<std::uint32_t>(std::atoll(given)) : 41;
  RecordProperty("seed", static_cast<int>(seed));
  SCOPED_TRACE("STRATA_SEED=" + std::to_string(seed));
  std::mt19937 random(seed);
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };

  struct Expected {
    Layer layer;
    std::int64_t epoch = 0, sequence = 0;
    std::optional<std::size_t> owner;
    std::map<std::int64_t, std::size_t> committed_by{};  // epoch → node
  };
  std::vector<Expected> models;
  for (const char* name : {"m1", "m2", "m3", "m4"}) {
    const Model made = test::make_model(*store_, name);
    models.push_back({test::make_layer(*store_, made.id), 0, 0, {}, {}});
  }
  struct Member {
    NewNode node;
    bool lives = false;
    std::map<std::size_t, std::int64_t> held{};  // model → epoch of the node's last claim
  };
  std::vector<Member> members;
  for (const char* url : {"http://n1", "http://n2", "http://n3"}) members.push_back({node_at(url)});

  int commits = 0, deposed = 0, refused_claims = 0;
  for (int step = 0; step < 1500; ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    const std::size_t who = below(members.size()), which = below(models.size());
    Member& member = members[who];
    Expected& model = models[which];
    switch (below(12)) {
      case 0:
        if (member.lives) break;
        ASSERT_TRUE(join(member.node));
        member.lives = true;
        break;
      case 1:
        if (below(3) > 0) break;
        if (member.lives) end_lease(member.node.id);
        member.lives = false;
        break;
      case 2: ASSERT_EQ(renew(member.node.id).has_value(), member.lives); break;
      case 3:
        if (const auto held = member.held.find(which); held != member.held.end()) {
          ASSERT_TRUE(nodes_.release(model.layer.model_id, held->second));
          if (held->second == model.epoch) model.owner.reset();
          member.held.erase(held);
        }
        break;
      case 4:
      case 5:
      case 6: {
        const auto claimed = nodes_.claim(model.layer.model_id, member.node.id);
        const bool is_free = !model.owner || *model.owner == who || !members[*model.owner].lives;
        ASSERT_EQ(claimed.has_value(), member.lives && is_free);
        if (!claimed) {
          ++refused_claims;
          ASSERT_EQ(claimed.error().code, member.lives ? ErrorCode::moved : ErrorCode::unavailable);
          break;
        }
        ASSERT_EQ(*claimed, ++model.epoch) << "epochs never go back";
        model.owner = who;
        member.held[which] = *claimed;
        break;
      }
      default: {
        // The node cannot detect that it is deposed, or that its lease has ended.
        const auto held = member.held.find(which);
        if (held == member.held.end()) break;
        test::Painter painter(model.layer, 1);
        const auto done = commit(painter.entry(model.sequence + 1), held->second);
        ASSERT_EQ(done.has_value(), held->second == model.epoch);
        if (!done) {
          ++deposed;
          ASSERT_EQ(done.error().problem.code, ErrorCode::moved);
          member.held.erase(held);
          break;
        }
        ++commits;
        ++model.sequence;
        const auto [by, fresh] = model.committed_by.try_emplace(held->second, who);
        ASSERT_EQ(by->second, who) << "two nodes committed in one epoch";
      }
    }
  }
  EXPECT_GT(commits, 50);
  EXPECT_GT(deposed, 5);
  EXPECT_GT(refused_claims, 5);
  for (const Expected& model : models) {
    const auto state = store_->journal().state(model.layer.model_id, {}).value();
    EXPECT_EQ(state.epoch, model.epoch);
    EXPECT_EQ(state.last_sequence, model.sequence);
    const auto counted = connection_.query(
        "SELECT count(*), coalesce(min(sequence), 1), coalesce(max(sequence), 0) FROM edits WHERE model_id = $1",
        Params().id(model.layer.model_id));
    ASSERT_TRUE(counted);
    EXPECT_EQ(counted->integer(0, 0), model.sequence);
    EXPECT_EQ(counted->integer(0, 1), 1);
    EXPECT_EQ(counted->integer(0, 2), model.sequence);
  }
}

TEST(NodeUrl, names_a_host_and_perhaps_a_path) {
  for (const char* url :
       {"http://a", "https://a.example", "http://127.0.0.1:8080", "http://[::1]:8080",
        "https://strata.example.org/node/a", "https://strata.example.org/node/a%20b"})
    EXPECT_EQ(check_node_url(url).value_or("refused"), url);
  EXPECT_EQ(check_node_url("https://a.example/node/a//").value(), "https://a.example/node/a");
  EXPECT_EQ(check_node_url("https://a.example/").value(), "https://a.example");
  for (const char* url :
       {"", "a.example", "ftp://a", "http://", "http:///path", "HTTP://a", "http://user@a",
        "http://a?x=1", "http://a#top", "http://a:0", "http://a:65536", "http://a:", "http://a:8x",
        "http://a b", "http://a/\n", "http://[::1", "http://[]", "http://a/\"", "http://a/<b>"})
    EXPECT_FALSE(check_node_url(url)) << url;
  EXPECT_TRUE(check_node_url("http://a/" + std::string(246, 'x')));
  EXPECT_FALSE(check_node_url("http://a/" + std::string(247, 'x')));
}

}  // namespace
}  // namespace strata::store
