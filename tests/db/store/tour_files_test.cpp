#include "store/content/tour_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/pg/pg.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using std::chrono::hours;
using std::chrono::seconds;

class FilesOfATour : public ::testing::Test {
 protected:
  FilesOfATour() {
    NewModel fresh;
    fresh.model.project_id = 1;
    fresh.model.name = "bust";
    fresh.geometry = {1, 2, 3};
    NamedPart tour;
    tour.model_id = store_->models().create(fresh, {}).value().id;
    tour.name = "Once around";
    tour.content = {{"languages", {"en"}}, {"idle_s", 60}, {"stops", nlohmann::json::array()}};
    tour.user = "carl";
    tour_ = store_->tours().create(tour).value();
  }
  Result<TourFile> add(const std::string& content, const std::string& name = "a.png") {
    const auto path = std::filesystem::path(::testing::TempDir()) / "tour_file";
    std::ofstream(path, std::ios::binary) << content;
    return files_.add(tour_.id, {name, path, "image/png", 8, 6}, "carl");
  }
  std::int64_t blobs() {
    return connection_->query("SELECT count(*) FROM blobs").value().integer(0, 0);
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  TourFiles& files_ = store_->tour_files();
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  NamedPart tour_;
};

TEST_F(FilesOfATour, a_file_comes_back_with_its_facts_and_content) {
  const auto made = add("picture");
  ASSERT_TRUE(made) << made.error().detail;
  const auto found = files_.find(tour_.id, made->id).value();
  EXPECT_EQ(found.name, "a.png");
  EXPECT_EQ(found.bytes, 7u);
  EXPECT_EQ(found.width, 8);
  std::string bytes;
  ASSERT_TRUE(store_->attachments().read(found.sha256, 1, UINT64_MAX,
                                         [&](std::span<const std::uint8_t> piece) {
                                           bytes.append(piece.begin(), piece.end());
                                           return true;
                                         }));
  EXPECT_EQ(bytes, "icture");
  EXPECT_EQ(files_.find(NamedPartId(tour_.id.number() + 1), made->id).error().code,
            ErrorCode::not_found)
      << "another tour";
}

TEST_F(FilesOfATour, unused_ones_are_deleted_with_their_content_once_they_are_old) {
  const auto used = add("used"), unused = add("unused");
  const auto before = blobs();
  ASSERT_TRUE(files_.drop_unused(tour_.id, {used->id}, hours(24)));
  EXPECT_EQ(files_.of_tour(tour_.id)->size(), 2u) << "an open editor may use it";
  ASSERT_TRUE(files_.drop_unused(tour_.id, {used->id}, seconds(-60)));
  EXPECT_EQ(files_.of_tour(tour_.id)->size(), 1u);
  EXPECT_EQ(blobs(), before - 1);
  ASSERT_TRUE(files_.find(tour_.id, used->id));
}

TEST_F(FilesOfATour, the_number_and_the_bytes_have_limits) {
  for (std::int64_t i = 0; i < TourFiles::kMaxFiles; ++i) ASSERT_TRUE(add("same"));
  EXPECT_EQ(add("same").error().code, ErrorCode::conflict);
  ASSERT_TRUE(files_.drop_unused(tour_.id, {}, seconds(-60)));
  ASSERT_TRUE(add("small"));
  ASSERT_TRUE(connection_->script("UPDATE blobs SET bytes = 2147483647 WHERE bytes = 5"));
  EXPECT_EQ(add("another").error().code, ErrorCode::conflict);
}

TEST_F(FilesOfATour, the_content_is_kept_as_long_as_the_tour) {
  ASSERT_TRUE(add("picture"));
  const auto before = blobs();
  EXPECT_EQ(store_->attachments().drop_orphans().value(), 0);
  ASSERT_TRUE(store_->tours().remove(tour_));
  EXPECT_EQ(store_->attachments().drop_orphans().value(), 1);
  EXPECT_EQ(blobs(), before - 1);
}

}  // namespace
}  // namespace strata::store
