#include "render/edit/edit_pass.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>

#include "media/shape_texture.h"
#include "shared/edit.h"
#include "shared/pages.h"

namespace strata::render {
namespace {

// The inverse of ordered() in shaders/edit_pass.comp.
float unordered(std::uint32_t number) {
  return std::bit_cast<float>((number >> 31) != 0 ? number & 0x7fffffffu : ~number);
}

}  // namespace

Result<EditPass> EditPass::create(const std::filesystem::path& shader_dir,
                                  gl::ReadbackPool& readback) {
  EditPass pass;
  pass.readback_ = &readback;
  const auto format = [](int texel_bytes) {
    return "TEXEL_FORMAT r" + std::to_string(8 * texel_bytes) + "ui";
  };
  auto programs = STRATA_TRY(ProgramPerWidth::load(shader_dir, "edit_pass.comp", format));
  pass.programs_ = std::move(programs);
  // Strokes with a disc or a square use programs without the code for shapes.
  auto shape_programs =
      ProgramPerWidth::load(shader_dir, "edit_pass.comp", format, {"TOOL_TEXTURE"});
  if (!shape_programs) return tl::unexpected(shape_programs.error());
  pass.shape_programs_ = std::move(*shape_programs);
  pass.timer_ = gl::TimerQuery::create("edit");
  return pass;
}

Result<void> EditPass::send_shape(const StrokeBatch& stroke) {
  if (stroke.shape != ToolShape::texture || stroke.texture == shape_) return {};
  static_assert(shader::kShapeCells == kShapeSide);
  if (!shape_distances_) {
    auto made = STRATA_TRY(gl::Texture::create_2d(GL_R8UI, kShapeSide, kShapeSide, "tool shape"));
    shape_distances_ = std::move(made);
  }
  glTextureSubImage2D(shape_distances_.id(), 0, 0, 0, kShapeSide, kShapeSide, GL_RED_INTEGER,
                      GL_UNSIGNED_BYTE, stroke.texture->distances().data());
  shape_ = stroke.texture;
  return {};
}

Result<std::vector<TileAddress>> EditPass::make_pages(const std::vector<TileAddress>& tiles,
                                                      LayerTextures& layer) {
  std::vector<TileAddress> fresh;
  for (const TileAddress tile : tiles) {
    if (layer.page(tile) != shader::kNoPage) continue;
    if (auto page = layer.ensure_page(tile); !page) {
      for (const TileAddress taken : fresh) layer.free_page(taken);
      return tl::unexpected(page.error());
    }
    fresh.push_back(tile);
  }
  return fresh;
}

Result<DispatchedEdit> EditPass::dispatch(const StrokeBatch& stroke, TouchedTiles touched,
                                          const EditCuller& culler, const SurfaceMapTextures& map,
                                          const gl::Texture* depth, LayerTextures& layer,
                                          PageTables& tables) {
  DispatchedEdit edit;
  edit.tiles = std::move(touched.tiles);
  if (edit.tiles.empty()) return edit;
  if (!stroke.erase) {
    auto fresh = STRATA_TRY(make_pages(edit.tiles, layer));
    edit.fresh_tiles = std::move(fresh);
  }
  const auto give_up = [&](const Error& problem) {
    for (const TileAddress tile : edit.fresh_tiles) layer.free_page(tile);
    return tl::unexpected(problem);
  };
  if (auto flushed = tables.flush(); !flushed) return give_up(flushed.error());
  if (auto sent = send_shape(stroke); !sent) return give_up(sent.error());
  const std::size_t bytes = edit.tiles.size() * sizeof(shader::EditedTile);
  if (auto room = edited_.make_room(bytes); !room) return give_up(room.error());
  auto read = readback_->begin(bytes);
  if (!read) return give_up(read.error());

  std::set<std::uint32_t> chunks;
  for (const TileAddress tile : edit.tiles)
    if (const PageId page = layer.page(tile); page != shader::kNoPage)
      chunks.insert(page >> shader::kPageChunkShift);
  if (chunks.empty()) chunks.insert(0);  // nothing to erase; reports the texels

  const bool has_shape = stroke.shape == ToolShape::texture;
  const gl::Program& program =
      (has_shape ? shape_programs_ : programs_).of(layer.pool().texel_bytes());
  program.use();
  edited_.buffer().clear(0, bytes);
  culler.bind(map);
  tables.bind(0);
  map.boxes().bind_storage(4);
  edited_.bind_storage(7);
  map.positions().bind(0);
  if (depth) depth->bind(1);
  if (has_shape) shape_distances_.bind(2);
  const GLuint groups =
      (touched.parts + shader::kEditPartsPerGroup - 1) / shader::kEditPartsPerGroup;
  const GLuint columns = std::min(groups, shader::kEditGroupsPerRow);
  timer_.begin();
  for (const std::uint32_t chunk : chunks) {  // a dispatch binds only one pair of images
    if (layer.pool().has_chunk(chunk)) {
      layer.pool().values(chunk).bind_image(0, GL_WRITE_ONLY);
      layer.pool().valid(chunk).bind_image(1, GL_WRITE_ONLY);
    }
    program.set(0, chunk);
    program.set(1, GLuint{chunk == *chunks.begin()});
    glDispatchCompute(columns, (groups + columns - 1) / columns, 1);
  }
  timer_.end();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  edited_.buffer().copy_to(read->buffer(), 0, bytes);
  read->submit();
  edit.edited = std::move(*read);
  return edit;
}

EditedTiles EditPass::edited(const DispatchedEdit& edit) {
  EditedTiles found;
  if (!edit.edited) return found;
  static_assert(std::endian::native == std::endian::little);
  static_assert(sizeof(shader::EditedTile::texels) == sizeof(TileMask::words));
  const std::byte* source = edit.edited.data().data();
  for (std::size_t i = 0; i < edit.tiles.size(); ++i) {
    shader::EditedTile tile;
    std::memcpy(&tile, source + i * sizeof tile, sizeof tile);
    if (tile.high[0] == 0) continue;
    glm::vec3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = unordered(~tile.low[axis]);
      high[axis] = unordered(tile.high[axis]);
    }
    found.written_min = found.masks.empty() ? low : glm::min(found.written_min, low);
    found.written_max = found.masks.empty() ? high : glm::max(found.written_max, high);
    std::memcpy(found.masks[edit.tiles[i]].words.data(), tile.texels, sizeof tile.texels);
  }
  return found;
}

}  // namespace strata::render
