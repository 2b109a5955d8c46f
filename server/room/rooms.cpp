#include "room/rooms.h"

#include <unistd.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <condition_variable>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <thread>
#include <utility>

#include "core/give_back_memory.h"
#include "core/log.h"
#include "core/text/slug.h"
#include "room/edits.h"
#include "room/journal_tail.h"
#include "room/layers.h"
#include "room/open/following.h"
#include "room/open/open_room.h"
#include "room/presence_exchange.h"
#include "room/role_filtered_room.h"
#include "store/content/models.h"
#include "store/nodes/nodes.h"
#include "store/store.h"

namespace strata::room {
namespace {

constexpr int kStrandThreads = 2;
constexpr int kWorkerThreads = 2;
constexpr int kReaderThreads = 2;
constexpr auto kSweepEvery = std::chrono::seconds(5);
constexpr auto kFollowAgainAfter = std::chrono::minutes(1);  // after a model could not be followed

// Returns 60 % of the memory of the machine or of its container.
std::uint64_t default_budget() {
  std::uint64_t bytes = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  std::uint64_t limit = 0;
  // If the file contains "max", it is not a number and there is no limit.
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit) bytes = std::min(bytes, limit);
  return bytes / 10 * 6;
}

const Error kClosing{ErrorCode::unavailable,
                     "Model is closing",
                     "The server is closing this model. Try again in a moment.",
                     {}};
const Error kStopping{ErrorCode::unavailable,
                      "Server is stopping",
                      "The server is stopping. Try again when it is running again.",
                      {}};
const Error kNotSaving{
    ErrorCode::unavailable,
    "Not saved",
    "This node has lost its connection to the database, so it cannot save edits. "
    "You can still view the model. Try again in a moment.",
    {}};
const Error kNoLease{ErrorCode::unavailable,
                     "Node not available",
                     "This node has lost its connection to the database, so it cannot open models. "
                     "Try again in a moment.",
                     {}};
const Error kNotFollowed{ErrorCode::unavailable,
                         "Model cannot be shown here",
                         "This node cannot show the newest state of the model. Try again in a "
                         "minute, or at the node that has the model.",
                         {}};

// The error `gone` means that the model was deleted, and `moved` that another server has it. In
// both cases, no edit waits for an answer.
Result<void> settle_if_open(OpenRoom& room) {
  auto settled = room.settle();
  if (!settled && settled.error().code != ErrorCode::gone &&
      settled.error().code != ErrorCode::moved)
    return settled;
  return {};
}

}  // namespace

struct Rooms::Impl {
  Impl(store::Store& store, render::Renderer& the_renderer, stream::StreamContext stream,
       RoomOptions options)
      : renderer(the_renderer),
        writer(store, {options.retry_for, 256u << 20}),
        strands(kStrandThreads),
        workers(kWorkerThreads),
        readers(kReaderThreads),
        memory("main memory", "--memory",
               options.memory_bytes > 0 ? options.memory_bytes : default_budget()),
        services{
            store,
            writer,
            renderer,
            stream,
            strands,
            workers,
            memory,
            readers,
            retired_keys,
            options,
            [this](const std::shared_ptr<OpenRoom>& room, const Error& why) { drop(room, why); },
            timings} {
    memory.set_evictor([this] { return drop_a_map(); });
    renderer.on_context_lost([this] {
      std::lock_guard lock(mutex);
      ++context_losses;
      for (const auto* open : {&rooms, &followers})
        for (auto& [id, room] : *open) room->gpu_lost();
    });
    if (options.node && options.follows)
      tail = std::make_unique<JournalTail>(
          store, JournalTail::Handlers{[this] { return all_in(followers); },
                                       [this](const auto& room) { drop_deleted_follower(room); },
                                       [this](const auto& room) { drop_ended_follower(room); }});
    if (options.node)
      presence =
          std::make_unique<PresenceExchange>(store, *options.node, [this] { return all_open(); });
    sweeper = std::thread([this] { sweep(); });
  }

  ~Impl() {
    {
      std::lock_guard lock(mutex);
      stopping = true;
      changed.notify_all();
    }
    sweeper.join();
    presence.reset();
    tail.reset();
    renderer.on_context_lost({});
    for (const auto& room : all_open()) room->close(kStopping);
    writer.drain();
    workers.join();
    readers.join();
    renderer.finish();  // so no callback is posted to a destroyed strand
    strands.join();
    rooms.clear();
    followers.clear();
  }

