#include "bench/edit_methods.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "bench/peers/octree_edit.h"
#include "bench/peers/paper.h"
#include "gl/program.h"
#include "mesh/parallel.h"
#include "render/edit/depth_bias.h"
#include "render/memory/mesh_buffers.h"
#include "render/view/depth_buffers.h"
#include "support/shader_dirs.h"

namespace strata::bench {
namespace {

constexpr std::uint8_t kValue = 200;
constexpr std::uint32_t kColor = 0xff2080c8;

std::uint64_t mesh_bytes(const mesh::Geometry& geometry) {
  return geometry.vertices.size() * sizeof(mesh::Vertex) +
         geometry.indices.size() * sizeof(std::uint32_t);
}

StrokeBatch dab(const EditScene& scene, glm::dvec2 center, double radius_px) {
  StrokeBatch stroke;
  stroke.camera = scene.camera;
  stroke.path = {center};
  stroke.radius_px = radius_px;
  stroke.fixed_depth_bias = kPaperDepthBias;  // so tiles and paper paint the same texels
  stroke.value_bits = kValue;
  return stroke;
}

// The result of `decide`, which computes in double precision whether a dab paints a position. At
// three thresholds the rounding of floats decides: at the tool's edge, at a pixel's border (which
// selects the depth) and in the depth test.
struct Decision {
  bool painted = false, near_threshold = false;
};
Decision decide(const EditScene& scene, const render::DepthCopy& depth, glm::dvec2 center,
                double radius_px, const glm::vec3& position) {
  const Camera& camera = scene.camera;
  const glm::dvec4 clip = camera.projection * camera.view *
                          glm::dvec4(glm::dvec3(position) + scene.mesh.geometry->origin, 1);
  const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
  const glm::dvec2 window = (glm::dvec2(ndc) * 0.5 + 0.5) * glm::dvec2(camera.width, camera.height);
  if (window.x < 0 || window.y < 0 || window.x >= camera.width || window.y >= camera.height)
    return {};
  const double inside =
      radius_px - glm::length(window - glm::dvec2(center.x, camera.height - center.y));
  const double here =
      depth.depth[static_cast<std::size_t>(window.y) * static_cast<std::size_t>(camera.width) +
                  static_cast<std::size_t>(window.x)];
  const double before = here - (ndc.z * 0.5 + 0.5 - kPaperDepthBias);
  const glm::dvec2 to_border = glm::abs(window - glm::round(window));
  return {inside > 0 && before >= 0, std::abs(inside) < 2e-3 ||
                                         std::min(to_border.x, to_border.y) < 1e-3 ||
                                         std::abs(before) < 1e-6};
}

// The depth of the scene on the GPU. Every system needs this depth anyway to draw the scene.
class SceneDepth {
 public:
  SceneDepth(render::Renderer& renderer, const EditScene& scene) : renderer_(renderer) {
    renderer_.run_on_gpu_thread_for_test([&] {
      readback_ = std::make_unique<gl::ReadbackPool>();
      depths_ = std::make_unique<render::DepthBuffers>(must(render::DepthBuffers::create(
          test::shader_dir(), std::size_t{1} << 26, memory_, *readback_)));
      auto mesh = must(render::MeshBuffers::create(scene.mesh.geometry, memory_));
      while (!mesh->upload_slice()) {
      }
      buffer_ = must(depths_->start(
          render::depth_key(1, scene.camera, scene.camera.width, scene.camera.height)));
      render::MeshProgress progress;
      while (!must(depths_->draw_slice(buffer_, *mesh, scene.camera, progress))) {
      }
      render::DepthBuffers::copy_to_memory(*buffer_, mesh::hardware_threads());
    });
  }
  ~SceneDepth() {
    renderer_.run_on_gpu_thread_for_test([&] {
      buffer_.reset();
      depths_.reset();
      readback_.reset();
    });
  }
  const gl::Texture& texture() const { return buffer_->texture; }
  const render::DepthCopy& copy() const { return *buffer_->copy; }

 private:
  render::Renderer& renderer_;
  render::GpuMemory memory_{std::uint64_t{1} << 40};
  std::unique_ptr<gl::ReadbackPool> readback_;
  std::unique_ptr<render::DepthBuffers> depths_;
  std::shared_ptr<render::DepthBuffer> buffer_;
};

class TilesMethod : public EditMethod {
 public:
  TilesMethod(render::Renderer& renderer, const EditScene& scene,
              std::shared_ptr<const mesh::SurfaceMap> map, double bake_s)
      : renderer_(renderer), scene_(scene), map_(std::move(map)) {
    creation_.structure_s = bake_s;
    const double start = now_ms();
    await<void>([&](auto done) { renderer_.add_surface_map(scene_.model, map_, std::move(done)); });
    layer_ = await<render::LayerHandle>([&](auto done) {
      renderer_.add_layer(scene_.model, ValueType::u8, map_->resolution, std::move(done));
    });
    creation_.structure_s += (now_ms() - start) / 1000;
    creation_.model_bytes = mesh_bytes(*scene_.mesh.geometry);
    creation_.structure_bytes = map_->bytes();
    for (const auto& bounds : map_->bounds_of_tile)
      creation_.layer_bytes += bounds.radius < 0 ? 0 : kTexelsPerTile * 2;
  }
  ~TilesMethod() override { renderer_.remove_layer(layer_); }

