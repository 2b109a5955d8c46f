// Messages between nodes: triggers write them in the transaction of a change, and a reader gets
// each of them once, also if transactions end in another order than they began.
#include "store/nodes/node_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

#include "db/journal_painter.h"
#include "store/content/comments.h"
#include "store/nodes/nodes.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr auto kLong = std::chrono::minutes(5);

template <class Condition>
bool wait_until(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

class MessagesOfNodes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (joins_) join();
  }
  // Node b makes the changes in `store_`. Node a reads the messages about them.
  void join() {
    ASSERT_TRUE(store_->nodes().join(a_));
    ASSERT_TRUE(store_->nodes().join(b_));
    ASSERT_TRUE(reader_.read());
  }
  PgConnection connect() { return std::move(PgConnection::connect(dsn_).value()); }
  static void script(PgConnection& connection, const std::string& sql) {
    const auto done = connection.script(sql);
    ASSERT_TRUE(done) << done.error().detail;
  }
  // Returns the SQL that creates a tool, for a connection that belongs to no node.
  static std::string new_tool(const std::string& name) {
    return "INSERT INTO tool_shapes (name, slug, cells) VALUES ('" + name + "', '" + name +
           "', decode(repeat('00', 8192), 'hex'))";
  }
  static std::vector<std::string> read(NodeMessages& reader) {
    constexpr const char* kKinds[] = {"records",   "table", "comment", "view", "snapshot",
                                      "selection", "tool",  "access",  "kiosk"};
    constexpr const char* kEvents[] = {"created", "changed", "deleted"};
    const auto news = reader.read();
    EXPECT_TRUE(news) << (news ? "" : news.error().detail);
    std::vector<std::string> lines;
    if (!news) return lines;
    EXPECT_FALSE(news->missed);
    for (const NodeMessage& message : news->messages) {
      std::string line = kKinds[static_cast<int>(message.kind)];
      line += std::string(" ") + kEvents[static_cast<int>(message.event)];
      if (message.sequence) line += " " + std::to_string(*message.sequence);
      if (!message.user.empty()) line += " " + message.user;
      lines.push_back(line);
    }
    return lines;
  }
  std::int64_t count() {
    return connection_.query("SELECT count(*) FROM node_messages")->integer(0, 0);
  }
  TableChange write(const Table& table, const std::vector<const char*>& names,
                    std::optional<std::int64_t> key = {}, const std::string& user = "ada") {
    WriteRecords request;
    for (const char* name : names) {
      RecordInput& record = request.records.emplace_back();
      record.key = key;
      record.values[table.columns[0].id] = name;
    }
    auto change = store_->records().write(table.id, request, user);
    EXPECT_TRUE(change && change->problems.empty());
    return change.value_or(TableChange());
  }
  Table make_table() {
    Table table;
    table.project_id = 1;
    table.name = "Finds";
    table.columns.resize(1);
    table.columns[0].name = "Name";
    IdempotentResponse<Table> by_ada;
    by_ada.user = "ada";
    return store_->tables().create(table, by_ada).value();
  }

  bool joins_ = true;
  const std::string dsn_ = test::fresh_database();
  const NewNode a_{random_uuid(), "http://a.example", "1.0", "llvmpipe"},
      b_{random_uuid(), "http://b.example", "1.0", "llvmpipe"};
  std::unique_ptr<Store> store_ = test::open_store(with_sessions_of(b_.id, dsn_));
  PgConnection connection_ = connect();
  NodeMessages reader_{dsn_, a_.id};
};

class MessagesWithoutNodes : public MessagesOfNodes {
 protected:
  MessagesWithoutNodes() { joins_ = false; }
};

TEST_F(MessagesWithoutNodes, a_site_without_nodes_writes_no_messages) {
  make_table();
  script(connection_, new_tool("star"));
  EXPECT_EQ(count(), 0);
  join();
  script(connection_, new_tool("cross"));
  EXPECT_EQ(count(), 1);
  EXPECT_THAT(read(reader_), ElementsAre("tool created"));
}