  using OpenRooms = std::map<ModelId, std::shared_ptr<OpenRoom>>;
  std::shared_ptr<OpenRoom> find(const std::string& ref) { return find(ref, rooms); }
  std::shared_ptr<OpenRoom> find(const std::string& ref, const OpenRooms& open) {
    std::lock_guard lock(mutex);
    for (auto& [id, room] : open)
      if (is_all_digits(ref) ? to_string(id) == ref : room->model().slug == ref) {
        room->touch();
        return room;
      }
    return nullptr;
  }

  // Opens a room with a claim, or one that follows another node.
  enum class Use { claim, follow };
  Result<std::shared_ptr<OpenRoom>> open(const std::string& model_ref, Use use);
  // Returns the open room for this use. Call while holding `mutex`.
  std::shared_ptr<OpenRoom> open_for(Use use, ModelId id) {
    if (const auto found = rooms.find(id); found != rooms.end()) return found->second;
    if (use == Use::claim) return nullptr;
    const auto found = followers.find(id);
    return found == followers.end() ? nullptr : found->second;
  }

  // After a suspension, the room may lack edits of another node until it was compared with the
  // journal.
  static Result<std::shared_ptr<OpenRoom>> current(std::shared_ptr<OpenRoom> room) {
    if (!room->is_current()) return tl::unexpected(kNoLease);
    return room;
  }

  // Closes a room whose model another server has claimed.
  void drop(const std::shared_ptr<OpenRoom>& room, const Error& why) {
    {
      std::lock_guard lock(mutex);
      const auto found = rooms.find(room->id());
      if (found == rooms.end() || found->second != room) return;
      rooms.erase(found);
      ++models_moved;
    }
    room->close(why);
  }

  std::shared_ptr<OpenRoom> take_follower(ModelId id) {
    std::lock_guard lock(mutex);
    const auto found = followers.find(id);
    if (found == followers.end()) return nullptr;
    auto room = std::move(found->second);
    followers.erase(found);
    return room;
  }

  // Closes a room that follows another node, because this node has the model now or stops. Its
  // participants connect again.
  void drop_follower(ModelId id, const Error& why) {
    const auto room = take_follower(id);
    if (!room) return;
    room->move_away(why);
    room->close(why);
  }

  // Returns false if the room was closed already.
  bool remove_follower(const std::shared_ptr<OpenRoom>& room) {
    std::lock_guard lock(mutex);
    const auto found = followers.find(room->id());
    if (found == followers.end() || found->second != room) return false;
    followers.erase(found);
    return true;
  }

  void drop_deleted_follower(const std::shared_ptr<OpenRoom>& room) {
    if (remove_follower(room)) room->close_deleted();
  }

  // Closes a room that does not follow any longer. Its participants connect again. If it could not
  // be kept up to date, they are sent to the owner.
  void drop_ended_follower(const std::shared_ptr<OpenRoom>& room) {
    if (room->following()->end() == OpenRoom::FollowingPart::End::failed) {
      log::warning("model " + to_string(room->id()) +
                   " of another node could not be kept up to date, so its viewers move there");
      std::lock_guard lock(mutex);
      failed_followers[room->id()] = std::chrono::steady_clock::now();
    }
    if (!remove_follower(room)) return;
    room->move_away(moved_to({}));
    room->close(moved_to({}));
  }

  // Returns whether the model could not be followed a short time ago. Call while holding `mutex`.
  bool fails_to_follow(ModelId id) const {
    const auto failed = failed_followers.find(id);
    return failed != failed_followers.end() &&
           std::chrono::steady_clock::now() - failed->second < kFollowAgainAfter;
  }

  // Without a lease, the database is probably unreachable, and the claims end with the lease.
  bool is_suspended() {
    std::lock_guard lock(mutex);
    return suspended;
  }

  // Releases a room whose edits are durable, so that another node can open its model immediately.
  void pass_on(const std::shared_ptr<OpenRoom>& room, const Error& why) {
    if (!is_suspended()) room->release();
    room->move_away(why);
    drop(room, why);
  }

  // Returns the error for the listeners of a node that drains.
  Error moved_elsewhere() {
    if (is_suspended()) return moved_to({});
    const auto other = services.store.nodes().another(*services.options.node);
    return moved_to(other && *other ? (*other)->url : std::string());
  }

