#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>

#include "mesh/face_builder.h"
#include "mesh/gltf_document.h"
#include "mesh/gltf_draco.h"
#include "mesh/gltf_materials.h"
#include "mesh/load_formats.h"
#include "mesh/vertex_color.h"

namespace strata::mesh {
namespace {

using nlohmann::json;

constexpr std::uint32_t kUnused = 0xffffffffu;

enum Mode : std::uint64_t { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

// What one primitive holds, wherever it was compressed; texture coordinates and colours may be missing.
struct Primitive {
  GltfDocument::Values positions, uvs, colors;
  std::vector<std::uint32_t> indices;
  std::uint64_t mode = Mode::triangles;
};

glm::dvec3 point_of(const GltfDocument::Values& values, std::uint64_t i) {
  return {values.numbers[3 * i], values.numbers[3 * i + 1], values.numbers[3 * i + 2]};
}

// Node transforms stay in double to the end: a translation may be a place on Earth.
class GltfReader {
 public:
  GltfReader(GltfDocument document, const InputFiles& files, Progress& progress, std::size_t max_triangles)
      : document_(std::move(document)),
        files_(files),
        progress_(progress),
        max_triangles_(max_triangles),
        faces_(loaded_.mesh, max_triangles) {}

  Result<LoadedMesh> read() {
    auto materials = read_gltf_materials(document_, files_, loaded_);
    if (!materials) return tl::unexpected(materials.error());
    materials_ = std::move(*materials);
    if (auto walked = walk_scene(); !walked) return tl::unexpected(walked.error());
    auto& mesh = loaded_.mesh;
    if (mesh.vertex_colors.empty()) mesh.colors_tint_materials = false;
    if (mesh.triangles.empty() && ignored_primitives_ > 0)
      return refuse_file("The glTF holds points or lines only, and no triangles.");
    faces_.report(loaded_.repairs);
    note(loaded_.repairs, "ignored points and lines", ignored_primitives_);
    note(loaded_.repairs, "ignored skins, morph targets and instances of EXT_mesh_gpu_instancing", ignored_motion_);
    loaded_.unit = Unit::m;  // both by the specification
    loaded_.up = "y";
    return std::move(loaded_);
  }

 private:
  struct Visit {
    std::uint64_t node;
    glm::dmat4 world_from_parent;
  };

  // The default scene; without scenes all nodes that are no one's children.
  Result<std::vector<Visit>> roots() {
    const json& root = document_.root();
    std::vector<Visit> roots;
    if (root.contains("scenes")) {
      const auto scene = whole_number(root, "scene", 0);
      if (!scene) return tl::unexpected(scene.error());
      const auto found = document_.element("scenes", *scene);
      if (!found) return tl::unexpected(found.error());
      const auto nodes = children_of(**found, "nodes");
      if (!nodes) return tl::unexpected(nodes.error());
      for (const std::uint64_t node : *nodes) roots.push_back({node, glm::dmat4(1)});
      return roots;
    }
    const auto nodes = root.find("nodes");
    const std::size_t count = nodes != root.end() && nodes->is_array() ? nodes->size() : 0;
    std::vector<bool> is_child(count, false);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(*nodes)[i].is_object()) continue;
      const auto children = children_of((*nodes)[i], "children");
      if (!children) return tl::unexpected(children.error());
      for (const std::uint64_t child : *children)
        if (child < count) is_child[child] = true;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (!is_child[i]) roots.push_back({i, glm::dmat4(1)});
    return roots;
  }

  static Result<std::vector<std::uint64_t>> children_of(const json& parent, const char* name) {
    std::vector<std::uint64_t> children;
    const auto list = parent.find(name);
    if (list == parent.end()) return children;
    if (!list->is_array()) return refuse_file("In the glTF, \"" + std::string(name) + "\" is not a list.");
    for (const json& child : *list) {
      if (!child.is_number_unsigned()) return refuse_file("In the glTF, a child of a node is not a number.");
      children.push_back(child.get<std::uint64_t>());
    }
    return children;
  }

