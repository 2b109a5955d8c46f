#include "store/people/sign_ons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "store/people/accounts.h"
#include "store/people/audit.h"
#include "store/people/groups.h"
#include "store/people/tokens.h"
#include "store/pg/acting.h"
#include "store/pg/pg.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Outcome = SignedOn::Outcome;

constexpr std::chrono::minutes kSoon{10};
const std::string kIssuer = "https://login.museum.example";

class SignOnsOfStore : public ::testing::Test {
 protected:
  SignOnsOfStore() {
    store_->accounts().create("ada", "Ada Lovelace", Role::annotator).value();
    excavation_ = store_->groups().create("Excavation 2026", {}).value().group.id;
    students_ = store_->groups().create("Students", {}).value().group.id;
  }
  static SignOn of(const std::string& subject, const std::string& name = "grace") {
    SignOn sign_on;
    sign_on.issuer = kIssuer;
    sign_on.subject = subject;
    sign_on.name = name;
    sign_on.full_name = "Grace Hopper";
    sign_on.may_create = true;
    return sign_on;
  }
  Result<SignedOn> sign_in(const SignOn& sign_on) {
    return store_->sign_ons().sign_in(sign_on, std::chrono::hours(1), "a browser");
  }
  std::vector<std::string> groups_of(const std::string& user) {
    return store_->accounts().find(user).value().groups;
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  GroupId excavation_, students_;
};

TEST_F(SignOnsOfStore, a_first_sign_in_creates_an_account_and_later_ones_use_it) {
  const SignedOn first = sign_in(of("s1")).value();
  EXPECT_EQ(first.outcome, Outcome::signed_in);
  EXPECT_EQ(first.user, "grace");
  const auto principal = store_->tokens().find(first.session).value();
  ASSERT_TRUE(principal);
  EXPECT_EQ(principal->user, "grace");
  EXPECT_EQ(principal->kind, TokenKind::session);
  EXPECT_EQ(principal->roles.everywhere, Role::guest);
  EXPECT_TRUE(store_->accounts().find("grace")->has_sign_on);
  EXPECT_FALSE(store_->accounts().find("grace")->has_password);
  // another name at the provider is the same person
  const SignedOn second = sign_in(of("s1", "rear admiral")).value();
  EXPECT_EQ(second.user, "grace");
  EXPECT_NE(second.session, first.session);
}

TEST_F(SignOnsOfStore, an_equal_name_does_not_take_over_an_account) {
  EXPECT_EQ(sign_in(of("s1", "ada"))->user, "ada-2");
  EXPECT_EQ(sign_in(of("s2", "ADA"))->user, "ADA-3");
  EXPECT_EQ(sign_in(of("s3", "owner"))->user, "owner-2");
  EXPECT_FALSE(store_->accounts().find("ada")->has_sign_on);
  // the same subject of another issuer is another person
  SignOn elsewhere = of("s1", "ada");
  elsewhere.issuer = "https://login.university.example";
  EXPECT_EQ(sign_in(elsewhere)->user, "ada-4");
}

TEST_F(SignOnsOfStore, accounts_are_created_only_if_that_is_allowed) {
  SignOn sign_on = of("s1");
  sign_on.may_create = false;
  const SignedOn refused = sign_in(sign_on).value();
  EXPECT_EQ(refused.outcome, Outcome::no_account);
  EXPECT_EQ(refused.session, "");
  EXPECT_FALSE(store_->accounts().find("grace"));
  ASSERT_TRUE(store_->sign_ons().bind("ada", kIssuer, "s1"));
  EXPECT_FALSE(store_->accounts().find("ada")->has_sign_on) << "before the first sign-in";
  EXPECT_EQ(sign_in(sign_on)->user, "ada");
  EXPECT_TRUE(store_->accounts().find("ada")->has_sign_on);
}

TEST_F(SignOnsOfStore, an_identity_belongs_to_one_account) {
  ASSERT_TRUE(store_->sign_ons().bind("ada", kIssuer, "s1"));
  ASSERT_TRUE(store_->sign_ons().bind("Ada", kIssuer, "s1")) << "again";
  const auto taken = store_->sign_ons().bind("owner", kIssuer, "s1");
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, ErrorCode::conflict);
  EXPECT_EQ(store_->sign_ons().bind("nobody", kIssuer, "s2").error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->sign_ons().bind("ada", kIssuer, "").error().code, ErrorCode::invalid);
  EXPECT_EQ(store_->sign_ons().bind("ada", kIssuer, std::string(256, 's')).error().code,
            ErrorCode::invalid);
  EXPECT_FALSE(sign_in(of(std::string("s\0", 2))));
}

