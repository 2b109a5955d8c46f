#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <random>
#include <thread>

#include "core/digest.h"
#include "core/text/hex.h"
#include "db/journal_painter.h"
#include "store/content/models.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

std::vector<std::uint8_t> noise(std::size_t bytes, std::uint32_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::uint8_t> data(bytes);
  for (auto& byte : data) byte = static_cast<std::uint8_t>(random());
  return data;
}

void write(const std::filesystem::path& file, const std::vector<std::uint8_t>& data) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
}

NewModel model_of(const std::filesystem::path& file, std::vector<std::uint8_t> geometry) {
  NewModel fresh;
  fresh.model.project_id = 1;
  fresh.model.name = "scan";
  fresh.geometry = std::move(geometry);
  fresh.sources = {{"größe 1.ply", file}};
  return fresh;
}

std::int64_t count(const std::string& dsn, const char* sql) {
  return PgConnection::connect(dsn)->query(sql)->integer(0, 0);
}

class Sources : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;
  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
};

TEST_F(Sources, thirty_megabytes_come_back_bit_for_bit) {
  const auto data = noise(30'000'001, 1);
  const auto geometry = noise(9'000'000, 2);
  write(folder_.path() / "scan", data);
  const auto model =
      store_->models().create(model_of(folder_.path() / "scan", geometry), {}).value();
  ASSERT_EQ(model.source_files.size(), 1u);
  EXPECT_EQ(model.source_files[0].name, "größe 1.ply");
  EXPECT_EQ(model.source_files[0].bytes, data.size());
  EXPECT_EQ(model.source_files[0].sha256, to_hex(sha256(data)));
  std::vector<std::uint8_t> read;
  std::size_t largest = 0;
  const auto source = store_->models().read_source(model.id, "größe 1.ply", [&](auto chunk) {
    largest = std::max(largest, chunk.size());
    read.insert(read.end(), chunk.begin(), chunk.end());
    return true;
  });
  ASSERT_TRUE(source) << source.error().detail;
  EXPECT_EQ(source->sha256, model.source_files[0].sha256);
  EXPECT_LE(largest, 1u << 20);
  EXPECT_TRUE(read == data);
  EXPECT_TRUE(store_->models().geometry(model.id).value() == geometry);
}

