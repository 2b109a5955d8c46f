#include "render/view/shade_pass.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "shared/shade.h"

namespace strata::render {
namespace {

constexpr GLuint kUvUnit = 0, kLightUnit = 1, kPaletteUnit = 2, kValuesUnit = 3, kValidUnit = 9;
// A model has few combinations of layers, but painting adds chunks, and each new combination of
// chunks needs a program.
constexpr std::size_t kMaxPrograms = 64;

glm::vec4 color(const Rgba& c) { return glm::vec4(c[0], c[1], c[2], c[3]) / 255.0f; }

std::uint32_t mode_of(PaletteMode mode) {
  switch (mode) {
    case PaletteMode::linear: return shader::kPaletteLinear;
    case PaletteMode::step: return shader::kPaletteStep;
    case PaletteMode::categorical: return shader::kPaletteCategorical;
  }
  return shader::kPaletteLinear;
}

std::uint32_t blend_of(LayerBlend blend) {
  switch (blend) {
    case LayerBlend::normal: return shader::kBlendNormal;
    case LayerBlend::multiply: return shader::kBlendMultiply;
    case LayerBlend::screen: return shader::kBlendScreen;
  }
  return shader::kBlendNormal;
}

void set_unit(shader::ShadeLayer& layer, std::uint32_t chunk, std::uint32_t unit) {
  auto& units = chunk < 8 ? layer.units_low : layer.units_high;
  const std::uint32_t shift = (chunk % 8) * 4;
  units = (units & ~(15u << shift)) | unit << shift;
}

}  // namespace

Result<ShadePass> ShadePass::create(const std::filesystem::path& shader_dir,
                                    bool program_per_kinds) {
  ShadePass pass;
  pass.shader_dir_ = shader_dir;
  pass.program_per_kinds_ = program_per_kinds;
  auto palettes = STRATA_TRY(PaletteTextures::create());
  pass.palettes_ = std::move(palettes);
  auto background =
      STRATA_TRY(gl::Program::load(shader_dir, {"picture.vert", "background_pass.frag"}));
  pass.background_ = std::move(background);
  STRATA_TRY(pass.program({}, false, true));
  return pass;
}

Result<const gl::Program*> ShadePass::program(const Batch& batch, bool shows_inside, bool first) {
  std::string kinds;
  for (std::size_t i = 0; program_per_kinds_ && i < batch.layers.size(); ++i) {
    const auto& layer = batch.layers[i];
    kinds += "SHADE_LAYER(" + std::to_string(i) + "u, " + std::to_string(layer.mode) + "u, " +
             std::to_string(layer.type) + "u, " + std::to_string(batch.units[i]) + "u, " +
             std::to_string(layer.patterns) + "u, " + std::to_string(layer.blend) + "u) ";
  }
  const std::tuple key{batch.chunks.size(), kinds, shows_inside, first};
  const auto built = programs_.find(key);
  if (built != programs_.end()) return &built->second;
  std::vector<std::string> defines{"CHUNK_COUNT " + std::to_string(batch.chunks.size())};
  if (shows_inside) defines.emplace_back("CUT");
  if (!first) defines.emplace_back("OVER");
  if (!kinds.empty()) defines.push_back("LAYERS " + kinds);
  auto program =
      STRATA_TRY(gl::Program::load(shader_dir_, {"picture.vert", "shade_pass.frag"}, defines));
  if (programs_.size() >= kMaxPrograms) programs_.clear();
  return &programs_.insert_or_assign(key, std::move(program)).first->second;
}

bool ShadePass::can_take(const Batch& batch, const Chunk& chunk, bool listed) const {
  if (program_per_kinds_ && !listed && batch.layers.size() >= kLayersPerProgram) return false;
  const bool bound =
      std::find(batch.chunks.begin(), batch.chunks.end(), chunk) != batch.chunks.end();
  return bound || batch.chunks.size() < kChunksPerDraw;
}

shader::ShadeLayer ShadePass::describe(const ShadeInput::Layer& layer) {
  const auto entry = palettes_.find(layer.palette, layer.textures->type());
  shader::ShadeLayer out{};
  out.table = layer.textures->table_offset();
  out.resolution_bits = static_cast<std::uint32_t>(
      std::countr_zero(static_cast<unsigned>(layer.textures->resolution())));
  out.type = static_cast<std::uint32_t>(layer.textures->type());
  out.mode = mode_of(layer.palette->mode);
  out.row = entry.row;
  out.points = entry.points;
  out.point_count = entry.point_count;
  out.opacity = std::clamp(layer.opacity, 0.0f, 1.0f);
  out.palette_min = static_cast<float>(layer.palette->min);
  out.palette_max = static_cast<float>(layer.palette->max);
  out.has_others = layer.palette->others ? 1 : 0;
  out.others = packed(layer.palette->others.value_or(Rgba{}));
  out.patterns = !entry.patterned ? shader::kNoPatterns
                 : layer.bare     ? shader::kBarePatterns
                                  : shader::kPatterns;
  out.blend = blend_of(layer.blend);
  // Without a range, each value maps to one end of the palette. The range must not be 0, because
  // the shader divides by it.
  const bool has_range = out.palette_max > out.palette_min;
  if (!has_range && layer.palette->mode == PaletteMode::linear)
    out.palette_max = std::nextafter(out.palette_min, 1e38f);
  static_assert(shader::kNoChunkUnit == 0xfu);
  out.units_low = out.units_high = 0xffffffffu;  // no chunk has a unit so far
  return out;
}

// Plans batches in drawing order. If the chunks of a layer do not fit into one batch, the layer is
// in several batches. Each texel of the layer is shaded by one batch.
std::vector<ShadePass::Batch> ShadePass::plan(std::span<const ShadeInput::Layer> layers) {
  std::vector<Batch> batches(1);
  for (const ShadeInput::Layer& layer : layers) {
    const auto described = describe(layer);
    bool listed = false;  // the layer is in the last batch
    for (std::uint32_t i = 0; i < PagePool::kMaxChunks; ++i) {
      if (!layer.textures->has_page_in(i)) continue;
      const Chunk chunk{&layer.textures->pool(), i};
      if (!can_take(batches.back(), chunk, listed)) {
        batches.emplace_back();
        listed = false;
      }
      Batch& batch = batches.back();
      if (!listed) {
        batch.layers.push_back(described);
        batch.units.push_back(0);
      }
      listed = true;
      auto bound = std::find(batch.chunks.begin(), batch.chunks.end(), chunk);
      if (bound == batch.chunks.end()) bound = batch.chunks.insert(bound, chunk);
      const auto unit = static_cast<std::uint32_t>(bound - batch.chunks.begin());
      batch.units.back() |= 1u << unit;
      set_unit(batch.layers.back(), chunk.index, unit);
    }
  }
  return batches;
}

Result<void> ShadePass::shade(const ShadeInput& input, const PageTables& tables) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, input.target.id());
  no_vertices_.bind();
  glViewport(0, 0, input.uv.width(), input.uv.height());
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_SCISSOR_TEST);
  const auto draw_all = [&]() -> Result<void> {
    STRATA_TRY(draw_background(input));
    glDepthFunc(GL_GREATER);
    glEnable(GL_DEPTH_TEST);
    bool first = true;
    std::span<const ShadeInput::Layer> left = input.layers;
    do {
      const auto group = left.first(std::min(left.size(), PaletteTextures::kMaxPalettes));
      left = left.subspan(group.size());
      std::vector<std::shared_ptr<const Palette>> palettes;
      for (const ShadeInput::Layer& layer : group) palettes.push_back(layer.palette);
      STRATA_TRY(palettes_.make_room(palettes));
      for (const Batch& batch : plan(group)) {
        STRATA_TRY(draw_surface(input, batch, first, tables));
        first = false;
        // The next draw outputs `picture + kept * destination`. The frame stays opaque.
        glBlendFuncSeparate(GL_ONE, GL_SRC1_COLOR, GL_ZERO, GL_ONE);
        glEnable(GL_BLEND);
      }
    } while (!left.empty());
    return {};
  };
  auto drawn = draw_all();
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  // Drivers reject draws to two textures while the blend function has two sources, even if blending
  // is disabled.
  glBlendFunc(GL_ONE, GL_ZERO);
  glDepthMask(GL_TRUE);
  return drawn;
}