TEST_F(SignOnsOfStore, a_disabled_person_gets_no_session) {
  ASSERT_TRUE(sign_in(of("s1")));
  const Person grace = store_->accounts().find("grace").value();
  ASSERT_TRUE(store_->accounts().update(grace.id, {.full_name = {}, .role = {}, .disabled = true}));
  SignOn sign_on = of("s1");
  sign_on.role = Role::administrator;
  const SignedOn refused = sign_in(sign_on).value();
  EXPECT_EQ(refused.outcome, Outcome::disabled);
  EXPECT_EQ(refused.session, "");
  EXPECT_EQ(store_->accounts().find("grace")->role, Role::guest);
}

TEST_F(SignOnsOfStore, a_deleted_account_is_no_longer_bound) {
  ASSERT_TRUE(store_->sign_ons().bind("ada", kIssuer, "s1"));
  SignOn sign_on = of("s1");
  sign_on.groups = {"Students"};
  ASSERT_TRUE(sign_in(sign_on));
  ASSERT_TRUE(store_->accounts().remove("ada"));
  EXPECT_EQ(sign_in(sign_on)->user, "grace");
}

TEST_F(SignOnsOfStore, claims_change_the_role_but_never_that_of_the_owner) {
  SignOn sign_on = of("s1");
  sign_on.role = Role::administrator;
  ASSERT_TRUE(sign_in(sign_on));
  EXPECT_EQ(store_->accounts().find("grace")->role, Role::administrator);
  EXPECT_EQ(store_->accounts().administrator_can_sign_in(true), true);
  EXPECT_EQ(store_->accounts().administrator_can_sign_in(false), true);
  sign_on.role = Role::viewer;
  EXPECT_TRUE(sign_in(sign_on)->changed);
  EXPECT_EQ(store_->accounts().find("grace")->role, Role::viewer);
  EXPECT_FALSE(sign_in(sign_on)->changed);
  sign_on.role.reset();  // the provider has no claims for roles
  ASSERT_TRUE(sign_in(sign_on));
  EXPECT_EQ(store_->accounts().find("grace")->role, Role::viewer);
  ASSERT_TRUE(store_->sign_ons().bind("owner", kIssuer, "s2"));
  SignOn owner = of("s2");
  owner.role = Role::guest;
  EXPECT_EQ(sign_in(owner)->user, "owner");
  EXPECT_EQ(store_->accounts().find("owner")->role, Role::owner);
}

TEST_F(SignOnsOfStore, memberships_follow_the_claims_and_those_by_hand_stay) {
  SignOn sign_on = of("s1");
  sign_on.groups = {"excavation 2026", "Unknown", std::string("Zero\0", 5)};
  const SignedOn first = sign_in(sign_on).value();
  EXPECT_THAT(first.skipped_groups, ElementsAre("Unknown"));
  EXPECT_THAT(groups_of("grace"), ElementsAre("Excavation 2026"));
  ASSERT_TRUE(store_->groups().change(students_, {.add = {"grace"}}, "owner"));
  sign_on.groups = {"Students"};
  EXPECT_TRUE(sign_in(sign_on)->changed);
  EXPECT_THAT(groups_of("grace"), ElementsAre("Students"));
  sign_on.groups = {};
  EXPECT_FALSE(sign_in(sign_on)->changed);
  EXPECT_THAT(groups_of("grace"), ElementsAre("Students")) << "was given by hand";
  // an administrator removed a membership that the claims gave
  sign_on.groups = {"Excavation 2026"};
  ASSERT_TRUE(sign_in(sign_on));
  ASSERT_TRUE(store_->groups().change(excavation_, {.remove = {"grace"}}, "owner"));
  EXPECT_TRUE(sign_in(sign_on)->changed) << "the claims give it again";
  EXPECT_THAT(groups_of("grace"), ElementsAre("Excavation 2026", "Students"));
}

