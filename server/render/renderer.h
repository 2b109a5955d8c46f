#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/layers/layer_blend.h"
#include "domain/layers/palette.h"
#include "domain/layers/tile.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/background.h"
#include "domain/scene/camera.h"
#include "domain/scene/light.h"
#include "domain/scene/stroke.h"
#include "mesh/analysis/contact_shadow.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "render/memory/mipmapped_picture.h"
#include "render/view/drawn_features.h"

namespace strata::render {

// Handles are valid until removed or until the context is lost; 0 is no handle. A handle of another
// generation is refused.
using ModelHandle = std::uint64_t;
using LayerHandle = std::uint64_t;
using ViewHandle = std::uint64_t;
using SurfaceImageHandle = std::uint64_t;

// Where strokes are painted: by a compute pass, or by a kernel on the CPU, which is several times
// faster if the GPU is a CPU.
enum class EditPath { automatic, compute, kernel };

struct RendererOptions {
  std::string shader_dir;              // folder `shaders`
  std::uint64_t gpu_memory_bytes = 0;  // budget; 0: 70 % of what the driver reports, or 4 GiB
  bool debug = false;                  // KHR_debug context; errors are counted (see `debug_errors`)
  std::size_t queue_capacity = 4096;
  EditPath edit_path = EditPath::automatic;
  // of each pixel of a frame with smooth edges (FrameRequest::smooth), 1 to kMaxSmoothSamples. 0:
  // as many as the GPU has time for, 1 with a software renderer
  int smooth_samples = 0;
};

struct GpuInfo {
  std::string vendor, renderer, version;
  bool software = false;
  EditPath edit_path = EditPath::compute;  // the chosen path
  int max_texture_size = 0, max_array_layers = 0, max_texture_units = 0, max_image_units = 0;
};

// The result of one stroke batch. Tiles whose written mask is empty are left out.
struct WrittenTile {
  TileAddress address;
  TileMask written;  // surface and gutter texels the tool wrote, whether or not the value changed
  TileData after;
};
struct StrokeOutcome {
  std::vector<WrittenTile> tiles;
  // model-space box of the written blocks; for changed screen rectangles
  glm::vec3 written_min{0}, written_max{0};
  // from the selection of the blocks until the texels are written; with EditPath::compute until the
  // result is read back
  double edit_ms = 0;
  // share of this, EditPath::compute: both passes, by timer queries; kernel: reading, changing and
  // uploading tiles
  double gpu_ms = 0;
  std::size_t bytes_up = 0, bytes_down = 0;  // between CPU and GPU
};

struct TileUpload {
  TileAddress address;
  // null or empty: the tile becomes empty and its page is freed
  std::shared_ptr<const TileData> data;
};

struct LayerStyle {  // one layer in a view, bottom to top
  LayerHandle layer = 0;
  std::shared_ptr<const Palette> palette;  // identified by its address: it must not change
  float opacity = 1;
  LayerBlend blend = LayerBlend::normal;
  // its hatch and dots have neither tint nor border: a mark over another layer, not a class
  bool bare = false;
  bool operator==(const LayerStyle&) const = default;
};

struct SurfaceImageStyle {
  // one picture of the surface in a view, bottom to top, over the colors of the vertices
  SurfaceImageHandle image = 0;
  float opacity = 1;
  bool operator==(const SurfaceImageStyle&) const = default;
};
constexpr std::size_t kMaxSurfaceImagesShown = 4;

// Identified by its address: it must not change. Null: no features.
using FeaturesShown = std::shared_ptr<const std::vector<DrawnFeature>>;

// the content of a view of its model
struct ViewStyle {
  std::vector<LayerStyle> layers;
  std::vector<SurfaceImageStyle> images;  // kMaxSurfaceImagesShown at most
  FeaturesShown features;                 // over the layers, the last ones on top
  Light light;
  Background background{};
  double unit_mm = 1000;  // length of the model's unit, for patterns of palettes
  // On the background, except for a camera with a section. Identified by its address, null: none.
  std::shared_ptr<const mesh::ContactShadow> contact_shadow{};
  bool operator==(const ViewStyle&) const = default;
};

struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;  // origin top left
  bool operator==(const PixelRect&) const = default;
};

constexpr int kMaxSamples = 64, kMaxSmoothSamples = 16;

