#include "store/files/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "store/content/models.h"
#include "store/content/surface_images.h"
#include "store/files/folder_files.h"
#include "store/nodes/nodes.h"
#include "store/pg/blobs.h"
#include "store/tables/attachments.h"
#include "support/s3_server.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using Direction = Files::Direction;

std::vector<std::uint8_t> noise(std::size_t bytes, unsigned seed) {
  std::vector<std::uint8_t> content(bytes);
  for (std::size_t i = 0; i < bytes; ++i)
    content[i] = static_cast<std::uint8_t>((i * 31 >> 2) + i * i + seed * 101);
  return content;
}

// A folder that fails when a test requires it.
class FaultyFiles : public FileStore {
 public:
  explicit FaultyFiles(std::unique_ptr<FileStore> files) : files_(std::move(files)) {}
  std::string place() const override { return files_->place(); }
  std::uint64_t max_bytes() const override { return limit; }
  Result<void> put(const Content& content, const std::function<bool()>& cancelled) override {
    if (fault) return fail(*fault, "Fault", "A fault of the test.");
    ++puts;
    if (on_put) on_put();
    return files_->put(content, cancelled);
  }
  Result<std::vector<std::uint8_t>> read(const Sha256& hash, std::uint64_t begin,
                                         std::size_t size) override {
    if (fault) return fail(*fault, "Fault", "A fault of the test.");
    return files_->read(hash, begin, size);
  }
  Result<bool> remove(const Sha256& hash) override {
    if (hash == locked) return fail(ErrorCode::unavailable, "Fault", "Nobody may delete it.");
    if (fault) return fail(*fault, "Fault", "A fault of the test.");
    return files_->remove(hash);
  }
  Result<void> list(const std::function<Result<void>(const StoredFile&)>& visit) override {
    return files_->list(visit);
  }
  Result<void> remove_unfinished(seconds age) override { return files_->remove_unfinished(age); }
  Result<std::optional<std::string>> read_mark() override { return files_->read_mark(); }
  Result<void> write_mark(const std::string& text) override { return files_->write_mark(text); }

  std::optional<ErrorCode> fault;
  std::optional<Sha256> locked;  // cannot be deleted
  std::function<void()> on_put;
  std::uint64_t limit = UINT64_MAX;
  std::atomic<int> puts = 0;

 private:
  const std::unique_ptr<FileStore> files_;
};

class FilesOutside : public ::testing::Test {
 protected:
  FilesOutside() {
    write("scan.ply", source_);
    store_ = opened();
  }