TEST_F(SignOnsOfStore, first_sign_ins_at_the_same_time_create_one_account) {
  std::vector<std::string> users(8);
  std::vector<std::thread> threads;
  for (std::string& user : users)
    threads.emplace_back([&] {
      const auto signed_on = sign_in(of("s1"));
      user = signed_on ? signed_on->user : signed_on.error().detail;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(users, ::testing::Each("grace"));
  EXPECT_EQ(store_->accounts().all()->size(), 3u);  // owner, ada, grace
}

TEST_F(SignOnsOfStore, a_pending_sign_in_is_taken_once_by_its_browser) {
  const PendingSignIn pending{"museum", "a nonce", "a verifier", "/models/7?view=2"};
  ASSERT_TRUE(store_->sign_ons().begin("state", "browser", pending, kSoon));
  EXPECT_FALSE(store_->sign_ons().take("state", "another browser").value());
  EXPECT_FALSE(store_->sign_ons().take("state", "").value());
  EXPECT_FALSE(store_->sign_ons().take("", "browser").value());
  const auto taken = store_->sign_ons().take("state", "browser").value();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->provider, "museum");
  EXPECT_EQ(taken->nonce, "a nonce");
  EXPECT_EQ(taken->code_verifier, "a verifier");
  EXPECT_EQ(taken->return_to, "/models/7?view=2");
  EXPECT_FALSE(store_->sign_ons().take("state", "browser").value()) << "a replay";
}

TEST_F(SignOnsOfStore, pending_sign_ins_expire_and_are_limited) {
  const PendingSignIn pending{"museum", "n", "v", "/"};
  ASSERT_TRUE(store_->sign_ons().begin("old", "browser", pending, std::chrono::seconds(-1)));
  EXPECT_FALSE(store_->sign_ons().take("old", "browser").value());
  ASSERT_TRUE(connection_->query(
      "INSERT INTO pending_sign_ins SELECT sha256(n::text::bytea), sha256('b'), 'museum', 'n', 'v', "
      "'/', now() + interval '1 minute' FROM generate_series(1, $1) n",
      Params().integer(SignOns::kMaxPending - 1)));
  ASSERT_TRUE(store_->sign_ons().begin("last", "browser", pending, kSoon));
  ASSERT_TRUE(store_->sign_ons().begin("more", "browser", pending, kSoon));
  EXPECT_EQ(connection_->query("SELECT count(*) FROM pending_sign_ins")->integer(0, 0),
            SignOns::kMaxPending);
  EXPECT_TRUE(store_->sign_ons().take("last", "browser").value()) << "the oldest one is removed";
}

TEST_F(SignOnsOfStore, secrets_of_pending_sign_ins_are_stored_as_hashes) {
  ASSERT_TRUE(
      store_->sign_ons().begin("the state", "the browser", {"museum", "n", "v", "/"}, kSoon));
  const auto row = connection_->query("SELECT pending_sign_ins::text FROM pending_sign_ins");
  ASSERT_TRUE(row);
  EXPECT_EQ(row->text(0, 0).find("the "), std::string::npos);
}

TEST_F(SignOnsOfStore, the_audit_log_names_the_provider) {
  const ActingAs acting({{}, {}, "192.0.2.8", "oidc", "museum"});
  ASSERT_TRUE(sign_in(of("s1")));
  const auto signed_in = store_->audit().rows({.action = "sign_in"}).value();
  ASSERT_EQ(signed_in.size(), 1u);
  EXPECT_EQ(signed_in[0].actor, "grace");
  EXPECT_EQ(signed_in[0].details, nlohmann::json({{"method", "oidc"}, {"provider", "museum"}}));
  const auto bound = store_->audit().rows({.action = "oidc_bound"}).value();
  ASSERT_EQ(bound.size(), 1u);
  EXPECT_EQ(bound[0].subject, "grace");
  EXPECT_EQ(bound[0].details, nlohmann::json({{"issuer", kIssuer}, {"subject", "s1"}}));
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(store_->audit().failed_sign_in({}, "oidc"));
  const auto failed = store_->audit().rows({.action = "sign_in_failed"}).value();
  ASSERT_THAT(failed, ::testing::Not(IsEmpty()));  // the minute may change between the two sign-ins
  EXPECT_EQ(failed[0].details, nlohmann::json({{"method", "oidc"}, {"provider", "museum"}}));
}

TEST(UserNames, they_are_made_from_the_names_at_a_provider) {
  EXPECT_EQ(user_name_from("grace.hopper@navy.example"), "grace.hopper@navy.example");
  EXPECT_EQ(user_name_from("Grace Hopper"), "Grace-Hopper");
  EXPECT_EQ(user_name_from("Jürgen Müller"), "jurgen-muller");
  EXPECT_EQ(user_name_from("..//hidden"), "hidden");
  EXPECT_EQ(user_name_from("考古"), "user");
  EXPECT_EQ(user_name_from(""), "user");
  EXPECT_EQ(user_name_from(std::string("a\0b", 3)), "a-b");
  EXPECT_EQ(user_name_from("Former-7"), "user-Former-7");
  EXPECT_EQ(user_name_from(std::string(100, 'x')).size(), 64u);
}

}  // namespace
}  // namespace strata::store
