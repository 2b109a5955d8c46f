#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <optional>

#include "mesh/io/face_builder.h"
#include "mesh/io/gltf/gltf_document.h"
#include "mesh/io/gltf/gltf_instances.h"
#include "mesh/io/gltf/gltf_materials.h"
#include "mesh/io/gltf/gltf_primitive.h"
#include "mesh/io/load_formats.h"
#include "mesh/texture/vertex_color.h"

namespace strata::mesh {
namespace {

using nlohmann::json;

constexpr std::uint64_t kTrianglesBetweenReports = 1u << 20;

// Node transforms stay in double precision, because a translation may be a geographic position.
class GltfReader {
 public:
  GltfReader(GltfDocument document, const InputFiles& files, Progress& progress,
             std::size_t max_triangles)
      : document_(std::move(document)),
        files_(files),
        progress_(progress),
        max_triangles_(max_triangles),
        faces_(loaded_.mesh, max_triangles) {}

  Result<LoadedMesh> read() {
    auto materials = STRATA_TRY(read_gltf_materials(document_, files_, loaded_));
    materials_ = std::move(materials);
    STRATA_TRY(walk_scene());
    auto& mesh = loaded_.mesh;
    if (mesh.vertex_colors.empty()) mesh.colors_tint_materials = false;
    if (mesh.triangles.empty()) return nothing_to_see();
    faces_.report(loaded_.repairs);
    note(loaded_.repairs, "ignored points and lines", remarks_.points_and_lines);
    note(loaded_.repairs, "ignored parts of meshes without positions", remarks_.without_positions);
    note(loaded_.repairs, "ignored skins and morph targets", ignored_motion_);
    note(loaded_.repairs, "integer colors without a normalized flag, read as normalized",
         remarks_.colors_taken_as_normalized);
    loaded_.unit = Unit::m;  // both values are defined by the specification
    loaded_.up = "y";
    return std::move(loaded_);
  }

 private:
  tl::unexpected<Error> nothing_to_see() const {
    const auto meshes = document_.root().find("meshes");
    if (remarks_.points_and_lines > 0)
      return refuse_file("The glTF contains only points or lines, but no triangles.");
    if (remarks_.without_positions > 0)
      return refuse_file("The meshes of the glTF have no POSITION and therefore no triangles.");
    if (meshes == document_.root().end() || meshes->empty())
      return refuse_file("The glTF contains no meshes.");
    if (!mesh_shown_)
      return refuse_file(
          "The glTF contains meshes, but no node of its scene uses one. Export the scene "
          "with its objects.");
    return refuse_file("The file contains no triangle: the meshes of the glTF are empty.");
  }

  struct Visit {
    std::uint64_t node;
    glm::dmat4 world_from_parent;
  };

  // Returns the nodes of the default scene. Without scenes, returns all nodes without a parent.
  Result<std::vector<Visit>> roots() {
    const json& root = document_.root();
    std::vector<Visit> roots;
    if (root.contains("scenes")) {
      const auto scene = STRATA_TRY(whole_number(root, "scene", 0));
      const auto found = STRATA_TRY(document_.element("scenes", scene));
      const auto nodes = STRATA_TRY(children_of(*found, "nodes"));
      for (const std::uint64_t node : nodes) roots.push_back({node, glm::dmat4(1)});
      return roots;
    }
    const auto nodes = root.find("nodes");
    const std::size_t count = nodes != root.end() && nodes->is_array() ? nodes->size() : 0;
    std::vector<bool> is_child(count, false);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(*nodes)[i].is_object()) continue;
      const auto children = STRATA_TRY(children_of((*nodes)[i], "children"));
      for (const std::uint64_t child : children)
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
    if (!list->is_array())
      return refuse_file("In the glTF, \"" + std::string(name) + "\" is not a list.");
    for (const json& child : *list) {
      if (!child.is_number_unsigned())
        return refuse_file("In the glTF, a child of a node is not a number.");
      children.push_back(child.get<std::uint64_t>());
    }
    return children;
  }