  // A store on the same database and folder.
  std::unique_ptr<Store> opened() { return opened(dsn_); }
  std::unique_ptr<Store> opened(const std::string& dsn) {
    auto store = test::open_store(dsn);
    auto files = std::make_unique<FaultyFiles>(FolderFiles::open(place()).value());
    faulty_ = files.get();
    const auto open = store->files().open(std::move(files));
    EXPECT_TRUE(open) << open.error().detail;
    return store;
  }
  fs::path place() const { return folder_.path() / "files"; }
  void write(const std::string& name, const std::vector<std::uint8_t>& data) {
    std::ofstream(folder_.path() / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(data.data()),
               static_cast<std::streamsize>(data.size()));
  }
  NewModel new_model(const std::string& name) {
    NewModel fresh;
    fresh.model.project_id = 1;
    fresh.model.name = name;
    fresh.geometry = geometry_;
    fresh.sources = {{"scan.ply", folder_.path() / "scan.ply"}};
    fresh.images = {{"color", "image/png", image_, 16, 8}};
    return fresh;
  }
  Result<Model> create(Store& store, const std::string& name) {
    return store.models().create(new_model(name), {});
  }
  Model create(const std::string& name) { return create(*store_, name).value(); }
  Result<std::string> read(Store& store, const std::vector<std::uint8_t>& content,
                           std::uint64_t begin = 0, std::uint64_t end = UINT64_MAX) {
    std::string bytes;
    const auto done = store.attachments().read(
        to_hex_of(content), begin, end, [&](std::span<const std::uint8_t> piece) {
          EXPECT_LE(piece.size(), kChunkBytes);
          bytes.append(reinterpret_cast<const char*>(piece.data()), piece.size());
          return true;
        });
    return done ? Result<std::string>(bytes) : tl::unexpected(done.error());
  }
  void expect_whole(Store& store, const Model& model) {
    const auto geometry = store.models().geometry(model.id);
    ASSERT_TRUE(geometry) << geometry.error().detail;
    EXPECT_TRUE(*geometry == geometry_);
    std::string source;
    const auto read = store.models().read_source(model.id, "scan.ply", [&](auto piece) {
      source.append(reinterpret_cast<const char*>(piece.data()), piece.size());
      return true;
    });
    ASSERT_TRUE(read) << read.error().detail;
    EXPECT_TRUE(source == text(source_));
    const auto images = store.surface_images().of_model(model.id).value();
    EXPECT_TRUE(store.surface_images().picture(images.at(0).id).value() == image_);
  }
  static std::string text(const std::vector<std::uint8_t>& content) {
    return {content.begin(), content.end()};
  }
  static std::string to_hex_of(const std::vector<std::uint8_t>& content) {
    return file_name_of(sha256(content)).substr(6);
  }
  fs::path file_of(const std::vector<std::uint8_t>& content) const {
    return place() / file_name_of(sha256(content));
  }
  // The names of the contents in the folder.
  std::size_t files() const {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(place()))
      count += entry.is_regular_file() && entry.path().filename().string().size() == 64;
    return count;
  }
  std::int64_t count(const std::string& of) {
    return PgConnection::connect(dsn_)->query_once("SELECT count(*) FROM " + of)->integer(0, 0);
  }
  void run(const std::string& statement) {
    ASSERT_TRUE(PgConnection::connect(dsn_)->script(statement));
  }
  // A database that names the same folder, as a restored copy does.
  std::string copied_database() {
    const auto row =
        PgConnection::connect(dsn_)->query_once("SELECT id::text, place, owner FROM file_store");
    auto copy = test::fresh_database();
    EXPECT_TRUE(PgConnection::connect(copy)->query(
        "INSERT INTO file_store (id, place, owner) VALUES ($1::uuid, $2, $3)",
        Params().text(row->text(0, 0)).text(row->text(0, 1)).text(row->text(0, 2))));
    return copy;
  }
  // Deletes unused files without a delay: the file in the first pass, its row in the second pass.
  void sweep_twice() {
    for (int pass = 0; pass < 2; ++pass) {
      const auto swept = store_->files().sweep(seconds(0), seconds(0));
      ASSERT_TRUE(swept) << swept.error().detail;
    }
  }

  const std::vector<std::uint8_t> geometry_ = noise(2'500'000, 1), source_ = noise(9'500'000, 2),
                                  image_ = noise(5000, 3);
  test::TemporaryFolder folder_;
  const std::string dsn_ = test::fresh_database();
  FaultyFiles* faulty_ = nullptr;  // the folder of the newest store
  std::unique_ptr<Store> store_;
};

TEST_F(FilesOutside, large_content_is_in_the_folder_and_comes_back_bit_for_bit) {
  const Model model = create("bust");
  EXPECT_EQ(files(), 3u);
  EXPECT_EQ(count("blob_chunks"), 0);
  EXPECT_EQ(count("blobs WHERE is_outside"), 3);
  expect_whole(*store_, model);
  store_ = opened();
  expect_whole(*store_, model);
  EXPECT_EQ(read(*store_, source_, 1'048'570, 1'048'580).value(),
            text(source_).substr(1'048'570, 10))
      << "across two chunks";
  EXPECT_EQ(read(*store_, source_, 9'499'999).value(), text(source_).substr(9'499'999));
  const auto facts = store_->files().facts().value();
  EXPECT_EQ(facts.outside_files, 3);
  EXPECT_EQ(facts.place, place().string());
}

TEST_F(FilesOutside, without_a_place_all_content_is_in_the_database) {
  const auto plain = test::fresh_store();
  const auto model = create(*plain, "bust");
  ASSERT_TRUE(model);
  expect_whole(*plain, *model);
  EXPECT_TRUE(plain->files().check_open());
  EXPECT_FALSE(plain->files().sweep(seconds(0)).value());
  EXPECT_EQ(plain->files().facts()->inside_files, 3);
}

