#include "render/renderer.h"

#include <atomic>
#include <future>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "core/log.h"
#include "core/trace.h"
#include "render/thread/frame_job.h"
#include "render/thread/frame_queue.h"
#include "render/thread/gpu_scene.h"
#include "render/thread/gpu_thread.h"
#include "render/thread/paint_job.h"
#include "render/thread/refinements.h"
#include "render/thread/upload_jobs.h"

namespace strata::render {

struct Renderer::Impl {
  explicit Impl(RendererOptions given)
      : options(std::move(given)),
        thread(options.queue_capacity),
        frames(options.queue_capacity),
        memory(0) {}

  RendererOptions options;
  gl::DebugMessages messages;
  GpuThread thread;
  FrameQueue frames;
  Refinements refinements;
  GpuMemory memory;
  Histogram frame_times;
  std::unique_ptr<GpuScene> scene;                       // used on the GPU thread only
  std::uint64_t generation = 0;                          // used on the GPU thread only
  std::vector<std::weak_ptr<const FrameJob>> under_way;  // used on the GPU thread only
  std::atomic<bool> lose_context{false};

  // Held during the call of the callback, so the removal of the callback waits for that call.
  std::mutex lost_callback_mutex;
  std::function<void()> lost_callback;

  mutable std::mutex mutex;  // guards the members below
  GpuInfo info;
  std::unordered_map<LayerHandle, std::shared_ptr<std::atomic<std::uint64_t>>> layer_bytes;

  Result<void> make_scene() {
    auto made = STRATA_TRY(GpuScene::create(options, ++generation, memory, messages));
    scene = std::move(made);
    std::lock_guard lock(mutex);
    info = scene->info();
    return {};
  }

  Result<void> recover() {
    scene.reset();
    lose_context = false;
    {
      std::lock_guard lock(mutex);
      layer_bytes.clear();
    }
    STRATA_TRY(make_scene());
    log::warning(
        "The GPU context was lost and created again; the server uploads the models again.");
    std::lock_guard lock(lost_callback_mutex);
    if (lost_callback) lost_callback();
    return {};
  }

  // Starts a frame, usually a rectangle, whose turn precedes all turns of frames in progress.
  std::optional<Job> next_part() {
    std::erase_if(under_way, [](const auto& frame) { return frame.expired(); });
    std::vector<FrameTask::Turn> turns;
    for (const auto& one : under_way)
      if (const auto frame = one.lock()) turns.push_back(frame->turn());
    return start(frames.take_part(turns));
  }

  std::optional<Job> start(std::optional<FrameTask> task) {
    if (!task) return std::nullopt;
    auto frame = std::make_shared<FrameJob>(std::move(*task));
    under_way.push_back(frame);
    return Job{[this, frame] {
                 const Step step = frame->step(*scene);
                 if (step == Step::done) {
                   frames.finished(frame->task(), frame->busy_ms(), frame->is_drawn());
                   frame_times.add(std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::duration<double, std::milli>(frame->busy_ms())));
                 }
                 return step;
               },
               [frame](const Error& problem) { frame->abort(problem); }};
  }

  void refine(FrameRequest request, Done<SharedFrame> done) {
    const auto task = refinements.push(std::move(request), std::move(done));
    if (!task) return;
    const auto answer = [this, task](const Result<SharedFrame>& frame) {
      refinements.answer(*task, frame);
    };
    struct Refinement {
      Refinements& all;
      std::shared_ptr<Refinements::Task> task;
      FrameJob frame;
      Step step(GpuScene& at) { return all.continues(*task) ? frame.step(at) : Step::done; }
      void abort(const Error& problem) { frame.abort(problem); }
    };
    FrameTask frame{task->request, {{task->request.view, answer, {}}}, {}};
    post(Lane::idle,
         std::make_shared<Refinement>(Refinement{refinements, task, FrameJob(std::move(frame))}));
  }

  // Posts a job object with `step(GpuScene&)` and `abort`. Aborts the job if the queue is full.
  template <class JobType>
  void post(Lane lane, std::shared_ptr<JobType> job) {
    // Log lines of the job belong to the trace of the caller.
    Job posted{[this, job, trace = current_trace()] {
                 const TraceScope scope(trace);
                 return job->step(*scene);
               },
               [job](const Error& problem) { job->abort(problem); }};
    if (thread.post(lane, std::move(posted))) return;
    thread.post_reply([job] {
      job->abort({ErrorCode::busy,
                  "GPU queue full",
                  "The queue of the GPU is full. Try again in a moment.",
                  {}});
    });
  }