  Result<void> walk_scene() {
    auto open = roots();
    if (!open) return tl::unexpected(open.error());
    std::reverse(open->begin(), open->end());
    std::vector<bool> seen(document_.root().contains("nodes") ? document_.root()["nodes"].size() : 0, false);
    while (!open->empty()) {
      const Visit visit = open->back();
      open->pop_back();
      const auto node = document_.element("nodes", visit.node);
      if (!node) return tl::unexpected(node.error());
      if (seen[visit.node])
        return refuse_file("Node " + std::to_string(visit.node) +
                           " of the glTF hangs in its scene twice, or is its own ancestor.");
      seen[visit.node] = true;
      const auto local = transform_of(**node);
      if (!local) return tl::unexpected(local.error());
      const glm::dmat4 world_from_node = visit.world_from_parent * *local;
      if ((*node)->contains("mesh")) {
        ignored_motion_ +=
            (*node)->contains("skin") || object_in(**node, "extensions").contains("EXT_mesh_gpu_instancing");
        if (auto added = add_mesh(**node, world_from_node); !added) return added;
      }
      auto children = children_of(**node, "children");
      if (!children) return tl::unexpected(children.error());
      for (auto child = children->rbegin(); child != children->rend(); ++child)
        open->push_back({*child, world_from_node});
    }
    return {};
  }

  static Result<glm::dmat4> transform_of(const json& node) {
    if (node.contains("matrix")) {
      const auto matrix = real_numbers(node, "matrix", std::vector<double>(16));
      if (!matrix) return tl::unexpected(matrix.error());
      return glm::make_mat4(matrix->data());
    }
    const auto t = real_numbers(node, "translation", {0, 0, 0}), r = real_numbers(node, "rotation", {0, 0, 0, 1}),
               s = real_numbers(node, "scale", {1, 1, 1});
    for (const auto* numbers : {&t, &r, &s})
      if (!*numbers) return tl::unexpected(numbers->error());
    glm::dquat rotation((*r)[3], (*r)[0], (*r)[1], (*r)[2]);
    const double length = glm::length(rotation);
    rotation = length > 0 ? rotation / length : glm::dquat(1, 0, 0, 0);
    glm::dmat4 matrix = glm::mat4_cast(rotation);
    for (int k = 0; k < 3; ++k) matrix[k] *= (*s)[k];
    matrix[3] = glm::dvec4((*t)[0], (*t)[1], (*t)[2], 1);
    return matrix;
  }

  Result<void> add_mesh(const json& node, const glm::dmat4& world_from_node) {
    const auto index = whole_number(node, "mesh");
    if (!index) return tl::unexpected(index.error());
    const auto mesh = document_.element("meshes", *index);
    if (!mesh) return tl::unexpected(mesh.error());
    const auto primitives = (*mesh)->find("primitives");
    if (primitives == (*mesh)->end() || !primitives->is_array())
      return refuse_file("Mesh " + std::to_string(*index) + " of the glTF has no primitives.");
    for (const json& primitive : *primitives) {
      if (!primitive.is_object()) return refuse_file("A primitive of the glTF is not an object.");
      progress_.report(kParsedShare * done_ / (done_ + 1), "Reading triangles");
      done_ += 0.25;
      if (progress_.cancelled()) return cancelled_problem();
      ignored_motion_ += primitive.contains("targets");
      if (auto added = add_primitive(primitive, world_from_node); !added) return added;
    }
    return {};
  }

  Result<void> add_primitive(const json& source, const glm::dmat4& world_from_node) {
    GltfMaterial material;
    if (source.contains("material")) {
      const auto index = whole_number(source, "material");
      if (!index) return tl::unexpected(index.error());
      if (*index >= materials_.size())
        return refuse_file("A primitive of the glTF names material " + std::to_string(*index) + ", but there are " +
                           std::to_string(materials_.size()) + ".");
      material = materials_[*index];
    }
    const auto primitive = read_primitive(source, material);
    if (!primitive) return tl::unexpected(primitive.error());
    if (!*primitive) return {};
    return append(**primitive, material, world_from_node);
  }

