#include <boost/asio/post.hpp>
#include <condition_variable>
#include <set>
#include <thread>

#include "core/log.h"
#include "core/slug.h"
#include "room/open_room.h"

namespace strata::room {
namespace {

constexpr int kStrandThreads = 2;
constexpr int kWorkerThreads = 2;
constexpr int kReaderThreads = 2;
constexpr auto kSweepEvery = std::chrono::seconds(5);

const Problem kClosing{503, "Model is closing", "The server is letting go of this model; try again in a moment.", {}};
const Problem kStopping{503, "Server is stopping", "Try again when it is back.", {}};

}  // namespace

struct Rooms::Impl {
  Impl(store::Store& store, render::Renderer& the_renderer, stream::StreamContext stream, RoomOptions options)
      : renderer(the_renderer),
        writer(store, {options.retry_for, 256u << 20}),
        strands(kStrandThreads),
        workers(kWorkerThreads),
        readers(kReaderThreads),
        parts{store, writer, renderer, stream, strands, workers, readers, options} {
    renderer.on_context_lost([this] {
      std::lock_guard lock(mutex);
      ++context_losses;
      for (auto& [id, room] : rooms) room->gpu_lost();
    });
    sweeper = std::thread([this] { sweep(); });
  }

  ~Impl() {
    {
      std::lock_guard lock(mutex);
      stopping = true;
      changed.notify_all();
    }
    sweeper.join();
    renderer.on_context_lost({});
    for (auto& [id, room] : rooms) room->shut(kStopping);
    writer.drain();
    workers.join();
    readers.join();
    renderer.finish();  // nothing comes back to strands that are gone
    strands.join();
    rooms.clear();
  }

  std::shared_ptr<OpenRoom> find(const std::string& ref) {
    std::lock_guard lock(mutex);
    for (auto& [id, room] : rooms)
      if (is_all_digits(ref) ? std::to_string(id) == ref : room->model().slug == ref) {
        room->touch();
        return room;
      }
    return nullptr;
  }

  // Lets go of rooms that nobody has been in for a while.
  void sweep() {
    std::unique_lock lock(mutex);
    while (!stopping) {
      changed.wait_for(lock, kSweepEvery, [&] { return stopping; });
      std::vector<std::shared_ptr<OpenRoom>> leaving;
      const auto now = std::chrono::steady_clock::now();
      for (auto found = rooms.begin(); !stopping && found != rooms.end();) {
        // Ours is the only reference: no request is looking at it, and no edit waits for an answer.
        if (found->second.use_count() == 1 && found->second->deserted(now)) {
          leaving.push_back(std::move(found->second));
          found = rooms.erase(found);
        } else {
          ++found;
        }
      }
      lock.unlock();
      for (auto& room : leaving) {
        room->shut(kClosing);
        log::info("closed model " + std::to_string(room->id()) + ", nobody is looking");
      }
      leaving.clear();
      lock.lock();
    }
  }

  render::Renderer& renderer;
  store::JournalWriter writer;
  boost::asio::thread_pool strands, workers, readers;
  const RoomParts parts;
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::int64_t, std::shared_ptr<OpenRoom>> rooms;
  std::set<std::int64_t> opening, deleted_meanwhile;
  std::atomic<int> context_losses{0};
  bool stopping = false;
  bool draining = false;
  std::thread sweeper;
};

Rooms::Rooms(store::Store& store, render::Renderer& renderer, stream::StreamContext stream, RoomOptions options)
    : impl_(std::make_unique<Impl>(store, renderer, stream, options)) {}

Rooms::~Rooms() = default;

Result<std::shared_ptr<Room>> Rooms::open(const std::string& model_ref) {
  // An open room is found without the database, so that viewing goes on when that is away.
  if (auto room = impl_->find(model_ref)) return room;
  auto model = impl_->parts.store.model(model_ref);
  if (!model) return tl::unexpected(model.error());
  const int losses_before = impl_->context_losses;
  {
    std::unique_lock lock(impl_->mutex);
    // One at a time loads a model; the others wait for it.
    impl_->changed.wait(lock,
                        [&] { return impl_->stopping || impl_->draining || !impl_->opening.contains(model->id); });
    if (impl_->stopping || impl_->draining) return tl::unexpected(kStopping);
    if (auto found = impl_->rooms.find(model->id); found != impl_->rooms.end()) {
      found->second->touch();
      return found->second;
    }
    impl_->opening.insert(model->id);
  }
  auto room = OpenRoom::open(impl_->parts, std::to_string(model->id));
  std::unique_lock lock(impl_->mutex);
  impl_->opening.erase(model->id);
  impl_->changed.notify_all();
  const bool deleted = impl_->deleted_meanwhile.erase(model->id) > 0;
  if (!room) return tl::unexpected(room.error());
  if (deleted || impl_->draining) {
    lock.unlock();
    (*room)->shut(kClosing);
    if (!deleted) return tl::unexpected(kStopping);
    return fail(404, "Not found", "The model was deleted.");
  }
  impl_->rooms[model->id] = *room;
  if (impl_->context_losses != losses_before) (*room)->gpu_lost();  // it was filled in vain
  return std::static_pointer_cast<Room>(*room);
}

void Rooms::forget(std::int64_t model_id) {
  std::shared_ptr<OpenRoom> room;
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->opening.contains(model_id)) impl_->deleted_meanwhile.insert(model_id);
    auto found = impl_->rooms.find(model_id);
    if (found == impl_->rooms.end()) return;
    room = std::move(found->second);
    impl_->rooms.erase(found);
  }
  room->shut_deleted();
}

std::size_t Rooms::open_rooms() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->rooms.size();
}

void Rooms::drain() {
  std::vector<std::shared_ptr<OpenRoom>> rooms;
  {
    std::lock_guard lock(impl_->mutex);
    impl_->draining = true;  // a room that is being opened is not kept
    impl_->changed.notify_all();
    for (auto& [id, room] : impl_->rooms) rooms.push_back(room);
  }
  for (auto& room : rooms) room->take_no_edits();
  const auto deadline = std::chrono::steady_clock::now() + impl_->parts.options.drain_for;
  for (auto& room : rooms) {
    while (!room->idle() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (room->idle()) continue;
    log::error("model " + std::to_string(room->id()) + ": edits still wait and are refused, since the server stops");
    room->shut(kStopping);
  }
  impl_->writer.drain();
}

}  // namespace strata::room