TEST_F(FilesOutside, unused_files_stay_for_their_time_and_go_after_that) {
  const Model model = create("bust");
  ASSERT_TRUE(store_->models().remove(model.id));
  EXPECT_EQ(files(), 3u) << "a backup may still need them";
  ASSERT_TRUE(store_->files().sweep(std::chrono::hours(24), seconds(0)));
  EXPECT_EQ(files(), 3u);
  EXPECT_EQ(count("blobs WHERE unused IS NOT NULL"), 3);
  ASSERT_TRUE(store_->files().sweep(seconds(0), std::chrono::hours(1)));
  EXPECT_EQ(count("blobs WHERE removing IS NOT NULL"), 3);
  EXPECT_EQ(files(), 3u) << "an upload may still rely on them";
  sweep_twice();
  EXPECT_EQ(files(), 0u);
  EXPECT_EQ(count("blobs"), 0);
}

TEST_F(FilesOutside, files_in_use_are_never_swept) {
  const Model first = create("bust"), second = create("copy");
  EXPECT_EQ(files(), 3u);
  sweep_twice();
  expect_whole(*store_, first);
  ASSERT_TRUE(store_->models().remove(first.id));
  sweep_twice();
  expect_whole(*store_, second);
  EXPECT_EQ(count("blobs WHERE unused IS NOT NULL"), 0);
}

TEST_F(FilesOutside, the_file_of_a_transaction_that_did_not_commit_is_swept) {
  SurfaceImage image;
  image.model_id = ModelId(4711);
  image.name = "color";
  image.media_type = "image/png";
  image.width = image.height = 8;
  EXPECT_EQ(store_->surface_images().create(image, image_).error().code, ErrorCode::not_found);
  EXPECT_EQ(files(), 1u) << "uploaded before the transaction";
  EXPECT_EQ(count("blobs WHERE unused IS NOT NULL"), 1);
  EXPECT_FALSE(store_->files().sweep(std::chrono::hours(24)).value());
  EXPECT_EQ(files(), 1u);
  sweep_twice();
  EXPECT_EQ(files(), 0u);
  EXPECT_EQ(count("blobs"), 0);
}

TEST_F(FilesOutside, content_whose_file_is_being_removed_goes_into_the_database) {
  const Model model = create("bust");
  ASSERT_TRUE(store_->models().remove(model.id));
  ASSERT_TRUE(store_->files().sweep(seconds(0), std::chrono::hours(1)));  // only marks
  const Model again = create("again");
  EXPECT_EQ(count("blobs WHERE NOT is_outside"), 3);
  sweep_twice();
  EXPECT_EQ(files(), 0u);
  expect_whole(*store_, again);
  EXPECT_EQ(count("blobs WHERE removing IS NOT NULL"), 0);
}

TEST_F(FilesOutside, a_row_whose_file_may_still_be_deleted_stays_until_that_is_over) {
  const Model model = create("bust");
  ASSERT_TRUE(store_->models().remove(model.id));
  ASSERT_TRUE(store_->files().sweep(seconds(0), std::chrono::hours(1)));  // only marks
  const Model again = create("again");
  ASSERT_TRUE(store_->models().remove(again.id));
  EXPECT_EQ(store_->attachments().drop_orphans().value(), 0);
  EXPECT_EQ(count("blobs WHERE removing IS NOT NULL"), 3)
      << "without the row, an upload would rely on the file";
  sweep_twice();
  EXPECT_EQ(count("blobs") + static_cast<std::int64_t>(files()), 0);
}

TEST_F(FilesOutside, a_site_that_has_left_the_folder_can_delete_its_content) {
  const Model model = create("bust");
  Progress progress;
  ASSERT_TRUE(store_->files().move(Direction::into_database, progress));
  const auto plain = test::open_store(dsn_);
  ASSERT_TRUE(plain->models().remove(model.id));
  run("UPDATE blobs SET removing = removing - interval '2 days'");
  EXPECT_EQ(plain->attachments().drop_orphans().value(), 3);
  EXPECT_EQ(count("blob_chunks"), 0);
}

TEST_F(FilesOutside, a_deletion_that_failed_may_still_happen_within_the_hour) {
  const Model model = create("bust");
  ASSERT_TRUE(store_->models().remove(model.id));
  ASSERT_TRUE(store_->files().sweep(seconds(0), std::chrono::hours(1)));  // only marks
  run("UPDATE blobs SET removing = removing - interval '2 hours'");
  faulty_->fault = ErrorCode::unavailable;
  EXPECT_FALSE(store_->files().sweep(seconds(0), std::chrono::hours(1)));
  EXPECT_EQ(count("blobs WHERE removing < clock_timestamp() - interval '1 hour'"), 0);
  faulty_->fault.reset();
  for (const auto& content : {geometry_, source_, image_}) fs::remove(file_of(content));
  ASSERT_TRUE(store_->files().sweep(seconds(0), std::chrono::hours(1)));
  EXPECT_EQ(count("blobs WHERE removing IS NOT NULL"), 3) << "new content must not rely on a file";
}

