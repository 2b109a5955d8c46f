#include "support/gl_scene.h"

#include <algorithm>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <string_view>

#include "support/shader_dirs.h"

namespace strata::test {
namespace {

template <class T>
T expect(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().title + ": " + result.error().detail);
  return std::move(*result);
}

void expect(Result<void> result) {
  if (!result) throw std::runtime_error(result.error().title + ": " + result.error().detail);
}

// Adds a grid of quads as one chart. For u and v in [0, 1], `place` returns the position and `uv`
// the texture coordinates.
template <class Place, class Uv>
void add_chart(mesh::TriangleMesh& mesh, int quads, Place place, Uv uv) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto at = [&](int i) { return static_cast<double>(i) / quads; };
  for (int y = 0; y <= quads; ++y)
    for (int x = 0; x <= quads; ++x) mesh.positions.push_back(place(at(x), at(y)));
  const auto corner = [&](int x, int y) {
    mesh.triangles.push_back(first + static_cast<std::uint32_t>(y * (quads + 1) + x));
    mesh.corner_uvs.push_back(uv(at(x), at(y)));
  };
  for (int y = 0; y < quads; ++y) {
    for (int x = 0; x < quads; ++x) {
      corner(x, y), corner(x + 1, y), corner(x + 1, y + 1);
      corner(x, y), corner(x + 1, y + 1), corner(x, y + 1);
    }
  }
}

}  // namespace

mesh::TriangleMesh bumpy_sphere(int quads_per_edge) {
  mesh::TriangleMesh mesh;
  for (int face = 0; face < 6; ++face) {
    const auto place = [&](double u, double v) {
      const double a = std::tan((2 * u - 1) * 0.7853981633974483),
                   b = std::tan((2 * v - 1) * 0.7853981633974483);
      const glm::dvec3 directions[] = {{1, b, -a}, {-1, b, a}, {a, 1, -b},
                                       {a, -1, b}, {a, b, 1},  {-a, b, -1}};
      const glm::dvec3 d = glm::normalize(directions[face]);
      const double bump = 0.05 * std::sin(7 * d.x) * std::sin(6 * d.y + 1) * std::sin(8 * d.z + 2) +
                          0.004 * std::sin(61 * d.x) * std::sin(53 * d.y) * std::sin(67 * d.z);
      return d * (1 + bump);
    };
    // Each chart is rotated in its cell, so texel rows and triangle edges do not align.
    const int column = face % 3, row = face / 3;
    const glm::vec2 center((0.5f + static_cast<float>(column)) / 3,
                           (0.5f + static_cast<float>(row)) / 2);
    const float turn = 0.1f + 0.2f * static_cast<float>(face), size = 0.21f;
    const auto uv = [&](double u, double v) {
      const glm::vec2 p(static_cast<float>(u) - 0.5f, static_cast<float>(v) - 0.5f);
      return center + size * glm::vec2(std::cos(turn) * p.x - std::sin(turn) * p.y,
                                       std::sin(turn) * p.x + std::cos(turn) * p.y);
    };
    add_chart(mesh, quads_per_edge, place, uv);
  }
  return mesh;
}

mesh::TriangleMesh folded_sheets(double gap) {
  mesh::TriangleMesh mesh;
  for (int sheet = 0; sheet < 2; ++sheet) {
    add_chart(
        mesh, 4, [&](double u, double v) { return glm::dvec3(u - 0.5, v - 0.5, -gap * sheet); },
        [&](double u, double v) {
          return glm::vec2(0.05 + 0.5 * sheet + 0.4 * u, 0.05 + 0.4 * v);
        });
  }
  return mesh;
}

mesh::TriangleMesh flat_square(int quads_per_edge) {
  return relief_square(quads_per_edge, [](double, double) { return 0.0; });
}

mesh::TriangleMesh relief_square(int quads_per_edge,
                                 const std::function<double(double, double)>& height) {
  mesh::TriangleMesh mesh;
  add_chart(
      mesh, quads_per_edge,
      [&](double u, double v) { return glm::dvec3(u - 0.5, v - 0.5, height(u - 0.5, v - 0.5)); },
      [](double u, double v) { return glm::vec2(0.05 + 0.9 * u, 0.05 + 0.9 * v); });
  return mesh;
}

Camera perspective_camera(const glm::dvec3& eye, const glm::dvec3& target, int width, int height,
                          double fov_degrees) {
  const glm::dvec3 up =
      std::abs(glm::normalize(target - eye).y) > 0.95 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  return {glm::lookAt(eye, target, up),
          glm::perspective(glm::radians(fov_degrees), double(width) / height, 0.1, 20.0), width,
          height};
}

Camera orthographic_camera(const glm::dvec3& eye, const glm::dvec3& target, int width, int height,
                           double half_height) {
  const double half_width = half_height * width / height;
  return {glm::lookAt(eye, target, glm::dvec3(0, 1, 0)),
          glm::ortho(-half_width, half_width, -half_height, half_height, 0.1, 20.0), width, height};
}

