#include "store/files/file_store.h"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "store/files/folder_files.h"
#include "store/files/s3_files.h"
#include "support/s3_server.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> pattern(std::size_t bytes, unsigned seed = 0) {
  std::vector<std::uint8_t> content(bytes);
  for (std::size_t i = 0; i < bytes; ++i)
    content[i] = static_cast<std::uint8_t>((i * 7 >> 3) + i * i + seed);
  return content;
}

// The contract of both stores. The parameter is `folder` or `s3`.
class FileStoreContract : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "s3") {
      const test::S3Server* server = test::shared_s3();
      if (!server) {
        const char* ci = std::getenv("CI");
        ASSERT_FALSE(ci && ci == std::string("true")) << "missing: Swift (scripts/setup.sh)";
        GTEST_SKIP() << "SKIPPED: Swift is not installed. ./test installs it (scripts/setup.sh)";
      }
      static int prefixes = 0;
      place_ = {"s3://strata/site-" + std::to_string(++prefixes), server->endpoint};
    } else {
      place_ = {(folder_.path() / "files").string(), {}};
    }
    files_ = reopened();
    ASSERT_TRUE(files_->write_mark("a mark"));
  }
  std::unique_ptr<FileStore> reopened() { return open_file_store(place_).value(); }
  std::set<std::string> names() {
    std::set<std::string> found;
    const auto listed = files_->list([&](const StoredFile& file) -> Result<void> {
      EXPECT_TRUE(found.insert(file_name_of(file.hash)).second);
      return {};
    });
    EXPECT_TRUE(listed) << listed.error().detail;
    return found;
  }

  test::TemporaryFolder folder_;
  FilesPlace place_;
  std::unique_ptr<FileStore> files_;
};

TEST_P(FileStoreContract, content_comes_back_bit_for_bit_from_any_place_in_it) {
  const auto bytes = pattern(3'000'001);
  const Content content = content_of(Bytes(bytes));
  const auto put = files_->put(content, {});
  ASSERT_TRUE(put) << put.error().detail;
  const auto other = reopened();
  EXPECT_TRUE(other->read(content.hash, 0, bytes.size()).value() == bytes);
  EXPECT_TRUE(other->read(content.hash, 1'048'576, 5).value() ==
              std::vector(bytes.begin() + 1'048'576, bytes.begin() + 1'048'581));
  EXPECT_EQ(other->read(content.hash, 3'000'000, 100)->size(), 1u) << "the file ends";
  EXPECT_EQ(other->read(content.hash, 4'000'000, 100)->size(), 0u);
}

TEST_P(FileStoreContract, a_file_and_no_bytes_can_be_stored) {
  const auto bytes = pattern(1'500'000, 3);
  const fs::path file = folder_.path() / "scan.ply";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  const Content content = content_of(file, {}).value();
  ASSERT_TRUE(files_->put(content, {}));
  ASSERT_TRUE(files_->put(content, {})) << "again";
  EXPECT_TRUE(files_->read(content.hash, 0, bytes.size()).value() == bytes);
  const Content nothing = content_of(Bytes());
  ASSERT_TRUE(files_->put(nothing, {}));
  EXPECT_EQ(files_->read(nothing.hash, 0, 10)->size(), 0u);
}

TEST_P(FileStoreContract, a_missing_file_is_reported_and_deletion_is_final) {
  const auto bytes = pattern(100);
  const Content content = content_of(Bytes(bytes));
  EXPECT_EQ(files_->read(content.hash, 0, 10).error().code, ErrorCode::not_found);
  EXPECT_FALSE(files_->remove(content.hash).value());
  ASSERT_TRUE(files_->put(content, {}));
  EXPECT_TRUE(files_->remove(content.hash).value());
  EXPECT_FALSE(files_->remove(content.hash).value());
  EXPECT_EQ(files_->read(content.hash, 0, 10).error().code, ErrorCode::not_found);
}

TEST_P(FileStoreContract, the_list_has_all_contents_and_nothing_else) {
  EXPECT_TRUE(names().empty()) << "the mark is no content";
  std::set<std::string> expected;
  for (unsigned i = 0; i < 20; ++i) {
    const auto bytes = pattern(10 + i, i);
    const Content content = content_of(Bytes(bytes));
    ASSERT_TRUE(files_->put(content, {}));
    expected.insert(file_name_of(content.hash));
  }
  EXPECT_EQ(names(), expected);
  const auto now = std::chrono::system_clock::now();
  ASSERT_TRUE(files_->list([&](const StoredFile& file) -> Result<void> {
    EXPECT_GE(file.bytes, 10u);
    EXPECT_LT(std::chrono::abs(now - file.changed), std::chrono::hours(1));
    return {};
  }));
  int visited = 0;
  const auto stopped = files_->list([&](const StoredFile&) -> Result<void> {
    ++visited;
    return fail(ErrorCode::cancelled, "Stop", "Stop.");
  });
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  EXPECT_EQ(visited, 1);
}

