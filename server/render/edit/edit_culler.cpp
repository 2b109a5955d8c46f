#include "render/edit/edit_culler.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "render/edit/facing_limit.h"
#include "shared/edit.h"

namespace strata::render {
namespace {

constexpr std::size_t kMarksBegin = offsetof(shader::EditTiles, number_of_tile),
                      kCountBytes = offsetof(shader::EditTiles, tiles);
constexpr std::uint32_t kSegmentBits = 32;

shader::EditUniforms make_uniforms(const StrokeBatch& stroke, const glm::dvec3& origin,
                                   const ToolPath& path, const DepthBias& bias) {
  static_assert(kMaxSectionPlanes == shader::kSectionPlanes);
  shader::EditUniforms uniforms{};
  uniforms.clip_from_model = clip_from_model(stroke.camera, origin);
  uniforms.window = glm::vec4(stroke.camera.width, stroke.camera.height, 0, 0);
  uniforms.tool_box = glm::vec4(path.box.x0, path.box.y0, path.box.x1, path.box.y1);
  uniforms.bias =
      glm::vec4(bias.fixed.value_or(0), bias.scale, bias.slope_factor, bias.slope_limit);
  uniforms.value = stroke.value_bits;
  uniforms.flags = (stroke.erase ? shader::kEditErase : 0u) |
                   (stroke.through ? shader::kEditThrough : 0u) |
                   (stroke.shape == ToolShape::square ? shader::kEditSquare : 0u) |
                   (bias.fixed ? shader::kEditFixedBias : 0u) |
                   (stroke.max_angle_deg ? shader::kEditFacing : 0u);
  uniforms.segment_count = static_cast<std::uint32_t>(path.segments.size());
  uniforms.segments_per_bit = (uniforms.segment_count + kSegmentBits - 1) / kSegmentBits;
  uniforms.inner_radius = static_cast<float>(path.inner_radius);
  if (stroke.max_angle_deg) {
    const FacingLimit limit = make_facing_limit(stroke.camera, *stroke.max_angle_deg);
    uniforms.facing[0] = glm::vec4(limit.x_row, limit.least_squared_cosine);
    uniforms.facing[1] = glm::vec4(limit.y_row, 0);
    uniforms.facing[2] = glm::vec4(limit.w_row, 0);
    uniforms.facing[3] = glm::vec4(limit.far_row, 0);
  }
  uniforms.section_count = static_cast<std::uint32_t>(stroke.camera.section.size());
  std::ranges::copy(section_in_model(stroke.camera, origin), uniforms.section);
  return uniforms;
}

std::size_t used_bytes(const shader::EditUniforms& uniforms) {
  if (uniforms.section_count > 0)
    return offsetof(shader::EditUniforms, section) + uniforms.section_count * sizeof(glm::vec4);
  if (uniforms.flags & shader::kEditFacing) return offsetof(shader::EditUniforms, section);
  return offsetof(shader::EditUniforms, facing);
}

}  // namespace

Result<EditCuller> EditCuller::create(const std::filesystem::path& shader_dir,
                                      gl::ReadbackPool& readback) {
  auto program = STRATA_TRY(gl::Program::load(shader_dir, {"edit_cull_pass.comp"}));
  auto tiles = STRATA_TRY(
      gl::Buffer::create(sizeof(shader::EditTiles), gl::Buffer::Use::fixed, "edit tiles"));
  EditCuller culler;
  culler.readback_ = &readback;
  culler.program_ = std::move(program);
  culler.tiles_ = std::move(tiles);
  culler.timer_ = gl::TimerQuery::create("edit culling");
  return culler;
}

Result<gl::Readback> EditCuller::dispatch(const StrokeBatch& stroke, const glm::dvec3& origin,
                                          const ToolPath& path, const DepthBias& bias,
                                          const SurfaceMapTextures& map,
                                          const gl::Buffer* depth_grid,
                                          const LayerTextures& layer) {
  auto uniforms = make_uniforms(stroke, origin, path, bias);
  uniforms.part_count = static_cast<std::uint32_t>(map.map().tree.parts.size());
  uniforms.table_offset = layer.table_offset();
  const auto sent = std::as_bytes(std::span(&uniforms, 1)).first(used_bytes(uniforms));
  const std::span<const shader::EditSegment> segments(path.segments);
  bytes_up_ = sent.size_bytes() + segments.size_bytes();
  STRATA_TRY(uniforms_.replace(sent));
  STRATA_TRY(segments_.replace(segments));
  const auto per_side = static_cast<std::size_t>(map.map().resolution / kTileSize);
  const std::size_t list_bytes = per_side * per_side * sizeof(std::uint32_t);
  auto read = STRATA_TRY(readback_->begin(kCountBytes + list_bytes));

  tiles_.clear(0, kCountBytes);
  tiles_.clear(kMarksBegin, list_bytes);
  bind(map);
  map.nodes().bind_storage(0);
  if (depth_grid) depth_grid->bind_storage(4);
  program_.use();
  timer_.begin();
  if (const GLuint groups =
          (uniforms.part_count + shader::kEditPartsPerNode - 1) / shader::kEditPartsPerNode;
      groups > 0) {
    const GLuint columns = std::min(groups, shader::kEditGroupsPerRow);
    glDispatchCompute(columns, (groups + columns - 1) / columns, 1);
  }
  timer_.end();
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  tiles_.copy_to(read.buffer(), 0, kCountBytes + list_bytes);
  read.submit();
  return read;
}

void EditCuller::bind(const SurfaceMapTextures& map) const {
  uniforms_.bind_uniform(0);
  map.spheres().bind_storage(1);
  map.parts().bind_storage(2);
  segments_.bind_storage(3);
  tiles_.bind_storage(5);
  map.touched_parts().bind_storage(6);
}

TouchedTiles EditCuller::touched(const gl::Readback& read, int resolution) {
  std::array<std::uint32_t, 2> counts;
  std::memcpy(counts.data(), read.data().data(), sizeof counts);
  std::vector<std::uint32_t> numbers(counts[1]);
  if (!numbers.empty())
    std::memcpy(numbers.data(), read.data().data() + kCountBytes,
                numbers.size() * sizeof(std::uint32_t));
  TouchedTiles touched;
  touched.parts = counts[0];
  const auto per_side = static_cast<std::uint32_t>(resolution / kTileSize);
  for (const std::uint32_t tile : numbers)
    touched.tiles.push_back(
        {static_cast<std::uint16_t>(tile % per_side), static_cast<std::uint16_t>(tile / per_side)});
  return touched;
}

}  // namespace strata::render