TEST_F(MessagesOfNodes, nodes_that_ended_long_ago_get_no_messages) {
  script(connection_, "UPDATE nodes SET lease_until = clock_timestamp() - interval '1 hour'");
  script(connection_, new_tool("star"));
  EXPECT_EQ(count(), 0);
  // A node that has just lost its lease may continue, and then needs the messages.
  script(connection_, "UPDATE nodes SET lease_until = clock_timestamp() - interval '1 minute'");
  script(connection_, new_tool("cross"));
  EXPECT_EQ(count(), 1);
}

TEST_F(MessagesOfNodes, a_node_reads_the_changes_of_the_others_once) {
  NodeMessages own(dsn_, b_.id);
  ASSERT_TRUE(own.read());
  const Table table = make_table();
  const TableChange change = write(table, {"bowl"}, {}, "bob");
  EXPECT_THAT(read(reader_),
              ElementsAre("table created ada",
                          "records changed " + std::to_string(change.sequence) + " bob"));
  EXPECT_THAT(read(reader_), IsEmpty());
  EXPECT_THAT(read(own), IsEmpty()) << "the changes of a node are not reported to it";
  script(connection_, new_tool("star"));
  EXPECT_THAT(read(own), ElementsAre("tool created")) << "a change of the command line";
}

TEST_F(MessagesOfNodes, comments_views_and_rights_are_reported) {
  const Model model = test::make_model(*store_);
  Comment comment;
  comment.model_id = model.id;
  comment.place = {{0, 0, 0}, {0, 0, 1}};
  comment.text = "Is this a crack?";
  comment.user = "ada";
  const auto thread = store_->comments().create(comment).value();
  Comment reply;
  reply.thread = thread.id;
  reply.text = "Yes";
  reply.user = "bob";
  ASSERT_TRUE(store_->comments().create(reply));
  EXPECT_THAT(read(reader_), ElementsAre("comment created", "comment created"));
  script(connection_, "UPDATE comments SET user_name = 'former-1'");
  EXPECT_THAT(read(reader_), IsEmpty()) << "the version did not change";
  script(connection_, "DELETE FROM comments WHERE thread_id IS NULL");
  const auto news = reader_.read();
  ASSERT_TRUE(news);
  std::set<std::int64_t> gone;
  for (const NodeMessage& message : news->messages) {
    EXPECT_EQ(message.event, NodeMessage::Event::deleted);
    EXPECT_EQ(message.model, model.id);
    gone.insert(message.subjects.begin(), message.subjects.end());
  }
  EXPECT_EQ(gone.size(), 2u);

  script(connection_,
         "INSERT INTO views (model_id, slug, name, content, user_name) SELECT id, 'v', 'v', '{}', "
         "'ada' FROM models; UPDATE views SET version = 2; DELETE FROM views");
  EXPECT_THAT(read(reader_), ElementsAre("view created", "view changed", "view deleted"));

  script(connection_, "INSERT INTO users (name, role) VALUES ('cleo', 'viewer')");
  script(connection_, "UPDATE users SET last_seen = now() WHERE name = 'cleo'");
  script(connection_, "UPDATE users SET role = 'curator' WHERE name = 'cleo'");
  EXPECT_THAT(read(reader_), ElementsAre("access created cleo", "access changed cleo"));
  script(connection_,
         "INSERT INTO project_members SELECT 1, id, 'viewer' FROM users WHERE name = 'cleo'");
  EXPECT_THAT(read(reader_), ElementsAre("access created cleo"));
  script(connection_,
         "INSERT INTO tokens (hash, kind, user_name, role) VALUES "
         "(decode(repeat('00', 32), 'hex'), 'session', 'cleo', 'viewer'); "
         "UPDATE tokens SET last_used = now(); UPDATE tokens SET revoked = now()");
  EXPECT_THAT(read(reader_), ElementsAre("access deleted cleo"));
}

