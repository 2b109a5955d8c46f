#pragma once

#include <functional>
#include <future>
#include <memory>
#include <string>

#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "render/renderer.h"
#include "render/view/depth_buffers.h"

namespace strata::test {

// Meshes with their own charts, for GL tests.
mesh::TriangleMesh bumpy_sphere(int quads_per_edge);  // radius ≈ 1, 6 charts, 12 · n² triangles
// Two unit squares at z = 0 and z = -gap, with 2 charts.
mesh::TriangleMesh folded_sheets(double gap);
mesh::TriangleMesh flat_square(int quads_per_edge = 1);  // unit square at z = 0, uv 0.05 … 0.95
// The same square with heights that `height` computes from x and y in -0.5 … 0.5.
mesh::TriangleMesh relief_square(int quads_per_edge,
                                 const std::function<double(double, double)>& height);

Camera perspective_camera(const glm::dvec3& eye, const glm::dvec3& target, int width, int height,
                          double fov_degrees = 45);
Camera orthographic_camera(const glm::dvec3& eye, const glm::dvec3& target, int width, int height,
                           double half_height);

struct Scene {
  std::shared_ptr<const mesh::Geometry> geometry;
  std::shared_ptr<const mesh::SurfaceMap> map;
  std::vector<std::shared_ptr<const mesh::Geometry>> coarser;
};
Scene make_scene(const mesh::TriangleMesh& mesh, int resolution);  // uses the mesh's corner_uvs

// Calls a function whose last argument is a `Done<T>` callback and waits for the result.
template <class T, class Call>
Result<T> await(Call call) {
  auto promise = std::make_shared<std::promise<Result<T>>>();
  auto future = promise->get_future();
  call([promise](Result<T> result) { promise->set_value(std::move(result)); });
  return future.get();
}

// A renderer in a debug context with blocking calls. Any Error fails the test. The destructor
// checks that no GL error was reported. STRATA_TEST_EDIT_PATH (`compute` or `kernel`) selects the
// path that paints, unless the options select one.
class TestRenderer {
 public:
  explicit TestRenderer(render::RendererOptions options = {});
  ~TestRenderer();

  render::Renderer* operator->() { return renderer_.get(); }
  render::Renderer& get() { return *renderer_; }

  render::ModelHandle add(const Scene& scene);  // adds the model and its surface map
  render::LayerHandle add_layer(render::ModelHandle model, ValueType type, int resolution);
  render::ViewHandle add_view(render::ModelHandle model);
  render::StrokeOutcome paint(render::LayerHandle layer, const StrokeBatch& stroke);
  render::Frame draw(const render::FrameRequest& request);
  void write(render::LayerHandle layer, std::vector<render::TileUpload> tiles);
  // Returns the depth of the full mesh, bottom row first.
  std::vector<float> depth(const Scene& scene, const Camera& camera);

 private:
  std::unique_ptr<render::Renderer> renderer_;
};

// Copies the rectangles of `part` into `whole`, as a client does.
void put(render::Frame& whole, const render::Frame& part);

// Draws the depth of the whole mesh. The caller must have a current context.
std::shared_ptr<render::DepthBuffer> draw_depth(render::DepthBuffers& depths,
                                                const render::MeshBuffers& mesh,
                                                const Camera& camera);

// Returns a stroke of one point with a round brush and a value of type u8.
StrokeBatch dab(const Camera& camera, double x, double y, double radius_px,
                std::uint32_t value_bits = 7);

}  // namespace strata::test
