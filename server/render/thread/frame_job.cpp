#include "render/thread/frame_job.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/thread/screen_rect.h"

namespace strata::render {
namespace {

// With fewer samples, a refinement improves the frame too little for the time that it takes.
constexpr int kMinSamples = 4;
// Bytes for texture coordinates, light, depth, frame and mean.
constexpr std::uint64_t kSampledBytesPerPixel = 4 + 4 + 4 + 4 + 8;
constexpr int kPixelsOfMeanPerStep = 1 << 20;

constexpr std::size_t kBytesCollectedPerStep = std::size_t{16} << 20;  // takes a few milliseconds

// As kFeatureReach_px, for coarser copies, whose surface can differ from the full mesh.
constexpr double kFeatureReachOfCopies_px = 10;

// The cost of one segment of a mark (0.8 µs with llvmpipe), in the unit of `kRectCost_px`. Each
// rectangle draws all marks again.
constexpr std::int64_t kFeatureCost_px = 28;

std::size_t row_bytes(const PixelRect& rect) {
  return std::size_t{4} * static_cast<std::size_t>(rect.width);
}

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

ShadeInput::Patterns patterns_of(const FrameRequest& request, const Camera& camera,
                                 const mesh::Geometry& geometry) {
  const glm::dvec3 middle = geometry.origin + glm::dvec3(geometry.box_min + geometry.box_max) * 0.5;
  const glm::dvec4 clip = camera.projection * camera.view * glm::dvec4(middle, 1);
  // If the eye is inside the model, the model's center may be at the eye or behind it. Only the
  // distance matters.
  const double w = std::max(std::abs(clip.w), 1e-9);
  const glm::dvec2 size(request.width, request.height);
  const glm::dvec2 origin = (glm::dvec2(clip) / w * 0.5 + 0.5) * size;
  const double pixel = 2 * w / (std::abs(camera.projection[0][0]) * size.x);  // in model units
  // The pattern repeats, so any of its cells can be the first. Small coordinates keep it sharp.
  const auto near = [](double v) { return static_cast<float>(std::clamp(v, -1e6, 1e6)); };
  return {{near(origin.x), near(origin.y)},
          static_cast<float>(std::clamp(pixel * request.style.unit_mm, 1e-30, 1e30)),
          static_cast<float>(size.x / camera.width)};
}

}  // namespace

// Returns the view, or the buffers that are used instead of those of the view. A frame with several
// samples uses the view only once, to get its model.
Result<View*> FrameJob::buffers(GpuScene& scene) const {
  if (sample_view_) return sample_view_.get();
  if (shared_view_) return shared_view_.get();
  return scene.view(task_.request.view);
}

Step FrameJob::step(GpuScene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  auto view = buffers(scene);
  const auto refuse = [&](const Error& problem) {
    release_view(scene, false);
    abort(problem);
    return Step::done;
  };
  if (!view) return refuse(view.error());
  if (!sample_drawn_.passed()) return Step::waiting;
  measure(scene);
  const auto advance = [&]() -> Result<Step> {
    switch (stage_) {
      case Stage::prepare:
        STRATA_TRY(prepare(scene, **view));
        stage_ = Stage::layers;
        return Step::more;
      case Stage::layers: {
        auto here = STRATA_TRY(bring_layers(scene));
        if (here) stage_ = (*view)->gbuffer_complete ? Stage::area : Stage::gbuffer;
        samples_begin_ms_ = busy_ms_;
        return Step::more;
      }
      case Stage::gbuffer: {
        auto complete = STRATA_TRY(draw_slice(scene, **view));
        if (complete) stage_ = Stage::area;
        return Step::more;
      }
      case Stage::area:
        STRATA_TRY(choose_area(scene, **view));
        stage_ = frame_.rects.empty() ? Stage::readback : Stage::shade;
        return Step::more;
      case Stage::shade: {
        auto complete = STRATA_TRY(shade_band(scene, **view));
        if (complete && !mean_) stage_ = Stage::readback;
        if (complete && mean_) {
          auto last = STRATA_TRY(add_sample(scene, **view));
          stage_ = last ? Stage::mean : Stage::gbuffer;
        }
        return Step::more;
      }
      case Stage::mean:
        if (read_mean()) stage_ = Stage::readback;
        return Step::more;
      case Stage::readback: break;
    }
    if (!pixels_.ready()) return Step::waiting;
    return collect_rows() ? Step::done : Step::more;
  };
  const auto step = advance();
  if (!step) return refuse(step.error());
  busy_ms_ += ms_since(begin);
  if (*step == Step::done) {
    frame_.level = (*view)->key.level;
    release_view(scene, true);
    if (scene.lost())
      return refuse(
          {ErrorCode::gpu_lost,
           "GPU lost",
           "The server lost the GPU context and is restoring it. Request the frame again.",
           {}});
    pixels_ = {};
    frame_.render_ms = busy_ms_;
    if (progress_.cleared && !scene.info().software && !mean_ && part_.width == 0)
      scene.detail_budget().drawn(progress_.triangles, ms_since(mesh_begin_));
    if (samples_begin_)
      scene.detail_budget().smoothed(
          frame_.pixels.size() / 4 * static_cast<std::size_t>(samples_ - 1),
          ms_since(*samples_begin_));
    is_drawn_ = true;
    answer(std::make_shared<const Frame>(std::move(frame_)));
  }
  return *step;
}

// An incomplete picture must not be updated in parts.
void FrameJob::release_view(GpuScene& scene, bool is_complete) {
  if (shared_view_) return scene.return_shared_buffers(std::move(shared_view_));
  const auto view = scene.view(task_.request.view);
  if (!view || is_separate()) return;
  (*view)->drawing = false;
  (*view)->picture_complete = (*view)->picture_complete && is_complete;
  (*view)->returned = (*view)->picture_complete;
}

Result<void> FrameJob::prepare(GpuScene& scene, View& view) {
  const FrameRequest& request = task_.request;
  view.last_used = scene.next_use();
  if (request.acting) view.acted = std::chrono::steady_clock::now();
  if (request.model != 0 && request.model != view.model)
    return fail(ErrorCode::invalid, "Wrong model",
                "The request names a different model than its view. Send the model of the view, or "
                "no model.",
                "model");
  STRATA_TRY(validate(request.camera));
  if (request.width < 1 || request.height < 1 || request.width > kMaxViewSize ||
      request.height > kMaxViewSize) {
    return fail(
        ErrorCode::invalid, "Size out of range",
        "Each side of a picture must be 1 to " + std::to_string(kMaxViewSize) + " pixels long.",
        "width");
  }
  for (const LayerStyle& style : request.style.layers) {
    auto layer = STRATA_TRY(scene.layer(style.layer));
    if (layer->model() != view.model)
      return fail(ErrorCode::invalid, "Layer of another model",
                  "A view can show only layers of its own model.", "layers");
    const bool has_colors = style.palette && (style.palette->mode == PaletteMode::categorical ||
                                              !style.palette->points.empty());
    if (!has_colors || !std::isfinite(style.opacity)) {
      return fail(ErrorCode::invalid, "Invalid palette",
                  "A layer in a view must have a palette with points, and a finite opacity.",
                  "layers");
    }
    layer_uses_.push_back(layer->use(view.last_used));
  }
  STRATA_TRY(validate(request.style.light));
  if (request.style.images.size() > kMaxSurfaceImagesShown)
    return fail(
        ErrorCode::invalid, "Too many surface images",
        "A view can show at most " + std::to_string(kMaxSurfaceImagesShown) + " surface images.",
        "looks");
  for (const SurfaceImageStyle& style : request.style.images) {
    auto image = STRATA_TRY(scene.image(style.image));
    if (image->model != view.model)
      return fail(ErrorCode::invalid, "Image of another model",
                  "A view can show only surface images of its own model.", "looks");
    if (!std::isfinite(style.opacity))
      return fail(ErrorCode::invalid, "Invalid opacity", "The opacity must be from 0 to 1.",
                  "looks");
  }
  if (request.samples < 1 || request.samples > kMaxSamples)
    return fail(
        ErrorCode::invalid, "Samples out of range",
        "The number of samples per pixel must be from 1 to " + std::to_string(kMaxSamples) + ".",
        "samples");
  camera_ = request.camera;
  if (is_separate()) return start_samples(scene, view.model);
  auto key = depth_key(view.model, request.camera, request.width, request.height);
  if (is_part_of_last(view, key)) return start_part(scene, view, key);
  view.drawing = true;
  const auto has_gbuffer = [&](const DepthKey& needed) {
    return view.gbuffer_complete && view.key == needed && view.images == request.style.images &&
           view.lighting == request.style.light;
  };
  if (request.moving) {
    key.level = view.key.level;  // any level drawn for this camera is good enough
    if (has_gbuffer(key)) return {};
    auto level = STRATA_TRY(choose_level(scene, view));
    key.level = level;
  }
  if (has_gbuffer(key)) return {};
  view.images = request.style.images;
  view.lighting = request.style.light;
  if (!view.has_buffers_of(request.width, request.height))
    scene.limit_buffers(view, request.width, request.height);
  return prepare_gbuffer(view, key, scene.depths(), scene.memory());
}

// Returns whether the requester has the last frame of a view without buffers, and needs only the
// changed parts. A user who acts gets the whole frame once, and with it buffers and a depth that
// the next strokes use.
bool FrameJob::is_part_of_last(const View& view, const DepthKey& key) const {
  const FrameRequest& request = task_.request;
  DepthKey last = view.key;
  if (request.moving) last.level = 0;  // any level drawn for this camera is good enough
  return request.changed && !request.acting && !view.has_buffers() && view.returned &&
         last == key && view.images == request.style.images &&
         view.lighting == request.style.light && view.has_style(request);
}

Result<void> FrameJob::start_part(GpuScene& scene, const View& view, const DepthKey& key) {
  task_.add_late_changes();  // now, because the mesh is drawn only around the changes
  const FrameRequest& request = task_.request;
  auto model = STRATA_TRY(scene.model(view.model));
  const auto rects = changed_rects(model->mesh().geometry(), view);
  auto shared = scene.take_shared_buffers(request.width, request.height);
  shared->model = view.model;
  shared->images = view.images;
  shared->lighting = view.lighting;
  DepthKey of_part = key;
  of_part.level = view.key.level;
  STRATA_TRY(prepare_gbuffer(*shared, of_part, scene.depths(), scene.memory()));
  shared_view_ = std::move(shared);
  if (rects.empty()) {
    shared_view_->gbuffer_complete = true;  // nothing is drawn
    return {};
  }
  part_ = rects.front();
  for (const PixelRect& rect : rects) part_ = around(part_, rect);
  part_ = with_neighbors(part_, request.width, request.height,
                         static_cast<double>(request.width) / request.camera.width);
  return {};
}

std::vector<PixelRect> FrameJob::changed_rects(const mesh::Geometry& geometry,
                                               const View& view) const {
  const FrameRequest& request = task_.request;
  const glm::dmat4 clip =
      camera_.projection * camera_.view * glm::translate(glm::dmat4(1.0), geometry.origin);
  const auto features = static_cast<std::int64_t>(view.seen_features.count);
  return screen_rects(*request.changed, clip, request.width, request.height, request.align_to_16,
                      kRectCost_px + features * kFeatureCost_px,
                      static_cast<double>(request.width) / request.camera.width);
}

// Returns the tested marks, which are never in the shared buffers.
Result<const FeatureBuffer*> FrameJob::features(GpuScene& scene, const View& view) const {
  if (!shared_view_) return &view.seen_features;
  auto own = STRATA_TRY(scene.view(task_.request.view));
  return &own->seen_features;
}

// Uses separate buffers. The view keeps its frame and g-buffer, to which later edits add
// rectangles.
Result<void> FrameJob::start_samples(GpuScene& scene, ModelHandle model) {
  const FrameRequest& request = task_.request;
  const auto pixels =
      static_cast<std::uint64_t>(request.width) * static_cast<std::uint64_t>(request.height);
  // A refinement must not evict anything.
  if (request.refinement && !has_layers(scene))
    return fail(ErrorCode::out_of_memory, "Picture not refined",
                "The server removed a layer of the picture from the GPU because the memory was "
                "full.");
  if (request.refinement && !scene.memory().fits(pixels * kSampledBytesPerPixel))
    return tl::unexpected(
        scene.memory().used_up(pixels * kSampledBytesPerPixel, "a refined picture"));
  samples_ = request.samples;
  mean_ = STRATA_TRY(Accumulation::create(request.width, request.height, scene.memory()));
  return start_sample(scene, model);
}

// If there is not enough memory or time, the frame has one sample.
void FrameJob::make_smooth(GpuScene& scene, const View& view) {
  const FrameRequest& request = task_.request;
  if (!request.smooth || request.large || sample_view_) return;
  const auto pixels =
      static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height);
  const int samples = std::min(scene.smooth_samples(pixels), kMaxSmoothSamples);
  if (samples < 2 || !scene.memory().fits(pixels * kSampledBytesPerPixel)) return;
  auto mean = Accumulation::create(request.width, request.height, scene.memory());
  if (!mean) return;
  mean_ = std::move(*mean);
  samples_ = samples;
  level_ = view.key.level;
  own_triangles_ = progress_.triangles;
}