  // Posts a job of one step that returns a T.
  template <class T>
  void post_simple(Done<T> done, std::function<Result<T>(GpuScene&)> work) {
    struct Simple {
      Done<T> done;
      std::function<Result<T>(GpuScene&)> work;
      Step step(GpuScene& at) {
        done(work(at));
        return Step::done;
      }
      void abort(const Error& problem) { done(tl::unexpected(problem)); }
    };
    post(Lane::ordered, std::make_shared<Simple>(Simple{std::move(done), std::move(work)}));
  }

  void add_layer(ModelHandle model, ValueType type, int resolution,
                 std::shared_ptr<const TileMirror> mirror, Done<LayerHandle> done) {
    post_simple<LayerHandle>(
        std::move(done), [this, model, type, resolution, mirror = std::move(mirror)](GpuScene& at) {
          auto handle = at.add_layer(model, type, resolution, mirror);
          if (handle) {
            const auto layer = at.layer(*handle);
            std::lock_guard lock(mutex);
            layer_bytes[*handle] = (*layer)->textures().bytes();
          }
          return handle;
        });
  }

  // A full queue accepts removals, because they free memory. After a lost context there is nothing
  // to remove.
  void post_removal(std::function<void(GpuScene&)> work) {
    Job job{[this, work = std::move(work)] {
              work(*scene);
              return Step::done;
            },
            [](const Error&) {}};
    thread.post(Lane::ordered, std::move(job), true);
  }
};

Renderer::Renderer() = default;

Renderer::~Renderer() {
  if (impl_) impl_->thread.stop();
}

Result<std::unique_ptr<Renderer>> Renderer::start(RendererOptions options) {
  std::unique_ptr<Renderer> renderer(new Renderer);
  renderer->impl_ = std::make_unique<Impl>(std::move(options));
  Impl* impl = renderer->impl_.get();
  GpuThread::Hooks hooks;
  hooks.start = [impl] { return impl->make_scene(); };
  hooks.stop = [impl] { impl->scene.reset(); };
  hooks.lost = [impl] { return impl->lose_context || impl->scene->lost(); };
  hooks.recover = [impl] { return impl->recover(); };
  hooks.next_frame = [impl] { return impl->start(impl->frames.take()); };
  hooks.next_part = [impl] { return impl->next_part(); };
  hooks.abort_frames = [impl](const Error& problem) {
    for (FrameTask& task : impl->frames.take_all()) FrameJob(std::move(task)).abort(problem);
  };
  STRATA_TRY(impl->thread.start(std::move(hooks)));
  return renderer;
}

GpuInfo Renderer::info() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->info;
}

bool Renderer::ready() const { return impl_->thread.ready(); }

std::uint64_t Renderer::gpu_bytes_used() const { return impl_->memory.used(); }
std::uint64_t Renderer::gpu_bytes_limit() const { return impl_->memory.budget(); }
const Histogram& Renderer::frame_times() const { return impl_->frame_times; }

std::uint64_t Renderer::layer_bytes_used(LayerHandle layer) const {
  std::lock_guard lock(impl_->mutex);
  const auto found = impl_->layer_bytes.find(layer);
  return found == impl_->layer_bytes.end() ? 0 : found->second->load();
}

int Renderer::debug_errors() const { return impl_->messages.errors(); }

void Renderer::add_model(ModelGeometry geometry, Done<ModelHandle> done) {
  impl_->post(Lane::background,
              std::make_shared<ModelUpload>(std::move(geometry), std::move(done)));
}

void Renderer::remove_model(ModelHandle model) {
  impl_->post_removal([model](GpuScene& scene) { scene.remove_model(model); });
}

void Renderer::add_surface_image(ModelHandle model, std::shared_ptr<const MipmappedPicture> image,
                                 Done<SurfaceImageHandle> done) {
  impl_->post(Lane::background,
              std::make_shared<SurfaceImageUpload>(model, std::move(image), std::move(done)));
}

