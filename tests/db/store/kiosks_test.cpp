#include "store/people/kiosks.h"

#include <gtest/gtest.h>

#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/tokens.h"
#include "store/pg/pg.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using std::chrono::hours;

class KiosksOfATour : public ::testing::Test {
 protected:
  KiosksOfATour() {
    model_ = new_model(1, "bust");
    tour_ = new_tour(model_).id;
  }
  ModelId new_model(ProjectId project, const std::string& name) {
    NewModel fresh;
    fresh.model.project_id = project;
    fresh.model.name = name;
    fresh.geometry = {1, 2, 3};
    return store_->models().create(fresh, {}).value().id;
  }
  NamedPart new_tour(ModelId model) {
    NamedPart tour;
    tour.model_id = model;
    tour.name = "Once around";
    tour.content = {{"languages", {"en"}}, {"idle_s", 60}, {"stops", nlohmann::json::array()}};
    tour.user = "carl";
    return tours_.create(tour).value();
  }
  NewKiosk made(const std::string& name = "Hall",
                std::optional<std::chrono::seconds> lifetime = {}) {
    return kiosks_.create(tour_, name, "carl", lifetime).value();
  }
  void run(const std::string& sql) { ASSERT_TRUE(connection_->script(sql)); }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Kiosks& kiosks_ = store_->kiosks();
  NamedParts& tours_ = store_->tours();
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  ModelId model_;
  NamedPartId tour_;
};

TEST_F(KiosksOfATour, a_tour_comes_back_and_is_changed_where_its_version_equals) {
  NamedPart tour = tours_.find(model_, "once-around").value();
  EXPECT_EQ(tour.id, tour_);
  EXPECT_EQ(tour.content.at("idle_s"), 60);
  EXPECT_EQ(new_tour(model_).slug, "once-around-2");
  EXPECT_EQ(tours_.slugs(model_)->size(), 2u);
  tour.name = "Twice around";
  tour.content["idle_s"] = 90;
  const auto changed = tours_.update(tour).value();
  EXPECT_EQ(changed.version, 2);
  EXPECT_EQ(changed.slug, "once-around");
  EXPECT_EQ(tours_.update(tour).error().code, ErrorCode::stale);
  EXPECT_EQ(tours_.remove(tour).error().code, ErrorCode::stale);
  EXPECT_EQ(store_->views().find(model_, "once-around").error().code, ErrorCode::not_found)
      << "it is no view";
  ASSERT_TRUE(tours_.remove(changed));
  EXPECT_EQ(tours_.find(model_, "once-around").error().code, ErrorCode::not_found);
  EXPECT_EQ(tours_.update(changed).error().code, ErrorCode::not_found);
}

TEST_F(KiosksOfATour, a_model_has_a_bounded_number_of_tours) {
  for (int i = 1; i < NamedParts::kTours.most; ++i) new_tour(model_);
  NamedPart more;
  more.model_id = model_;
  more.name = "More";
  more.content = nlohmann::json::object();
  more.user = "carl";
  EXPECT_EQ(tours_.create(more).error().code, ErrorCode::conflict);
  more.model_id = new_model(1, "vase");
  EXPECT_TRUE(tours_.create(more));
  more.name.clear();
  EXPECT_EQ(tours_.create(more).error().code, ErrorCode::malformed);
}

TEST_F(KiosksOfATour, a_link_leads_to_its_kiosk_and_only_its_hash_is_kept) {
  const auto made = this->made("Entrance hall — left");
  EXPECT_EQ(made.secret.size(), 43u);
  const auto found = kiosks_.find(made.secret).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->id, made.kiosk.id);
  EXPECT_EQ(found->name, "Entrance hall — left");
  EXPECT_EQ(found->tour_id, tour_);
  EXPECT_EQ(found->model_id, model_);
  EXPECT_EQ(found->project_id, ProjectId(1));
  EXPECT_EQ(found->tour, "once-around");
  EXPECT_EQ(found->model, "bust");
  EXPECT_EQ(found->project, "default");
  EXPECT_EQ(found->user, "carl");
  EXPECT_FALSE(found->expires || found->last_seen || found->revoked || found->wants_reload);
  EXPECT_FALSE(kiosks_.find(made.secret + "x").value());
  EXPECT_FALSE(kiosks_.find("").value());
  const auto text = connection_->query("SELECT kiosks::text FROM kiosks")->text(0, 0);
  EXPECT_EQ(text.find(made.secret), std::string::npos);
  EXPECT_FALSE(store_->tokens().find(made.secret).value()) << "nobody signs in with it";
}

