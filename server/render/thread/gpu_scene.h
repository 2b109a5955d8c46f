#pragma once

#include <map>
#include <memory>
#include <unordered_map>

#include "gl/debug_messages.h"
#include "gl/egl_context.h"
#include "render/edit/edit_pass.h"
#include "render/memory/gpu_layer.h"
#include "render/memory/surface_image_texture.h"
#include "render/memory/tile_reader.h"
#include "render/thread/detail_budget.h"
#include "render/thread/view_cache.h"
#include "render/view/accumulation.h"
#include "render/view/contact_shadow_pass.h"
#include "render/view/feature_pass.h"
#include "render/view/shade_pass.h"

namespace strata::render {

// All objects of one GL context: passes, pools, models, layers, views. They are created and
// destroyed together, so no object of a lost context remains. GPU thread only.
class GpuScene {
 public:
  struct Model {
    std::vector<std::unique_ptr<MeshBuffers>> levels;  // the full mesh, then its coarser copies
    const MeshBuffers& mesh() const { return *levels.front(); }
    std::map<int, std::unique_ptr<SurfaceMapTextures>> maps;  // complete maps by resolution
  };
  struct SurfaceImage {
    ModelHandle model = 0;
    std::unique_ptr<SurfaceImageTexture> texture;
  };

  // `generation` is part of all handles. `memory` and `messages` must outlive the scene.
  static Result<std::unique_ptr<GpuScene>> create(const RendererOptions& options,
                                                  std::uint64_t generation, GpuMemory& memory,
                                                  gl::DebugMessages& messages);
  GpuScene(const GpuScene&) = delete;
  GpuScene& operator=(const GpuScene&) = delete;
  ~GpuScene();

  bool lost() { return context_.lost(); }
  const GpuInfo& info() const { return info_; }
  const RendererOptions& options() const { return options_; }
  GpuMemory& memory() { return memory_; }
  gl::ReadbackPool& readback() { return readback_; }
  PageTables& tables() { return tables_; }
  DepthBuffers& depths() { return *depths_; }
  EditCuller& edit_culler() { return *edit_culler_; }
  EditPass& edit_pass() { return *edit_pass_; }
  TileReader& tile_reader() { return *tile_reader_; }
  // True if KernelPainter paints strokes. It needs no surface maps on the GPU.
  bool edits_on_cpu() const { return info_.edit_path == EditPath::kernel; }
  MeshPass& gbuffer_pass() { return *gbuffer_pass_; }
  ShadePass& shade_pass() { return *shade_pass_; }
  ContactShadowPass& contact_shadow_pass() { return *contact_shadow_pass_; }
  FeaturePass& feature_pass() { return *feature_pass_; }
  AccumulationPass& accumulation_pass() { return *accumulation_pass_; }
  DetailBudget& detail_budget() { return detail_budget_; }
  // The number of pixels that a step shades, for one layer.
  int pixels_per_band() const {
    return info_.software ? kPixelsPerBandSoftware : kPixelsPerBandHardware;
  }
  // Returns the number of samples of each pixel of a frame with smooth edges.
  int smooth_samples(std::size_t pixels) {
    return options_.smooth_samples > 0 ? options_.smooth_samples : detail_budget_.samples(pixels);
  }
  std::uint64_t next_use() { return ++uses_; }

  // Buffers for the partial frame of a view that has none. They have any size and content. Return
  // them after the frame.
  std::unique_ptr<View> take_shared_buffers(int width, int height);
  void return_shared_buffers(std::unique_ptr<View> buffers);
  // Makes room for new buffers of a view of this size, instead of those that it may have. The
  // buffers of views take at most a quarter of the memory budget, or the memory of eight views of
  // this size. Beyond that, the least recently used ones are freed, because drawing a rectangle
  // without them takes only a little longer.
  void limit_buffers(const View& of, int width, int height);

  ModelHandle add(Model model);
  SurfaceImageHandle add(SurfaceImage image);
  // `mirror` may be null (see GpuLayer).
  Result<LayerHandle> add_layer(ModelHandle model, ValueType type, int resolution,
                                std::shared_ptr<const TileMirror> mirror = nullptr);
  Result<ViewHandle> add_view(ModelHandle model);
  // These functions return the Error `not_found` if the handle is unknown, removed, or belongs to
  // another generation.
  Result<Model*> model(ModelHandle handle);
  Result<GpuLayer*> layer(LayerHandle handle);
  Result<View*> view(ViewHandle handle);
  Result<SurfaceImage*> image(SurfaceImageHandle handle);
  void remove_model(ModelHandle handle);  // also removes its layers, images and views
  void remove_surface_image(SurfaceImageHandle handle) { images_.erase(handle); }
  void remove_layer(LayerHandle handle) { layers_.erase(handle); }
  void remove_view(ViewHandle handle) { views_.erase(handle); }

 private:
  // A band takes a few milliseconds. A frame of 1280 x 720 pixels with three layers is one band.
  static constexpr int kPixelsPerBandSoftware = 1 << 22, kPixelsPerBandHardware = 1 << 28;

  GpuScene(const RendererOptions& options, std::uint64_t generation, GpuMemory& memory);
  Result<void> load();
  bool evict_one();
  View* least_recent_view(const View* besides = nullptr);
  // Evicts the least recently used layer. If `pool` is given, evicts a layer of this pool.
  bool let_a_layer_leave(const PagePool* pool = nullptr);
  std::uint64_t next_handle() { return generation_ << 40 | ++handles_; }
  Error unknown(const char* what, std::uint64_t handle) const;

  gl::EglContext context_;  // the first member, so it is destroyed after its objects
  const RendererOptions options_;
  const std::uint64_t generation_;
  GpuMemory& memory_;
  GpuInfo info_;
  std::uint64_t handles_ = 0, uses_ = 0;
  gl::ReadbackPool readback_;
  PagePool pool_1_, pool_2_, pool_4_;
  PageTables tables_;
  std::optional<DepthBuffers> depths_;
  std::optional<EditCuller> edit_culler_;
  std::optional<EditPass> edit_pass_;
  std::optional<TileReader> tile_reader_;
  std::optional<MeshPass> gbuffer_pass_;
  std::optional<ShadePass> shade_pass_;
  std::optional<ContactShadowPass> contact_shadow_pass_;
  std::optional<FeaturePass> feature_pass_;
  std::optional<AccumulationPass> accumulation_pass_;
  DetailBudget detail_budget_;
  std::unordered_map<ModelHandle, Model> models_;
  std::unordered_map<LayerHandle, GpuLayer> layers_;
  std::unordered_map<ViewHandle, View> views_;
  std::vector<std::unique_ptr<View>> shared_buffers_;
  std::unordered_map<SurfaceImageHandle, SurfaceImage> images_;
};

}  // namespace strata::render