TEST_F(FilesOutside, a_file_that_cannot_be_deleted_does_not_keep_the_others) {
  const Model model = create("bust");
  ASSERT_TRUE(store_->models().remove(model.id));
  faulty_->locked = std::min({sha256(geometry_), sha256(source_), sha256(image_)});
  EXPECT_FALSE(store_->files().sweep(seconds(0), seconds(0))) << "the sweep reports it";
  EXPECT_EQ(files(), 1u);
}

TEST_F(FilesOutside, a_sweep_ends_when_the_server_stops) {
  const Model model = create("bust");
  ASSERT_TRUE(store_->models().remove(model.id));
  const auto stopping = [] { return true; };
  ASSERT_TRUE(store_->files().sweep(seconds(0), seconds(0), stopping));
  EXPECT_EQ(files(), 3u);
  EXPECT_EQ(store_->files().find_superfluous(stopping).error().code, ErrorCode::cancelled);
}

TEST_F(FilesOutside, the_list_never_finds_the_file_of_a_running_upload) {
  // An upload that has taken longer than a day.
  faulty_->on_put = [&] {
    for (const auto& content : {geometry_, source_, image_})
      if (fs::exists(file_of(content)))
        fs::last_write_time(file_of(content),
                            fs::file_time_type::clock::now() - std::chrono::hours(48));
    EXPECT_TRUE(store_->files().find_superfluous());
    EXPECT_TRUE(store_->files().sweep(std::chrono::hours(24), seconds(0)));
  };
  const Model model = create("bust");
  faulty_->on_put = {};
  EXPECT_EQ(files(), 3u);
  EXPECT_EQ(count("blobs WHERE is_outside AND removing IS NULL"), 3);
  expect_whole(*store_, model);
}

TEST_F(FilesOutside, a_lost_file_does_not_keep_the_others_from_moving) {
  const Model model = create("bust");
  fs::remove(file_of(source_));
  std::fstream(file_of(image_), std::ios::binary | std::ios::in | std::ios::out) << "?";
  Progress progress;
  const auto moved = store_->files().move(Direction::into_database, progress);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().code, ErrorCode::damaged);
  for (const auto& lost : {source_, image_})
    EXPECT_THAT(moved.error().detail, ::testing::HasSubstr(file_name_of(sha256(lost))));
  EXPECT_EQ(count("blobs WHERE NOT is_outside"), 1);
  EXPECT_TRUE(store_->models().geometry(model.id).value() == geometry_);
}

TEST_F(FilesOutside, a_backup_can_rely_on_files_that_were_moved_into_the_database) {
  const Model model = create("bust");
  Progress progress;
  ASSERT_TRUE(store_->files().move(Direction::into_database, progress));
  for (int pass = 0; pass < 2; ++pass)
    ASSERT_TRUE(store_->files().sweep(std::chrono::hours(24), seconds(0)));
  EXPECT_EQ(files(), 3u);
  sweep_twice();
  EXPECT_EQ(files(), 0u);
  expect_whole(*store_, model);
}

TEST_F(FilesOutside, a_newer_backup_can_be_restored_after_an_older_one) {
  const Model model = create("bust");
  ASSERT_TRUE(store_->models().remove(model.id));
  run("DELETE FROM blobs");  // as in an older backup
  for (const auto& content : {geometry_, source_, image_})
    fs::last_write_time(file_of(content),
                        fs::file_time_type::clock::now() - std::chrono::hours(24 * 60));
  ASSERT_TRUE(store_->files().find_superfluous());
  EXPECT_EQ(count("blobs WHERE is_outside"), 3);
  for (int pass = 0; pass < 2; ++pass)
    ASSERT_TRUE(store_->files().sweep(std::chrono::hours(24 * 30), seconds(0)));
  EXPECT_EQ(files(), 3u) << "found only now";
  fs::resize_file(file_of(geometry_), 100);
  run("UPDATE blobs SET bytes = 100 WHERE bytes = " + std::to_string(geometry_.size()));
  const Model again = create("again");
  EXPECT_EQ(count("blobs WHERE is_outside"), 3);
  expect_whole(*store_, again);
}

