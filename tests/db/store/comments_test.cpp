#include "store/content/comments.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "store/content/answers.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/people/accounts.h"
#include "store/pg/pg.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

class CommentsOfAModel : public ::testing::Test {
 protected:
  CommentsOfAModel() {
    NewModel fresh;
    fresh.model.project_id = 1;
    fresh.model.name = "bust";
    fresh.geometry = {1, 2, 3};
    model_ = store_->models().create(fresh, {}).value().id;
  }
  Comment thread(const std::string& text, const std::string& user = "ada") {
    Comment comment;
    comment.model_id = model_;
    comment.place = {{1, 2.5, -3e6}, {0, 0, 1}};
    comment.text = text;
    comment.user = user;
    return comment;
  }
  static Comment reply(CommentId to, const std::string& text, const std::string& user = "bob") {
    Comment comment;
    comment.thread = to;
    comment.text = text;
    comment.user = user;
    return comment;
  }
  std::int64_t count() {
    return connection_->query("SELECT count(*) FROM comments")->integer(0, 0);
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Comments& comments_ = store_->comments();
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  ModelId model_;
};

TEST_F(CommentsOfAModel, what_was_written_comes_back) {
  const auto first = comments_.create(thread("Is this\nthe crack — δ?")).value();
  EXPECT_EQ(first.model_id, model_);
  EXPECT_EQ(first.text, "Is this\nthe crack — δ?");
  EXPECT_EQ(first.place->position, glm::dvec3(1, 2.5, -3e6));
  EXPECT_EQ(first.place->normal, glm::dvec3(0, 0, 1));
  EXPECT_FALSE(first.resolved || first.edited || first.deleted || first.thread || first.layer_id ||
               first.record);
  const auto answer = comments_.create(reply(first.id, "Yes")).value();
  EXPECT_EQ(answer.model_id, model_);
  EXPECT_EQ(answer.thread, first.id);
  EXPECT_FALSE(answer.place);
  const auto all = comments_.of_model(model_, Role::owner, {}).value();
  ASSERT_EQ(all.total, 2);
  EXPECT_EQ(all.comments[0].id, first.id);
  EXPECT_EQ(all.comments[1].text, "Yes");
  const auto second = comments_.of_model(model_, Role::owner, {{}, {}, 1, 1}).value();
  EXPECT_EQ(second.total, 2);
  ASSERT_EQ(second.comments.size(), 1u);
  EXPECT_EQ(second.comments[0].id, answer.id);
  EXPECT_EQ(comments_.replies(first.id, Role::owner, 10, 0)->comments.at(0).id, answer.id);
  EXPECT_EQ(comments_.replies(answer.id, Role::owner, 10, 0).error().code, ErrorCode::invalid);
  EXPECT_EQ(comments_.comment(CommentId(answer.id.number() + 1), Role::owner).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(comments_.of_model(ModelId(model_.number() + 1), Role::owner, {})->total, 0);
}

TEST_F(CommentsOfAModel, texts_that_are_none_are_refused) {
  EXPECT_EQ(comments_.create(thread("")).error().code, ErrorCode::invalid);
  EXPECT_EQ(comments_.create(thread(" \n\t ")).error().code, ErrorCode::invalid);
  EXPECT_EQ(comments_.create(thread("\xff")).error().code, ErrorCode::malformed);
  EXPECT_EQ(comments_.create(thread(std::string("a\0b", 3))).error().code, ErrorCode::malformed);
  std::string long_text;
  for (int i = 0; i < 10'000; ++i) long_text += "δ";
  EXPECT_TRUE(comments_.create(thread(long_text)));
  EXPECT_EQ(comments_.create(thread(long_text + "x")).error().field, "text");
  auto nowhere = thread("Where?");
  nowhere.model_id = ModelId(model_.number() + 1);
  EXPECT_EQ(comments_.create(nowhere).error().code, ErrorCode::not_found);
  EXPECT_EQ(comments_.create(reply(999, "To whom?")).error().code, ErrorCode::not_found);
  EXPECT_EQ(count(), 1);
}

TEST_F(CommentsOfAModel, replies_are_to_the_first_one_of_a_thread) {
  const auto first = comments_.create(thread("Look")).value();
  const auto answer = comments_.create(reply(first.id, "Yes")).value();
  EXPECT_EQ(comments_.create(reply(answer.id, "No")).error().code, ErrorCode::invalid);
}

TEST_F(CommentsOfAModel, a_changed_text_is_marked_and_a_stale_change_refused) {
  const auto first = comments_.create(thread("Lok")).value();
  auto better = first;
  better.text = "Look";
  const auto changed = comments_.update(better).value();
  EXPECT_EQ(changed.text, "Look");
  EXPECT_EQ(changed.version, 2);
  ASSERT_TRUE(changed.edited);
  EXPECT_GE(*changed.edited, first.time);
  EXPECT_EQ(comments_.update(better).error().code, ErrorCode::stale);
  better.id = CommentId(better.id.number() + 1);
  EXPECT_EQ(comments_.update(better).error().code, ErrorCode::not_found);
}

TEST_F(CommentsOfAModel, a_thread_is_resolved_by_the_first_who_says_so_until_it_is_opened_again) {
  auto comment = comments_.create(thread("Look")).value();
  comments_.create(reply(comment.id, "Yes")).value();
  comments_.create(thread("Another")).value();
  comment.resolved = {"bob", {}};
  comment = comments_.update(comment).value();
  ASSERT_TRUE(comment.resolved);
  EXPECT_EQ(comment.resolved->user, "bob");
  EXPECT_GE(comment.resolved->time, comment.time);
  EXPECT_FALSE(comment.edited);
  const auto when = comment.resolved->time;
  comment.resolved->user = "ada";
  comment = comments_.update(comment).value();
  EXPECT_EQ(comment.resolved->user, "bob");
  EXPECT_EQ(comment.resolved->time, when);
  EXPECT_EQ(comments_.of_model(model_, Role::owner, {true, {}})->total, 2)
      << "the thread with its reply";
  EXPECT_EQ(comments_.of_model(model_, Role::owner, {false, {}})->total, 1);
  comment.resolved.reset();
  EXPECT_FALSE(comments_.update(comment)->resolved);
  EXPECT_EQ(comments_.of_model(model_, Role::owner, {false, {}})->total, 3);
}

TEST_F(CommentsOfAModel, those_that_changed_since_a_time_are_found) {
  const auto old = comments_.create(thread("Old")).value();
  comments_.create(thread("Untouched")).value();
  ASSERT_TRUE(connection_->script("UPDATE comments SET changed = changed - interval '2 days'"));
  comments_.create(thread("New")).value();
  const auto day_ago =
      connection_
          ->query(
              "SELECT to_char(now() AT TIME ZONE 'UTC' - interval '1 day', 'YYYY-MM-DD\"T\"HH24:MI:SS\"Z\"')")
          ->text(0, 0);
  EXPECT_EQ(comments_.of_model(model_, Role::owner, {{}, day_ago})->total, 1);
  auto resolved = old;
  resolved.resolved = {"ada", {}};
  ASSERT_TRUE(comments_.update(resolved));
  EXPECT_EQ(comments_.of_model(model_, Role::owner, {{}, day_ago})->total, 2);
}

TEST_F(CommentsOfAModel, the_first_one_stays_without_its_text_while_there_are_replies) {
  const auto first = comments_.create(thread("A secret")).value();
  const auto one = comments_.create(reply(first.id, "One")).value();
  const auto two = comments_.create(reply(first.id, "Two")).value();
  const auto removal = comments_.remove(first).value();
  EXPECT_TRUE(removal.gone.empty());
  ASSERT_TRUE(removal.left);
  EXPECT_TRUE(removal.left->deleted);
  EXPECT_EQ(removal.left->text, "");
  EXPECT_EQ(
      connection_->query("SELECT count(*) FROM comments c WHERE c::text ~ 'secret'")->integer(0, 0),
      0);
  EXPECT_EQ(comments_.remove(first).error().code, ErrorCode::stale);
  EXPECT_EQ(comments_.remove(*removal.left).error().code, ErrorCode::conflict);
  EXPECT_TRUE(comments_.create(reply(first.id, "Three"))) << "it can be talked about";
  const auto three = comments_.replies(first.id, Role::owner, 10, 2)->comments.at(0);
  EXPECT_EQ(comments_.remove(one)->gone, std::vector{one.id});
  EXPECT_EQ(comments_.remove(three)->gone, std::vector{three.id});
  EXPECT_EQ(comments_.remove(two)->gone, (std::vector{two.id, first.id}))
      << "nothing is left of the thread";
  EXPECT_EQ(count(), 0);
  EXPECT_EQ(comments_.remove(two).error().code, ErrorCode::not_found);
}

TEST_F(CommentsOfAModel, a_deleted_thread_that_stays_can_be_resolved) {
  const auto first = comments_.create(thread("Look")).value();
  ASSERT_TRUE(comments_.create(reply(first.id, "Yes")));
  auto left = comments_.remove(first)->left.value();
  left.resolved = {"bob", {}};
  EXPECT_TRUE(comments_.update(left)->resolved);
}

TEST_F(CommentsOfAModel, of_replies_deleted_at_once_the_last_takes_the_deleted_first_along) {
  const auto first = comments_.create(thread("Look")).value();
  std::vector<Comment> replies;
  for (int i = 0; i < 4; ++i) replies.push_back(comments_.create(reply(first.id, "Yes")).value());
  ASSERT_TRUE(comments_.remove(first));
  std::atomic<int> gone = 0;
  {
    std::vector<std::jthread> people;
    for (const Comment& each : replies)
      people.emplace_back([&] {
        if (const auto removal = comments_.remove(each))
          gone += static_cast<int>(removal->gone.size());
      });
  }
  EXPECT_EQ(gone, 5);
  EXPECT_EQ(count(), 0);
}

TEST_F(CommentsOfAModel, an_answer_is_kept_with_the_comment) {
  const IdempotentResponse<Comment> answer{"k", [](const Comment& made) {
                                             return nlohmann::json{{"id", made.id}};
                                           }};
  const auto first = comments_.create(thread("Look"), answer).value();
  EXPECT_EQ(store_->answers().find("k").value()->at("id"), first.id.number());
  EXPECT_EQ(comments_.create(thread("Look"), answer).error().code, ErrorCode::conflict);
  EXPECT_EQ(count(), 1);
}

TEST_F(CommentsOfAModel, they_go_with_the_model_and_stay_without_layer_and_table) {
  Layer layer;
  layer.model_id = model_;
  layer.name = "Units";
  layer.kind = LayerKind::database;
  layer.type = ValueType::u8;
  layer = store_->layers().create(layer).value();
  auto comment = thread("About unit 3");
  comment.layer_id = layer.id;
  comment.table_id = layer.table;
  comment.record = 3;
  comment = comments_.create(comment).value();
  EXPECT_EQ(comment.layer_id, layer.id);
  EXPECT_EQ(comment.record, 3);
  ASSERT_TRUE(comments_.create(reply(comment.id, "Yes")));
  ASSERT_TRUE(store_->layers().remove(layer.id));
  comment = comments_.comment(comment.id, Role::owner).value();
  EXPECT_FALSE(comment.layer_id);
  EXPECT_EQ(comment.table_id, layer.table);
  EXPECT_EQ(comment.record, 3);
  ASSERT_TRUE(store_->tables().remove(*layer.table));
  comment = comments_.comment(comment.id, Role::owner).value();
  EXPECT_FALSE(comment.table_id || comment.record);
  ASSERT_TRUE(store_->models().remove(model_));
  EXPECT_EQ(count(), 0);
}

TEST_F(CommentsOfAModel, of_who_is_deleted_no_name_is_left_in_them) {
  const Person ada = store_->accounts().create("Ada.L", "", Role::annotator).value();
  const std::string former = "former-" + to_string(ada.id);
  const auto hers = comments_.create(thread("Mine", "Ada.L")).value();
  auto settled =
      comments_.create(thread("@ada.l, look. (@ADA.L) x@ada.l @ada.lovelace @adaxl @Ada.L", "bob"))
          .value();
  settled.resolved = {"Ada.L", {}};
  ASSERT_TRUE(comments_.update(settled));
  const IdempotentResponse<Comment> answer{"k", [](const Comment& made) {
                                             return nlohmann::json{{"body", made.text}};
                                           }};
  ASSERT_TRUE(comments_.create(reply(settled.id, "For @ada.l only"), answer));
  ASSERT_TRUE(store_->accounts().remove("ada.l"));
  EXPECT_EQ(comments_.comment(hers.id, Role::owner)->user, former);
  settled = comments_.comment(settled.id, Role::owner).value();
  EXPECT_EQ(settled.resolved->user, former);
  EXPECT_EQ(settled.user, "bob");
  EXPECT_EQ(settled.text,
            "@" + former + ", look. (@" + former + ") x@ada.l @ada.lovelace @adaxl @" + former)
      << "addresses of mail and other people's names stay";
  EXPECT_EQ(comments_.replies(settled.id, Role::owner, 1, 0)->comments.at(0).text,
            "For @" + former + " only");
  EXPECT_FALSE(store_->answers().find("k").value())
      << "what was said to them is not told again either";
}

}  // namespace
}  // namespace strata::store
