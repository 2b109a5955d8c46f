#include "store/journal/journal_writer.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>

#include "core/log.h"
#include "core/trace.h"
#include "store/journal/journal_commit.h"
#include "store/store_impl.h"

namespace strata::store {

// Not in the unnamed namespace, because it is the type of a class member.
struct WaitingEntry {
  JournalEntry entry;
  JournalWriter::Done done;
  std::size_t bytes;
};

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kGroupEntries = 256;
constexpr std::size_t kGroupBytes = 16u << 20;
constexpr std::chrono::milliseconds kRetryPause{100};

std::size_t bytes_of(const nlohmann::json& json) {
  if (!json.is_structured())
    return sizeof(json) + (json.is_string() ? json.get_ref<const std::string&>().size() : 0);
  std::size_t bytes = sizeof(json);
  for (const auto& [key, value] : json.items())
    bytes += bytes_of(value) + (json.is_object() ? key.size() + 48 : 0);
  return bytes;
}

std::size_t bytes_of(const JournalEntry& entry) {
  std::size_t bytes =
      sizeof(WaitingEntry) + entry.user.size() + bytes_of(entry.record) + bytes_of(entry.answer);
  for (const auto& revision : entry.revisions)
    bytes += sizeof(revision) + revision.difference.size() + revision.key_tile.size();
  return bytes;
}

std::vector<const JournalEntry*> pointers(const std::deque<WaitingEntry>& group) {
  std::vector<const JournalEntry*> entries;
  for (const auto& waiting : group) entries.push_back(&waiting.entry);
  return entries;
}

}  // namespace

struct JournalWriter::Impl {
  Impl(std::string given_dsn, Options given) : dsn(std::move(given_dsn)), options(given) {}

  const std::string dsn;
  const Options options;

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::deque<WaitingEntry> queue;
  std::size_t waiting_bytes = 0;  // bytes in the queue and in the current group
  std::uint64_t submitted = 0;
  std::uint64_t answered = 0;
  bool closing = false;
  bool failing = false;  // the last commit failed and is being retried

  Histogram commit_times;
  std::atomic<std::uint64_t> failed_commits{0};

  // Only the thread of the writer uses these members.
  std::optional<PgConnection> connection;
  std::thread thread;

  void run() {
    for (;;) {
      std::deque<WaitingEntry> group = take_group();
      if (group.empty()) return;
      write(group);
    }
  }