  std::string name() const override { return "tiles"; }
  EditCost edit(glm::dvec2 center, double radius_px) override {
    EditCost cost;
    const double start = now_ms();
    const auto outcome = await<render::StrokeOutcome>([&](auto done) {
      renderer_.paint(layer_, dab(scene_, center, radius_px), std::move(done));
    });
    cost.ms_to_memory = now_ms() - start;
    cost.ms = outcome.edit_ms;
    if (renderer_.info().edit_path == render::EditPath::compute) cost.gpu_ms = outcome.gpu_ms;
    for (const auto& tile : outcome.tiles)
      cost.cells += static_cast<std::uint64_t>(tile.written.count());
    cost.bytes_up = outcome.bytes_up;
    cost.bytes_down = outcome.bytes_down;
    return cost;
  }
  EditCreation creation() const override { return creation_; }

 private:
  render::Renderer& renderer_;
  const EditScene& scene_;
  std::shared_ptr<const mesh::SurfaceMap> map_;
  render::LayerHandle layer_ = 0;
  EditCreation creation_;
};

}  // namespace

class EditMethods::Paper {
 public:
  Paper(render::Renderer& renderer, const EditScene& scene, std::shared_ptr<const SceneDepth> depth,
        int texture)
      : renderer_(renderer), scene_(scene), depth_(std::move(depth)) {
    renderer_.run_on_gpu_thread_for_test([&] {
      const double start = now_ms();
      editor_ = must(PaperEditor::create(*scene_.mesh.geometry, texture));
      glFinish();
      creation_.structure_s = (now_ms() - start) / 1000;
      creation_.model_bytes = mesh_bytes(*scene_.mesh.geometry);
      creation_.structure_bytes = editor_->structure_bytes();
      creation_.layer_bytes = editor_->layer_bytes();
    });
  }
  ~Paper() {
    renderer_.run_on_gpu_thread_for_test([&] { editor_.reset(); });
  }
  EditCost edit(glm::dvec2 center, double radius_px, PaperEditor::Padding padding) {
    EditCost cost;
    renderer_.run_on_gpu_thread_for_test([&] {
      glFinish();
      const double start = now_ms();
      editor_->edit(scene_.camera, depth_->texture(), center, radius_px, kValue, padding);
      glFinish();
      cost.ms = now_ms() - start;
    });
    cost.bytes_up = sizeof(glm::mat4);  // the matrix of the tool
    return cost;
  }
  std::pair<std::vector<std::uint8_t>, std::vector<std::uint8_t>> mask_and_coverage(
      glm::dvec2 center, double radius_px) {
    std::pair<std::vector<std::uint8_t>, std::vector<std::uint8_t>> found;
    renderer_.run_on_gpu_thread_for_test([&] {
      editor_->clear();
      editor_->edit(scene_.camera, depth_->texture(), center, radius_px, kValue);
      found = {editor_->mask(), editor_->coverage()};
    });
    return found;
  }
  const EditCreation& creation() const { return creation_; }
  const render::DepthCopy& depth() const { return depth_->copy(); }

 private:
  render::Renderer& renderer_;
  const EditScene& scene_;
  std::shared_ptr<const SceneDepth> depth_;
  std::unique_ptr<PaperEditor> editor_;
  EditCreation creation_;
};

// One tree with one layer, which both octree methods can paint.
class EditMethods::Tree {
 public:
  static Result<std::shared_ptr<Tree>> create(render::Renderer& renderer, const EditScene& scene,
                                              std::shared_ptr<const SceneDepth> depth, int levels) {
    const double start = now_ms();
    auto tree = Octree::build(*scene.mesh.geometry, levels, mesh::hardware_threads());
    if (!tree) return tl::unexpected(tree.error());
    auto made = std::make_shared<Tree>(renderer, scene, std::move(depth), std::move(*tree));
    made->creation_.structure_s = (now_ms() - start) / 1000;
    return made;
  }
  Tree(render::Renderer& renderer, const EditScene& scene, std::shared_ptr<const SceneDepth> depth,
       Octree tree)
      : renderer_(renderer),
        scene_(scene),
        depth_(std::move(depth)),
        tree_(std::move(tree)),
        layer_(tree_) {
    renderer_.run_on_gpu_thread_for_test([&] {
      colors_ = must(gl::Buffer::create(layer_.colors.size() * sizeof(std::uint32_t),
                                        gl::Buffer::Use::fixed, "octree colours"));
      upload(0, layer_.colors.size());
      glFinish();
    });
    creation_.model_bytes = mesh_bytes(*scene_.mesh.geometry);
    creation_.structure_bytes = tree_.bytes();
    creation_.layer_bytes = layer_.bytes() + colors_.size();
  }
  ~Tree() {
    renderer_.run_on_gpu_thread_for_test([&] { colors_ = {}; });
  }

