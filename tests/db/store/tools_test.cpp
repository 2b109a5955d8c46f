#include <gtest/gtest.h>

#include <thread>

#include "media/shape_texture.h"
#include "store/content/answers.h"
#include "store/content/tools.h"
#include "store/pg/pg.h"
#include "support/shapes.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

Tool named(const std::string& name) {
  Tool tool;
  tool.name = name;
  return tool;
}

class Tools : public ::testing::Test {
 protected:
  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  const ShapeBits flag_ = test::shape_bits(test::in_flag), dots_ = test::shape_bits(test::in_dots);
};

TEST_F(Tools, their_shapes_come_back_cell_by_cell_after_a_restart) {
  EXPECT_TRUE(store_->tools().all()->empty());
  const auto flag = store_->tools().create(named("Flag"), flag_).value();
  const auto dots = store_->tools().create(named("dots"), dots_).value();
  store_ = test::open_store(dsn_);
  EXPECT_EQ(store_->tools().shape(flag.id).value(), flag_);
  EXPECT_EQ(store_->tools().shape(dots.id).value(), dots_);
  const auto tools = store_->tools().all().value();
  ASSERT_EQ(tools.size(), 2u);
  EXPECT_EQ(tools[0].name, "dots") << "by name, whatever its case";
  EXPECT_EQ(tools[1].slug, "flag");
  EXPECT_EQ(store_->tools().find("flag")->id, flag.id);
  EXPECT_EQ(store_->tools().find(to_string(dots.id))->name, "dots");
}

TEST_F(Tools, are_renamed_and_keep_slug_and_shape) {
  auto tool = store_->tools().create(named("Flag"), flag_).value();
  auto changed = tool;
  changed.name = "Fähnchen";
  changed = store_->tools().update(changed).value();
  EXPECT_EQ(changed.name, "Fähnchen");
  EXPECT_EQ(changed.slug, "flag");
  EXPECT_EQ(changed.version, tool.version + 1);
  EXPECT_EQ(store_->tools().update(tool).error().code, ErrorCode::stale);
  EXPECT_EQ(store_->tools().shape(tool.id).value(), flag_);
}

TEST_F(Tools, a_deleted_one_is_found_by_its_id_alone_and_its_slug_is_free_again) {
  const auto tool = store_->tools().create(named("Flag"), flag_).value();
  ASSERT_TRUE(store_->tools().remove(tool.id));
  EXPECT_TRUE(store_->tools().all()->empty());
  EXPECT_EQ(store_->tools().find("flag").error().code, ErrorCode::not_found);
  EXPECT_TRUE(store_->tools().find(to_string(tool.id))->deleted);
  EXPECT_EQ(store_->tools().shape(tool.id).value(), flag_);
  EXPECT_EQ(store_->tools().remove(tool.id).error().code, ErrorCode::not_found);
  auto renamed = store_->tools().find(to_string(tool.id)).value();
  EXPECT_EQ(store_->tools().update(renamed).error().code, ErrorCode::not_found);
  const auto next = store_->tools().create(named("Flag"), dots_).value();
  EXPECT_EQ(next.slug, "flag");
  EXPECT_NE(next.id, tool.id);
}

TEST_F(Tools, no_slug_is_that_of_a_shape_that_is_always_there) {
  EXPECT_EQ(store_->tools().create(named("Disc"), flag_)->slug, "disc-2");
  EXPECT_EQ(store_->tools().create(named("square!"), flag_)->slug, "square-2");
  EXPECT_EQ(store_->tools().create(named("disc"), flag_)->slug, "disc-3");
  EXPECT_EQ(store_->tools().create(named("7"), flag_)->slug, "n-7");
}

TEST_F(Tools, bad_names_and_unknown_ids_are_refused) {
  EXPECT_EQ(store_->tools().create(named(""), flag_).error().code, ErrorCode::malformed);
  EXPECT_EQ(store_->tools().create(named(std::string("a\0b", 3)), flag_).error().code,
            ErrorCode::malformed);
  EXPECT_EQ(store_->tools().find("none").error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->tools().find("99999999999999999999").error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->tools().shape(77).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->tools().remove(77).error().code, ErrorCode::not_found);
}

TEST_F(Tools, a_site_has_no_more_than_its_limit_however_many_ask_at_once) {
  for (int i = 0; i < store::Tools::kMaxTools - 2; ++i)
    ASSERT_TRUE(store_->tools().create(named("n"), flag_));
  std::vector<std::thread> people;
  for (int i = 0; i < 4; ++i)
    people.emplace_back([&] { (void)store_->tools().create(named("n"), flag_); });
  for (auto& person : people) person.join();
  EXPECT_EQ(store_->tools().all()->size(), std::size_t{store::Tools::kMaxTools});
  EXPECT_EQ(store_->tools().create(named("n"), flag_).error().code, ErrorCode::conflict);
  ASSERT_TRUE(store_->tools().remove(store_->tools().all()->front().id));
  EXPECT_TRUE(store_->tools().create(named("n"), flag_)) << "deleted ones do not count";
}

TEST_F(Tools, the_answer_is_kept_with_what_it_answers_for) {
  const IdempotentResponse<Tool> answer{"key", [](const Tool& made) { return to_json(made); }};
  const auto tool = store_->tools().create(named("Flag"), flag_, answer).value();
  EXPECT_EQ(store_->answers().find("key").value().value()["id"], tool.id.number());
  EXPECT_EQ(store_->tools().create(named("Flag"), flag_, answer).error().code, ErrorCode::conflict);
  EXPECT_EQ(store_->tools().all()->size(), 1u);
}

}  // namespace
}  // namespace strata::store