  std::deque<WaitingEntry> take_group() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return closing || !queue.empty(); });
    std::deque<WaitingEntry> group;
    std::size_t bytes = 0;
    while (!queue.empty() && group.size() < kGroupEntries && bytes < kGroupBytes) {
      bytes += queue.front().bytes;
      group.push_back(std::move(queue.front()));
      queue.pop_front();
    }
    return group;
  }

  void answer_front(std::deque<WaitingEntry>& group, const Result<void>& result) {
    std::size_t bytes = 0;
    {
      const TraceScope scope(group.front().entry.trace);
      WaitingEntry waiting = std::move(group.front());
      group.pop_front();
      waiting.done(result);
      bytes = waiting.bytes;
    }
    // Destroy `waiting` before `answered` is incremented: after a drain, the caller may destroy the
    // objects that `waiting` refers to.
    std::lock_guard lock(mutex);
    waiting_bytes -= bytes;
    ++answered;
    changed.notify_all();
  }

  void set_failing(bool now) {
    std::lock_guard lock(mutex);
    failing = now;
    changed.notify_all();
  }

  // Writes the group. Tries again until every entry of the group has a result.
  void write(std::deque<WaitingEntry>& group) {
    const auto started = Clock::now();
    bool failed_before = false;
    while (!group.empty()) {
      auto outcome = attempt(group, failed_before);
      if (outcome) {
        set_failing(false);
        while (!group.empty()) answer_front(group, {});
        if (failed_before) log::info("journal: commits succeed again");
        return;
      }
      if (!outcome.error().transient) {
        outcome = one_by_one(group);
        if (outcome) {
          set_failing(false);
          return;
        }
      }
      set_failing(true);
      if (!std::exchange(failed_before, true))
        log::warning("journal: a commit failed and is tried again: " +
                     outcome.error().problem.detail);
      if (Clock::now() - started >= options.retry_for) {
        give_up(group, outcome.error().problem);
        return;
      }
      std::this_thread::sleep_for(kRetryPause);
    }
    set_failing(false);
  }

  tl::expected<PgConnection*, CommitFailure> connected() {
    if (connection && connection->alive()) return &*connection;
    connection.reset();
    auto fresh = PgConnection::connect(dsn, options.limits);
    if (!fresh) return tl::unexpected(CommitFailure{fresh.error(), true});
    // The writer never pauses within a transaction. If this node is cut off, another one can soon
    // claim the models, whose rows the transaction locks.
    if (auto set = fresh->script("SET idle_in_transaction_session_timeout = '3s'"); !set)
      return tl::unexpected(CommitFailure{set.error(), true});
    connection.emplace(std::move(*fresh));
    return &*connection;
  }

  // Reports success for the entries that an earlier attempt committed although its response was
  // lost. A transaction is atomic, so these entries are at the front of the group.
  tl::expected<void, CommitFailure> skip_saved(PgConnection& to, std::deque<WaitingEntry>& group) {
    const auto saved = find_saved(to, pointers(group));
    if (!saved) return tl::unexpected(CommitFailure{saved.error(), true});
    for (std::size_t i = 0; i < saved->size() && (*saved)[i]; ++i) answer_front(group, {});
    return {};
  }

  tl::expected<void, CommitFailure> attempt(std::deque<WaitingEntry>& group, bool retry) {
    auto to = STRATA_TRY(connected());
    if (retry) STRATA_TRY(skip_saved(*to, group));
    return group.empty() ? tl::expected<void, CommitFailure>{} : commit(*to, pointers(group));
  }

  // Commits the entries, and counts the time of the transaction. Log lines about the transaction
  // have the trace of its first entry.
  tl::expected<void, CommitFailure> commit(PgConnection& to,
                                           std::span<const JournalEntry* const> entries) {
    const TraceScope scope(entries.front()->trace);
    const auto begin = Clock::now();
    auto committed = commit_entries(to, entries);
    const auto duration = Clock::now() - begin;
    if (committed)
      commit_times.add(duration);
    else
      failed_commits.fetch_add(1, std::memory_order_relaxed);
    if (log::is_enabled(log::Level::debug)) {
      const log::Field fields[] = {
          {"entries", static_cast<std::int64_t>(entries.size())},
          {"commit_ms", std::chrono::duration<double, std::milli>(duration).count()}};
      log::write(log::Level::debug, committed ? "journal: committed" : "journal: a commit failed",
                 fields);
    }
    return committed;
  }

  // Commits each entry in a separate transaction, because one entry of the group can never be
  // written. Later entries of the same model fail too, because they depend on it. (A lower sequence
  // or another epoch means that the caller has started again.)
  tl::expected<void, CommitFailure> one_by_one(std::deque<WaitingEntry>& group) {
    struct Broken {
      std::int64_t sequence, epoch;
      Error problem;
    };
    std::map<ModelId, Broken> broken;
    while (!group.empty()) {
      const JournalEntry* entry = &group.front().entry;
      if (const auto before = broken.find(entry->model_id);
          before != broken.end() && entry->epoch == before->second.epoch &&
          entry->sequence > before->second.sequence) {
        Error problem = before->second.problem;
        if (problem.code != ErrorCode::moved)
          problem.detail =
              "The server did not save this edit, because it could not save an earlier one: " +
              problem.detail;
        answer_front(group, tl::unexpected(problem));
        continue;
      }
      auto to = STRATA_TRY(connected());
      auto committed = commit(*to, std::span(&entry, 1));
      if (!committed && committed.error().transient) return committed;
      bool saved = committed.has_value();
      if (!saved) {
        const auto found = find_saved(*to, std::span(&entry, 1));
        if (!found) return tl::unexpected(CommitFailure{found.error(), true});
        saved = (*found)[0];
      }
      if (saved) {
        broken.erase(entry->model_id);
        answer_front(group, {});
        continue;
      }
      broken.insert_or_assign(entry->model_id,
                              Broken{entry->sequence, entry->epoch, committed.error().problem});
      answer_front(group, tl::unexpected(committed.error().problem));
    }
    return {};
  }

  void give_up(std::deque<WaitingEntry>& group, const Error& problem) {
    log::error("journal: commits kept failing, waiting edits are not saved: " + problem.detail);
    std::deque<WaitingEntry> waiting;
    {
      std::lock_guard lock(mutex);
      waiting.swap(queue);
    }
    while (!group.empty()) answer_front(group, tl::unexpected(problem));
    while (!waiting.empty()) answer_front(waiting, tl::unexpected(problem));
    connection.reset();
    set_failing(false);
  }
};

JournalWriter::JournalWriter(Store& store, Options options)
    : impl_(std::make_unique<Impl>(store.impl_->options.dsn, options)) {
  impl_->thread = std::thread([this] { impl_->run(); });
}

JournalWriter::~JournalWriter() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->closing = true;
    impl_->changed.notify_all();
  }
  impl_->thread.join();
}

bool JournalWriter::submit(JournalEntry entry, Done done) {
  const std::size_t bytes = bytes_of(entry);
  std::lock_guard lock(impl_->mutex);
  // A single entry larger than the limit (a large import) is accepted when nothing else waits.
  const bool full =
      impl_->waiting_bytes > 0 && impl_->waiting_bytes + bytes > impl_->options.max_waiting_bytes;
  if (impl_->closing || impl_->failing || full) return false;
  impl_->queue.push_back({std::move(entry), std::move(done), bytes});
  impl_->waiting_bytes += bytes;
  ++impl_->submitted;
  impl_->changed.notify_all();
  return true;
}

bool JournalWriter::accepting() const {
  std::lock_guard lock(impl_->mutex);
  return !impl_->closing && !impl_->failing &&
         impl_->waiting_bytes < impl_->options.max_waiting_bytes;
}

std::size_t JournalWriter::waiting() const {
  std::lock_guard lock(impl_->mutex);
  return static_cast<std::size_t>(impl_->submitted - impl_->answered);
}

const Histogram& JournalWriter::commit_times() const { return impl_->commit_times; }
std::uint64_t JournalWriter::failed_commits() const { return impl_->failed_commits; }

void JournalWriter::drain() {
  std::unique_lock lock(impl_->mutex);
  const std::uint64_t until = impl_->submitted;
  impl_->changed.wait(lock, [&] { return impl_->answered >= until && !impl_->failing; });
}

}  // namespace strata::store
