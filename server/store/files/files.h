#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "store/files/file_store.h"

namespace strata::store {

class Blobs;
class Pool;

struct FilesFacts {
  std::string place;               // the last place of the files; empty: none was used yet
  std::int64_t outside_files = 0;  // contents in use that are outside the database
  std::int64_t outside_bytes = 0;
  std::int64_t inside_files = 0;
  std::int64_t inside_bytes = 0;
};

struct FileProblem {
  enum class Kind { missing, changed, superfluous };
  Kind kind;
  std::string name;
  std::uint64_t bytes = 0;
  std::string used_by;  // the things that need the file, such as `model Pot`
};

struct FileFaults {
  std::uint64_t missing = 0, changed = 0, unreachable = 0;  // failed reads since the start
};

// The content outside the database, as a whole. Part of Store, whose rules for threads and errors
// apply. `Blobs` stores and reads single contents.
//
// A file is deleted in four steps, each durable before the next:
//   1. `unused`: the sweep notices that nothing uses the content
//   2. `removing`: it was unused for `keep`; from now on, new content with this hash goes into the
//      database, so that no upload relies on the file
//   3. the file is deleted after kRest, when no upload that began before step 2 continues
//   4. the row is deleted after another kRest, when no delayed request can delete a later file
//
// The file of content that was moved into the database remains for `keep`, too, because a backup of
// the database may need it.
class Files {
 public:
  static constexpr std::chrono::seconds kRest = std::chrono::hours(1);

  Files(Pool& pool, Blobs& blobs) : pool_(pool), blobs_(blobs) {}

  // Uses this place for new content. Call before other threads use the store. Returns a `conflict`
  // error if the place belongs to another site, or does not have the files of this site.
  Result<void> open(const FilesPlace& place);
  Result<void> open(std::unique_ptr<FileStore> files);
  bool is_open() const;
  // Returns a `conflict` error if content is outside the database, but no place is open.
  Result<void> check_open();
  // Returns whether this database may write and delete files. A restored copy of the database may
  // not, as long as it uses the place of the original.
  Result<bool> owns_files();
  // Lets this database write and delete files, and no other.
  Result<void> adopt();

  Result<FilesFacts> facts();
  FileFaults faults() const;
  void stop_uploads();  // ends all uploads soon, because the server stops

  // Deletes files that nothing has used for `keep`. Works in small steps, and returns true if there
  // may be more to do. Does nothing if this database does not own the files. Ends soon after
  // `cancelled`. If some files cannot be deleted, deletes the others, and returns the first error.
  Result<bool> sweep(std::chrono::seconds keep, std::chrono::seconds rest = kRest,
                     const std::function<bool()>& cancelled = {});
  // Finds files without a row that are older than a day. The sweep then deletes them after `keep`.
  // Such files remain if an older database is restored, and a restore of a newer backup needs them.
  Result<void> find_superfluous(const std::function<bool()>& cancelled = {});

  enum class Direction { out_of_database, into_database };
  struct Moved {
    std::int64_t files = 0, bytes = 0;
    std::int64_t skipped = 0;  // too large for the file store, or being removed
  };
  // Moves content, one file after the other, and can be repeated after an interruption. The server
  // can continue to run. If files are missing or changed, moves the others, and returns `damaged`.
  Result<Moved> move(Direction direction, Progress& progress);

  struct Checked {
    std::int64_t files = 0, bytes = 0;
  };
  // Reads all files and compares them with their hashes. Calls `found` for each problem.
  // A file is superfluous if it has no row and is older than a day.
  Result<Checked> check(const std::function<void(const FileProblem&)>& found, Progress& progress);

 private:
  struct Row {
    Sha256 hash{};
    std::int64_t bytes = 0;
  };
  Result<void> remove_marked(std::chrono::seconds keep, std::chrono::seconds rest,
                             const std::function<bool()>& cancelled, bool& more);
  Result<void> finish(Bytes hash, std::chrono::seconds keep, std::chrono::seconds rest);
  Result<void> each_without_row(
      const std::function<bool()>& cancelled,
      const std::function<Result<void>(const std::vector<StoredFile>&)>& visit);
  Result<std::vector<Row>> rows_after(Bytes last, bool is_outside);
  // Calls `visit` for each content in use, in the order of the hashes.
  Result<void> each_row(bool is_outside, Progress& progress, const char* what,
                        const std::function<Result<void>(const Row&)>& visit);
  Result<bool> move_one(const Row& row, bool into, const Progress& progress);
  Result<bool> put_out(const Content& content, const std::function<bool()>& cancelled);
  Result<bool> take_in(const Content& content, const std::function<bool()>& cancelled);
  Result<std::string> users_of(Bytes hash);

  Pool& pool_;
  Blobs& blobs_;
};

}  // namespace strata::store