  EditCost edit(glm::dvec2 center, double radius_px, bool fair) {
    OctreeDab dab{scene_.camera, scene_.mesh.geometry->origin, center, radius_px, kValue, kColor};
    EditCost cost;
    renderer_.run_on_gpu_thread_for_test([&] {
      const double start = now_ms();
      if (fair) {
        cost.cells = paint_by_descent(tree_, dab, depth_->copy(), mesh::hardware_threads(), layer_);
        cost.bytes_up = upload_dirty();
      } else {
        cost.cells = paint_by_rays(tree_, dab, layer_);
        cost.bytes_up = upload(0, layer_.colors.size());
        std::fill(layer_.dirty.begin(), layer_.dirty.end(), std::uint8_t{0});
      }
      glFinish();
      cost.ms = now_ms() - start;
    });
    return cost;
  }
  const EditCreation& creation() const { return creation_; }

 private:
  std::uint64_t upload(std::size_t first, std::size_t count) {
    colors_.upload_values(first * sizeof(std::uint32_t),
                          std::span<const std::uint32_t>(layer_.colors).subspan(first, count));
    return count * sizeof(std::uint32_t);
  }
  std::uint64_t upload_dirty() {
    std::uint64_t bytes = 0;
    auto& dirty = layer_.dirty;
    for (std::size_t first = 0; first < dirty.size();) {
      if (dirty[first] == 0) {
        ++first;
        continue;
      }
      std::size_t last = first;
      while (last < dirty.size() && dirty[last] != 0) dirty[last++] = 0;
      const std::size_t begin = first * OctreeLayer::kLeavesPerRange;
      const std::size_t end = std::min(last * OctreeLayer::kLeavesPerRange, layer_.colors.size());
      bytes += upload(begin, end - begin);
      first = last;
    }
    return bytes;
  }

  render::Renderer& renderer_;
  const EditScene& scene_;
  std::shared_ptr<const SceneDepth> depth_;
  const Octree tree_;
  OctreeLayer layer_;
  gl::Buffer colors_;
  EditCreation creation_;
};

namespace {

// One method of a peer. The two methods of a peer share the object `peer`; `way` selects the
// method.
template <class Peer, class Way>
class PeerMethod : public EditMethod {
 public:
  PeerMethod(std::string name, std::shared_ptr<Peer> peer, Way way)
      : name_(std::move(name)), peer_(std::move(peer)), way_(way) {}
  std::string name() const override { return name_; }
  EditCost edit(glm::dvec2 center, double radius_px) override {
    return peer_->edit(center, radius_px, way_);
  }
  EditCreation creation() const override { return peer_->creation(); }