Scene make_scene(const mesh::TriangleMesh& mesh, int resolution) {
  mesh::Atlas atlas;
  atlas.corner_uvs = mesh.corner_uvs;
  Scene scene;
  scene.geometry = std::make_shared<const mesh::Geometry>(mesh::build_geometry(mesh, atlas));
  Progress progress;
  scene.map = std::make_shared<const mesh::SurfaceMap>(
      expect(mesh::bake_surface_map(*scene.geometry, resolution, progress)));
  return scene;
}

TestRenderer::TestRenderer(render::RendererOptions options) {
  if (const char* path = std::getenv("STRATA_TEST_EDIT_PATH");
      path && options.edit_path == render::EditPath::automatic)
    options.edit_path =
        std::string_view(path) == "kernel" ? render::EditPath::kernel : render::EditPath::compute;
  options.shader_dir = shader_dir().string();
  options.debug = true;
  renderer_ = expect(render::Renderer::start(options));
}

TestRenderer::~TestRenderer() {
  // Wait until the jobs of other threads have run, then count the errors.
  renderer_->run_on_gpu_thread_for_test([] {});
  EXPECT_EQ(renderer_->debug_errors(), 0) << "the driver reported GL errors; see the log above";
}

render::ModelHandle TestRenderer::add(const Scene& scene) {
  const auto model = expect(await<render::ModelHandle>([&](auto done) {
    renderer_->add_model({scene.geometry, scene.coarser}, std::move(done));
  }));
  if (scene.map)
    expect(await<void>(
        [&](auto done) { renderer_->add_surface_map(model, scene.map, std::move(done)); }));
  return model;
}

render::LayerHandle TestRenderer::add_layer(render::ModelHandle model, ValueType type,
                                            int resolution) {
  return expect(await<render::LayerHandle>(
      [&](auto done) { renderer_->add_layer(model, type, resolution, std::move(done)); }));
}

render::ViewHandle TestRenderer::add_view(render::ModelHandle model) {
  return expect(
      await<render::ViewHandle>([&](auto done) { renderer_->add_view(model, std::move(done)); }));
}

render::StrokeOutcome TestRenderer::paint(render::LayerHandle layer, const StrokeBatch& stroke) {
  return expect(await<render::StrokeOutcome>(
      [&](auto done) { renderer_->paint(layer, stroke, std::move(done)); }));
}

render::Frame TestRenderer::draw(const render::FrameRequest& request) {
  return *expect(
      await<render::SharedFrame>([&](auto done) { renderer_->draw(request, std::move(done)); }));
}

void TestRenderer::write(render::LayerHandle layer, std::vector<render::TileUpload> tiles) {
  expect(await<void>(
      [&](auto done) { renderer_->write_tiles(layer, std::move(tiles), std::move(done)); }));
}

std::shared_ptr<render::DepthBuffer> draw_depth(render::DepthBuffers& depths,
                                                const render::MeshBuffers& mesh,
                                                const Camera& camera) {
  auto buffer = expect(depths.start(render::depth_key(1, camera, camera.width, camera.height)));
  render::MeshProgress progress;
  while (!expect(depths.draw_slice(buffer, mesh, camera, progress))) {
  }
  return buffer;
}

std::vector<float> TestRenderer::depth(const Scene& scene, const Camera& camera) {
  std::vector<float> pixels(static_cast<std::size_t>(camera.width) *
                            static_cast<std::size_t>(camera.height));
  renderer_->run_on_gpu_thread_for_test([&] {
    render::GpuMemory memory(std::uint64_t{1} << 32);
    gl::ReadbackPool readback;
    auto depths =
        expect(render::DepthBuffers::create(shader_dir(), std::size_t{1} << 16, memory, readback));
    auto mesh = expect(render::MeshBuffers::create(scene.geometry, memory));
    while (!mesh->upload_slice()) {
    }
    const auto buffer = draw_depth(depths, *mesh, camera);
    glGetTextureImage(buffer->texture.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                      static_cast<GLsizei>(pixels.size() * sizeof(float)), pixels.data());
  });
  return pixels;
}

StrokeBatch dab(const Camera& camera, double x, double y, double radius_px,
                std::uint32_t value_bits) {
  StrokeBatch stroke;
  stroke.camera = camera;
  stroke.path = {{x, y}};
  stroke.radius_px = radius_px;
  stroke.value_bits = value_bits;
  return stroke;
}

void put(render::Frame& whole, const render::Frame& part) {
  const std::uint8_t* from = part.pixels.data();
  for (const auto& rect : part.rects)
    for (int y = 0; y < rect.height; ++y, from += 4 * rect.width)
      std::copy_n(from, 4 * rect.width,
                  &whole.pixels[std::size_t{4} *
                                static_cast<std::size_t>((rect.y + y) * whole.width + rect.x)]);
  EXPECT_EQ(from, part.pixels.data() + part.pixels.size());
}

}  // namespace strata::test