  // Closes rooms that were empty for `close_after`. Returns the memory of participants who have
  // left to the system: each view takes about 15 MB, in small pieces if the CPU draws.
  void sweep() {
    std::size_t departed = 0;  // since memory was last returned
    bool due = false;  // return memory in the next round, when the renderer has released the views
    for (;;) {
      {
        std::unique_lock lock(mutex);
        if (changed.wait_for(lock, kSweepEvery, [&] { return stopping; })) return;
      }
      const auto now = std::chrono::steady_clock::now();
      bool closed = close_rooms([&](const OpenRoom& room) { return room.is_idle(now); },
                                "because nobody uses it");
      for (const auto& room : all_open()) closed |= room->drop_large_unused_maps(now);
      if (std::exchange(due, false)) give_back_memory();
      std::size_t here = 0;
      for (const auto& room : all_open()) {
        here += room->participant_count();
        departed += room->take_leave_count();
      }
      if (!closed && (departed == 0 || departed < here)) continue;
      due = true;
      departed = 0;
    }
  }

  // Drops the surface map that was unused for the longest time. Skips rooms where painting is in
  // progress. Blocks, so it must not run on a strand.
  bool drop_a_map() {
    std::vector<std::pair<SurfaceMaps::Clock::time_point, std::shared_ptr<OpenRoom>>> by_use;
    {
      std::lock_guard lock(mutex);
      for (const auto* open : {&rooms, &followers})
        for (auto& [id, room] : *open)
          if (const auto use = room->maps().oldest_use()) by_use.emplace_back(*use, room);
    }
    std::sort(by_use.begin(), by_use.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    return std::any_of(by_use.begin(), by_use.end(),
                       [](const auto& entry) { return entry.second->drop_map(); });
  }

  // Closes empty rooms early. Returns false if no room is empty.
  bool close_empty_rooms() {
    return close_rooms([](const OpenRoom& room) { return room.participant_count() == 0; },
                       "because another model needs its memory");
  }

  // Closes rooms that are not used by a request and have no edit in progress. `rooms` or
  // `followers` holds the only reference to such a room.
  bool close_rooms(const std::function<bool(const OpenRoom&)>& may_close, const char* why) {
    std::vector<std::shared_ptr<OpenRoom>> leaving;
    {
      std::lock_guard lock(mutex);
      if (suspended) return false;  // a room that is closed must be released in the database
      for (auto* open : {&rooms, &followers})
        for (auto found = open->begin(); found != open->end();) {
          if (found->second.use_count() == 1 && may_close(*found->second)) {
            leaving.push_back(std::move(found->second));
            found = open->erase(found);
          } else {
            ++found;
          }
        }
    }
    for (auto& room : leaving) {
      room->close(kClosing);
      room->release();
      log::info("closed model " + to_string(room->id()) + ", " + why);
    }
    return !leaving.empty();
  }

  std::vector<std::shared_ptr<OpenRoom>> all_in(const OpenRooms& open) {
    std::lock_guard lock(mutex);
    std::vector<std::shared_ptr<OpenRoom>> all;
    for (const auto& [id, room] : open) all.push_back(room);
    return all;
  }
  // Returns the rooms with a claim.
  std::vector<std::shared_ptr<OpenRoom>> open_ones() { return all_in(rooms); }
  // Also returns the rooms that follow other nodes.
  std::vector<std::shared_ptr<OpenRoom>> all_open() {
    auto all = open_ones();
    std::ranges::copy(all_in(followers), std::back_inserter(all));
    return all;
  }

  render::Renderer& renderer;
  store::JournalWriter writer;
  boost::asio::thread_pool strands, workers, readers;
  MemoryLedger memory;
  RetiredKeys retired_keys;
  EditTimings timings;
  const RoomServices services;
  std::mutex mutex;
  std::condition_variable changed;
  OpenRooms rooms;      // with a claim
  OpenRooms followers;  // of models that other nodes have
  // When models could not be followed any longer.
  std::map<ModelId, std::chrono::steady_clock::time_point> failed_followers;
  std::set<ModelId> opening, deleted_meanwhile;
  std::atomic<int> context_losses{0};
  std::atomic<std::uint64_t> models_moved{0};
  int suspensions = 0;
  bool suspended = false;
  bool stopping = false;
  bool draining = false;
  std::unique_ptr<JournalTail> tail;           // null: this server follows no other node
  std::unique_ptr<PresenceExchange> presence;  // null: the site has one server
  std::thread sweeper;
};

Rooms::Rooms(store::Store& store, render::Renderer& renderer, const stream::StreamContext& stream,
             RoomOptions options)
    : impl_(std::make_unique<Impl>(store, renderer, stream, options)) {}

Rooms::~Rooms() = default;

Result<std::shared_ptr<Room>> Rooms::open(const std::string& model_ref, Role seen_by) {
  auto room = STRATA_TRY(impl_->open(model_ref, Impl::Use::claim));
  return seen_as(std::move(room), seen_by);
}

Result<std::shared_ptr<Room>> Rooms::follow(const std::string& model_ref, Role seen_by) {
  auto room = impl_->open(model_ref, Impl::Use::follow);
  if (room) return seen_as(std::move(*room), seen_by);
  // The owner has the model open already. Other nodes may have no memory for it either.
  if (is_server_failure(room.error().code))
    if (const auto owner = elsewhere(model_ref); owner && *owner)
      return tl::unexpected(moved_to(**owner));
  return tl::unexpected(room.error());
}

bool Rooms::may_follow() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->tail && !impl_->draining;
}

