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
#include "core/histogram.h"
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

// A handle is valid until its object is removed or the context is lost. 0 is not a valid handle.
// The renderer rejects handles of an earlier context.
using ModelHandle = std::uint64_t;
using LayerHandle = std::uint64_t;
using ViewHandle = std::uint64_t;
using SurfaceImageHandle = std::uint64_t;

// The method of painting strokes: a compute pass, or a kernel on the CPU. With a software renderer
// the kernel is several times faster.
enum class EditPath { automatic, compute, kernel };

struct RendererOptions {
  std::string shader_dir;              // path of the folder `shaders`
  std::uint64_t gpu_memory_bytes = 0;  // 0: 70 % of the memory if the driver reports it, else 4 GiB
  bool debug = false;                  // KHR_debug context that counts errors (`debug_errors`)
  std::size_t queue_capacity = 4096;
  EditPath edit_path = EditPath::automatic;
  // Samples of each pixel of a frame with smooth edges (FrameRequest::smooth), 1 to
  // kMaxSmoothSamples. 0: five if the GPU is fast enough, otherwise one.
  int smooth_samples = 0;
};

struct GpuInfo {
  std::string vendor, renderer, version;
  bool software = false;
  EditPath edit_path = EditPath::compute;  // the chosen path
  int max_texture_size = 0, max_array_layers = 0, max_texture_units = 0, max_image_units = 0;
};

// The result of one stroke batch. Contains only tiles with written texels.
struct WrittenTile {
  TileAddress address;
  // Surface and gutter texels under the tool, including texels that already had the value.
  TileMask written;
  TileData after;
};
struct StrokeOutcome {
  std::vector<WrittenTile> tiles;
  // The model-space box of the written blocks. It determines the changed screen rectangles.
  glm::vec3 written_min{0}, written_max{0};
  // The time from the selection of the blocks until the texels are written. With EditPath::compute
  // it includes the read-back of the written texels.
  double edit_ms = 0;
  // The part of `edit_ms` on the GPU. EditPath::compute: both passes, by timer queries.
  // EditPath::kernel: the time to read, change and upload tiles.
  double gpu_ms = 0;
  std::size_t bytes_up = 0, bytes_down = 0;  // transferred bytes
};

struct TileUpload {
  TileAddress address;
  // Null or empty: empties the tile and frees its page.
  std::shared_ptr<const TileData> data;
};

struct LayerStyle {  // the style of one layer in a view
  LayerHandle layer = 0;
  std::shared_ptr<const Palette> palette;  // identified by its address, so it must not change
  float opacity = 1;
  LayerBlend blend = LayerBlend::normal;
  // Draws hatch and dots without tint and border, for a mark over another layer.
  bool bare = false;
  bool operator==(const LayerStyle&) const = default;
};

struct SurfaceImageStyle {
  // The style of one surface image in a view. Surface images cover the vertex colors.
  SurfaceImageHandle image = 0;
  float opacity = 1;
  bool operator==(const SurfaceImageStyle&) const = default;
};
constexpr std::size_t kMaxSurfaceImagesShown = 4;

// Identified by its address, so it must not change. Null: no features.
using FeaturesShown = std::shared_ptr<const std::vector<DrawnFeature>>;

// The content of a view, except for its camera. Layers and images are listed from bottom to top.
struct ViewStyle {
  std::vector<LayerStyle> layers;
  std::vector<SurfaceImageStyle> images;  // at most kMaxSurfaceImagesShown
  FeaturesShown features;                 // over the layers, the last one on top
  Light light;
  Background background{};
  double unit_mm = 1000;  // millimeters in a model unit, for palette patterns
  // The shadow on the background, except for a camera with a section or hidden parts. Identified by
  // its address, so it must not change. Null: no shadow.
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
  // The model of the view, or 0. If it is set, views of this model that request the same frame
  // share one, and any of these views may draw it.
  ModelHandle model = 0;
  Camera camera;
  // The camera is moving, so a coarser copy of the model may be drawn to save time.
  bool moving = false;
  // A band of a large image. Smaller frames with earlier turns can be drawn between its steps.
  bool large = false;
  // The user paints or moves the camera. Frames of other users do not delay this frame.
  bool acting = false;
  int width = 0, height = 0;  // pixels of the frame, to which the camera's window is scaled
  // Samples of each pixel, 1 to kMaxSamples. With more than one, the frame is the mean of that many
  // frames, whose cameras differ by fractions of a pixel. It is drawn into separate buffers, so the
  // view keeps its last frame. `changed` is then ignored.
  int samples = 1;
  // The time limit of all samples with a software renderer. If they would take longer, fewer are
  // drawn, but at least one. 0: no limit.
  std::chrono::milliseconds samples_time{0};
  // Repeats the view's last frame with several samples. The GPU thread draws it while it is
  // otherwise idle, and evicts nothing for it. A newer request of the view ends it with the Error
  // `superseded`. If `samples_time` is too short for a few samples, it fails with `too_large`.
  bool refinement = false;
  // A whole frame may have smooth edges. It is then the mean of the view's frame and of a few
  // frames from slightly moved cameras (RendererOptions::smooth_samples). The view keeps its frame
  // with one sample, and later rectangles have one sample.
  bool smooth = false;
  ViewStyle style;
  // The model-space boxes that changed since this view's last frame. Only the rectangles that they
  // cover are shaded and returned. Without a value, or after a change to the camera, the size or
  // the style, the whole frame is shaded.
  struct Box {
    glm::vec3 min, max;
    bool operator==(const Box&) const = default;
  };
  std::optional<std::vector<Box>> changed;
  // The first and the last row of the background that the frame covers, as shares of the height
  // from the top. Only a band of a larger image has other values than 0 and 1.
  glm::vec2 background_rows{0, 1};
  bool align_to_16 = true;  // enlarge the rectangles to multiples of 16 pixels for JPEG
};
struct Frame {
  // The area of `pixels`: the whole frame or its changed parts. Empty: nothing changed.
  std::vector<PixelRect> rects;
  int width = 0, height = 0;         // size of the whole frame
  std::vector<std::uint8_t> pixels;  // RGBA8, one rectangle after another, top row first
  double render_ms = 0;
  int level = 0;  // level of detail: 0 is the full mesh, 1 the finest coarser copy
};
using SharedFrame = std::shared_ptr<const Frame>;  // shared by all requests for the same frame

