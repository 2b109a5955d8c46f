#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/layers/palette.h"
#include "domain/layers/tile.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/background.h"
#include "domain/scene/camera.h"
#include "domain/scene/light.h"
#include "domain/scene/stroke.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "render/memory/mipmapped_picture.h"
#include "render/view/drawn_features.h"

namespace strata::render {

// Handles stay valid until removed or until the context is lost; 0 is none. A handle of another
// generation is refused.
using ModelHandle = std::uint64_t;
using LayerHandle = std::uint64_t;
using ViewHandle = std::uint64_t;
using SurfaceImageHandle = std::uint64_t;

// Where strokes are painted: a compute pass, or a kernel on the CPU, which is several times faster
// where the GPU is a CPU.
enum class EditPath { automatic, compute, kernel };

struct RendererOptions {
  std::string shader_dir;              // folder `shaders`
  std::uint64_t gpu_memory_bytes = 0;  // budget; 0: 70 % of what the driver reports, or 4 GiB
  bool debug = false;                  // KHR_debug context; errors are counted (see `debug_errors`)
  std::size_t queue_capacity = 4096;
  EditPath edit_path = EditPath::automatic;
};

struct GpuInfo {
  std::string vendor, renderer, version;
  bool software = false;
  EditPath edit_path = EditPath::compute;  // what was chosen
  int max_texture_size = 0, max_array_layers = 0, max_texture_units = 0, max_image_units = 0;
};

// What one stroke batch did. Tiles whose written mask is empty are not in it.
struct WrittenTile {
  TileAddress address;
  TileMask written;  // surface and gutter texels the tool wrote, whether or not the value changed
  TileData after;
};
struct StrokeOutcome {
  std::vector<WrittenTile> tiles;
  // model-space box of the written blocks; for changed screen rectangles
  glm::vec3 written_min{0}, written_max{0};
  // from choosing the blocks until the texels are written; with EditPath::compute until that is
  // known
  double edit_ms = 0;
  // of it, EditPath::compute: both passes, by timer queries; kernel: tiles read, changed and
  // uploaded
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
  std::shared_ptr<const Palette> palette;  // told apart by the object: nothing of it may change
  float opacity = 1;
  // its hatch and dots have neither tint nor border: a sign over another layer, which is no class
  // of its own
  bool bare = false;
  bool operator==(const LayerStyle&) const = default;
};

struct SurfaceImageStyle {
  // one picture of the surface in a view, bottom to top, over the colours of the vertices
  SurfaceImageHandle image = 0;
  float opacity = 1;
  bool operator==(const SurfaceImageStyle&) const = default;
};
constexpr std::size_t kMaxSurfaceImagesShown = 4;

// Told apart by the object: nothing of it may change. Null: none.
using FeaturesShown = std::shared_ptr<const std::vector<DrawnFeature>>;

struct ViewStyle {  // what a view shows of its model
  std::vector<LayerStyle> layers;
  std::vector<SurfaceImageStyle> images;  // kMaxSurfaceImagesShown at most
  FeaturesShown features;                 // over the layers, the last ones on top
  Light light;
  Background background{};
  double unit_mm = 1000;  // length of the model's unit, for patterns of palettes
  bool operator==(const ViewStyle&) const = default;
};

struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;  // origin top left
  bool operator==(const PixelRect&) const = default;
};

struct FrameRequest {
  ViewHandle view = 0;
  // Of the view. Given: views of this model that ask for the same picture are served with one,
  // which any of them may draw.
  ModelHandle model = 0;
  Camera camera;
  // a coarser copy of the model may be shown, so that the picture comes in time
  bool moving = false;
  // a band of a large picture: others' smaller pictures go before it, also when it is half done
  bool large = false;
  bool acting = false;  // for someone who is doing something, so that onlookers do not hold it up
  int width = 0, height = 0;  // pixels of the picture (the camera's window scaled to this size)
  ViewStyle style;
  // Empty: everything is shaded. Otherwise only these model-space boxes changed since this view's
  // last frame: the rectangles they cover are shaded and returned. A changed camera, size or style
  // shades everything anyway.
  struct Box {
    glm::vec3 min, max;
    bool operator==(const Box&) const = default;
  };
  std::optional<std::vector<Box>> changed;
  // The part of the background's height that the picture has, from the top: 0 … 1 but for a band.
  glm::vec2 background_rows{0, 1};
  bool align_to_16 = true;  // grow the rectangles to multiples of 16 for JPEG parts
};
struct Frame {
  // what `pixels` covers: all of it, or what changed; none: nothing did
  std::vector<PixelRect> rects;
  int width = 0, height = 0;         // of the whole picture
  std::vector<std::uint8_t> pixels;  // RGBA8 of one rectangle after the other, top row first
  double render_ms = 0;
  int level = 0;  // of the model that is shown: 0 is the full mesh, 1 the finest coarser copy
};
using SharedFrame = std::shared_ptr<const Frame>;  // one for all who asked for the same picture