TEST_F(FilesOutside, those_who_upload_delete_and_sweep_at_once_lose_nothing) {
  std::atomic<bool> stop = false;
  std::thread sweeper([&] {
    while (!stop) {
      const auto swept = store_->files().sweep(seconds(0), seconds(0));
      EXPECT_TRUE(swept) << swept.error().detail;
    }
  });
  std::vector<std::thread> threads;
  std::vector<Model> kept(3);
  for (std::size_t i = 0; i < kept.size(); ++i)
    threads.emplace_back([&, i] {
      for (int n = 0; n < 8; ++n) {
        auto model = create(*store_, "model " + std::to_string(i));
        ASSERT_TRUE(model) << model.error().detail;
        kept[i] = *model;
        if (n < 7) {
          const auto gone = store_->models().remove(model->id);
          EXPECT_TRUE(gone) << gone.error().detail;
        }
      }
    });
  for (auto& thread : threads) thread.join();
  stop = true;
  sweeper.join();
  sweep_twice();
  for (const Model& model : kept) expect_whole(*store_, model);
}

TEST_F(FilesOutside, a_changed_file_is_not_passed_on_and_a_new_upload_repairs_it) {
  const Model model = create("bust");
  std::fstream file(file_of(source_), std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(2'000'000);
  file.put(static_cast<char>(source_[2'000'000] ^ 1));
  file.close();
  const auto whole = read(*store_, source_);
  ASSERT_FALSE(whole);
  EXPECT_EQ(whole.error().code, ErrorCode::damaged);
  EXPECT_THAT(whole.error().detail, ::testing::HasSubstr(file_name_of(sha256(source_))));
  EXPECT_EQ(store_->files().faults().changed, 1u);
  std::string passed;
  (void)store_->attachments().read(to_hex_of(source_), 0, UINT64_MAX, [&](auto piece) {
    passed.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    return true;
  });
  EXPECT_EQ(passed, text(source_).substr(0, 1 << 20)) << "only the chunks before the changed one";
  EXPECT_EQ(read(*store_, source_, 5'000'000, 5'000'010).value(),
            text(source_).substr(5'000'000, 10))
      << "other parts are as they were";
  create("again");
  expect_whole(*store_, model);
}

TEST_F(FilesOutside, errors_do_not_name_the_folder) {
  const Model model = create("bust");
  fs::rename(place(), folder_.path() / "elsewhere");
  const auto read = store_->models().geometry(model.id);
  const auto uploaded = create(*store_, "again");
  fs::create_directory(place());
  const auto written = create(*store_, "again");
  for (const auto* error : {&read.error(), &uploaded.error(), &written.error()}) {
    EXPECT_EQ(error->code, ErrorCode::unavailable);
    EXPECT_EQ(error->detail.find(folder_.path().string()), std::string::npos) << error->detail;
  }
  fs::remove(place());
  fs::rename(folder_.path() / "elsewhere", place());
  fs::remove(file_of(geometry_));
  const auto missing = store_->models().geometry(model.id);
  EXPECT_EQ(missing.error().code, ErrorCode::damaged);
  EXPECT_EQ(missing.error().detail.find(folder_.path().string()), std::string::npos);
}

TEST_F(FilesOutside, an_upload_ends_when_the_server_stops) {
  store_->files().stop_uploads();
  EXPECT_EQ(create(*store_, "bust").error().code, ErrorCode::cancelled);
  EXPECT_EQ(files(), 0u);
}

TEST_F(FilesOutside, a_shortened_or_missing_file_is_an_error) {
  const Model model = create("bust");
  fs::resize_file(file_of(geometry_), geometry_.size() - 1);
  EXPECT_EQ(store_->models().geometry(model.id).error().code, ErrorCode::damaged);
  fs::remove(file_of(geometry_));
  const auto missing = store_->models().geometry(model.id);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::damaged);
  const auto faults = store_->files().faults();
  EXPECT_EQ(faults.changed, 1u);
  EXPECT_EQ(faults.missing, 1u);
  create("again");
  expect_whole(*store_, model);
}