  // Nothing: points or lines.
  Result<std::optional<Primitive>> read_primitive(const json& source, const GltfMaterial& material) {
    Primitive primitive;
    const auto mode = whole_number(source, "mode", Mode::triangles);
    if (!mode) return tl::unexpected(mode.error());
    primitive.mode = *mode;
    if (*mode != Mode::triangles && *mode != Mode::triangle_strip && *mode != Mode::triangle_fan) {
      ++ignored_primitives_;
      return std::nullopt;
    }
    const auto& attributes = object_in(source, "attributes");
    const std::string uv_name = "TEXCOORD_" + std::to_string(material.texcoord);
    const auto& draco = object_in(object_in(source, "extensions"), "KHR_draco_mesh_compression");
    if (!draco.empty()) {
      if (auto done = read_draco(source, draco, uv_name, primitive); !done) return tl::unexpected(done.error());
    } else {
      const auto read = [&](const std::string& name, GltfDocument::Values& values) -> Result<void> {
        if (!attributes.contains(name)) return {};
        const auto accessor = whole_number(attributes, name.c_str());
        if (!accessor) return tl::unexpected(accessor.error());
        auto found = document_.values(*accessor, name);
        if (!found) return tl::unexpected(found.error());
        values = std::move(*found);
        return {};
      };
      for (auto& [name, values] : {std::pair<std::string, GltfDocument::Values*>{"POSITION", &primitive.positions},
                                   {uv_name, &primitive.uvs},
                                   {"COLOR_0", &primitive.colors}})
        if (auto done = read(name, *values); !done) return tl::unexpected(done.error());
      if (auto done = read_indices(source, primitive); !done) return tl::unexpected(done.error());
    }
    const std::uint64_t count = primitive.positions.count;
    if (primitive.positions.components != 3) return refuse_file("A primitive of the glTF has no POSITION.");
    const auto fits = [&](const GltfDocument::Values& values, int least, int most) {
      return values.components == 0 ||
             (values.count == count && values.components >= least && values.components <= most);
    };
    if (!fits(primitive.uvs, 2, 2) || !fits(primitive.colors, 3, 4))
      return refuse_file("A primitive of the glTF has texture coordinates or colours that do not match its positions.");
    for (const std::uint32_t index : primitive.indices)
      if (index >= count)
        return refuse_file("A triangle of the glTF names vertex " + std::to_string(index) + ", but its primitive has " +
                           std::to_string(count) + ".");
    return primitive;
  }

  Result<void> read_indices(const json& source, Primitive& primitive) {
    if (!source.contains("indices")) {
      if (primitive.positions.count > 3 * std::uint64_t{max_triangles_})
        return refuse_file("The glTF has more vertices than may be.");
      primitive.indices.resize(primitive.positions.count);
      for (std::uint32_t i = 0; i < primitive.indices.size(); ++i) primitive.indices[i] = i;
      return {};
    }
    const auto accessor = whole_number(source, "indices");
    if (!accessor) return tl::unexpected(accessor.error());
    auto indices = document_.indices(*accessor);
    if (!indices) return tl::unexpected(indices.error());
    primitive.indices = std::move(*indices);
    return {};
  }

  Result<void> read_draco(const json& source, const json& extension, const std::string& uv_name, Primitive& primitive) {
    const auto& attributes = object_in(extension, "attributes");
    std::map<std::string, std::uint32_t> ids;
    for (const std::string& name : {std::string("POSITION"), uv_name, std::string("COLOR_0")}) {
      if (!attributes.contains(name)) continue;
      const auto id = whole_number(attributes, name.c_str());
      if (!id) return tl::unexpected(id.error());
      ids[name] = static_cast<std::uint32_t>(*id);
    }
    const auto view_index = whole_number(extension, "bufferView"), accessor = whole_number(source, "indices");
    if (!view_index) return tl::unexpected(view_index.error());
    if (!accessor) return tl::unexpected(accessor.error());
    const auto announced = document_.count(*accessor);
    if (!announced) return tl::unexpected(announced.error());
    const auto view = document_.view(*view_index);
    if (!view) return tl::unexpected(view.error());
    auto decoded = decode_draco(view->bytes, ids, std::min<std::uint64_t>(*announced / 3, max_triangles_));
    if (!decoded) return tl::unexpected(decoded.error());
    const auto take = [&](const std::string& name, GltfDocument::Values& values) {
      const auto found = decoded->attributes.find(name);
      if (found != decoded->attributes.end())
        values = {decoded->points, found->second.components, std::move(found->second.numbers)};
    };
    take("POSITION", primitive.positions);
    take(uv_name, primitive.uvs);
    take("COLOR_0", primitive.colors);
    primitive.indices = std::move(decoded->indices);
    primitive.mode = Mode::triangles;
    return {};
  }