TEST_F(MessagesOfNodes, a_message_whose_transaction_ends_later_is_read) {
  PgConnection slow = connect();
  script(slow, "BEGIN");
  script(slow, new_tool("slow"));  // has the lower id
  script(connection_, new_tool("quick"));
  EXPECT_THAT(read(reader_), ElementsAre("tool created"));
  EXPECT_THAT(read(reader_), IsEmpty());
  script(connection_, new_tool("next"));
  EXPECT_THAT(read(reader_), ElementsAre("tool created"));
  script(slow, "COMMIT");
  const auto news = reader_.read();
  ASSERT_TRUE(news);
  ASSERT_EQ(news->messages.size(), 1u);
  EXPECT_EQ(connection_
                .query("SELECT name FROM tool_shapes WHERE id = $1",
                       Params().integer(news->messages[0].subjects.at(0)))
                ->text(0, 0),
            "slow");
  EXPECT_THAT(read(reader_), IsEmpty());
  script(slow, "BEGIN");
  script(slow, new_tool("undone"));
  script(slow, "ROLLBACK");
  EXPECT_THAT(read(reader_), IsEmpty());
}

TEST_F(MessagesOfNodes, a_transaction_that_began_before_the_reader_is_not_missed) {
  PgConnection slow = connect();
  script(slow, "BEGIN");
  script(slow, new_tool("slow"));
  script(connection_, new_tool("quick"));
  NodeMessages late(dsn_, a_.id);
  EXPECT_THAT(read(late), IsEmpty()) << "the present state is the start";
  script(slow, "COMMIT");
  EXPECT_THAT(read(late), ElementsAre("tool created"));
}

TEST_F(MessagesOfNodes, many_messages_are_read_in_parts) {
  NodeMessages::Options options;
  options.most_at_once = 2;
  NodeMessages reader(dsn_, a_.id, options);
  ASSERT_TRUE(reader.read());
  for (const char* name : {"one", "two", "three"}) script(connection_, new_tool(name));
  const auto first = reader.read();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->messages.size(), 2u);
  EXPECT_TRUE(first->more);
  const auto second = reader.read();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->messages.size(), 1u);
  EXPECT_FALSE(second->more);
}

TEST_F(MessagesOfNodes, a_reader_connects_again_and_continues) {
  script(connection_, new_tool("one"));
  EXPECT_THAT(read(reader_), ElementsAre("tool created"));
  script(connection_,
         "SELECT pg_terminate_backend(pid, 60000) FROM pg_stat_activity "
         "WHERE datname = current_database() AND pid <> pg_backend_pid()");
  script(connection_, new_tool("two"));
  std::vector<NodeMessage> messages;
  ASSERT_TRUE(wait_until([&] {
    auto news = reader_.read();  // the first call may notice the broken connection
    if (!news) return false;
    EXPECT_FALSE(news->missed);
    messages = news->messages;
    return true;
  }));
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].kind, NodeMessage::Kind::tool);
}

TEST_F(MessagesOfNodes, after_an_outage_the_reader_also_gets_the_changes_of_its_own_node) {
  NodeMessages own_reader{dsn_, b_.id};
  ASSERT_TRUE(own_reader.read());
  const Table table = make_table();
  EXPECT_THAT(read(own_reader), IsEmpty());
  script(connection_,
         "SELECT pg_terminate_backend(pid, 60000) FROM pg_stat_activity "
         "WHERE datname = current_database() AND pid <> pg_backend_pid()");
  // The effect of a commit whose response was lost.
  ASSERT_TRUE(write(table, {"bowl"}).sequence);
  std::vector<NodeMessage> messages;
  ASSERT_TRUE(wait_until([&] {
    auto news = own_reader.read();  // the first call may notice the broken connection
    if (news) messages = news->messages;
    return news.has_value();
  }));
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].kind, NodeMessage::Kind::records);
  ASSERT_TRUE(write(table, {"lamp"}).sequence);
  EXPECT_THAT(read(own_reader), IsEmpty()) << "only once";
}

TEST_F(MessagesOfNodes, a_notification_wakes_the_reader) {
  while (reader_.wait(0ms).value_or(false)) {
  }
  EXPECT_FALSE(reader_.wait(0ms).value());
  script(connection_, new_tool("one"));
  EXPECT_TRUE(reader_.wait(kLong).value());
  EXPECT_THAT(read(reader_), ElementsAre("tool created"));
}