bool Rooms::is_followed(const std::string& model_ref) const {
  const auto room = impl_->find(model_ref, impl_->followers);
  return room && room->is_current();
}

Result<std::shared_ptr<Room>> Rooms::open_to_read(const std::string& model_ref, Role seen_by) {
  if (!may_follow()) return open(model_ref, seen_by);
  const auto owner = STRATA_TRY(elsewhere(model_ref));
  return owner ? follow(model_ref, seen_by) : open(model_ref, seen_by);
}

std::optional<std::int64_t> Rooms::shown_sequence(const std::string& model_ref) const {
  auto room = impl_->find(model_ref);
  if (!room) room = impl_->find(model_ref, impl_->followers);
  return room ? std::optional(room->edits().sequence()) : std::nullopt;
}

Result<std::shared_ptr<OpenRoom>> Rooms::Impl::open(const std::string& model_ref, Use use) {
  if (is_suspended()) return tl::unexpected(kNoLease);
  // Finds an open room without the database, so viewing continues while the database is
  // unreachable.
  if (auto room = find(model_ref)) return current(std::move(room));
  if (auto room = use == Use::follow ? find(model_ref, followers) : nullptr)
    return current(std::move(room));
  auto model = STRATA_TRY(services.store.models().find(model_ref));
  const int losses_before = context_losses;
  int suspensions_before = 0;
  {
    std::unique_lock lock(mutex);
    // One caller at a time loads a model. The others wait for it.
    changed.wait(lock,
                 [&] { return stopping || draining || suspended || !opening.contains(model.id); });
    if (stopping || draining) return tl::unexpected(kStopping);
    if (suspended) return tl::unexpected(kNoLease);
    suspensions_before = suspensions;
    if (auto found = open_for(use, model.id)) {
      found->touch();
      return current(std::move(found));
    }
    if (use == Use::follow && fails_to_follow(model.id)) return tl::unexpected(kNotFollowed);
    opening.insert(model.id);
  }
  const auto load = [&] {
    const auto ref = to_string(model.id);
    return use == Use::claim ? OpenRoom::open(services, ref) : OpenRoom::follow(services, ref);
  };
  auto room = load();
  if (!room && room.error().code == ErrorCode::out_of_memory) {
    if (use == Use::claim) drop_follower(model.id, moved_to({}));
    close_empty_rooms();
    room = load();
  }
  if (room && use == Use::claim) drop_follower(model.id, moved_to({}));
  std::unique_lock lock(mutex);
  opening.erase(model.id);
  changed.notify_all();
  const bool deleted = deleted_meanwhile.erase(model.id) > 0;
  if (!room) return tl::unexpected(room.error());
  if (suspensions != suspensions_before) {
    lock.unlock();
    (*room)->close(kNoLease);
    return tl::unexpected(kNoLease);
  }
  if (deleted || draining) {
    lock.unlock();
    (*room)->close(kClosing);
    (*room)->release();
    if (!deleted) return tl::unexpected(kStopping);
    return fail(ErrorCode::not_found, "Not found", "The model was deleted.");
  }
  (use == Use::claim ? rooms : followers)[model.id] = *room;
  // The GPU data of the room belongs to a lost context.
  if (context_losses != losses_before) (*room)->gpu_lost();
  return room;
}

void Rooms::records_changed(TableId table_id) {
  for (const auto& room : impl_->all_open()) room->layers().records_changed(table_id);
}

Result<void> Rooms::retire_keys(TableId table_id, std::span<const std::int64_t> keys) {
  impl_->retired_keys.retire(table_id, keys);
  for (const auto& room : impl_->open_ones()) {
    const auto layers = room->layers().all();
    if (std::ranges::none_of(layers, [&](const Layer& layer) { return layer.table == table_id; }))
      continue;
    if (auto settled = settle_if_open(*room); !settled) return settled;
  }
  return {};
}

Result<void> Rooms::settle() {
  for (const auto& room : impl_->open_ones())
    if (auto settled = settle_if_open(*room); !settled) return settled;
  return {};
}

