#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "store/pg/pg.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

Column column(const std::string& name, ColumnKind kind) {
  Column made;
  made.name = name;
  made.kind = kind;
  return made;
}

class Attachments : public ::testing::Test {
 protected:
  Attachments() {
    folder_ = fs::temp_directory_path() / ("strata-attachments-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    table_ = make("Units");
  }
  ~Attachments() override { fs::remove_all(folder_); }

  Table make(const std::string& name) {
    Table table;
    table.project_id = 1;
    table.name = name;
    table.columns = {column("Code", ColumnKind::text), column("Photos", ColumnKind::picture),
                     column("Papers", ColumnKind::document)};
    Table made = store_->tables().create(table).value();
    WriteRecords request;
    request.records = {{1, {}}, {2, {}}};
    EXPECT_TRUE(store_->records().write(made.id, request, "ana"));
    return made;
  }
  ColumnId column_id(const std::string& slug) const {
    return find_column(table_.columns, slug)->id;
  }

  NewAttachment file(const std::string& name, const std::string& content,
                     const std::string& type = "image/jpeg") {
    const fs::path path = folder_ / std::to_string(++files_);
    std::ofstream(path, std::ios::binary) << content;
    return {name, path, type, 4, 3};
  }
  Result<Attached> attach(std::int64_t key, const std::vector<NewAttachment>& files,
                          std::optional<ColumnId> column = {}) {
    return store_->attachments().attach(table_.id, key, column, files, {}, {"ana", Role::owner});
  }
  json cell(std::int64_t key, const std::string& slug, std::optional<std::int64_t> at = {}) {
    const auto page =
        store_->records().page(table_.id, Role::owner, {{}, std::vector{key}, at, 10, 0}).value();
    return to_json(page.records.at(0), page.table.columns).at("values").at(slug);
  }
  Result<TableChange> patch(std::int64_t key, const std::string& slug, json value) {
    WriteRecords request;
    request.records = {{key, {{column_id(slug), std::move(value)}}}};
    auto change = store_->records().write(table_.id, request, "ana");
    if (change && !change->problems.empty())
      return tl::unexpected(change->problems.front().problem);
    return change;
  }
  void undo(bool redo = false) {
    const auto plan = store_->tables().plan_undo(table_.id, "ana", redo);
    ASSERT_TRUE(plan) << plan.error().detail;
    const auto done = store_->tables().undo(table_.id, "ana", redo, plan->table_sequence);
    ASSERT_TRUE(done) << done.error().detail;
  }
  std::string content(const Attachment& attachment, std::uint64_t begin = 0,
                      std::uint64_t end = UINT64_MAX) {
    std::string bytes;
    const auto read = store_->attachments().read(
        attachment.sha256, begin, end, [&](std::span<const std::uint8_t> piece) {
          bytes.append(reinterpret_cast<const char*>(piece.data()), piece.size());
          return true;
        });
    EXPECT_TRUE(read) << read.error().detail;
    return bytes;
  }
  std::int64_t count(const std::string& of) {
    auto connection = PgConnection::connect(dsn_);
    return connection->query_once("SELECT count(*) FROM " + of)->integer(0, 0);
  }

  fs::path folder_;
  int files_ = 0;
  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Table table_;
};

TEST_F(Attachments, files_are_kept_bit_for_bit_and_listed_in_their_cell) {
  std::string large(3'000'000, 'x');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>(i * 7 >> 3);
  const auto attached = attach(1, {file("north.jpg", large), file("south.jpg", "small")});
  ASSERT_TRUE(attached) << attached.error().detail;
  ASSERT_EQ(attached->attachments.size(), 2u);
  const Attachment& north = attached->attachments[0];
  EXPECT_EQ(north.name, "north.jpg");
  EXPECT_EQ(north.bytes, large.size());
  EXPECT_EQ(north.width, 4);
  EXPECT_EQ(north.user, "ana");
  EXPECT_EQ(cell(1, "photos"), json({north.id, attached->attachments[1].id}));
  EXPECT_EQ(content(north), large);
  EXPECT_EQ(content(north, 1'048'575, 1'048'578), large.substr(1'048'575, 3))
      << "across two chunks";
  EXPECT_EQ(content(north, 2'999'999), large.substr(2'999'999));
  EXPECT_EQ(store_->attachments().find(north.id, {"", Role::owner})->sha256, north.sha256);
}

TEST_F(Attachments, equal_contents_are_kept_once) {
  ASSERT_TRUE(attach(1, {file("a.jpg", "same"), file("b.jpg", "same")}));
  ASSERT_TRUE(attach(2, {file("c.jpg", "same")}));
  EXPECT_EQ(count("attachments"), 3);
  EXPECT_EQ(count("blobs"), 1);
}

TEST_F(Attachments, files_go_to_the_first_column_that_takes_them_all) {
  ASSERT_TRUE(attach(1, {file("a.jpg", "a")}));
  EXPECT_EQ(cell(1, "photos").size(), 1u);
  ASSERT_TRUE(attach(1, {file("b.jpg", "b"), file("c.pdf", "c", "application/pdf")}));
  EXPECT_EQ(cell(1, "photos").size(), 1u);
  EXPECT_EQ(cell(1, "papers").size(), 2u);
  ASSERT_TRUE(attach(1, {file("d.jpg", "d")}, column_id("papers")));
  EXPECT_EQ(cell(1, "papers").size(), 3u);
}

TEST_F(Attachments, what_does_not_fit_is_refused_and_leaves_nothing) {
  const auto svg = attach(1, {file("a.jpg", "<svg/>", "image/svg+xml")}, column_id("photos"));
  ASSERT_FALSE(svg);
  EXPECT_EQ(svg.error().code, ErrorCode::invalid);
  EXPECT_EQ(svg.error().field, "values.photos");
  EXPECT_EQ(attach(1, {file("a.jpg", "a")}, column_id("code")).error().field, "column");
  EXPECT_EQ(attach(9, {file("a.jpg", "a")}).error().code, ErrorCode::not_found);
  EXPECT_EQ(attach(1, {file("", "a")}).error().code, ErrorCode::malformed);
  EXPECT_EQ(store_->attachments()
                .attach(table_.id, 1, {}, {file("a.jpg", "a")}, 77, {"ana", Role::owner})
                .error()
                .code,
            ErrorCode::stale);
  EXPECT_EQ(count("attachments") + count("blobs") + count("blob_chunks"), 0);
  EXPECT_EQ(cell(1, "photos"), json());
}

TEST_F(Attachments, undo_and_the_past_have_them_as_they_were) {
  const auto first = attach(1, {file("a.jpg", "a")});
  const auto second = attach(1, {file("b.jpg", "b")});
  const AttachmentId a = first->attachments[0].id, b = second->attachments[0].id;
  undo();
  EXPECT_EQ(cell(1, "photos"), json({a}));
  undo(true);
  EXPECT_EQ(cell(1, "photos"), json({a, b}));
  const auto removed = store_->attachments().detach(a, "ana");
  ASSERT_TRUE(removed) << removed.error().detail;
  EXPECT_EQ(cell(1, "photos"), json({b}));
  EXPECT_EQ(cell(1, "photos", first->change.sequence), json({a}));
  EXPECT_EQ(content(*store_->attachments().find(a, {"", Role::owner})), "a") << "the past shows it";
  EXPECT_EQ(store_->attachments().detach(a, "ana").error().code, ErrorCode::not_found);
  undo();
  EXPECT_EQ(cell(1, "photos"), json({a, b}));
}

TEST_F(Attachments, a_file_is_taken_out_of_all_records_that_have_it) {
  const auto attached = attach(1, {file("a.jpg", "a")});
  const json id = attached->attachments[0].id;
  ASSERT_TRUE(patch(2, "photos", json({id})));
  ASSERT_TRUE(patch(2, "papers", json({id})));
  const auto removed = store_->attachments().detach(id.get<AttachmentId>(), "ana");
  ASSERT_TRUE(removed);
  EXPECT_EQ(removed->changed, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(cell(1, "photos"), json());
  EXPECT_EQ(cell(2, "papers"), json());
}

TEST_F(Attachments, cells_list_the_tables_own_files_and_pictures_only) {
  const auto paper = attach(1, {file("a.pdf", "a", "application/pdf")});
  const json id = paper->attachments[0].id;
  EXPECT_EQ(patch(2, "photos", json({id})).error().code, ErrorCode::invalid)
      << "a PDF is no picture";
  EXPECT_EQ(patch(2, "papers", json::array({4711})).error().code, ErrorCode::invalid);
  EXPECT_EQ(patch(2, "papers", json::array({0})).error().code, ErrorCode::invalid);
  EXPECT_EQ(patch(2, "papers", json("a.pdf")).error().code, ErrorCode::invalid);
  ASSERT_TRUE(patch(2, "papers", json({id, id})));
  EXPECT_EQ(cell(2, "papers"), json({id})) << "once";
  const Table units = table_;
  table_ = make("Finds");
  EXPECT_EQ(patch(1, "papers", json({id})).error().code, ErrorCode::invalid) << "another table's";
  table_ = units;
}

TEST_F(Attachments, a_column_of_pictures_becomes_one_of_documents_with_its_files) {
  const auto attached = attach(1, {file("a.jpg", "a")});
  Column papers = *find_column(table_.columns, "photos");
  papers.kind = ColumnKind::document;
  const auto changed = store_->tables().update_column(table_.id, papers, {}, "ana");
  ASSERT_TRUE(changed) << changed.error().detail;
  EXPECT_EQ(changed->record.at("converted"), 1);
  EXPECT_EQ(cell(1, "photos"), json({attached->attachments[0].id}));
}

TEST_F(Attachments, orphans_go_with_their_table_and_at_start_and_others_stay) {
  const auto shared = attach(1, {file("a.jpg", "shared"), file("b.jpg", "own")});
  const Table units = table_;
  table_ = make("Finds");
  const auto other = attach(1, {file("c.jpg", "shared")});
  ASSERT_TRUE(other);
  EXPECT_EQ(store_->attachments().drop_orphans().value(), 0)
      << "records and their journal hold them";
  ASSERT_TRUE(store_->tables().remove(units.id));
  EXPECT_EQ(count("attachments"), 1);
  EXPECT_EQ(count("blobs"), 1) << "what another table has stays";
  EXPECT_EQ(content(other->attachments[0]), "shared");
  auto connection = PgConnection::connect(dsn_);
  ASSERT_TRUE(connection->script(
      "INSERT INTO blobs (sha256, bytes) VALUES (sha256('left behind'), 1);"
      "INSERT INTO blob_chunks (sha256, chunk, data) VALUES (sha256('left behind'), 0, 'x')"));
  EXPECT_EQ(store_->attachments().drop_orphans().value(), 1);
  EXPECT_EQ(count("blob_chunks"), 1);
}

TEST_F(Attachments, small_pictures_are_kept_by_content_and_go_with_it) {
  const auto attached = attach(1, {file("a.jpg", "same"), file("b.jpg", "same")});
  const std::vector<std::uint8_t> small{1, 2, 3};
  EXPECT_EQ(store_->attachments().thumbnail(attached->attachments[0].sha256, 256).value(),
            std::nullopt);
  ASSERT_TRUE(store_->attachments().keep_thumbnail(attached->attachments[0].sha256, 256, small));
  ASSERT_TRUE(store_->attachments().keep_thumbnail(attached->attachments[1].sha256, 256, small))
      << "of two at once one is kept";
  EXPECT_EQ(store_->attachments().thumbnail(attached->attachments[1].sha256, 256).value(), small);
  EXPECT_EQ(store_->attachments().thumbnail(attached->attachments[1].sha256, 64).value(),
            std::nullopt);
  ASSERT_TRUE(store_->tables().remove(table_.id));
  EXPECT_EQ(count("thumbnails"), 0);
}

TEST_F(Attachments, those_who_attach_and_delete_at_once_leave_nothing_half) {
  const Table units = table_;
  std::vector<std::thread> threads;
  std::vector<NewAttachment> files;
  for (int i = 0; i < 8; ++i) files.push_back(file("a.jpg", "same"));
  for (const auto& each : files)
    threads.emplace_back([&, each] {
      for (int n = 0; n < 5; ++n) {
        const auto done =
            store_->attachments().attach(units.id, 1 + n % 2, {}, {each}, {}, {"ana", Role::owner});
        if (!done) {
          EXPECT_EQ(done.error().code, ErrorCode::not_found) << done.error().detail;
        }
      }
    });
  threads.emplace_back([&] { EXPECT_TRUE(store_->tables().remove(units.id)); });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(count("attachments"), 0);
  EXPECT_TRUE(store_->attachments().drop_orphans());
  EXPECT_EQ(count("blobs"), 0);
}

}  // namespace
}  // namespace strata::store
