#include "render/thread/frame_job.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/thread/screen_rect.h"

namespace strata::render {
namespace {

constexpr std::size_t kBytesCollectedPerStep = std::size_t{16} << 20;  // a few milliseconds

// How far a place of a mark may lie below what is seen, in pixels of the camera's window: a coarser
// copy's surface lies where it likes.
constexpr double kFeatureReach_px = 1, kFeatureReachOfCopies_px = 10;

// All marks are drawn for each rectangle: what one segment of them costs there (0.8 µs with
// llvmpipe), as `kRectCost_px`.
constexpr std::int64_t kFeatureCost_px = 28;

std::size_t row_bytes(const PixelRect& rect) {
  return std::size_t{4} * static_cast<std::size_t>(rect.width);
}

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

ShadeInput::Patterns patterns_of(const FrameRequest& request, const mesh::Geometry& geometry) {
  const Camera& camera = request.camera;
  const glm::dvec3 middle = geometry.origin + glm::dvec3(geometry.box_min + geometry.box_max) * 0.5;
  const glm::dvec4 clip = camera.projection * camera.view * glm::dvec4(middle, 1);
  // From within a model its middle may be at the eye, or behind it: the distance counts.
  const double w = std::max(std::abs(clip.w), 1e-9);
  const glm::dvec2 size(request.width, request.height);
  const glm::dvec2 origin = (glm::dvec2(clip) / w * 0.5 + 0.5) * size;
  const double pixel = 2 * w / (std::abs(camera.projection[0][0]) * size.x);  // model units
  // Any cell of the pattern serves as the first; numbers that stay small keep it sharp.
  const auto near = [](double v) { return static_cast<float>(std::clamp(v, -1e6, 1e6)); };
  return {{near(origin.x), near(origin.y)},
          static_cast<float>(std::clamp(pixel * request.style.unit_mm, 1e-30, 1e30)),
          static_cast<float>(size.x / camera.width)};
}

}  // namespace

Step FrameJob::step(GpuScene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  auto view = scene.view(task_.request.view);
  const auto refuse = [&](const Error& problem) {
    // A picture that was not finished is not to be added to.
    if (view) {
      (*view)->drawing = false;
      (*view)->picture_complete = false;
    }
    abort(problem);
    return Step::done;
  };
  if (!view) return refuse(view.error());
  const auto advance = [&]() -> Result<Step> {
    switch (stage_) {
      case Stage::prepare:
        STRATA_TRY(prepare(scene, **view));
        stage_ = Stage::layers;
        return Step::more;
      case Stage::layers: {
        auto here = STRATA_TRY(bring_layers(scene));
        if (here) stage_ = (*view)->gbuffer_complete ? Stage::area : Stage::gbuffer;
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
        if (complete) stage_ = Stage::readback;
        return Step::more;
      }
      case Stage::readback: break;
    }
    if (!pixels_.ready()) return Step::waiting;
    return collect_rows() ? Step::done : Step::more;
  };
  const auto step = advance();
  if (!step) return refuse(step.error());
  busy_ms_ += ms_since(begin);
  if (*step == Step::done) {
    (*view)->drawing = false;
    if (scene.lost())
      return refuse({ErrorCode::gpu_lost,
                     "GPU lost",
                     "The GPU context was lost and is being rebuilt. Ask for the frame again.",
                     {}});
    pixels_ = {};
    frame_.render_ms = busy_ms_;
    frame_.level = (*view)->key.level;
    if (progress_.cleared && !scene.info().software)
      scene.detail_budget().drawn(progress_.triangles(), ms_since(mesh_begin_));
    answer(std::make_shared<const Frame>(std::move(frame_)));
  }
  return *step;
}

Result<void> FrameJob::prepare(GpuScene& scene, View& view) {
  const FrameRequest& request = task_.request;
  view.last_used = scene.next_use();
  if (request.model != 0 && request.model != view.model)
    return fail(ErrorCode::invalid, "View of another model",
                "A request names its view's model, or none.", "model");
  STRATA_TRY(validate(request.camera));
  if (request.width < 1 || request.height < 1 || request.width > kMaxViewSize ||
      request.height > kMaxViewSize) {
    return fail(ErrorCode::invalid, "Size out of range",
                "A picture is 1 to " + std::to_string(kMaxViewSize) + " pixels a side.", "width");
  }
  for (const LayerStyle& style : request.style.layers) {
    auto layer = STRATA_TRY(scene.layer(style.layer));
    if (layer->model() != view.model)
      return fail(ErrorCode::invalid, "Layer of another model",
                  "A view shows layers of its own model.", "layers");
    const bool has_colors = style.palette && (style.palette->mode == PaletteMode::categorical ||
                                              !style.palette->points.empty());
    if (!has_colors || !std::isfinite(style.opacity)) {
      return fail(ErrorCode::invalid, "Palette not usable",
                  "A layer in a view needs a palette with points, and a finite opacity.", "layers");
    }
    layer_uses_.push_back(layer->use(view.last_used));
  }
  STRATA_TRY(validate(request.style.light));
  if (request.style.images.size() > kMaxSurfaceImagesShown)
    return fail(
        ErrorCode::invalid, "Too many surface images",
        "A view shows at most " + std::to_string(kMaxSurfaceImagesShown) + " surface images.",
        "looks");
  for (const SurfaceImageStyle& style : request.style.images) {
    auto image = STRATA_TRY(scene.image(style.image));
    if (image->model != view.model)
      return fail(ErrorCode::invalid, "Look of another model",
                  "A view shows surface images of its own model.", "looks");
    if (!std::isfinite(style.opacity))
      return fail(ErrorCode::invalid, "Opacity not finite", "An opacity is 0 to 1.", "looks");
  }
  auto key = depth_key(view.model, request.camera, request.width, request.height);
  view.drawing = true;
  const auto has_gbuffer = [&](const DepthKey& wanted) {
    return view.gbuffer_complete && view.key == wanted && view.images == request.style.images &&
           view.lighting == request.style.light;
  };
  if (request.moving) {
    key.level = view.key.level;  // what there is of this camera serves
    if (has_gbuffer(key)) return {};
    auto level = STRATA_TRY(choose_level(scene, view));
    key.level = level;
  }
  if (has_gbuffer(key)) return {};
  view.images = request.style.images;
  view.lighting = request.style.light;
  return prepare_gbuffer(view, key, scene.depths(), scene.memory());
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
  auto mesh_look = mesh_view(task_.request.camera, mesh.geometry().origin, view.lighting);
  for (std::size_t i = 0; i < view.images.size(); ++i) {
    auto image = STRATA_TRY(scene.image(view.images[i].image));
    mesh_look.images.push_back(&image->texture->texture());
    mesh_look.uniforms.look_opacity[static_cast<glm::length_t>(i)] =
        std::clamp(view.images[i].opacity, 0.0f, 1.0f);
  }
  auto complete = scene.gbuffer_pass().draw_slice(mesh, mesh_look,
                                                  {view.gbuffer, view.depth->texture}, progress_);
  if (!complete || !*complete) return complete;
  view.gbuffer_complete = view.depth->complete = true;
  // A software renderer works while it is called, a GPU until the picture can be read.
  if (scene.info().software)
    scene.detail_budget().drawn(progress_.triangles(), ms_since(mesh_begin_));
  return true;
}

Result<void> FrameJob::choose_area(GpuScene& scene, View& view) {
  const FrameRequest& request = task_.request;
  auto model = STRATA_TRY(scene.model(view.model));
  const mesh::Geometry& geometry = model->mesh().geometry();
  const glm::dmat4 clip = request.camera.projection * request.camera.view *
                          glm::translate(glm::dmat4(1.0), geometry.origin);
  frame_.width = request.width;
  frame_.height = request.height;
  if (request.changed && view.shows(request)) {
    const auto features = static_cast<std::int64_t>(view.seen_features.count);
    frame_.rects = screen_rects(*request.changed, clip, request.width, request.height,
                                request.align_to_16, kRectCost_px + features * kFeatureCost_px,
                                static_cast<double>(request.width) / request.camera.width);
    if (frame_.rects.empty()) return {};
  } else {
    frame_.rects = {{0, 0, request.width, request.height}};
    std::vector<shader::FeatureSegment> pieces;
    if (request.style.features)
      pieces =
          project_features(*request.style.features, request.camera, request.width, request.height,
                           {view.key.level == 0 ? kFeatureReach_px : kFeatureReachOfCopies_px,
                            glm::distance(geometry.box_min, geometry.box_max)});
    const bool cut_open = !request.camera.section.empty() && eye_is_cut_away(request.camera);
    auto looked =
        scene.feature_pass().test_sight(pieces, view.depth->texture, cut_open, view.seen_features);
    if (!looked) return looked;
  }
  surface_ =
      screen_rect({geometry.box_min, geometry.box_max}, clip, request.width, request.height, false);
  std::size_t bytes = 0;
  for (const PixelRect& rect : frame_.rects) bytes += rgba_bytes(rect);
  auto pixels = STRATA_TRY(scene.readback().begin(bytes));
  pixels_ = std::move(pixels);
  return {};
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
                   patterns_of(request, model->mesh().geometry())};
  for (const LayerStyle& style : request.style.layers) {
    auto layer = STRATA_TRY(scene.layer(style.layer));
    input.layers.push_back({&layer->textures(), style.palette, style.opacity, style.bare});
  }
  STRATA_TRY(scene.tables().flush());
  STRATA_TRY(scene.shade_pass().shade(input, scene.tables()));
  auto marked = scene.feature_pass().draw(view.seen_features, view.shading, request.width,
                                          request.height, band);
  if (!marked) return tl::unexpected(marked.error());

  const int rows_below = rect.height - shaded_.done - band.height;
  const std::size_t offset =
      shaded_.before + row_bytes(rect) * static_cast<std::size_t>(rows_below);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, pixels_.buffer().id());
  // NOLINTNEXTLINE(performance-no-int-to-ptr): GL takes the offset into the buffer as a pointer
  void* const into = reinterpret_cast<void*>(offset);
  glGetTextureSubImage(view.picture.id(), 0, band.x, request.height - band.y - band.height, 0,
                       band.width, band.height, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                       static_cast<GLsizei>(rgba_bytes(band)), into);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  advance(shaded_, band.height);
  if (!complete(shaded_)) return false;
  pixels_.submit();
  view.picture_complete = true;
  view.layers = request.style.layers;
  view.background = request.style.background;
  view.background_rows = request.background_rows;
  view.unit_mm = request.style.unit_mm;
  view.features = request.style.features;
  return true;
}

// Textures have their lowest row first, pictures their highest.
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
