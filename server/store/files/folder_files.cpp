#include "store/files/folder_files.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/uuid.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

constexpr const char* kUnfinished = "unfinished";
constexpr const char* kLostAndFound = "lost+found";  // only root can read this folder of a disk
constexpr std::size_t kMaxMark = 4096;

tl::unexpected<Error> failed_file(const fs::path& file, const char* what, int error) {
  const std::string detail = std::string(what) + " " + file.string() + ": " + std::strerror(error);
  if (error == ENOSPC || error == EDQUOT)
    return fail(ErrorCode::storage_full, "Disk full",
                detail + ". Free some space on the disk of the files.", "--files");
  return fail(ErrorCode::unavailable, "Files unavailable",
              detail + ". Check the disk of the files and its permissions.", "--files");
}

class OpenFile {
 public:
  OpenFile(const fs::path& file, int flags)
      : descriptor_(open(file.c_str(), flags | O_CLOEXEC, 0600)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  explicit operator bool() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  // Closes the file. Returns false if the file system reports an error.
  bool end() { return close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

bool write_all(int descriptor, Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

// A new name in a folder is durable after the folder was synced. Some network file systems cannot
// sync folders (EINVAL).
Result<void> sync_folder(const fs::path& folder) {
  const OpenFile open(folder, O_RDONLY | O_DIRECTORY);
  if (open && (fsync(open.descriptor()) == 0 || errno == EINVAL)) return {};
  return failed_file(folder, "Cannot sync", errno);
}

// Creates the folder if it does not exist. Its parent exists.
Result<void> make_folder(const fs::path& folder) {
  if (mkdir(folder.c_str(), 0700) == 0) return sync_folder(folder.parent_path());
  if (errno == EEXIST) return {};
  return failed_file(folder, "Cannot create", errno);
}

// Deletes an unfinished file unless it was renamed.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(fs::path file) : file_(std::move(file)) {}
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile() {
    std::error_code ignored;
    fs::remove(file_, ignored);
  }
  const fs::path& path() const { return file_; }

 private:
  const fs::path file_;
};

}  // namespace

Result<std::unique_ptr<FileStore>> FolderFiles::open(const fs::path& folder) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  std::unique_ptr<FolderFiles> files(new FolderFiles(absolute));
  STRATA_TRY(make_folder(absolute));
  return std::unique_ptr<FileStore>(std::move(files));
}

// If the disk is no longer mounted, the mark is missing. Then a missing file is not lost, and
// nothing may be written below the mount point.
Result<void> FolderFiles::check_folder() const {
  struct stat facts {};
  const fs::path mark = folder_ / kFilesMark;
  if (stat(mark.c_str(), &facts) == 0) return {};
  return failed_file(mark, "Cannot find", errno);
}

// Only its user can read a file. For example, the server could not read the files of a
// `strata files move` that root ran.
Result<void> FolderFiles::check_user(int descriptor) const {
  struct stat mark {
  }, file{};
  if (stat((folder_ / kFilesMark).c_str(), &mark) != 0 || fstat(descriptor, &file) != 0 ||
      mark.st_uid == file.st_uid)
    return {};
  const passwd* user = getpwuid(mark.st_uid);
  return fail(ErrorCode::unavailable, "Files of another user",
              folder_.string() + " belongs to the user " +
                  (user ? user->pw_name : std::to_string(mark.st_uid)) +
                  ", who could not read new files. Run the command as this user, for example with "
                  "`sudo -u`.",
              "--files");
}

Result<void> FolderFiles::write_file(const fs::path& file, const Write& write) {
  const UnfinishedFile unfinished(folder_ / kUnfinished / to_string(random_uuid()));
  OpenFile out(unfinished.path(), O_WRONLY | O_CREAT | O_EXCL);
  if (!out) return failed_file(unfinished.path(), "Cannot create", errno);
  STRATA_TRY(check_user(out.descriptor()));
  STRATA_TRY(write([&](Bytes bytes) -> Result<void> {
    if (!write_all(out.descriptor(), bytes))
      return failed_file(unfinished.path(), "Cannot write", errno);
    return {};
  }));
  if (fsync(out.descriptor()) != 0 || !out.end())
    return failed_file(unfinished.path(), "Cannot write", errno);
  if (rename(unfinished.path().c_str(), file.c_str()) != 0)
    return failed_file(file, "Cannot create", errno);
  return sync_folder(file.parent_path());
}

Result<void> FolderFiles::put(const Content& content, const std::function<bool()>& cancelled) {
  const fs::path file = path_of(content.hash);
  STRATA_TRY(check_folder());
  STRATA_TRY(make_folder(folder_ / kUnfinished));  // a copy of a bucket has no such folder
  STRATA_TRY(make_folder(file.parent_path().parent_path()));
  STRATA_TRY(make_folder(file.parent_path()));
  // Another thread may have made these folders, and not yet synced them.
  STRATA_TRY(sync_folder(folder_));
  STRATA_TRY(sync_folder(file.parent_path().parent_path()));
  return write_file(file, [&](const std::function<Result<void>(Bytes)>& sink) {
    return each_chunk(content, cancelled, sink);
  });
}

Result<std::vector<std::uint8_t>> FolderFiles::read(const Sha256& hash, std::uint64_t begin,
                                                    std::size_t size) {
  const fs::path path = path_of(hash);
  const OpenFile file(path, O_RDONLY);
  if (!file) {
    const int error = errno;
    if (error != ENOENT) return failed_file(path, "Cannot open", error);
    STRATA_TRY(check_folder());
    return fail(ErrorCode::not_found, "File missing", "There is no file " + path.string() + ".");
  }
  std::vector<std::uint8_t> bytes(size);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = pread(file.descriptor(), bytes.data() + done, size - done,
                                static_cast<off_t>(begin + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return failed_file(path, "Cannot read", errno);
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

Result<bool> FolderFiles::remove(const Sha256& hash) {
  STRATA_TRY(check_folder());
  const fs::path path = path_of(hash);
  if (unlink(path.c_str()) == 0) {
    STRATA_TRY(sync_folder(path.parent_path()));
    return true;
  }
  if (errno == ENOENT) return false;
  return failed_file(path, "Cannot delete", errno);
}

Result<void> FolderFiles::list(const std::function<Result<void>(const StoredFile&)>& visit) {
  STRATA_TRY(check_folder());
  std::error_code error;
  fs::recursive_directory_iterator entry(folder_, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const fs::path& path = entry->path();
    if (entry.depth() == 0 &&
        (path.filename() == kUnfinished || path.filename() == kLostAndFound)) {
      entry.disable_recursion_pending();
      continue;
    }
    const auto hash = hash_of_file_name(path.lexically_relative(folder_).generic_string());
    if (!hash) continue;
    struct stat facts {};
    if (stat(path.c_str(), &facts) != 0) continue;  // deleted since then
    STRATA_TRY(visit({*hash, static_cast<std::uint64_t>(facts.st_size),
                      std::chrono::system_clock::from_time_t(facts.st_mtime)}));
  }
  return error ? failed_file(folder_, "Cannot list", error.value()) : Result<void>{};
}

Result<void> FolderFiles::remove_unfinished(std::chrono::seconds age) {
  const auto oldest = std::chrono::system_clock::now() - age;
  std::error_code error;
  fs::directory_iterator entry(folder_ / kUnfinished, error);
  if (error == std::errc::no_such_file_or_directory) return {};
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    struct stat facts {};
    if (stat(entry->path().c_str(), &facts) != 0) continue;
    if (std::chrono::system_clock::from_time_t(facts.st_mtime) <= oldest) {
      std::error_code ignored;  // the next call tries again
      fs::remove(entry->path(), ignored);
    }
  }
  return error ? failed_file(folder_ / kUnfinished, "Cannot list", error.value()) : Result<void>{};
}

Result<std::optional<std::string>> FolderFiles::read_mark() {
  const fs::path path = folder_ / kFilesMark;
  const OpenFile file(path, O_RDONLY);
  if (!file && errno == ENOENT) return std::optional<std::string>();
  if (!file) return failed_file(path, "Cannot open", errno);
  std::string text(kMaxMark, '\0');
  const ssize_t count = pread(file.descriptor(), text.data(), text.size(), 0);
  if (count < 0) return failed_file(path, "Cannot read", errno);
  text.resize(static_cast<std::size_t>(count));
  return std::optional(std::move(text));
}

Result<void> FolderFiles::write_mark(const std::string& text) {
  const bool is_first = !STRATA_TRY(read_mark());
  if (is_first) STRATA_TRY(check_is_new());
  STRATA_TRY(make_folder(folder_ / kUnfinished));
  return write_file(folder_ / kFilesMark, [&](const std::function<Result<void>(Bytes)>& sink) {
    return sink({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  });
}

Result<void> FolderFiles::check_is_new() const {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename();
    if (name != kUnfinished && name != kFilesMark && name != kLostAndFound)
      return fail(ErrorCode::conflict, "Folder not empty",
                  folder_.string() + " contains " + name +
                      ". Choose a new folder for the files of this site.",
                  "--files");
  }
  return error ? failed_file(folder_, "Cannot list", error.value()) : Result<void>{};
}

}  // namespace strata::store