bool FrameJob::has_layers(GpuScene& scene) const {
  return std::ranges::all_of(task_.request.style.layers, [&](const LayerStyle& style) {
    const auto layer = scene.layer(style.layer);
    return layer && (*layer)->is_here();
  });
}

Result<void> FrameJob::start_sample(GpuScene& scene, ModelHandle model) {
  const FrameRequest& request = task_.request;
  if (!sample_view_) {
    sample_view_ = std::make_unique<View>();
    sample_view_->model = model;
  }
  const glm::dvec2 offset =
      is_separate() ? sample_offset(sample_, samples_) : smooth_sample_offset(sample_, samples_);
  camera_ = jittered(request.camera, request.width, request.height, offset);
  sample_view_->images = request.style.images;
  sample_view_->lighting = request.style.light;
  progress_ = {};
  shaded_ = {};
  auto key = depth_key(sample_view_->model, camera_, request.width, request.height);
  key.level = level_;
  return prepare_gbuffer(*sample_view_, key, scene.depths(), scene.memory());
}

Result<bool> FrameJob::add_sample(GpuScene& scene, const View& view) {
  // A software renderer draws during the calls, so `busy_ms_` includes the drawing.
  const auto limit_ms = static_cast<double>(task_.request.samples_time.count());
  if (is_separate() && sample_ == 0 && limit_ms > 0 && scene.info().software) {
    const double sample_ms = std::max(busy_ms_ - samples_begin_ms_, 1.0);
    const int fit = std::min(static_cast<int>(limit_ms / sample_ms), samples_);
    const int least = std::min(kMinSamples, samples_);
    if (task_.request.refinement && fit < least)
      return fail(ErrorCode::too_large, "Picture not refined",
                  "One sample of each pixel takes " + std::to_string(std::lround(sample_ms)) +
                      " ms, so " + std::to_string(least) + " samples would exceed the time limit.");
    samples_ = std::max(1, fit);
  }
  scene.accumulation_pass().add(view.picture, *mean_, samples_);
  sample_drawn_ = gl::Fence::place();
  if (++sample_ < samples_) {
    // If the view was removed, no client waits for the frame.
    if (!task_.request.refinement) STRATA_TRY(scene.view(task_.request.view));
    STRATA_TRY(start_sample(scene, view.model));
    return false;
  }
  auto pixels = STRATA_TRY(scene.readback().begin(rgba_bytes(frame_.rects.front())));
  pixels_ = std::move(pixels);
  shaded_ = {};
  return true;
}