TEST_F(Sources, a_reader_may_stop_and_unknown_files_are_not_found) {
  write(folder_.path() / "scan", noise(5'000'000, 1));
  const auto model = store_->models().create(model_of(folder_.path() / "scan", {1}), {}).value();
  int chunks = 0;
  EXPECT_TRUE(
      store_->models().read_source(model.id, "größe 1.ply", [&](auto) { return ++chunks < 2; }));
  EXPECT_EQ(chunks, 2);
  EXPECT_EQ(store_->models().read_source(model.id, "other", [](auto) { return true; }).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(
      store_->models()
          .read_source(ModelId(model.id.number() + 1), "größe 1.ply", [](auto) { return true; })
          .error()
          .code,
      ErrorCode::not_found);
  EXPECT_EQ(store_->models().geometry(ModelId(model.id.number() + 1)).error().code,
            ErrorCode::not_found);
}

TEST_F(Sources, the_same_file_is_kept_once_and_goes_with_its_last_model) {
  write(folder_.path() / "scan", noise(3'000'000, 1));
  const auto first = store_->models().create(model_of(folder_.path() / "scan", {1}), {}).value();
  const auto second = store_->models().create(model_of(folder_.path() / "scan", {2}), {}).value();
  EXPECT_EQ(count(dsn_, "SELECT count(*) FROM blobs"), 3);
  ASSERT_TRUE(store_->models().remove(first.id));
  EXPECT_EQ(count(dsn_, "SELECT count(*) FROM blobs"), 2);
  EXPECT_TRUE(store_->models().read_source(second.id, "größe 1.ply", [](auto) { return true; }));
  ASSERT_TRUE(store_->models().remove(second.id));
  EXPECT_EQ(count(dsn_, "SELECT count(*) FROM blobs"), 0);
  EXPECT_EQ(count(dsn_, "SELECT count(*) FROM blob_chunks"), 0);
  EXPECT_EQ(store_->models().remove(second.id).error().code, ErrorCode::not_found);
}

TEST_F(Sources, coarser_copies_are_kept_in_their_order_and_go_with_the_model) {
  write(folder_.path() / "scan", noise(1000, 1));
  auto fresh = model_of(folder_.path() / "scan", {1});
  fresh.detail_levels = {noise(2'000'000, 2), noise(700, 3), {1}};
  const auto model = store_->models().create(fresh, {}).value();
  EXPECT_TRUE(store_->models().detail_levels(model.id).value() == fresh.detail_levels);
  const auto plain = store_->models().create(model_of(folder_.path() / "scan", {1}), {}).value();
  EXPECT_TRUE(store_->models().detail_levels(plain.id).value().empty());
  ASSERT_TRUE(store_->models().remove(plain.id));
  EXPECT_TRUE(store_->models().detail_levels(model.id).value() == fresh.detail_levels);
  ASSERT_TRUE(store_->models().remove(model.id));
  EXPECT_EQ(count(dsn_, "SELECT count(*) FROM blobs"), 0);
}

TEST_F(Sources, imports_and_deletions_of_one_file_at_once_lose_nothing) {
  write(folder_.path() / "scan", noise(1'500'000, 1));
  std::vector<std::thread> people;
  for (int i = 0; i < 4; ++i)
    people.emplace_back([&] {
      for (int round = 0; round < 8; ++round) {
        const auto model = store_->models().create(model_of(folder_.path() / "scan", {1}), {});
        ASSERT_TRUE(model) << model.error().detail;
        std::size_t bytes = 0;
        EXPECT_TRUE(store_->models().read_source(model->id, "größe 1.ply", [&](auto chunk) {
          bytes += chunk.size();
          return true;
        }));
        EXPECT_EQ(bytes, 1'500'000u);
        const auto deleted = store_->models().remove(model->id);
        EXPECT_TRUE(deleted) << deleted.error().detail;
      }
    });
  for (auto& person : people) person.join();
  EXPECT_EQ(count(dsn_, "SELECT count(*) FROM blobs"), 0);
}

TEST_F(Sources, a_cancelled_or_unreadable_import_leaves_nothing_behind) {
  write(folder_.path() / "scan", noise(8'000'000, 1));
  int calls = 0;
  const auto cancelled =
      store_->models().create(model_of(folder_.path() / "scan", {1}), [&] { return ++calls > 12; });
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
  EXPECT_EQ(store_->models().create(model_of(folder_.path() / "missing", {1}), {}).error().title,
            "File not readable");
  auto twice = model_of(folder_.path() / "scan", {1});
  twice.sources.push_back(twice.sources[0]);
  EXPECT_EQ(store_->models().create(twice, {}).error().code, ErrorCode::conflict);
  auto nameless = model_of(folder_.path() / "scan", {1});
  nameless.sources[0].name = "";
  EXPECT_EQ(store_->models().create(nameless, {}).error().code, ErrorCode::malformed);
  EXPECT_EQ(
      count(
          dsn_,
          "SELECT (SELECT count(*) FROM models) + (SELECT count(*) FROM blobs) + (SELECT count(*) FROM blob_chunks)"),
      0);
}

TEST_F(Sources, an_empty_file_and_an_empty_geometry_are_kept) {
  write(folder_.path() / "scan", {});
  const auto model = store_->models().create(model_of(folder_.path() / "scan", {}), {}).value();
  EXPECT_EQ(model.source_files[0].bytes, 0u);
  EXPECT_TRUE(store_->models().geometry(model.id)->empty());
  EXPECT_TRUE(store_->models().read_source(model.id, "größe 1.ply", [](auto) { return true; }));
}

TEST_F(Sources, deleting_a_model_deletes_all_it_has) {
  const auto model = test::make_model(*store_);
  test::Painter painter(test::make_layer(*store_, model.id), 1, 2);
  {
    JournalWriter writer(*store_, {});
    for (int i = 1; i <= 4; ++i) ASSERT_TRUE(test::save(writer, painter.paint(i, 3, 2)));
  }
  EXPECT_GT(store_->journal().revision_bytes(model.id).value(), 0u);
  ASSERT_TRUE(store_->models().remove(model.id));
  for (const char* sql : {"SELECT count(*) FROM layers", "SELECT count(*) FROM edits",
                          "SELECT count(*) FROM tile_revisions", "SELECT count(*) FROM blobs"})
    EXPECT_EQ(count(dsn_, sql), 0) << sql;
}

}  // namespace
}  // namespace strata::store