void Rooms::admit_keys(TableId table_id, std::span<const std::int64_t> keys) {
  impl_->retired_keys.admit(table_id, keys);
}

void Rooms::forget(ModelId model_id) {
  if (const auto follower = impl_->take_follower(model_id)) follower->close_deleted();
  std::shared_ptr<OpenRoom> room;
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->opening.contains(model_id)) impl_->deleted_meanwhile.insert(model_id);
    auto found = impl_->rooms.find(model_id);
    if (found == impl_->rooms.end()) return;
    room = std::move(found->second);
    impl_->rooms.erase(found);
  }
  room->close_deleted();
  room->release();
}

Result<std::optional<std::string>> Rooms::elsewhere(const std::string& model_ref) {
  const auto& node = impl_->services.options.node;
  if (!node || impl_->find(model_ref)) return std::nullopt;
  bool leaves = false;
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->suspended) return std::nullopt;
    leaves = impl_->draining;
  }
  auto& nodes = impl_->services.store.nodes();
  auto owner = STRATA_TRY(nodes.owner_of(model_ref));
  if (!owner && leaves) owner = STRATA_TRY(nodes.another(*node));
  if (!owner || owner->id == *node) return std::nullopt;
  return owner->url;
}

void Rooms::suspend() {
  {
    std::lock_guard lock(impl_->mutex);
    ++impl_->suspensions;
    impl_->suspended = true;
    impl_->changed.notify_all();
  }
  for (const auto& room : impl_->all_open()) room->stop_saving(kNotSaving);
  if (const auto claimed = impl_->open_ones().size(); claimed > 0)
    log::warning(std::to_string(claimed) +
                 " models are read-only, because this node may have lost them to other nodes");
}

void Rooms::resume() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->suspended = false;
    impl_->changed.notify_all();
  }
  impl_->services.store.nodes().drop_connections();
  if (impl_->tail) impl_->tail->reconnect();
  if (impl_->presence) impl_->presence->reconnect();
  for (const auto& room : impl_->all_open()) room->continue_saving();
}

std::uint64_t Rooms::models_moved() const { return impl_->models_moved; }

std::size_t Rooms::participants() const {
  std::size_t count = 0;
  for (const auto& room : impl_->all_open()) count += room->participant_count();
  return count;
}

std::uint64_t Rooms::memory_bytes_used() const { return impl_->memory.used(); }
MemoryLedger& Rooms::memory() { return impl_->memory; }
const EditTimings& Rooms::edit_timings() const { return impl_->timings; }
const store::JournalWriter& Rooms::journal() const { return impl_->writer; }

std::size_t Rooms::open_rooms() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->rooms.size() + impl_->followers.size();
}

std::size_t Rooms::followed_models() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->followers.size();
}

std::chrono::duration<double> Rooms::follower_lag() const {
  return impl_->tail ? impl_->tail->lag() : std::chrono::duration<double>(0);
}

std::vector<Rooms::Claim> Rooms::claims() const {
  std::vector<Claim> claims;
  for (const auto& room : impl_->open_ones()) claims.push_back({room->id(), room->epoch()});
  return claims;
}

void Rooms::drain() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->draining = true;  // rooms that are being opened are closed again
    impl_->changed.notify_all();
  }
  auto rooms = impl_->open_ones();
  for (const auto& room : rooms) room->take_no_edits();
  const auto deadline = std::chrono::steady_clock::now() + impl_->services.options.drain_for;
  if (impl_->services.options.node) {
    const Error why = impl_->moved_elsewhere();
    for (const auto& room : impl_->all_in(impl_->followers)) impl_->drop_follower(room->id(), why);
    // Passes on each room as soon as possible, because the users of the room wait.
    while (!rooms.empty() && std::chrono::steady_clock::now() < deadline) {
      const auto ready = std::ranges::stable_partition(
          rooms, [](const auto& room) { return !room->has_no_edits(); });
      for (const auto& room : ready) impl_->pass_on(room, why);
      rooms.erase(ready.begin(), ready.end());
      if (!rooms.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    // The clients send the remaining edits to the next owner.
    for (const auto& room : rooms) impl_->pass_on(room, why);
    impl_->writer.drain();
    return;
  }
  for (const auto& room : rooms) {
    while (!room->has_no_edits() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (room->has_no_edits()) continue;
    log::error("model " + to_string(room->id()) +
               ": the server is stopping and rejects edits that still wait");
    room->close(kStopping);
  }
  impl_->writer.drain();
}

}  // namespace strata::room