TEST_P(FileStoreContract, content_that_changes_while_it_is_sent_is_refused) {
  const auto bytes = pattern(5000);
  const fs::path file = folder_.path() / "scan.ply";
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), 5000);
  const Content content = content_of(file, {}).value();
  std::fstream(file, std::ios::binary | std::ios::in | std::ios::out) << "changed";
  const auto put = files_->put(content, {});
  ASSERT_FALSE(put);
  EXPECT_EQ(put.error().code, ErrorCode::conflict) << put.error().detail;
  fs::resize_file(file, 100);
  const auto shorter = files_->put(content, {});
  ASSERT_FALSE(shorter);
  EXPECT_EQ(shorter.error().code, ErrorCode::conflict) << shorter.error().detail;
  EXPECT_EQ(files_->read(content.hash, 0, 1).error().code, ErrorCode::not_found);
  EXPECT_TRUE(names().empty());
}

TEST_P(FileStoreContract, a_cancelled_upload_leaves_nothing) {
  const auto bytes = pattern(3'000'000);
  const Content content = content_of(Bytes(bytes));
  const auto put = files_->put(content, [] { return true; });
  ASSERT_FALSE(put);
  EXPECT_EQ(put.error().code, ErrorCode::cancelled);
  EXPECT_TRUE(names().empty());
}

TEST_P(FileStoreContract, writers_and_readers_of_one_content_do_not_disturb_each_other) {
  const auto bytes = pattern(400'000);
  const Content content = content_of(Bytes(bytes));
  ASSERT_TRUE(files_->put(content, {}));
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&, i] {
      for (int n = 0; n < 5; ++n) {
        if (i % 2 == 0) {
          const auto put = files_->put(content, {});
          EXPECT_TRUE(put) << put.error().detail;
        }
        const auto read = files_->read(content.hash, 0, bytes.size());
        ASSERT_TRUE(read) << read.error().detail;
        EXPECT_TRUE(*read == bytes);
      }
    });
  for (auto& thread : threads) thread.join();
}

TEST_P(FileStoreContract, the_mark_is_kept) {
  EXPECT_EQ(reopened()->read_mark().value(), "a mark");
}

INSTANTIATE_TEST_SUITE_P(Stores, FileStoreContract, ::testing::Values("folder", "s3"),
                         [](const auto& place) { return place.param; });