// A mesh and its coarser copies, finest first (mesh::make_detail_levels).
struct ModelGeometry {
  std::shared_ptr<const mesh::Geometry> full;
  std::vector<std::shared_ptr<const mesh::Geometry>> coarser;
};

// Owns the GPU: one thread with the EGL context and a bounded queue (invariant 1 of
// ARCHITECTURE.md). All functions are thread-safe and return at once; callbacks run on the GPU
// thread and must be quick. Order: edits and layer changes in the order given, before frames,
// before background work (uploads of models and surface maps, in slices). A full queue or a stopped
// renderer answers with an Error unavailable; a lost context answers pending work with an Error
// unavailable titled "GPU lost". (Only a stopped renderer calls back on the caller's thread: there
// is no other left.)
class Renderer {
 public:
  // Starts the thread and waits for the context. The error says what was tried and how to mend it.
  static Result<std::unique_ptr<Renderer>> start(RendererOptions options);
  ~Renderer();  // asks to stop and joins

  GpuInfo info() const;
  // false while a lost context cannot be replaced: what is asked for meanwhile is refused
  bool ready() const;
  std::uint64_t gpu_bytes_used() const;
  // page table and pages that are on the GPU
  std::uint64_t layer_bytes_used(LayerHandle layer) const;
  int debug_errors() const;

  template <class T>
  using Done = std::function<void(Result<T>)>;

  void add_model(ModelGeometry geometry, Done<ModelHandle> done);
  void remove_model(ModelHandle model);  // and its layers, looks, surface maps and views
  void add_surface_image(ModelHandle model, std::shared_ptr<const MipmappedPicture> image,
                         Done<SurfaceImageHandle> done);
  void remove_surface_image(SurfaceImageHandle handle);
  // Needed before strokes at this resolution; baked by the caller, uploaded in slices.
  void add_surface_map(ModelHandle model, std::shared_ptr<const mesh::SurfaceMap> map,
                       Done<void> done);

  // strokes at it are refused (conflict) from then on
  void remove_surface_map(ModelHandle model, int resolution);

  // A layer that holds what `mirror` does, now and later: it is brought to the GPU when it is first
  // shown or painted, and may leave it again while `mirror` is not held (TileMirror::hold) and no
  // frame shows it.
  void add_layer(ModelHandle model, std::shared_ptr<const TileMirror> mirror,
                 Done<LayerHandle> done);
  // An empty layer that is known to the GPU alone.
  void add_layer(ModelHandle model, ValueType type, int resolution, Done<LayerHandle> done);
  void remove_layer(LayerHandle layer);
  // Sets whole tiles (fill, undo, import); done after the GPU has them. In order with strokes.
  // Frames that are drawn before `done` may show some of the tiles as they were.
  void write_tiles(LayerHandle layer, std::vector<TileUpload> tiles, Done<void> done);
  void paint(LayerHandle layer, StrokeBatch stroke, Done<StrokeOutcome> done);

  // Views keep a g-buffer and the last picture. Requests of one view replace each other while they
  // wait ("latest wins"): the replaced request's callback gets the Error `superseded`.
  // Views take turns by what drawing for them has taken (render/thread/frame_queue).
  void add_view(ModelHandle model, Done<ViewHandle> done);
  void remove_view(ViewHandle view);
  void draw(FrameRequest request, Done<SharedFrame> done);

  // Returns when all that was asked before, frames excepted, is answered. Blocks.
  void finish();

  // Called on the GPU thread after a lost context was replaced: every handle given before is void.
  // There is one callback: a new one takes the place of the last, an empty one removes it. The last
  // is not running any more when this returns.
  void on_context_lost(std::function<void()> callback);
  void lose_context_for_test();  // destroys the context, as a driver reset would
  // Runs `work` with the context current, in order with edits, and returns after it.
  void run_on_gpu_thread_for_test(std::function<void()> work);

 private:
  Renderer();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::render
