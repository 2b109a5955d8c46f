#include "store/content/photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "store/content/models.h"
#include "store/content/trash.h"
#include "store/pg/pg.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

photo::PosedPhotograph posed(const std::string& name, double x = 0) {
  photo::PosedPhotograph photograph;
  photograph.name = name;
  auto& calibration = photograph.calibration;
  calibration.width = 600;
  calibration.height = 400;
  calibration.focal = {500.5, 501.25};
  calibration.offset = {3, -4};
  calibration.skew = 0.125;
  calibration.lens = {photo::LensModel::rational, {1, 2, 3, 4, 5, 6}, {7, 8, 9, 10}};
  photograph.pose.camera_from_world = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  photograph.pose.center = {x, 4'500'000.125, -3};
  return photograph;
}

class PhotographsOfAModel : public ::testing::Test {
 protected:
  PhotographsOfAModel() {
    NewModel fresh;
    fresh.model.project_id = 1;
    fresh.model.name = "bust";
    fresh.geometry = {1, 2, 3};
    model_ = store_->models().create(fresh, {}).value().id;
  }
  Result<MergedPhotographs> merge(const std::vector<photo::PosedPhotograph>& photographs) {
    return photographs_.merge(model_, photographs);
  }
  Result<Photograph> set(PhotographId id, const std::string& content, int width = 600,
                         int height = 400) {
    const auto path = std::filesystem::path(::testing::TempDir()) / "photograph";
    std::ofstream(path, std::ios::binary) << content;
    return photographs_.set_original(model_, id, {path, "image/jpeg", width, height});
  }
  std::int64_t count(const std::string& query) {
    return connection_->query(query.c_str()).value().integer(0, 0);
  }
  PhotographId id_of(const std::string& name) {
    const auto all = photographs_.of_model(model_).value();
    for (const Photograph& photograph : all)
      if (photograph.posed.name == name) return photograph.id;
    return 0;
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Photographs& photographs_ = store_->photographs();
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  ModelId model_;
};

TEST_F(PhotographsOfAModel, poses_come_back_exactly) {
  auto other = posed("b");
  other.calibration.unit = photo::CalibrationUnit::longest_side;
  other.calibration.width = other.calibration.height = 0;
  other.calibration.lens = {photo::LensModel::division, {-0.1}, {}};
  const auto merged = merge({other, posed("a/IMG 1.jpg", 1e-300)});
  ASSERT_TRUE(merged) << merged.error().detail;
  EXPECT_EQ(merged->added, 2);
  EXPECT_EQ(merged->total, 2);
  const auto found = photographs_.of_model(model_).value();
  ASSERT_EQ(found.size(), 2u);
  for (const auto& [photograph, expected] :
       {std::pair(found[0], posed("a/IMG 1.jpg", 1e-300)), std::pair(found[1], other)}) {
    EXPECT_EQ(photograph.posed.name, expected.name);
    EXPECT_EQ(photograph.posed.calibration, expected.calibration);
    EXPECT_EQ(photograph.posed.pose.camera_from_world, expected.pose.camera_from_world);
    EXPECT_EQ(photograph.posed.pose.center, expected.pose.center);
    EXPECT_FALSE(photograph.original);
  }
}

TEST_F(PhotographsOfAModel, a_known_name_gets_a_new_pose_and_keeps_its_image) {
  ASSERT_TRUE(merge({posed("a"), posed("b")}));
  const auto before = set(id_of("a"), "picture").value();
  auto cropped = posed("a", 5);
  cropped.calibration.width = 300;
  auto merged = merge({cropped, posed("b", 5), posed("c"), posed("c", 9)}).value();
  EXPECT_EQ(merged.added, 1);
  EXPECT_EQ(merged.updated, 1);
  EXPECT_EQ(merged.total, 3);
  ASSERT_EQ(merged.refused.size(), 2u);
  EXPECT_EQ(merged.refused[0].name, "a") << "its image has other sides";
  EXPECT_EQ(merged.refused[1].name, "c") << "twice";
  EXPECT_EQ(photographs_.find(model_, before.id)->posed.pose.center.x, 0);

  ASSERT_EQ(merge({posed("a", 5)})->updated, 1);
  const auto after = photographs_.find(model_, before.id).value();
  EXPECT_EQ(after.posed.pose.center.x, 5);
  EXPECT_EQ(after.original->sha256, before.original->sha256);
  EXPECT_EQ(after.version, before.version + 1);
}

TEST_F(PhotographsOfAModel, images_must_have_the_sides_of_the_calibration) {
  ASSERT_TRUE(merge({posed("a")}));
  const PhotographId id = id_of("a");
  EXPECT_EQ(set(id, "picture", 400, 600).error().code, ErrorCode::invalid) << "turned";
  EXPECT_FALSE(photographs_.find(model_, id)->original);
  const auto half = set(id, "picture", 300, 200);
  ASSERT_TRUE(half) << half.error().detail;
  EXPECT_EQ(half->original->width, 300);
  EXPECT_EQ(half->original->bytes, 7u);
  std::string bytes;
  ASSERT_TRUE(store_->attachments().read(half->original->sha256, 0, UINT64_MAX,
                                         [&](std::span<const std::uint8_t> piece) {
                                           bytes.append(piece.begin(), piece.end());
                                           return true;
                                         }));
  EXPECT_EQ(bytes, "picture");
  EXPECT_EQ(set(PhotographId(id.number() + 1), "picture").error().code, ErrorCode::not_found);
}

TEST_F(PhotographsOfAModel, the_content_is_kept_as_long_as_a_photograph_uses_it) {
  ASSERT_TRUE(merge({posed("a"), posed("b"), posed("c")}));
  const auto blobs = [&] { return count("SELECT count(*) FROM blobs"); };
  const auto before = blobs();
  ASSERT_TRUE(set(id_of("a"), "same"));
  ASSERT_TRUE(set(id_of("b"), "same"));
  EXPECT_EQ(blobs(), before + 1);
  EXPECT_EQ(store_->attachments().drop_orphans().value(), 0);
  ASSERT_TRUE(set(id_of("a"), "other"));
  EXPECT_EQ(blobs(), before + 2);
  ASSERT_TRUE(photographs_.remove(model_, id_of("b")));
  EXPECT_EQ(blobs(), before + 1);
  EXPECT_EQ(photographs_.remove(model_, 999).error().code, ErrorCode::not_found);
  ASSERT_TRUE(photographs_.remove_all(model_));
  EXPECT_EQ(blobs(), before);
  EXPECT_TRUE(photographs_.of_model(model_)->empty());
}

TEST_F(PhotographsOfAModel, they_are_deleted_with_their_model) {
  ASSERT_TRUE(merge({posed("a")}));
  ASSERT_TRUE(set(id_of("a"), "picture"));
  ASSERT_TRUE(store_->models().remove(model_));
  EXPECT_EQ(count("SELECT count(*) FROM photographs"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM blobs WHERE bytes = 7"), 0);
}

TEST_F(PhotographsOfAModel, pages_are_sorted_by_name) {
  std::vector<photo::PosedPhotograph> many;
  for (int i = 0; i < 2500; ++i)
    many.push_back(posed("IMG_" + std::to_string(10'000 + 7 * i % 2500)));
  ASSERT_EQ(merge(many)->added, 2500);
  ASSERT_TRUE(set(id_of("IMG_10002"), "picture"));
  const auto page = photographs_.page(model_, {.limit = 3, .after = "IMG_10000"}).value();
  EXPECT_EQ(page.total, 2500);
  EXPECT_EQ(page.with_original, 1);
  ASSERT_EQ(page.photographs.size(), 3u);
  EXPECT_EQ(page.photographs[0].posed.name, "IMG_10001");
  EXPECT_TRUE(page.photographs[1].original);
  EXPECT_EQ(photographs_.page(model_, {.limit = 3, .offset = 2499})->photographs.size(), 1u);
}

TEST_F(PhotographsOfAModel, pages_can_be_of_some_of_them) {
  ASSERT_TRUE(merge({posed("a/NORTH_1"), posed("a/north_2"), posed("b/50%_x"), posed("b/Äste")}));
  ASSERT_TRUE(set(id_of("a/north_2"), "picture"));
  const auto names = [&](const std::string& text, std::optional<bool> with_original = {}) {
    const auto page =
        photographs_.page(model_, {.limit = 3, .text = text, .with_original = with_original});
    std::vector<std::string> found{std::to_string(page->total),
                                   std::to_string(page->with_original)};
    for (const auto& photograph : page->photographs) found.push_back(photograph.posed.name);
    return found;
  };
  using testing::ElementsAre;
  EXPECT_THAT(names("North_"), ElementsAre("2", "1", "a/NORTH_1", "a/north_2"));
  EXPECT_THAT(names("%_"), ElementsAre("1", "0", "b/50%_x"));
  EXPECT_THAT(names("äST"), ElementsAre("1", "0", "b/Äste"));
  EXPECT_THAT(names("c"), ElementsAre("0", "0"));
  EXPECT_THAT(names("", true), ElementsAre("1", "1", "a/north_2"));
  EXPECT_THAT(names("a/", false), ElementsAre("1", "0", "a/NORTH_1"));
  EXPECT_THAT(names("", false), ElementsAre("3", "0", "a/NORTH_1", "b/50%_x", "b/Äste"));
}

TEST_F(PhotographsOfAModel, a_model_has_a_limit) {
  std::vector<photo::PosedPhotograph> many;
  for (std::int64_t i = 0; i < Photographs::kMaxPhotographs; ++i)
    many.push_back(posed(std::to_string(i)));
  ASSERT_TRUE(merge(many));
  EXPECT_EQ(merge({posed("one more")}).error().code, ErrorCode::conflict);
  ASSERT_EQ(merge({posed("7", 1)})->updated, 1);
}

TEST_F(PhotographsOfAModel, deletions_are_audited_once) {
  const auto by = [] { return IdempotentResponse<>{{}, [] { return nlohmann::json(); }, "carl"}; };
  ASSERT_TRUE(merge({posed("a"), posed("b"), posed("c")}));
  ASSERT_TRUE(photographs_.remove(model_, id_of("a"), by()));
  ASSERT_TRUE(photographs_.remove_all(model_, by()));
  const auto rows = connection_->query(
      "SELECT subject, (details ->> 'photographs')::bigint FROM audit_log "
      "WHERE subject_kind = 'photograph' AND actor = 'carl' ORDER BY id");
  ASSERT_EQ(rows->rows(), 2);
  EXPECT_EQ(rows->text(0, 0), "a");
  EXPECT_EQ(rows->text(1, 0), "");
  EXPECT_EQ(rows->integer(1, 1), 2);
}

}  // namespace
}  // namespace strata::store
