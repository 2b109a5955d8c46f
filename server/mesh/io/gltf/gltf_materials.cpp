#include "mesh/io/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/text/utf8.h"
#include "mesh/io/load_formats.h"
#include "mesh/io/texture_loader.h"
#include "mesh/texture/vertex_color.h"

namespace strata::mesh {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNotes = 100;

Wrap wrap_of(std::uint64_t mode) {
  if (mode == 33071) return Wrap::clamp;
  return mode == 33648 ? Wrap::mirror : Wrap::repeat;
}

class MaterialReader {
 public:
  MaterialReader(GltfDocument& document, const InputFiles& files, LoadedMesh& loaded)
      : document_(document),
        mesh_(loaded.mesh),
        repairs_(loaded.repairs),
        shelf_(files, loaded.mesh, loaded.repairs) {}

  Result<std::vector<GltfMaterial>> read() {
    std::vector<GltfMaterial> materials;
    const auto list = document_.root().find("materials");
    if (list == document_.root().end()) return materials;
    if (!list->is_array() || list->size() >= kNoMaterial)
      return refuse_file("In the glTF, \"materials\" is not a list of fewer than 65535 materials.");
    for (const json& source : *list) {
      if (!source.is_object()) return refuse_file("A material of the glTF is not an object.");
      auto material = STRATA_TRY(read_material(source));
      material.material = static_cast<std::uint16_t>(materials.size());
      materials.push_back(material);
    }
    return materials;
  }

 private:
  Result<GltfMaterial> read_material(const json& source) {
    const json& glossy =
        object_in(object_in(source, "extensions"), "KHR_materials_pbrSpecularGlossiness");
    const json& metallic = object_in(source, "pbrMetallicRoughness");
    const bool is_glossy = metallic.empty() && !glossy.empty();
    const auto factor =
        STRATA_TRY(real_numbers(is_glossy ? glossy : metallic,
                                is_glossy ? "diffuseFactor" : "baseColorFactor", {1, 1, 1, 1}));
    Material material;
    material.name = text_of(source, "name").substr(0, 200);
    for (int k = 0; k < 3; ++k) material.color[k] = static_cast<float>(srgb_of_linear(factor[k]));
    material.color.a = static_cast<float>(std::clamp(factor[3], 0.0, 1.0));
    GltfMaterial result;
    const json& texture =
        object_in(is_glossy ? glossy : metallic, is_glossy ? "diffuseTexture" : "baseColorTexture");
    if (!texture.empty()) STRATA_TRY(read_texture(texture, material, result));
    mesh_.materials.push_back(std::move(material));
    return result;
  }

  Result<void> read_texture(const json& reference, Material& material, GltfMaterial& result) {
    const json& transform = object_in(object_in(reference, "extensions"), "KHR_texture_transform");
    const auto index = whole_number(reference, "index"),
               texcoord = whole_number(reference, "texCoord", 0);
    if (!index) return tl::unexpected(index.error());
    if (!texcoord) return tl::unexpected(texcoord.error());
    const auto set = STRATA_TRY(whole_number(transform, "texCoord", *texcoord));
    result.texcoord = static_cast<int>(std::min<std::uint64_t>(set, 1000));
    STRATA_TRY(read_transform(transform, result));

    const auto texture = STRATA_TRY(document_.element("textures", *index));
    if (texture->contains("sampler")) {
      const auto number = STRATA_TRY(whole_number(*texture, "sampler"));
      const auto sampler = STRATA_TRY(document_.element("samplers", number));
      const auto s = whole_number(*sampler, "wrapS", 10497),
                 t = whole_number(*sampler, "wrapT", 10497);
      if (!s) return tl::unexpected(s.error());
      if (!t) return tl::unexpected(t.error());
      material.wrap_u = wrap_of(*s);
      material.wrap_v = wrap_of(*t);
    }
    const auto source = STRATA_TRY(image_of(*texture));
    if (!source) {
      if (pictureless_.insert(*index).second && pictureless_.size() <= kMaxNotes)
        note(repairs_, "texture without a picture: " + title_of(*texture, *index), 1);
      return {};
    }
    const std::uint64_t image = *source;
    if (image_textures_.contains(image)) {
      material.texture = image_textures_[image];
      return {};
    }
    auto found = STRATA_TRY(document_.image(image));
    const std::string name = found.name.empty() ? "image " + std::to_string(image) : found.name;
    if (found.missing)
      shelf_.missing(name);
    else
      material.texture = shelf_.of_bytes(name, std::move(found.bytes));
    image_textures_[image] = material.texture;
    return {};
  }

  // Returns the plain image if it exists, otherwise the image of an extension in another format.
  // Returns nothing if no image is found. glTF allows a texture without an image, which another
  // extension may supply.
  static Result<std::optional<std::uint64_t>> image_of(const json& texture) {
    if (texture.contains("source")) return optional_number(texture);
    for (const char* extension :
         {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"}) {
      const json& found = object_in(object_in(texture, "extensions"), extension);
      if (found.contains("source")) return optional_number(found);
    }
    return std::nullopt;
  }
  static Result<std::optional<std::uint64_t>> optional_number(const json& object) {
    const auto number = whole_number(object, "source");
    if (!number) return tl::unexpected(number.error());
    return *number;
  }
  // Also lists the extensions that may supply an image.
  static std::string title_of(const json& texture, std::uint64_t index) {
    std::string title = "texture " + std::to_string(index);
    const json& extensions = object_in(texture, "extensions");
    for (auto extension = extensions.begin(); extension != extensions.end(); ++extension)
      title += (extension == extensions.begin() ? " (" : ", ") + extension.key();
    if (!extensions.empty()) title += ')';
    return mended_utf8(first_bytes(title, 200));
  }

  // The rotation is counterclockwise with v pointing down (KHR_texture_transform).
  static Result<void> read_transform(const json& transform, GltfMaterial& result) {
    const auto offset = real_numbers(transform, "offset", {0, 0}),
               scale = real_numbers(transform, "scale", {1, 1});
    if (!offset) return tl::unexpected(offset.error());
    if (!scale) return tl::unexpected(scale.error());
    double turn = 0;
    if (const auto rotation = transform.find("rotation"); rotation != transform.end()) {
      if (!rotation->is_number() || !std::isfinite(rotation->get<double>()))
        return refuse_file("In the glTF, \"rotation\" of a texture is not a number.");
      turn = rotation->get<double>();
    }
    const double c = std::cos(turn), s = std::sin(turn);
    result.uv_matrix = glm::dmat2(glm::dvec2(c, -s) * (*scale)[0], glm::dvec2(s, c) * (*scale)[1]);
    result.uv_offset = {(*offset)[0], (*offset)[1]};
    return {};
  }

  GltfDocument& document_;
  TriangleMesh& mesh_;
  std::vector<Repair>& repairs_;
  TextureLoader shelf_;
  std::set<std::uint64_t> pictureless_;
  std::map<std::uint64_t, int> image_textures_;
};

}  // namespace

Result<std::vector<GltfMaterial>> read_gltf_materials(GltfDocument& document,
                                                      const InputFiles& files, LoadedMesh& loaded) {
  return MaterialReader(document, files, loaded).read();
}

}  // namespace strata::mesh