  Result<void> append(const Primitive& primitive, const GltfMaterial& material, const glm::dmat4& world_from_node) {
    TriangleMesh& mesh = loaded_.mesh;
    // Primitives share accessors: each takes the vertices that its triangles name.
    std::vector<std::uint32_t> number(primitive.positions.count, kUnused), used;
    for (const std::uint32_t index : primitive.indices) {
      if (number[index] != kUnused) continue;
      number[index] = static_cast<std::uint32_t>(mesh.positions.size() + used.size());
      used.push_back(index);
    }
    if (mesh.positions.size() + used.size() >= kUnused)
      return refuse_file("More than 4 294 967 294 vertices; split the mesh.");
    append_colors(primitive.colors, mesh.positions.size(), used);
    for (const std::uint32_t index : used)
      mesh.positions.emplace_back(world_from_node * glm::dvec4(point_of(primitive.positions, index), 1));

    faces_.use_material(material.material);
    const bool has_uv = primitive.uvs.components == 2;
    const auto corner = [&](std::uint32_t index) {
      FaceBuilder::Corner made{number[index]};
      if (has_uv)
        made.uv = material.texture_uv(
            {primitive.uvs.numbers[2 * std::size_t{index}], primitive.uvs.numbers[2 * std::size_t{index} + 1]});
      return made;
    };
    const bool mirrored = glm::determinant(glm::dmat3(world_from_node)) < 0;
    const auto& indices = primitive.indices;
    const std::size_t step = primitive.mode == Mode::triangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < indices.size(); i += step) {
      std::uint32_t a = indices[primitive.mode == Mode::triangle_fan ? 0 : i], b = indices[i + 1], c = indices[i + 2];
      if (primitive.mode == Mode::triangle_strip) {
        if (a == b || b == c || c == a) continue;  // they only join strips
        if (i % 2 == 1) std::swap(a, b);
      }
      if (mirrored) std::swap(b, c);
      if (auto added = faces_.add_triangle(corner(a), corner(b), corner(c), has_uv); !added) return added;
    }
    return {};
  }

  // COLOR_0 is linear; ours are as pictures have them.
  void append_colors(const GltfDocument::Values& colors, std::size_t first, const std::vector<std::uint32_t>& used) {
    auto& out = loaded_.mesh.vertex_colors;
    if (colors.components == 0) {
      if (!out.empty()) out.resize(first + used.size(), 0xffffffffu);
      return;
    }
    loaded_.mesh.colors_tint_materials = true;
    out.resize(first, 0xffffffffu);
    const std::size_t n = static_cast<std::size_t>(colors.components);
    for (const std::uint32_t index : used) {
      const float* c = &colors.numbers[index * n];
      out.push_back(pack_color(255 * srgb_of_linear(c[0]), 255 * srgb_of_linear(c[1]), 255 * srgb_of_linear(c[2]),
                               n == 4 ? 255 * c[3] : 255));
    }
  }

  GltfDocument document_;
  const InputFiles& files_;
  Progress& progress_;
  const std::size_t max_triangles_;
  LoadedMesh loaded_;
  FaceBuilder faces_;
  std::vector<GltfMaterial> materials_;
  std::uint64_t ignored_primitives_ = 0, ignored_motion_ = 0;
  double done_ = 0;
};

}  // namespace

Result<LoadedMesh> parse_gltf(const InputFiles& files, Progress& progress, std::size_t max_triangles) {
  auto document = GltfDocument::open(files);
  if (!document) return tl::unexpected(document.error());
  return GltfReader(std::move(*document), files, progress, max_triangles).read();
}

}  // namespace strata::mesh