TEST_F(FilesOutside, a_store_that_fails_leaves_nothing_half_and_can_be_tried_again) {
  for (const ErrorCode fault : {ErrorCode::unavailable, ErrorCode::storage_full}) {
    faulty_->fault = fault;
    const auto refused = create(*store_, "bust");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, fault);
    EXPECT_EQ(count("all_models") + count("blob_chunks"), 0);
  }
  faulty_->fault.reset();
  const Model model = create("bust");
  expect_whole(*store_, model);
  faulty_->fault = ErrorCode::unavailable;
  EXPECT_EQ(store_->models().geometry(model.id).error().code, ErrorCode::unavailable);
  EXPECT_EQ(store_->files().faults().unreachable, 1u);
  ASSERT_TRUE(store_->models().remove(model.id));
  EXPECT_FALSE(store_->files().sweep(seconds(0), seconds(0))) << "the sweep reports it";
  EXPECT_EQ(count("blobs"), 3) << "the rows stay until the files are gone";
  faulty_->fault.reset();
  sweep_twice();
  EXPECT_EQ(count("blobs") + static_cast<std::int64_t>(files()), 0);
}

TEST_F(FilesOutside, content_that_is_too_large_for_the_store_stays_in_the_database) {
  faulty_->limit = 3'000'000;
  const Model model = create("bust");
  EXPECT_EQ(count("blobs WHERE is_outside"), 2);
  expect_whole(*store_, model);
  Progress progress;
  const auto moved = store_->files().move(Direction::out_of_database, progress);
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->skipped, 1);
}

TEST_F(FilesOutside, a_program_without_the_place_stores_in_the_database) {
  const Model model = create("bust");
  const auto plain = test::open_store(dsn_);
  EXPECT_EQ(plain->models().geometry(model.id).error().code, ErrorCode::unavailable);
  EXPECT_EQ(plain->files().check_open().error().code, ErrorCode::conflict);
  // A store without the folder cannot check the files, so it stores new content in the database.
  const auto second = create(*plain, "copy");
  ASSERT_TRUE(second) << second.error().detail;
  EXPECT_EQ(count("blobs WHERE is_outside"), 0);
  expect_whole(*plain, *second);
  expect_whole(*store_, model);
  sweep_twice();
  EXPECT_EQ(files(), 0u) << "nothing needs them any longer";
  expect_whole(*store_, model);
}

TEST_F(FilesOutside, content_moves_out_and_back_and_an_interrupted_move_continues) {
  const auto plain = test::open_store(dsn_);
  const Model model = create(*plain, "bust").value();
  Progress interrupted;
  faulty_->on_put = [&] { interrupted.cancel(); };
  EXPECT_FALSE(store_->files().move(Direction::out_of_database, interrupted));
  faulty_->on_put = {};
  expect_whole(*store_, model);
  Progress progress;
  const auto out = store_->files().move(Direction::out_of_database, progress);
  ASSERT_TRUE(out) << out.error().detail;
  EXPECT_EQ(count("blobs WHERE is_outside"), 3);
  EXPECT_EQ(count("blob_chunks"), 0);
  expect_whole(*store_, model);
  EXPECT_EQ(store_->files().move(Direction::out_of_database, progress)->files, 0);
  const auto back = store_->files().move(Direction::into_database, progress);
  ASSERT_TRUE(back) << back.error().detail;
  EXPECT_EQ(back->files, 3);
  expect_whole(*plain, model);
  EXPECT_TRUE(plain->files().check_open());
  sweep_twice();
  EXPECT_EQ(files(), 0u);
  expect_whole(*plain, model);
}

TEST_F(FilesOutside, readers_do_not_notice_a_move) {
  const Model model = create("bust");
  std::atomic<bool> stop = false;
  std::vector<std::thread> readers;
  for (int i = 0; i < 2; ++i)
    readers.emplace_back([&] {
      do {
        expect_whole(*store_, model);
      } while (!stop);
    });
  for (int i = 0; i < 4; ++i) {
    Progress progress;
    const auto moved = store_->files().move(
        i % 2 == 0 ? Direction::into_database : Direction::out_of_database, progress);
    EXPECT_TRUE(moved) << moved.error().detail;
    // A file that was moved in cannot move out before the sweep has removed it.
    sweep_twice();
  }
  stop = true;
  for (auto& reader : readers) reader.join();
}