void Renderer::remove_surface_image(SurfaceImageHandle handle) {
  impl_->post_removal([handle](GpuScene& scene) { scene.remove_surface_image(handle); });
}

void Renderer::add_surface_map(ModelHandle model, std::shared_ptr<const mesh::SurfaceMap> map,
                               Done<void> done) {
  impl_->post(Lane::background,
              std::make_shared<SurfaceMapUpload>(model, std::move(map), std::move(done)));
}

void Renderer::remove_surface_map(ModelHandle model, int resolution) {
  impl_->post_removal([model, resolution](GpuScene& scene) {
    if (auto found = scene.model(model)) (*found)->maps.erase(resolution);
  });
}

void Renderer::add_layer(ModelHandle model, std::shared_ptr<const TileMirror> mirror,
                         Done<LayerHandle> done) {
  const ValueType type = mirror->type();
  const int resolution = mirror->resolution();
  impl_->add_layer(model, type, resolution, std::move(mirror), std::move(done));
}

void Renderer::add_layer(ModelHandle model, ValueType type, int resolution,
                         Done<LayerHandle> done) {
  impl_->add_layer(model, type, resolution, nullptr, std::move(done));
}

void Renderer::remove_layer(LayerHandle layer) {
  impl_->post_removal([impl = impl_.get(), layer](GpuScene& scene) {
    scene.remove_layer(layer);
    std::lock_guard lock(impl->mutex);
    impl->layer_bytes.erase(layer);
  });
}

void Renderer::write_tiles(LayerHandle layer, std::vector<TileUpload> tiles, Done<void> done) {
  impl_->post(Lane::ordered,
              std::make_shared<TilesUpload>(layer, std::move(tiles), std::move(done)));
  impl_->refinements.content_changed();
}

void Renderer::paint(LayerHandle layer, StrokeBatch stroke, Done<StrokeOutcome> done) {
  impl_->post(Lane::ordered, std::make_shared<PaintJob>(layer, std::move(stroke), std::move(done)));
  impl_->refinements.content_changed();
}

void Renderer::add_view(ModelHandle model, Done<ViewHandle> done) {
  impl_->post_simple<ViewHandle>(std::move(done),
                                 [model](GpuScene& scene) { return scene.add_view(model); });
}

void Renderer::remove_view(ViewHandle view) {
  impl_->frames.forget(view);
  impl_->refinements.forget(view);
  impl_->post_removal([view](GpuScene& scene) { scene.remove_view(view); });
}

void Renderer::draw(FrameRequest request, Done<SharedFrame> done, LateChanges late_changes) {
  if (request.refinement) return impl_->refine(std::move(request), std::move(done));
  impl_->refinements.overtake(request.view);
  auto pushed = impl_->frames.push(std::move(request), std::move(done), std::move(late_changes));
  if (pushed.displaced) {
    const Error problem =
        pushed.accepted ? superseded_error()
                        : Error{ErrorCode::busy,
                                "GPU queue full",
                                "Too many views are waiting for a frame. Try again in a moment.",
                                {}};
    impl_->thread.post_reply([displaced = std::move(*pushed.displaced), problem] {
      displaced(tl::unexpected(problem));
    });
  }
  impl_->thread.wake();
}

void Renderer::view_acts(ViewHandle view) { impl_->frames.view_acts(view); }

void Renderer::on_context_lost(std::function<void()> callback) {
  std::lock_guard lock(impl_->lost_callback_mutex);
  impl_->lost_callback = std::move(callback);
}

void Renderer::lose_context_for_test() {
  impl_->lose_context = true;
  impl_->thread.wake();
}

void Renderer::finish() {
  for (const Lane lane : {Lane::ordered, Lane::background}) {
    std::promise<void> reached;
    Job job{[&] {
              reached.set_value();
              return Step::done;
            },
            [&](const Error&) { reached.set_value(); }};
    if (impl_->thread.post(lane, std::move(job), true)) reached.get_future().wait();
  }
}

void Renderer::run_on_gpu_thread_for_test(std::function<void()> work) {
  std::promise<void> ran;
  impl_->post_simple<void>([&](const Result<void>&) { ran.set_value(); },
                           [&](GpuScene&) -> Result<void> {
                             work();
                             return {};
                           });
  ran.get_future().wait();
}

}  // namespace strata::render