// A mesh and its coarser copies, the finest one first (mesh::make_detail_levels).
struct ModelGeometry {
  std::shared_ptr<const mesh::Geometry> full;
  std::vector<std::shared_ptr<const mesh::Geometry>> coarser;
};

// Owns the GPU: one thread with the EGL context and a bounded queue
// (docs/developer/architecture/overview.md, "The GPU thread"). All functions are thread-safe and,
// unless stated otherwise, return without waiting. Callbacks run on the GPU thread and must be
// short. Edits and layer changes run first, in the order of their calls. Frames run next.
// Background work runs last: uploads of models and surface maps, in slices. A request fails with
// the Error `busy` if the queue is full. Pending requests fail with `unavailable` when the renderer
// stops, and with `gpu_lost` when the context is lost. After the renderer has stopped, callbacks
// run on the caller's thread.
class Renderer {
 public:
  // Starts the thread and waits for the context. The Error lists the attempts and possible fixes.
  static Result<std::unique_ptr<Renderer>> start(RendererOptions options);
  ~Renderer();  // stops and joins the thread

  GpuInfo info() const;
  // Returns false while a lost context cannot be replaced. The renderer then rejects requests.
  bool ready() const;
  std::uint64_t gpu_bytes_used() const;
  std::uint64_t gpu_bytes_limit() const;
  // The time of the GPU thread for each frame, except refinements.
  const Histogram& frame_times() const;
  // Returns the bytes of the layer's page table and of its pages on the GPU.
  std::uint64_t layer_bytes_used(LayerHandle layer) const;
  int debug_errors() const;

  template <class T>
  using Done = std::function<void(Result<T>)>;

  void add_model(ModelGeometry geometry, Done<ModelHandle> done);
  void remove_model(ModelHandle model);  // with its layers, images, surface maps and views
  void add_surface_image(ModelHandle model, std::shared_ptr<const MipmappedPicture> image,
                         Done<SurfaceImageHandle> done);
  void remove_surface_image(SurfaceImageHandle handle);
  // Uploads, in slices, a surface map that the caller has computed. Strokes at its resolution
  // require it.
  void add_surface_map(ModelHandle model, std::shared_ptr<const mesh::SurfaceMap> map,
                       Done<void> done);

  // After this call, strokes at this resolution fail with the Error `conflict`.
  void remove_surface_map(ModelHandle model, int resolution);

  // Adds a layer whose content follows `mirror`. The first frame or stroke that needs the layer
  // uploads it. It may be evicted while no frame shows it and no caller holds `mirror`
  // (TileMirror::hold).
  void add_layer(ModelHandle model, std::shared_ptr<const TileMirror> mirror,
                 Done<LayerHandle> done);
  // Adds an empty layer that exists on the GPU only.
  void add_layer(ModelHandle model, ValueType type, int resolution, Done<LayerHandle> done);
  void remove_layer(LayerHandle layer);
  // Replaces whole tiles (fill, undo, import), in order with strokes. Calls `done` when all tiles
  // are on the GPU. Frames drawn earlier may show some old tiles.
  void write_tiles(LayerHandle layer, std::vector<TileUpload> tiles, Done<void> done);
  void paint(LayerHandle layer, StrokeBatch stroke, Done<StrokeOutcome> done);

  // A view keeps a g-buffer and its last frame. A new request of a view replaces its waiting
  // request, whose callback gets the Error `superseded`. Views take turns by their used drawing
  // time (render/thread/frame_queue).
  void add_view(ModelHandle model, Done<ViewHandle> done);
  void remove_view(ViewHandle view);
  //
  // A request may wait for its turn while people paint. `late_changes` is called once, on the GPU
  // thread, when the mesh is drawn and before any pixel of the frame is shaded. It returns the
  // boxes that changed since the call of `draw`, which are then part of `FrameRequest::changed`. It
  // is not called for a refinement, or if the request fails before its turn.
  using LateChanges = std::function<std::vector<FrameRequest::Box>()>;
  void draw(FrameRequest request, Done<SharedFrame> done, LateChanges late_changes = {});
  // The user of the view begins to act. A waiting request of the view no longer waits among the
  // onlookers (FrameRequest::acting).
  void view_acts(ViewHandle view);

  // Blocks until all earlier requests, except frames, are complete.
  void finish();

  // Sets the only callback for a lost context. The GPU thread calls it after it has replaced the
  // context, when all earlier handles are invalid. An empty callback removes the current one. When
  // this function returns, the old callback is not running.
  void on_context_lost(std::function<void()> callback);
  void lose_context_for_test();  // destroys the context, like a driver reset
  // Runs `work` with the context current, in order with edits, and waits for it.
  void run_on_gpu_thread_for_test(std::function<void()> work);

 private:
  Renderer();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::render