TEST_F(FilesOutside, the_check_lists_missing_changed_and_superfluous_files) {
  const Model model = create("bust");
  Progress progress;
  std::vector<FileProblem> problems;
  const auto note = [&](const FileProblem& problem) { problems.push_back(problem); };
  const auto clean = store_->files().check(note, progress);
  ASSERT_TRUE(clean) << clean.error().detail;
  EXPECT_EQ(clean->files, 3);
  EXPECT_TRUE(problems.empty());

  fs::remove(file_of(source_));
  std::fstream(file_of(geometry_), std::ios::binary | std::ios::in | std::ios::out) << "?";
  const auto other = noise(10, 9);
  fs::create_directories(file_of(other).parent_path());
  std::ofstream(file_of(other)) << "other";
  ASSERT_TRUE(store_->files().check(note, progress));
  EXPECT_EQ(problems.size(), 2u) << "the other file may be a running upload";
  problems.clear();
  fs::last_write_time(file_of(other), fs::file_time_type::clock::now() - std::chrono::hours(25));
  ASSERT_TRUE(store_->files().check(note, progress));
  ASSERT_EQ(problems.size(), 3u);
  using Kind = FileProblem::Kind;
  for (const FileProblem& problem : problems) {
    const bool is_source = problem.name == file_name_of(sha256(source_));
    const bool is_other = problem.name == file_name_of(sha256(other));
    EXPECT_EQ(problem.kind, is_source  ? Kind::missing
                            : is_other ? Kind::superfluous
                                       : Kind::changed);
    if (is_source) {
      EXPECT_EQ(problem.used_by, "source file scan.ply of model bust");
    }
  }
  // The sweep finds the superfluous file, and leaves the others for a repair.
  ASSERT_TRUE(store_->files().find_superfluous());
  sweep_twice();
  EXPECT_FALSE(fs::exists(file_of(other)));
  EXPECT_TRUE(fs::exists(file_of(geometry_)));
}

TEST_F(FilesOutside, programs_that_cannot_read_files_outside_are_excluded) {
  const auto dsn = test::fresh_database();
  const auto is_readable = [&] {
    return PgConnection::connect(dsn)
        ->query_once(
            "SELECT readable_from IS NOT NULL FROM schema_migrations WHERE version = '000046'")
        ->boolean(0, 0);
  };
  const auto store = test::open_store(dsn);
  EXPECT_TRUE(is_readable()) << "a site without --files";
  const Uuid other = random_uuid();
  ASSERT_TRUE(store->nodes().join({other, "http://127.0.0.1:1", "0.0.1", ""}));
  const FilesPlace new_place{(folder_.path() / "new").string(), {}};
  EXPECT_EQ(store->files().open(new_place).error().code, ErrorCode::conflict);
  EXPECT_TRUE(is_readable());
  ASSERT_TRUE(store->nodes().leave(other));
  ASSERT_TRUE(store->files().open(new_place));
  EXPECT_FALSE(is_readable());
}

TEST_F(FilesOutside, a_wrong_folder_is_refused) {
  create("bust");
  const auto opened_with = [&](const std::string& dsn, const fs::path& folder) {
    auto store = test::open_store(dsn);
    return store->files().open({folder.string(), {}});
  };
  const auto other_site = test::fresh_database();
  EXPECT_EQ(opened_with(other_site, place()).error().code, ErrorCode::conflict);
  EXPECT_EQ(opened_with(dsn_, folder_.path() / "empty").error().code, ErrorCode::conflict);
  EXPECT_TRUE(opened_with(other_site, folder_.path() / "empty"));
  EXPECT_EQ(opened_with(dsn_, folder_.path() / "empty").error().code, ErrorCode::conflict);
  EXPECT_TRUE(opened_with(dsn_, place()));
}

TEST_F(FilesOutside, a_restored_copy_of_the_database_deletes_no_files_until_it_owns_them) {
  const Model model = create("bust");
  EXPECT_TRUE(store_->files().owns_files().value());
  run("UPDATE file_store SET owner = ''");
  EXPECT_FALSE(store_->files().owns_files().value());
  ASSERT_TRUE(store_->models().remove(model.id));
  sweep_twice();
  EXPECT_EQ(files(), 3u) << "the original may need them";
  ASSERT_TRUE(store_->files().adopt());
  sweep_twice();
  EXPECT_EQ(files(), 0u);
}