TEST_F(MessagesOfNodes, a_reader_that_was_too_slow_reports_missed_messages) {
  NodeMessages::Options options;
  options.missed_after = 0s;
  NodeMessages slow(dsn_, a_.id, options);
  EXPECT_FALSE(slow.read()->missed) << "the start";
  script(connection_, new_tool("one"));
  const auto news = slow.read();
  ASSERT_TRUE(news);
  EXPECT_TRUE(news->missed);
  EXPECT_THAT(news->messages, IsEmpty());

  options = {};
  options.most_unsettled = 1;
  NodeMessages full(dsn_, a_.id, options);
  PgConnection running = connect();
  script(running, "BEGIN");
  script(running, new_tool("running"));
  EXPECT_FALSE(full.read()->missed);
  for (const char* name : {"two", "three"}) script(connection_, new_tool(name));
  EXPECT_EQ(full.read()->messages.size(), 2u);
  EXPECT_TRUE(full.read()->missed) << "too many ids to remember";
  EXPECT_FALSE(full.read()->missed) << "it starts after the running transactions";
  script(running, "COMMIT");
}

// Other tests may use the same PostgreSQL, and their transactions may still be running.
TEST_F(MessagesOfNodes, messages_are_deleted_after_their_transactions_have_ended) {
  NodeMessages::Options options;
  options.keep = 0s;
  NodeMessages reader(dsn_, a_.id, options);
  const auto read_and_prune = [&] {
    const auto news = reader.read();
    EXPECT_TRUE(news && reader.prune());
    return news ? news->messages.size() : 0;
  };
  script(connection_, new_tool("one"));
  ASSERT_TRUE(wait_until([&] { return read_and_prune() == 0 && count() == 0; }));
  PgConnection slow = connect();
  script(slow, "BEGIN");
  script(slow, new_tool("slow"));
  script(connection_, new_tool("two"));
  EXPECT_EQ(read_and_prune(), 1u);
  read_and_prune();
  EXPECT_EQ(count(), 1) << "a transaction that began earlier is still running";
  script(slow, "COMMIT");
  EXPECT_EQ(read_and_prune(), 1u);
  ASSERT_TRUE(wait_until([&] {
    read_and_prune();
    return count() == 0;
  }));
}

TEST_F(MessagesOfNodes, a_change_of_records_is_read_from_the_journal) {
  const Table table = make_table();
  const ColumnId name = table.columns[0].id;
  const TableChange created = write(table, {"bowl", "jug"});
  ASSERT_EQ(created.created.size(), 2u);
  const auto key = created.created[0];
  const TableChange changed = write(table, {"cup"}, key);
  const auto deleted =
      store_->records().remove(table.id, created.created[1], std::nullopt, "ada").value();

  auto& tables = store_->tables();
  const auto first = tables.change_of(table.id, created.sequence, 100).value();
  EXPECT_THAT(first.created, ElementsAre(key)) << "the other record no longer exists";
  EXPECT_THAT(first.changed, IsEmpty());
  ASSERT_EQ(first.records.size(), 1u);
  EXPECT_EQ(first.records[0].values.at(name), "cup") << "the present state";
  EXPECT_EQ(first.table.project_id, table.project_id);
  EXPECT_THAT(tables.change_of(table.id, created.sequence, 0)->records, IsEmpty());
  const auto second = tables.change_of(table.id, changed.sequence, 100).value();
  EXPECT_THAT(second.changed, ElementsAre(key));
  EXPECT_FALSE(second.columns_changed);
  EXPECT_EQ(tables.change_of(table.id, deleted.sequence, 100)->deleted, deleted.deleted);
  EXPECT_EQ(tables.change_of(table.id, 999, 100).error().code, ErrorCode::not_found);

  Column added;
  added.name = "Depth";
  const auto column = tables.create_column(table.id, added, "ada").value();
  EXPECT_TRUE(tables.change_of(table.id, column.sequence, 100)->columns_changed);
}

}  // namespace
}  // namespace strata::store