 private:
  const std::string name_;
  const std::shared_ptr<Peer> peer_;
  const Way way_;
};

}  // namespace

EditMethods::EditMethods(render::Renderer& renderer, const EditScene& scene, int texture,
                         const std::vector<std::string>& names)
    : renderer_(renderer), scene_(scene) {
  std::shared_ptr<const SceneDepth> depth;
  std::shared_ptr<Tree> tree;
  const auto depth_of_scene = [&] {
    if (!depth) depth = std::make_shared<const SceneDepth>(renderer, scene);
    return depth;
  };
  for (const std::string& name : names) {
    if (name == "tiles") {
      Progress progress;
      const double start = now_ms();
      map_ = std::make_shared<const mesh::SurfaceMap>(must(mesh::bake_surface_map(
          *scene.mesh.geometry, texture, progress, mesh::hardware_threads())));
      methods_.push_back(
          std::make_unique<TilesMethod>(renderer, scene, map_, (now_ms() - start) / 1000));
    } else if (name == "paper" || name == "paper-compute") {
      if (!paper_) paper_ = std::make_shared<Paper>(renderer, scene, depth_of_scene(), texture);
      const auto padding =
          name == "paper" ? PaperEditor::Padding::raster : PaperEditor::Padding::compute;
      methods_.push_back(
          std::make_unique<PeerMethod<Paper, PaperEditor::Padding>>(name, paper_, padding));
    } else {
      if (!tree) {
        auto made = Tree::create(renderer, scene, depth_of_scene(),
                                 std::countr_zero(static_cast<unsigned>(texture)));
        if (!made) {
          not_made_.push_back(name + ": " + made.error().detail);
          continue;
        }
        tree = std::move(*made);
      }
      methods_.push_back(
          std::make_unique<PeerMethod<Tree, bool>>(name, tree, name == "octree-fair"));
    }
  }
}

EditMethods::~EditMethods() = default;

EditMethod* EditMethods::find(const std::string& name) const {
  const auto found = std::find_if(methods_.begin(), methods_.end(),
                                  [&](const auto& m) { return m->name() == name; });
  return found == methods_.end() ? nullptr : found->get();
}

EditAgreement EditMethods::compare_tiles_and_paper(glm::dvec2 center, double radius_px) {
  const mesh::SurfaceMap& map = *map_;
  const auto layer = await<render::LayerHandle>([&](auto done) {
    renderer_.add_layer(scene_.model, ValueType::u8, map.resolution, std::move(done));
  });
  const auto ours = await<render::StrokeOutcome>(
      [&](auto done) { renderer_.paint(layer, dab(scene_, center, radius_px), std::move(done)); });
  renderer_.remove_layer(layer);
  const auto [theirs, coverage] = paper_->mask_and_coverage(center, radius_px);
  const auto side = static_cast<std::size_t>(map.resolution);
  std::vector<std::uint8_t> written(theirs.size());
  for (const auto& tile : ours.tiles)
    for (std::size_t i = 0; i < kTexelsPerTile; ++i)
      if (tile.written.test(static_cast<int>(i)))
        written[(tile.address.y * kTileSize + i / kTileSize) * side + tile.address.x * kTileSize +
                i % kTileSize] = 1;
  EditAgreement agreement;
  for (std::size_t slot = 0; slot < map.block_of_slot.size(); ++slot)
    for (std::size_t i = 0; i < 64; ++i) {
      if (!(map.surface_mask[slot] >> i & 1)) continue;
      const auto per_side = static_cast<std::size_t>(map.blocks_per_side);
      const std::size_t x = map.block_of_slot[slot] % per_side * 8 + i % 8;
      const std::size_t y = map.block_of_slot[slot] / per_side * 8 + i / 8;
      // Skip texels that the paper's raster does not cover, because the paper treats them as
      // padding, although a thin triangle may own them in Strata's tiles.
      if (!coverage[y * side + x]) continue;
      const bool a = theirs[y * side + x] != 0, b = written[y * side + x] != 0;
      agreement.compared += a || b;
      if (a == b) continue;
      ++agreement.differ;
      const Decision exact =
          decide(scene_, paper_->depth(), center, radius_px,
                 map.position(static_cast<std::uint32_t>(slot), static_cast<int>(i)));
      ++(a == exact.painted ? agreement.tiles_off : agreement.paper_off);
      agreement.beyond_rounding += exact.near_threshold ? 0 : 1;
    }
  return agreement;
}

double copy_bandwidth(render::Renderer& renderer) {
  // The largest size that every driver accepts for one storage buffer.
  constexpr std::size_t kBytes = std::size_t{128} << 20;
  constexpr int kRuns = 7;
  Samples samples;
  if (renderer.info().software) {
    const int threads = mesh::hardware_threads();
    std::vector<std::byte> from(kBytes, std::byte{1}), to(kBytes);
    for (int run = 0; run < kRuns; ++run) {
      const double start = now_ms();
      mesh::parallel_for(threads, threads, [&](int part) {
        const std::size_t length = kBytes / static_cast<std::size_t>(threads);
        const std::size_t first = length * static_cast<std::size_t>(part);
        std::memcpy(to.data() + first, from.data() + first, length);
      });
      samples.add(now_ms() - start);
    }
  } else {
    renderer.run_on_gpu_thread_for_test([&] {
      // A shader copies, because the copy function of some drivers does not reach the memory
      // bandwidth.
      constexpr std::size_t kBytesPerGroup = std::size_t{256} * 16;
      const auto program = must(gl::Program::load(test::peer_shader_dir(), {"copy.comp"}));
      auto from = must(gl::Buffer::create(kBytes, gl::Buffer::Use::fixed, "copied"));
      auto to = must(gl::Buffer::create(kBytes, gl::Buffer::Use::fixed, "copy"));
      from.clear(0, kBytes);
      program.use();
      from.bind_storage(0);
      to.bind_storage(1);
      const auto copy = [&] {
        glDispatchCompute(static_cast<GLuint>(kBytes / kBytesPerGroup), 1, 1);
      };
      copy();
      for (int run = 0; run < kRuns; ++run) {
        glFinish();
        const double start = now_ms();
        for (int i = 0; i < 16; ++i) copy();
        glFinish();
        samples.add((now_ms() - start) / 16);
      }
    });
  }
  return 2.0 * static_cast<double>(kBytes) / (samples.quantile(0) / 1000);
}

}  // namespace strata::bench