  Result<void> walk_scene() {
    auto open = STRATA_TRY(roots());
    std::reverse(open.begin(), open.end());
    std::vector<bool> seen(
        document_.root().contains("nodes") ? document_.root()["nodes"].size() : 0, false);
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      const auto node = STRATA_TRY(document_.element("nodes", visit.node));
      if (seen[visit.node])
        return refuse_file("Node " + std::to_string(visit.node) +
                           " of the glTF appears in its scene twice, or is its own ancestor.");
      seen[visit.node] = true;
      const auto local = STRATA_TRY(transform_of(*node));
      const glm::dmat4 world_from_node = visit.world_from_parent * local;
      if (node->contains("mesh")) {
        mesh_shown_ = true;
        ignored_motion_ += node->contains("skin");
        STRATA_TRY(add_mesh(*node, world_from_node));
      }
      auto children = STRATA_TRY(children_of(*node, "children"));
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        open.push_back({*child, world_from_node});
    }
    return {};
  }

  static Result<glm::dmat4> transform_of(const json& node) {
    if (node.contains("matrix")) {
      const auto matrix = STRATA_TRY(real_numbers(node, "matrix", std::vector<double>(16)));
      return glm::make_mat4(matrix.data());
    }
    const auto t = real_numbers(node, "translation", {0, 0, 0}),
               r = real_numbers(node, "rotation", {0, 0, 0, 1}),
               s = real_numbers(node, "scale", {1, 1, 1});
    for (const auto* numbers : {&t, &r, &s})
      if (!*numbers) return tl::unexpected(numbers->error());
    return gltf_transform({(*t)[0], (*t)[1], (*t)[2]}, {(*r)[0], (*r)[1], (*r)[2], (*r)[3]},
                          {(*s)[0], (*s)[1], (*s)[2]});
  }

  Result<void> add_mesh(const json& node, const glm::dmat4& world_from_node) {
    const auto index = STRATA_TRY(whole_number(node, "mesh"));
    const auto mesh = STRATA_TRY(document_.element("meshes", index));
    const auto primitives = mesh->find("primitives");
    if (primitives == mesh->end() || !primitives->is_array())
      return refuse_file("Mesh " + std::to_string(index) + " of the glTF has no primitives.");
    const auto instances = STRATA_TRY(GltfInstances::read(document_, node));
    for (const json& primitive : *primitives) {
      if (!primitive.is_object()) return refuse_file("A primitive of the glTF is not an object.");
      progress_.report(kParsedShare * done_ / (done_ + 1), "Reading triangles");
      done_ += 0.25;
      if (progress_.cancelled()) return cancelled_problem();
      ignored_motion_ += primitive.contains("targets");
      STRATA_TRY(add_primitive(primitive, world_from_node, instances));
    }
    return {};
  }

