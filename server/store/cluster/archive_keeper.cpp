#include "store/cluster/archive_keeper.h"

#include <algorithm>

#include "core/log.h"
#include "store/cluster/archive_copies.h"
#include "store/cluster/cluster.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;

constexpr auto kWatchEvery = 5s;
constexpr auto kCheckCopiesEvery = 1h;
constexpr auto kFirstPause = 1min, kMaxPause = 60min;

}  // namespace

Result<ArchiverState> archiver_state(const std::string& dsn) {
  auto connection = STRATA_TRY(PgConnection::connect(dsn));
  auto row = STRATA_TRY(connection.query(
      "SELECT current_setting('archive_mode') = 'on', last_archived_time, failed_count, "
      "coalesce(last_failed_time > coalesce(last_archived_time, '-infinity'), false) "
      "FROM pg_stat_archiver"));
  ArchiverState state;
  state.archiving = row.boolean(0, 0);
  if (!row.null(0, 1)) state.archived = row.time(0, 1);
  state.failures = static_cast<std::uint64_t>(row.integer(0, 2));
  state.failing = row.boolean(0, 3);
  return state;
}

ArchiveKeeper::ArchiveKeeper(const Cluster& cluster, ArchiveRules rules)
    : cluster_(cluster), archive_(*cluster.archive()), rules_(rules), pause_(kFirstPause) {
  thread_ = std::thread([this] { keep(); });
}

ArchiveKeeper::~ArchiveKeeper() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

ArchiveKeeper::Status ArchiveKeeper::status() const {
  std::lock_guard lock(mutex_);
  return status_;
}

bool ArchiveKeeper::goes_on() const {
  std::lock_guard lock(mutex_);
  return !stopping_;
}

void ArchiveKeeper::keep() {
  drop_unfinished(archive_);
  auto next = Clock::now();
  while (goes_on()) {
    watch_archiver();
    if (Clock::now() >= next) next = Clock::now() + keep_copies();
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kWatchEvery, [this] { return stopping_; });
  }
}

// Logs when the archiver begins to fail, and when it works again. PostgreSQL itself tries again.
void ArchiveKeeper::watch_archiver() {
  const auto state = archiver_state(cluster_.dsn("postgres"));
  if (!state) return;  // the log already reports a database that does not respond
  if (state->failing && !status_.archiver.failing)
    log::error("archive: PostgreSQL cannot write to " + archive_.wal().string() +
               ". It keeps the WAL in the data folder and tries again. Check the free space and "
               "the permissions of the archive. The reason is at the end of " +
               (cluster_.folder() / "postgres.log").string() + ".");
  if (!state->failing && status_.archiver.failing)
    log::info("archive: PostgreSQL can write to the archive again");
  std::lock_guard lock(mutex_);
  status_.archiver = *state;
}

ArchiveKeeper::Clock::duration ArchiveKeeper::keep_copies() {
  const auto made = [&]() -> Result<void> {
    if (!STRATA_TRY(needs_copy(archive_, cluster_, rules_.copy_every))) return {};
    log::info("archive: making a copy of the database in " + archive_.folder().string());
    const auto copy = STRATA_TRY(make_copy(archive_, cluster_, [this] { return goes_on(); }));
    log::info("archive: the copy " + copy.folder.filename().string() + " is complete");
    drop_old(archive_, rules_.copies);
    return {};
  }();
  const auto copies = archive_.copies();
  std::lock_guard lock(mutex_);
  if (!copies.empty()) status_.copied = copies.back().made;
  if (made) {
    pause_ = kFirstPause;
    return kCheckCopiesEvery;
  }
  if (stopping_) return kCheckCopiesEvery;
  ++status_.failed_copies;
  const auto pause = pause_;
  pause_ = std::min<Clock::duration>(pause_ * 2, kMaxPause);
  log::error("archive: no copy of the database: " + made.error().detail +
             " Check the free space and the permissions of " + archive_.folder().string() +
             ". The next try is in " +
             std::to_string(std::chrono::duration_cast<std::chrono::minutes>(pause).count()) +
             " min.");
  return pause;
}

}  // namespace strata::store