// Measures the drawing time of the view's frame, after which the other samples begin.
void FrameJob::measure(GpuScene& scene) {
  if (is_separate() || sample_ == 0 || samples_begin_) return;
  if (own_triangles_ > 0 && !scene.info().software)
    scene.detail_budget().drawn(own_triangles_, ms_since(mesh_begin_));
  samples_begin_ = std::chrono::steady_clock::now();
}

Result<bool> FrameJob::bring_layers(GpuScene& scene) {
  for (const LayerStyle& style : task_.request.style.layers) {
    auto layer = STRATA_TRY(scene.layer(style.layer));
    auto here = layer->bring();
    if (!here || !*here) return here;
  }
  return true;
}

Result<int> FrameJob::choose_level(GpuScene& scene, const View& view) const {
  auto model = STRATA_TRY(scene.model(view.model));
  if (model->levels.size() == 1) return 0;
  // All levels have the origin of the full mesh.
  const glm::mat4 clip = clip_from_model(task_.request.camera, model->mesh().geometry().origin);
  std::vector<std::size_t> triangles;
  for (const auto& mesh : model->levels) triangles.push_back(mesh->visible_triangles(clip));
  return scene.detail_budget().choose(triangles);
}

Result<bool> FrameJob::draw_slice(GpuScene& scene, View& view) {
  auto model = STRATA_TRY(scene.model(view.model));
  const MeshBuffers& mesh = *model->levels[static_cast<std::size_t>(view.key.level)];
  if (!progress_.cleared) mesh_begin_ = std::chrono::steady_clock::now();
  auto mesh_look = mesh_view(camera_, mesh.geometry().origin, view.lighting);
  for (std::size_t i = 0; i < view.images.size(); ++i) {
    auto image = STRATA_TRY(scene.image(view.images[i].image));
    mesh_look.images.push_back(&image->texture->texture());
    mesh_look.uniforms.look_opacity[static_cast<glm::length_t>(i)] =
        std::clamp(view.images[i].opacity, 0.0f, 1.0f);
  }
  MeshTarget target{view.gbuffer, view.depth->texture, {}};
  if (shared_view_) target.part = part_;
  auto complete = scene.gbuffer_pass().draw_slice(mesh, mesh_look, target, progress_);
  if (!complete || !*complete) return complete;
  view.gbuffer_complete = true;
  if (shared_view_) return true;  // the depth outside the part is undefined
  view.depth->complete = true;
  // A software renderer draws during the calls. A GPU finishes later, when the frame can be read.
  if (scene.info().software && &view != sample_view_.get())
    scene.detail_budget().drawn(progress_.triangles, ms_since(mesh_begin_));
  return true;
}