struct FrameRequest {
  ViewHandle view = 0;
  // Model of the view. If set: views of this model that request the same picture share one, which
  // any of them may draw.
  ModelHandle model = 0;
  Camera camera;
  // a coarser copy of the model may be shown, so that the picture is fast enough
  bool moving = false;
  // a band of a large picture: smaller pictures of others precede it, even between its steps
  bool large = false;
  bool acting = false;        // the person is acting: viewers do not delay the frame
  int width = 0, height = 0;  // pixels of the picture (the camera's window scaled to this size)
  // Of each pixel, 1 to kMaxSamples. More than one: the picture is the mean of that many, whose
  // cameras differ by parts of a pixel. It is drawn into buffers of its own, so the view's picture
  // stays as it is; `changed` is ignored.
  int samples = 1;
  // On a CPU, there are fewer samples, at least one, if all would take longer. 0: no limit.
  std::chrono::milliseconds samples_time{0};
  // The picture on the screen, once more with several samples. It is drawn while the GPU thread has
  // nothing else to do, evicts nothing, and ends as `superseded` when its view requests something
  // else. It is refused as `too_large` if `samples_time` is too short for a few samples.
  bool refinement = false;
  // If the whole frame is drawn, its edges may be smooth: the mean of the view's frame and of a few
  // samples around it (RendererOptions::smooth_samples). The view keeps the frame with one sample,
  // and later rectangles have one, too.
  bool smooth = false;
  ViewStyle style;
  // Empty: everything is shaded. Otherwise only these model-space boxes changed since this view's
  // last frame: only the rectangles that they cover are shaded and returned. A changed camera, size
  // or style always shades everything.
  struct Box {
    glm::vec3 min, max;
    bool operator==(const Box&) const = default;
  };
  std::optional<std::vector<Box>> changed;
  // The part of the background's height that the picture covers, from the top: 0 … 1 except for a
  // band.
  glm::vec2 background_rows{0, 1};
  bool align_to_16 = true;  // grow the rectangles to multiples of 16 for JPEG parts
};
struct Frame {
  // the area of `pixels`: the whole picture or the changed parts; empty: no change
  std::vector<PixelRect> rects;
  int width = 0, height = 0;         // of the whole picture
  std::vector<std::uint8_t> pixels;  // RGBA8 of one rectangle after the other, top row first
  double render_ms = 0;
  int level = 0;  // of the drawn model: 0 is the full mesh, 1 the finest coarser copy
};
using SharedFrame = std::shared_ptr<const Frame>;  // shared by all requests of the same picture

// A mesh and its coarser copies, finest first (mesh::make_detail_levels).
struct ModelGeometry {
  std::shared_ptr<const mesh::Geometry> full;
  std::vector<std::shared_ptr<const mesh::Geometry>> coarser;
};

// Owns the GPU: one thread with the EGL context and a bounded queue
// (docs/developer/architecture/overview.md, "The GPU thread"). All functions are thread-safe and
// return at once; callbacks run on the GPU thread and must be short. Order: edits and layer changes
// in the given order, then frames, then background work (uploads of models and surface maps, in
// slices). If the queue is full or the renderer is stopped, the answer is an Error unavailable;
// after a lost context pending work is answered with an Error unavailable titled "GPU lost". (Only
// a stopped renderer calls back on the caller's thread, because no other thread is left.)
class Renderer {
 public:
  // Starts the thread and waits for the context. The error lists what was tried and how to fix it.
  static Result<std::unique_ptr<Renderer>> start(RendererOptions options);
  ~Renderer();  // asks to stop and joins

  GpuInfo info() const;
  // false while a lost context cannot be replaced: requests in this time are refused
  bool ready() const;
  std::uint64_t gpu_bytes_used() const;
  // bytes of the page table and of the pages on the GPU
  std::uint64_t layer_bytes_used(LayerHandle layer) const;
  int debug_errors() const;

  template <class T>
  using Done = std::function<void(Result<T>)>;

  void add_model(ModelGeometry geometry, Done<ModelHandle> done);
  void remove_model(ModelHandle model);  // and its layers, looks, surface maps and views
  void add_surface_image(ModelHandle model, std::shared_ptr<const MipmappedPicture> image,
                         Done<SurfaceImageHandle> done);
  void remove_surface_image(SurfaceImageHandle handle);
  // Required before strokes at this resolution; baked by the caller, uploaded in slices.
  void add_surface_map(ModelHandle model, std::shared_ptr<const mesh::SurfaceMap> map,
                       Done<void> done);

  // afterwards strokes at this resolution are refused (conflict)
  void remove_surface_map(ModelHandle model, int resolution);

  // Adds a layer with the content of `mirror`, now and later. It is uploaded when it is first shown
  // or painted, and may be evicted while `mirror` is not held (TileMirror::hold) and no frame shows
  // it.
  void add_layer(ModelHandle model, std::shared_ptr<const TileMirror> mirror,
                 Done<LayerHandle> done);
  // Adds an empty layer that exists on the GPU only.
  void add_layer(ModelHandle model, ValueType type, int resolution, Done<LayerHandle> done);
  void remove_layer(LayerHandle layer);
  // Sets whole tiles (fill, undo, import), in order with strokes; calls `done` after the GPU has
  // them. Frames drawn before `done` may show some of the old tiles.
  void write_tiles(LayerHandle layer, std::vector<TileUpload> tiles, Done<void> done);
  void paint(LayerHandle layer, StrokeBatch stroke, Done<StrokeOutcome> done);

  // Views keep a g-buffer and the last picture. While requests of one view wait, a new one replaces
  // the old one ("latest wins"): the callback of the replaced request gets the Error `superseded`.
  // Views take turns by the drawing time that they have used (render/thread/frame_queue).
  void add_view(ModelHandle model, Done<ViewHandle> done);
  void remove_view(ViewHandle view);
  void draw(FrameRequest request, Done<SharedFrame> done);

  // Blocks until all earlier requests, except frames, are answered.
  void finish();

  // Sets the callback that the GPU thread calls after a lost context was replaced: all earlier
  // handles are void. There is one callback: a new one replaces the last, an empty one removes it.
  // When this returns, the old callback is not running.
  void on_context_lost(std::function<void()> callback);
  void lose_context_for_test();  // destroys the context, as a driver reset would
  // Runs `work` with the context current, in order with edits, and returns afterwards.
  void run_on_gpu_thread_for_test(std::function<void()> work);

 private:
  Renderer();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::render