Result<void> ShadePass::draw(const ShadeInput& input, const gl::Program& program,
                             const PixelRect& rect, const shader::ShadeUniforms& uniforms) {
  STRATA_TRY(uniforms_.replace(std::span<const shader::ShadeUniforms>(&uniforms, 1)));
  uniforms_.bind_uniform(0);
  program.use();
  glScissor(rect.x, input.uv.height() - rect.y - rect.height, rect.width, rect.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return {};
}

Result<void> ShadePass::draw_background(const ShadeInput& input) {
  shader::ShadeUniforms uniforms{};
  const glm::vec4 top = color(input.background.top), bottom = color(input.background.bottom);
  uniforms.background_top = glm::mix(top, bottom, input.background_rows.x);
  uniforms.background_bottom = glm::mix(top, bottom, input.background_rows.y);
  uniforms.picture_height = static_cast<std::uint32_t>(input.uv.height());
  return draw(input, background_, input.rect, uniforms);
}

Result<void> ShadePass::draw_surface(const ShadeInput& input, const Batch& batch, bool first,
                                     const PageTables& tables) {
  if (input.surface_rect.width == 0) return {};
  auto built = STRATA_TRY(program(batch, input.shows_inside, first));
  STRATA_TRY(layers_.replace(std::span<const shader::ShadeLayer>(batch.layers)));
  layers_.bind_uniform(1);
  tables.bind(0);
  palettes_.bind(kPaletteUnit, 1);
  input.uv.bind(kUvUnit);
  input.light.bind(kLightUnit);
  for (std::size_t i = 0; i < batch.chunks.size(); ++i) {
    const Chunk& chunk = batch.chunks[i];
    chunk.pool->values(chunk.index).bind(kValuesUnit + static_cast<GLuint>(i));
    chunk.pool->valid(chunk.index).bind(kValidUnit + static_cast<GLuint>(i));
  }
  shader::ShadeUniforms uniforms{};
  uniforms.layer_count = static_cast<std::uint32_t>(batch.layers.size());
  uniforms.patterns = {input.patterns.origin, input.patterns.mm_per_pixel,
                       input.patterns.pixel_scale};
  return draw(input, *built, input.surface_rect, uniforms);
}

}  // namespace strata::render