Result<void> FrameJob::choose_area(GpuScene& scene, View& view) {
  task_.add_late_changes();
  const FrameRequest& request = task_.request;
  auto model = STRATA_TRY(scene.model(view.model));
  const mesh::Geometry& geometry = model->mesh().geometry();
  const glm::dmat4 clip =
      camera_.projection * camera_.view * glm::translate(glm::dmat4(1.0), geometry.origin);
  frame_.width = request.width;
  frame_.height = request.height;
  if (shared_view_ || (request.changed && !sample_view_ && view.shows(request))) {
    auto own = STRATA_TRY(scene.view(request.view));
    frame_.rects = changed_rects(geometry, *own);
    if (frame_.rects.empty()) return {};
  } else {
    frame_.rects = {{0, 0, request.width, request.height}};
    STRATA_TRY(test_features(scene, view));
    make_smooth(scene, view);
  }
  surface_ =
      screen_rect({geometry.box_min, geometry.box_max}, clip, request.width, request.height, false);
  shadow_ = {};
  if (request.style.contact_shadow && camera_.section.empty() && camera_.hidden_parts.none())
    shadow_ = screen_rect(box_of(*request.style.contact_shadow), clip, request.width,
                          request.height, false);
  if (mean_) return {};
  std::size_t bytes = 0;
  for (const PixelRect& rect : frame_.rects) bytes += rgba_bytes(rect);
  auto pixels = STRATA_TRY(scene.readback().begin(bytes));
  pixels_ = std::move(pixels);
  return {};
}