TEST_F(FilesOutside, two_databases_of_one_folder_do_not_delete_the_files_of_each_other) {
  const Model model = create("bust");
  const auto copy_dsn = copied_database();
  const auto copy = opened(copy_dsn);
  EXPECT_FALSE(copy->files().owns_files().value());
  const auto in_copy = create(*copy, "bust of the copy");
  ASSERT_TRUE(in_copy) << in_copy.error().detail;
  expect_whole(*copy, *in_copy);
  EXPECT_EQ(copy->files().facts()->outside_files, 0) << "the original would delete its files";
  Progress progress;
  EXPECT_EQ(copy->files().move(Direction::out_of_database, progress).error().code,
            ErrorCode::conflict);

  ASSERT_TRUE(copy->files().adopt());
  EXPECT_TRUE(copy->files().owns_files().value());
  EXPECT_FALSE(store_->files().owns_files().value());
  ASSERT_TRUE(store_->models().remove(model.id));
  sweep_twice();
  EXPECT_EQ(files(), 3u) << "the copy may need them";
  EXPECT_EQ(copy->files().move(Direction::out_of_database, progress)->files, 3);
  expect_whole(*copy, *in_copy);

  ASSERT_TRUE(store_->files().adopt());
  EXPECT_TRUE(store_->files().owns_files().value());
  EXPECT_FALSE(copy->files().owns_files().value());
}

TEST_F(FilesOutside, a_copy_of_the_cluster_owns_no_files_after_the_original_has_adopted_them) {
  // Such a copy has the identifiers of the original.
  run("CREATE TABLE of_copy AS SELECT owner FROM file_store");
  ASSERT_TRUE(store_->files().adopt());
  EXPECT_TRUE(store_->files().owns_files().value());
  run("UPDATE file_store SET owner = of_copy.owner FROM of_copy");
  EXPECT_FALSE(store_->files().owns_files().value());
}

TEST_F(FilesOutside, content_that_nothing_uses_does_not_hold_a_site_at_its_place) {
  const Model model = create("bust");
  const auto plain = test::open_store(dsn_);
  EXPECT_EQ(plain->files().check_open().error().code, ErrorCode::conflict);
  ASSERT_TRUE(store_->models().remove(model.id));
  EXPECT_EQ(count("blobs WHERE is_outside"), 3);
  EXPECT_TRUE(plain->files().check_open());
  const auto moved = plain->files().open({(folder_.path() / "new").string(), {}});
  EXPECT_TRUE(moved) << moved.error().detail;
}

TEST(FilesInBucket, content_is_checked_swept_and_moved_as_in_a_folder) {
  const test::S3Server* server = test::shared_s3();
  if (!server) GTEST_SKIP() << "SKIPPED: Swift is not installed. ./test installs it";
  const auto dsn = test::fresh_database();
  const auto store = test::open_store(dsn);
  const auto open = store->files().open({"s3://strata/whole-site", server->endpoint});
  ASSERT_TRUE(open) << open.error().detail;
  NewModel fresh;
  fresh.model.project_id = 1;
  fresh.model.name = "bust";
  fresh.geometry = noise(9'000'000, 1);
  const auto model = store->models().create(fresh, {});
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_TRUE(store->models().geometry(model->id).value() == fresh.geometry);
  const std::string key = "whole-site/" + file_name_of(sha256(fresh.geometry));
  auto changed = fresh.geometry;
  changed.back() ^= 1;
  test::replace_object(key, {changed.begin(), changed.end()});
  EXPECT_EQ(store->models().geometry(model->id).error().code, ErrorCode::damaged);
  test::delete_object(key);
  EXPECT_EQ(store->models().geometry(model->id).error().code, ErrorCode::damaged);
  EXPECT_EQ(store->files().faults().missing, 1u);
  const auto again = store->models().create(fresh, {});
  ASSERT_TRUE(again);
  EXPECT_TRUE(store->models().geometry(model->id).value() == fresh.geometry) << "repaired";
  Progress progress;
  EXPECT_EQ(store->files().move(Direction::into_database, progress)->files, 1);
  for (int pass = 0; pass < 2; ++pass) ASSERT_TRUE(store->files().sweep(seconds(0), seconds(0)));
  EXPECT_EQ(store->files().move(Direction::out_of_database, progress)->files, 1);
  EXPECT_TRUE(store->models().geometry(model->id).value() == fresh.geometry);
  ASSERT_TRUE(store->models().remove(model->id));
  ASSERT_TRUE(store->models().remove(again->id));
  for (int pass = 0; pass < 2; ++pass) ASSERT_TRUE(store->files().sweep(seconds(0), seconds(0)));
  EXPECT_EQ(PgConnection::connect(dsn)->query("SELECT count(*) FROM blobs")->integer(0, 0), 0);
}

}  // namespace
}  // namespace strata::store