  Result<void> add_primitive(const json& source, const glm::dmat4& world_from_node,
                             const GltfInstances& instances) {
    GltfMaterial material;
    if (source.contains("material")) {
      const auto index = STRATA_TRY(whole_number(source, "material"));
      if (index >= materials_.size())
        return refuse_file("A primitive of the glTF refers to material " + std::to_string(index) +
                           ", but the number of materials is " + std::to_string(materials_.size()) +
                           ".");
      material = materials_[index];
    }
    const auto primitive =
        read_gltf_primitive(document_, source, material, max_triangles_, remarks_);
    if (!primitive) return tl::unexpected(primitive.error());
    if (!*primitive || (*primitive)->most_triangles() == 0) return {};
    const std::uint64_t triangles = (*primitive)->most_triangles(), count = instances.count();
    // A few bytes can request any number of copies, so the size of the copies is checked first.
    // Some triangles of strips only connect other triangles.
    const std::uint64_t room =
        max_triangles_ - std::min<std::uint64_t>(loaded_.mesh.triangle_count(), max_triangles_);
    const std::uint64_t most =
        (*primitive)->mode == kTriangles ? room : 4 * std::uint64_t{max_triangles_};
    const std::uint64_t vertices = (*primitive)->positions.count;
    if (count > 1 &&
        (triangles > most / count || vertices > 3 * std::uint64_t{max_triangles_} / count))
      return refuse_file("The glTF repeats a mesh of " + std::to_string(triangles) + " triangles " +
                         std::to_string(count) + " times. That is more than " +
                         std::to_string(max_triangles_) +
                         " triangles. Reduce the mesh, or export the parts that you need.");
    std::uint64_t since_report = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      if ((since_report += triangles) >= kTrianglesBetweenReports) {
        since_report = 0;
        if (progress_.cancelled()) return cancelled_problem();
      }
      STRATA_TRY(append(**primitive, material, world_from_node * instances.node_from_instance(i)));
    }
    return {};
  }

  Result<void> append(const GltfPrimitive& primitive, const GltfMaterial& material,
                      const glm::dmat4& world_from_mesh) {
    TriangleMesh& mesh = loaded_.mesh;
    const std::size_t first = mesh.positions.size(), count = primitive.positions.count;
    if (first + count >= 0xffffffffu)
      return refuse_file("The file has more than 4 294 967 294 vertices. Split the mesh.");
    append_colors(primitive.colors, first, count);
    for (std::size_t i = 0; i < count; ++i)
      mesh.positions.emplace_back(world_from_mesh * glm::dvec4(primitive.position(i), 1));

    faces_.use_material(material.material);
    const bool has_uv = primitive.has_uvs();
    const auto corner = [&](std::uint32_t index) {
      FaceBuilder::Corner made{static_cast<std::uint32_t>(first) + index};
      if (has_uv)
        made.uv = material.texture_uv({primitive.uvs.numbers[2 * std::size_t{index}],
                                       primitive.uvs.numbers[2 * std::size_t{index} + 1]});
      return made;
    };
    const bool mirrored = glm::determinant(glm::dmat3(world_from_mesh)) < 0;
    const auto& indices = primitive.indices;
    const std::size_t step = primitive.mode == kTriangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < indices.size(); i += step) {
      std::uint32_t a = indices[primitive.mode == kTriangleFan ? 0 : i], b = indices[i + 1],
                    c = indices[i + 2];
      if (primitive.mode == kTriangleStrip) {
        if (a == b || b == c || c == a) continue;  // only connects strips
        if (i % 2 == 1) std::swap(a, b);
      }
      if (mirrored) std::swap(b, c);
      STRATA_TRY(faces_.add_triangle(corner(a), corner(b), corner(c), has_uv));
    }
    return {};
  }

  // COLOR_0 is linear. Vertex colors of a mesh are sRGB, as in images.
  void append_colors(const GltfDocument::Values& colors, std::size_t first, std::size_t count) {
    auto& out = loaded_.mesh.vertex_colors;
    if (colors.components == 0) {
      if (!out.empty()) out.resize(first + count, 0xffffffffu);
      return;
    }
    loaded_.mesh.colors_tint_materials = true;
    out.resize(first, 0xffffffffu);
    const std::size_t n = static_cast<std::size_t>(colors.components);
    for (std::size_t i = 0; i < count; ++i) {
      const float* c = &colors.numbers[i * n];
      out.push_back(pack_color(255 * srgb_of_linear(c[0]), 255 * srgb_of_linear(c[1]),
                               255 * srgb_of_linear(c[2]), n == 4 ? 255 * c[3] : 255));
    }
  }

  GltfDocument document_;
  const InputFiles& files_;
  Progress& progress_;
  const std::size_t max_triangles_;
  LoadedMesh loaded_;
  FaceBuilder faces_;
  std::vector<GltfMaterial> materials_;
  GltfRemarks remarks_;
  std::uint64_t ignored_motion_ = 0;
  bool mesh_shown_ = false;
  double done_ = 0;
};

}  // namespace

Result<LoadedMesh> parse_gltf(const InputFiles& files, Progress& progress,
                              std::size_t max_triangles) {
  auto document = STRATA_TRY(GltfDocument::open(files));
  return GltfReader(std::move(document), files, progress, max_triangles).read();
}

}  // namespace strata::mesh