Result<void> FrameJob::test_features(GpuScene& scene, View& view) const {
  const FrameRequest& request = task_.request;
  auto model = STRATA_TRY(scene.model(view.model));
  const mesh::Geometry& geometry = model->mesh().geometry();
  std::vector<shader::FeatureSegment> pieces;
  Camera camera = camera_;
  if (geometry.part_ends.empty()) camera.hidden_parts.reset();
  if (request.style.features)
    pieces = project_features(*request.style.features, camera, request.width, request.height,
                              {view.key.level == 0 ? kFeatureReach_px : kFeatureReachOfCopies_px,
                               glm::distance(geometry.box_min, geometry.box_max)});
  const bool cut_open = !camera_.section.empty() && eye_is_cut_away(camera_);
  return scene.feature_pass().test_sight(pieces, view.depth->texture, cut_open, view.seen_features);
}

Result<bool> FrameJob::shade_band(GpuScene& scene, View& view) {
  const FrameRequest& request = task_.request;
  auto model = STRATA_TRY(scene.model(view.model));
  const PixelRect& rect = frame_.rects[shaded_.rect];
  const int rows =
      std::max(1, scene.pixels_per_band() /
                      (rect.width * (1 + static_cast<int>(request.style.layers.size()))));
  const PixelRect band{rect.x, rect.y + shaded_.done, rect.width,
                       std::min(rows, rect.height - shaded_.done)};
  ShadeInput input{view.uv,
                   view.light,
                   view.shading,
                   band,
                   intersection(band, surface_),
                   request.style.background,
                   request.background_rows,
                   {},
                   patterns_of(request, camera_, model->mesh().geometry()),
                   !camera_.section.empty() && eye_is_cut_away(camera_)};
  for (const LayerStyle& style : request.style.layers) {
    auto layer = STRATA_TRY(scene.layer(style.layer));
    const double factor = style.bare ? 1 : opacity_of_layers(request.style.light);
    input.layers.push_back({&layer->textures(), style.palette,
                            style.opacity * static_cast<float>(factor), style.blend, style.bare});
  }
  STRATA_TRY(scene.tables().flush());
  STRATA_TRY(scene.shade_pass().shade(input, scene.tables()));
  if (request.style.contact_shadow)
    STRATA_TRY(scene.contact_shadow_pass().draw(
        request.style.contact_shadow, camera_, model->mesh().geometry().origin, view.shading,
        request.width, request.height, intersection(band, shadow_)));
  const auto* seen_features = STRATA_TRY(features(scene, view));
  auto marked =
      scene.feature_pass().draw(*seen_features, view.shading, request.width, request.height, band);
  if (!marked) return tl::unexpected(marked.error());

  mean_ ? advance(shaded_, band.height) : read_band(view.picture, band);
  if (!complete(shaded_)) return false;
  if (&view == sample_view_.get()) return true;
  if (!mean_) pixels_.submit();
  if (&view == shared_view_.get()) return true;
  view.picture_complete = true;
  view.layers = request.style.layers;
  view.background = request.style.background;
  view.background_rows = request.background_rows;
  view.unit_mm = request.style.unit_mm;
  view.features = request.style.features;
  view.contact_shadow = request.style.contact_shadow;
  return true;
}

