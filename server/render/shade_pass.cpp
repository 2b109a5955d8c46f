#include "render/shade_pass.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "shared/shade.h"

namespace strata::render {
namespace {

constexpr GLuint kUvUnit = 0, kLightUnit = 1, kPaletteUnit = 2, kValuesUnit = 3, kValidUnit = 9;
constexpr GLuint kGroupWidth = 16, kGroupHeight = 4;

glm::vec4 color(const Rgba& c) { return glm::vec4(c[0], c[1], c[2], c[3]) / 255.0f; }

std::uint32_t mode_of(PaletteMode mode) {
  switch (mode) {
    case PaletteMode::linear: return shader::kPaletteLinear;
    case PaletteMode::step: return shader::kPaletteStep;
    case PaletteMode::categorical: return shader::kPaletteCategorical;
  }
  return shader::kPaletteLinear;
}

double area(const PixelRect& rect) { return static_cast<double>(rect.width) * rect.height; }

// Where the background is most of the picture, it is worth a dispatch of its own that spares the layers those pixels.
constexpr double kMostlySurface = 0.8;

void set_unit(shader::ShadeLayer& layer, int chunk, std::uint32_t unit) {
  auto& units = chunk < 8 ? layer.units_low : layer.units_high;
  const int shift = (chunk % 8) * 4;
  units = (units & ~(15u << shift)) | unit << shift;
}

}  // namespace

Result<ShadePass> ShadePass::create(const std::filesystem::path& shader_dir, bool one_layer_per_dispatch) {
  ShadePass pass;
  pass.shader_dir_ = shader_dir;
  pass.one_layer_per_dispatch_ = one_layer_per_dispatch;
  auto palettes = PaletteTextures::create();
  if (!palettes) return tl::unexpected(palettes.error());
  pass.palettes_ = std::move(*palettes);
  // The usual ones at once, so that the first strokes and frames do not wait for the compiler.
  for (const auto& [chunks, modes] : {std::pair{0, 0u}, {1, 1u}, {1, 2u}, {1, 4u}}) {
    if (auto built = pass.program(static_cast<std::size_t>(chunks), modes); !built) return tl::unexpected(built.error());
  }
  return pass;
}

Result<const gl::Program*> ShadePass::program(std::size_t chunks, std::uint32_t modes) {
  const auto built = programs_.find({chunks, modes});
  if (built != programs_.end()) return &built->second;
  auto program = gl::Program::load(shader_dir_, {"shade_pass.comp"},
                                   {"CHUNK_COUNT " + std::to_string(chunks), "MODES " + std::to_string(modes),
                                    std::string("SINGLE_LAYER ") + (one_layer_per_dispatch_ ? "1" : "0")});
  if (!program) return tl::unexpected(program.error());
  return &programs_.insert_or_assign({chunks, modes}, std::move(*program)).first->second;
}

bool ShadePass::can_take(const Batch& batch, const Chunk& chunk) const {
  const bool bound = std::find(batch.chunks.begin(), batch.chunks.end(), chunk) != batch.chunks.end();
  if (one_layer_per_dispatch_) return batch.chunks.empty();
  return bound || batch.chunks.size() < kChunksPerDispatch;
}

shader::ShadeLayer ShadePass::describe(const ShadeInput::Layer& layer) {
  const auto entry = palettes_.find(layer.palette, layer.textures->type());
  shader::ShadeLayer out{};
  out.table = layer.textures->table_offset();
  out.resolution_bits = static_cast<std::uint32_t>(std::countr_zero(static_cast<unsigned>(layer.textures->resolution())));
  out.type = static_cast<std::uint32_t>(layer.textures->type());
  out.mode = mode_of(layer.palette->mode);
  out.row = entry.row;
  out.points = entry.points;
  out.point_count = entry.point_count;
  out.opacity = std::clamp(layer.opacity, 0.0f, 1.0f);
  out.palette_min = static_cast<float>(layer.palette->min);
  out.palette_max = static_cast<float>(layer.palette->max);
  // Without a range every value takes an end; the shader divides by it.
  const bool has_range = out.palette_max > out.palette_min;
  if (!has_range && layer.palette->mode == PaletteMode::linear) out.palette_max = std::nextafter(out.palette_min, 1e38f);
  out.units_low = out.units_high = 0xffffffffu;
  return out;
}

// Batches in drawing order. A layer whose chunks do not all fit spans several: each of its texels is in one of them.
std::vector<ShadePass::Batch> ShadePass::plan(const ShadeInput& input) {
  std::vector<Batch> batches(1);
  if (one_layer_per_dispatch_ && area(input.surface_rect) < area(input.rect) * kMostlySurface) batches.emplace_back();
  for (const ShadeInput::Layer& layer : input.layers) {
    const auto described = describe(layer);
    const std::uint32_t mode = 1u << described.mode;
    bool listed = false;  // in the last batch
    for (int i = 0; i < layer.textures->pool().chunk_count(); ++i) {
      if (!(layer.textures->chunks() >> i & 1u)) continue;
      const Chunk chunk{&layer.textures->pool(), i};
      if (!can_take(batches.back(), chunk)) {
        batches.emplace_back();
        listed = false;
      }
      Batch& batch = batches.back();
      if (!listed) batch.layers.push_back(described);
      listed = true;
      batch.modes |= mode;
      auto bound = std::find(batch.chunks.begin(), batch.chunks.end(), chunk);
      if (bound == batch.chunks.end()) bound = batch.chunks.insert(bound, chunk);
      set_unit(batch.layers.back(), chunk.index, static_cast<std::uint32_t>(bound - batch.chunks.begin()));
    }
  }
  return batches;
}

Result<void> ShadePass::shade(const ShadeInput& input, const PageTables& tables) {
  palettes_.make_room(input.layers.size());
  const auto batches = plan(input);
  dispatches_ = 0;
  for (const Batch& batch : batches) {
    const bool first = dispatches_ == 0;
    if (!first && batch.layers.empty()) continue;
    if (auto done = dispatch(input, batch, first ? input.rect : input.surface_rect, first, tables); !done) return done;
    ++dispatches_;
  }
  return {};
}

Result<void> ShadePass::dispatch(const ShadeInput& input, const Batch& batch, const PixelRect& rect, bool first,
                                 const PageTables& tables) {
  if (rect.width == 0 || rect.height == 0) return {};
  shader::ShadeUniforms uniforms{};
  uniforms.background_top = color(input.background_top);
  uniforms.background_bottom = color(input.background_bottom);
  uniforms.x = static_cast<std::uint32_t>(rect.x);
  uniforms.y = static_cast<std::uint32_t>(rect.y);
  uniforms.width = static_cast<std::uint32_t>(rect.width);
  uniforms.height = static_cast<std::uint32_t>(rect.height);
  uniforms.picture_width = static_cast<std::uint32_t>(input.picture.width());
  uniforms.picture_height = static_cast<std::uint32_t>(input.picture.height());
  uniforms.layer_count = static_cast<std::uint32_t>(batch.layers.size());
  uniforms.first_pass = first ? 1 : 0;
  if (auto sent = uniforms_.replace(std::span<const shader::ShadeUniforms>(&uniforms, 1)); !sent) return sent;
  if (auto sent = layers_.replace(std::span<const shader::ShadeLayer>(batch.layers)); !sent) return sent;

  auto built = program(batch.chunks.size(), batch.modes);
  if (!built) return tl::unexpected(built.error());
  (*built)->use();
  uniforms_.bind_uniform(0);
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
  glBindImageTexture(0, input.picture.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA8);
  glDispatchCompute((uniforms.width + kGroupWidth - 1) / kGroupWidth, (uniforms.height + kGroupHeight - 1) / kGroupHeight, 1);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT |
                  GL_TEXTURE_FETCH_BARRIER_BIT);
  return {};
}

}  // namespace strata::render