TEST_F(KiosksOfATour, a_revoked_or_expired_link_leads_nowhere_and_is_listed_for_a_while) {
  const auto valid = made("Kept"), revoked = made("Revoked"),
             short_lived = made("Short", hours(24));
  EXPECT_TRUE(short_lived.kiosk.expires);
  ASSERT_TRUE(kiosks_.revoke(revoked.kiosk.id));
  ASSERT_TRUE(kiosks_.revoke(revoked.kiosk.id)) << "again is the same";
  EXPECT_EQ(kiosks_.revoke(999).error().code, ErrorCode::not_found);
  EXPECT_TRUE(kiosks_.find(short_lived.secret).value());
  run("UPDATE kiosks SET expires = now() - interval '1 second' WHERE expires IS NOT NULL");
  EXPECT_TRUE(kiosks_.find(valid.secret).value());
  EXPECT_FALSE(kiosks_.find(revoked.secret).value());
  EXPECT_FALSE(kiosks_.find(short_lived.secret).value());
  EXPECT_EQ(kiosks_.ask_reload(revoked.kiosk.id).error().code, ErrorCode::conflict);
  EXPECT_EQ(kiosks_.all({}, 10, 0)->total, 3);
  EXPECT_TRUE(kiosks_.kiosk(revoked.kiosk.id)->revoked);
  run("UPDATE kiosks SET revoked = now() - interval '31 days' WHERE revoked IS NOT NULL");
  EXPECT_EQ(kiosks_.all({}, 10, 0)->total, 2);
  made("New");
  EXPECT_EQ(kiosks_.kiosk(revoked.kiosk.id).error().code, ErrorCode::not_found) << "cleared away";
}

TEST_F(KiosksOfATour, a_kiosk_is_seen_to_a_minute_and_is_asked_to_reload_until_it_did) {
  const auto made = this->made();
  const auto now = [&] { return kiosks_.kiosk(made.kiosk.id).value(); };
  ASSERT_TRUE(kiosks_.seen(made.kiosk.id, true));
  const auto first = now().last_seen;
  ASSERT_TRUE(first);
  ASSERT_TRUE(kiosks_.seen(made.kiosk.id, false));
  EXPECT_EQ(now().last_seen, first) << "not written again within a minute";
  run("UPDATE kiosks SET last_seen = now() - interval '61 seconds'");
  ASSERT_TRUE(kiosks_.seen(made.kiosk.id, false));
  EXPECT_GE(*now().last_seen, *first);
  EXPECT_TRUE(kiosks_.ask_reload(made.kiosk.id)->wants_reload);
  ASSERT_TRUE(kiosks_.seen(made.kiosk.id, false));
  EXPECT_TRUE(now().wants_reload) << "that it asked is not that it did";
  ASSERT_TRUE(kiosks_.seen(made.kiosk.id, true));
  EXPECT_FALSE(now().wants_reload);
  EXPECT_EQ(kiosks_.ask_reload(999).error().code, ErrorCode::not_found);
}

TEST_F(KiosksOfATour, those_of_some_projects_are_listed) {
  made("One");
  Project other;
  other.name = "Other";
  other.slug = "other";
  other = store_->projects().create(other).value();
  const auto elsewhere =
      kiosks_.create(new_tour(new_model(other.id, "wall")).id, "Two", "carl", {}).value();
  EXPECT_EQ(kiosks_.all({}, 10, 0)->total, 2);
  EXPECT_EQ(kiosks_.all(std::vector<ProjectId>{}, 10, 0)->total, 0);
  const auto page = kiosks_.all(std::vector{other.id}, 10, 0).value();
  ASSERT_EQ(page.kiosks.size(), 1u);
  EXPECT_EQ(page.kiosks[0].id, elsewhere.kiosk.id);
  const auto second = kiosks_.all({}, 1, 1).value();
  ASSERT_EQ(second.kiosks.size(), 1u);
  EXPECT_EQ(second.kiosks[0].name, "Two");
}

TEST_F(KiosksOfATour, links_go_with_their_tour_and_names_with_their_person) {
  const auto made = this->made();
  ASSERT_TRUE(store_->accounts().create("carl", "", Role::curator));
  ASSERT_TRUE(store_->accounts().remove("carl"));
  EXPECT_TRUE(kiosks_.kiosk(made.kiosk.id)->user.starts_with("former-"));
  EXPECT_TRUE(tours_.find(model_, "once-around")->user.starts_with("former-"));
  EXPECT_TRUE(kiosks_.find(made.secret).value()) << "the screen goes on";
  EXPECT_EQ(kiosks_.of_tour(tour_).value(), std::vector{made.kiosk.id});
  ASSERT_TRUE(tours_.remove(tours_.find(model_, "once-around").value()));
  EXPECT_FALSE(kiosks_.find(made.secret).value());
  EXPECT_EQ(kiosks_.create(tour_, "Late", "carl", {}).error().code, ErrorCode::not_found);
}

TEST_F(KiosksOfATour, a_tour_has_a_bounded_number_of_good_links) {
  const auto first = made("First");
  for (int i = 1; i < Kiosks::kMaxKiosks; ++i) made("More");
  EXPECT_EQ(kiosks_.create(tour_, "Too many", "carl", {}).error().code, ErrorCode::conflict);
  ASSERT_TRUE(kiosks_.revoke(first.kiosk.id));
  EXPECT_TRUE(kiosks_.create(tour_, "In its place", "carl", {}));
  EXPECT_EQ(kiosks_.create(tour_, "", "carl", {}).error().code, ErrorCode::malformed);
}

}  // namespace
}  // namespace strata::store