bool FrameJob::read_mean() {
  const PixelRect& rect = frame_.rects.front();
  const int rows = std::max(1, kPixelsOfMeanPerStep / rect.width);
  read_band(mean_->sum, {0, shaded_.done, rect.width, std::min(rows, rect.height - shaded_.done)});
  if (!complete(shaded_)) return false;
  pixels_.submit();
  return true;
}

// Reads back a band of the rectangle that is being shaded.
void FrameJob::read_band(const gl::Texture& picture, const PixelRect& band) {
  const PixelRect& rect = frame_.rects[shaded_.rect];
  const int rows_below = rect.height - shaded_.done - band.height;
  const std::size_t offset =
      shaded_.before + row_bytes(rect) * static_cast<std::size_t>(rows_below);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, pixels_.buffer().id());
  // NOLINTNEXTLINE(performance-no-int-to-ptr): GL takes the offset into the buffer as a pointer
  void* const into = reinterpret_cast<void*>(offset);
  glGetTextureSubImage(picture.id(), 0, band.x, task_.request.height - band.y - band.height, 0,
                       band.width, band.height, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                       static_cast<GLsizei>(rgba_bytes(band)), into);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  advance(shaded_, band.height);
}

// Copies rows to the frame. Textures start with the lowest row, frames with the highest.
bool FrameJob::collect_rows() {
  if (!pixels_) return true;
  const auto data = pixels_.data();
  frame_.pixels.reserve(data.size());
  const std::size_t until = frame_.pixels.size() + kBytesCollectedPerStep;
  while (!complete(collected_) && frame_.pixels.size() < until) {
    const PixelRect& rect = frame_.rects[collected_.rect];
    const std::size_t rows_below = static_cast<std::size_t>(rect.height - collected_.done - 1);
    const auto* row = reinterpret_cast<const std::uint8_t*>(data.data()) + collected_.before +
                      row_bytes(rect) * rows_below;
    frame_.pixels.insert(frame_.pixels.end(), row, row + row_bytes(rect));
    advance(collected_, 1);
  }
  return complete(collected_);
}

void FrameJob::advance(Rows& rows, int by) const {
  const PixelRect& rect = frame_.rects[rows.rect];
  rows.done += by;
  if (rows.done < rect.height) return;
  rows = {rows.rect + 1, rows.before + rgba_bytes(rect), 0};
}

}  // namespace strata::render