class FolderOfFiles : public ::testing::Test {
 protected:
  static Content content() {
    static const auto bytes = pattern(300'000);
    return content_of(Bytes(bytes));
  }
  test::TemporaryFolder folder_;
};

TEST_F(FolderOfFiles, a_disk_that_is_not_mounted_is_not_an_empty_one) {
  const fs::path folder = folder_.path() / "files";
  const auto files = FolderFiles::open(folder).value();
  EXPECT_FALSE(files->read_mark()->has_value());
  EXPECT_EQ(files->put(content(), {}).error().code, ErrorCode::unavailable) << "no mark";
  ASSERT_TRUE(files->write_mark("a mark"));
  ASSERT_TRUE(files->put(content(), {}));
  fs::rename(folder, folder_.path() / "elsewhere");
  fs::create_directory(folder);
  EXPECT_EQ(files->read(content().hash, 0, 1).error().code, ErrorCode::unavailable);
  EXPECT_EQ(files->put(content(), {}).error().code, ErrorCode::unavailable);
  EXPECT_EQ(files->remove(content().hash).error().code, ErrorCode::unavailable);
  EXPECT_EQ(files->list([](const StoredFile&) { return Result<void>{}; }).error().code,
            ErrorCode::unavailable);
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(FolderOfFiles, a_folder_with_other_files_is_refused) {
  std::ofstream(folder_.path() / "letter.txt") << "dear";
  const auto files = FolderFiles::open(folder_.path()).value();
  EXPECT_EQ(files->write_mark("a mark").error().code, ErrorCode::conflict);
  EXPECT_EQ(FolderFiles::open(folder_.path() / "no" / "parent").error().code,
            ErrorCode::unavailable);
}

TEST_F(FolderOfFiles, what_killed_uploads_left_is_removed_after_its_time) {
  const auto files = FolderFiles::open(folder_.path() / "files").value();
  ASSERT_TRUE(files->write_mark("a mark"));
  const fs::path left = folder_.path() / "files" / "unfinished" / "left";
  std::ofstream(left) << "half";
  ASSERT_TRUE(files->remove_unfinished(std::chrono::hours(24)));
  EXPECT_TRUE(fs::exists(left));
  fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(25));
  ASSERT_TRUE(files->remove_unfinished(std::chrono::hours(24)));
  EXPECT_FALSE(fs::exists(left));
}

TEST_F(FolderOfFiles, a_disk_of_its_own_can_be_listed) {
  const auto files = FolderFiles::open(folder_.path() / "files").value();
  fs::create_directories(folder_.path() / "files" / "lost+found");
  ASSERT_TRUE(files->write_mark("a mark"));
  ASSERT_TRUE(files->put(content(), {}));
  const fs::path lost = folder_.path() / "files" / "lost+found";
  fs::permissions(lost, fs::perms::none);  // root ignores this
  int visited = 0;
  const auto listed = files->list([&](const StoredFile&) -> Result<void> {
    ++visited;
    return {};
  });
  fs::permissions(lost, fs::perms::owner_all);
  EXPECT_TRUE(listed) << listed.error().detail;
  EXPECT_EQ(visited, 1);
}

TEST_F(FolderOfFiles, a_copy_of_a_bucket_takes_new_files) {
  const fs::path folder = folder_.path() / "files";
  fs::create_directory(folder);
  std::ofstream(folder / kFilesMark) << "a mark";
  const auto files = FolderFiles::open(folder).value();
  EXPECT_TRUE(files->remove_unfinished(std::chrono::hours(24)));
  const auto put = files->put(content(), {});
  EXPECT_TRUE(put) << put.error().detail;
}

TEST_F(FolderOfFiles, a_folder_of_another_user_gets_no_files_that_this_user_cannot_read) {
  if (geteuid() != 0) GTEST_SKIP() << "SKIPPED: no right to change the owner of a file";
  const fs::path folder = folder_.path() / "files";
  const auto files = FolderFiles::open(folder).value();
  ASSERT_TRUE(files->write_mark("a mark"));
  ASSERT_EQ(chown((folder / kFilesMark).c_str(), 65534, 65534), 0);
  EXPECT_EQ(files->put(content(), {}).error().title, "Files of another user");
  EXPECT_EQ(files->write_mark("another mark").error().title, "Files of another user");
  EXPECT_EQ(files->read_mark().value(), "a mark");
  EXPECT_TRUE(fs::is_empty(folder / "unfinished"));
}

TEST_F(FolderOfFiles, a_full_disk_is_reported_and_leaves_nothing) {
  const fs::path disk = folder_.path() / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64k") != 0)
    GTEST_SKIP() << "SKIPPED: no right to mount a small disk";
  {
    const auto files = FolderFiles::open(disk / "files").value();
    EXPECT_TRUE(files->write_mark("a mark"));
    const auto put = files->put(content(), {});
    EXPECT_FALSE(put);
    if (!put) {
      EXPECT_EQ(put.error().code, ErrorCode::storage_full) << put.error().detail;
    }
    EXPECT_TRUE(fs::is_empty(disk / "files" / "unfinished"));
    EXPECT_EQ(files->read(content().hash, 0, 1).error().code, ErrorCode::not_found);
  }
  umount(disk.c_str());
}

TEST(S3OfFiles, a_server_that_does_not_answer_is_unavailable_and_no_error_has_the_keys) {
  const S3Environment environment{
      "an-access-key", "the-secret-key", "the-session-token", "", "", ""};
  // Port 9 of this machine has no server.
  const auto files = S3Files::open({"s3://strata/site", "http://127.0.0.1:9"}, environment).value();
  const auto bytes = pattern(100);
  const Content content = content_of(Bytes(bytes));
  for (const Error& error : {files->put(content, {}).error(), files->read_mark().error(),
                             files->remove(content.hash).error()}) {
    EXPECT_EQ(error.code, ErrorCode::unavailable);
    for (const char* secret : {"an-access-key", "the-secret-key", "the-session-token"})
      EXPECT_EQ(error.detail.find(secret), std::string::npos) << error.detail;
  }
}

TEST(S3OfFiles, a_list_has_all_pages) {
  const test::S3Server* server = test::shared_s3();
  if (!server) GTEST_SKIP() << "SKIPPED: Swift is not installed";
  const auto files =
      S3Files::open({"s3://strata/pages", server->endpoint}, s3_environment(), 2).value();
  std::set<std::string> expected, found;
  for (unsigned i = 0; i < 5; ++i) {
    const auto bytes = pattern(10, i);
    const Content content = content_of(Bytes(bytes));
    ASSERT_TRUE(files->put(content, {}));
    expected.insert(file_name_of(content.hash));
  }
  const auto listed = files->list([&](const StoredFile& file) -> Result<void> {
    EXPECT_TRUE(found.insert(file_name_of(file.hash)).second);
    return {};
  });
  EXPECT_TRUE(listed) << listed.error().detail;
  EXPECT_EQ(found, expected);
}

TEST(S3OfFiles, wrong_keys_and_buckets_are_refused_and_lose_nothing) {
  const test::S3Server* server = test::shared_s3();
  if (!server) GTEST_SKIP() << "SKIPPED: Swift is not installed";
  S3Environment environment = s3_environment();
  const auto no_bucket =
      S3Files::open({"s3://another-bucket/site", server->endpoint}, environment).value();
  // A missing bucket must not look like a missing file.
  EXPECT_EQ(no_bucket->read_mark().error().code, ErrorCode::unavailable);
  EXPECT_EQ(no_bucket->read(Sha256{}, 0, 1).error().code, ErrorCode::unavailable);
  environment.secret_key = "another-secret-key";
  const auto files = S3Files::open({"s3://strata/site", server->endpoint}, environment).value();
  const auto refused = files->write_mark("a mark");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::unavailable);
  EXPECT_EQ(refused.error().detail.find("another-secret-key"), std::string::npos);
  EXPECT_EQ(files->read(Sha256{}, 0, 1).error().code, ErrorCode::unavailable);
}

}  // namespace
}  // namespace strata::store
