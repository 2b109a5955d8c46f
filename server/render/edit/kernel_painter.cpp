#include "render/edit/kernel_painter.h"

#include <cassert>
#include <chrono>

#include "mesh/parallel.h"
#include "render/memory/tile_bytes.h"
#include "shared/pages.h"

namespace strata::render {
namespace {

DepthGrid grid_of(const DepthCopy& depth) {
  return {depth.grid.data(), depth_cells(depth.width), depth_cells(depth.height)};
}

}  // namespace

Result<Step> KernelPainter::step(GpuScene& scene, const PaintTarget& target) {
  switch (stage_) {
    case Stage::begin:
      if (depth_ && !depth_->copy) drawn_ = gl::Fence::place();
      stage_ = Stage::depth_drawn;
      return Step::more;
    case Stage::depth_drawn:
      if (!drawn_.passed()) return Step::waiting;
      if (depth_ && !depth_->copy) DepthBuffers::copy_to_memory(*depth_, mesh::hardware_threads());
      stage_ = Stage::paint;
      return Step::more;
    case Stage::paint: break;
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed_ms = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
  };
  const KernelResult written = find_written(target);
  const double found_ms = elapsed_ms();
  const auto pages = STRATA_TRY(find_pages(written, target.layer));
  write(written, pages, target.layer);
  [[maybe_unused]] const auto flushed = scene.tables().flush();
  assert(flushed);  // only a new layer enlarges the tables
  outcome_.edit_ms = elapsed_ms();
  outcome_.gpu_ms = outcome_.edit_ms - found_ms;
  return Step::done;
}

KernelResult KernelPainter::find_written(const PaintTarget& target) {
  const mesh::Geometry& geometry = target.mesh.geometry();
  const auto at = path_pixels();
  std::vector<float> depths;
  for (const glm::ivec2 pixel : at.pixels)
    depths.push_back(depth_->copy->depth[static_cast<std::size_t>(pixel.y) *
                                             static_cast<std::size_t>(depth_->copy->width) +
                                         static_cast<std::size_t>(pixel.x)]);
  const ToolPath path = make_path(geometry, at, depths);
  BlockTest test;
  test.clip_from_model = strata::clip_from_model(stroke_.camera, geometry.origin);
  test.path = &path;
  test.depth = stroke_.through ? nullptr : depth_->copy.get();
  test.width = stroke_.camera.width;
  test.height = stroke_.camera.height;
  test.shape = stroke_.shape;
  test.texture = stroke_.texture.get();
  if (stroke_.max_angle_deg)
    test.facing = make_facing_limit(stroke_.camera, *stroke_.max_angle_deg);
  test.bias = depth_bias(geometry);
  const SectionPlanes section = section_in_model(stroke_.camera, geometry.origin);
  test.section = std::span(section).first(stroke_.camera.section.size());
  test.hidden_parts = stroke_.camera.hidden_parts;
  const BlockCuller culler(target.map.map(), clip_from_model(geometry), test.width, test.height,
                           path, test.bias, test.depth ? grid_of(*test.depth) : DepthGrid{});
  static const TestBlock test_block = test_block_on(best_vector_unit());
  return run_edit_kernel(target.map.map(), culler, test, test_block, mesh::hardware_threads());
}

Result<std::vector<PageId>> KernelPainter::find_pages(const KernelResult& written,
                                                      LayerTextures& layer) const {
  std::vector<PageId> pages, fresh;
  for (const auto& tile : written.tiles) {
    pages.push_back(layer.page(tile.address));
    if (pages.back() != shader::kNoPage || stroke_.erase) continue;
    auto page = layer.pool().allocate();
    if (!page) {
      for (const PageId taken : fresh) layer.pool().free(taken);
      return tl::unexpected(page.error());
    }
    fresh.push_back(*page);
    pages.back() = *page;
  }
  return pages;
}

void KernelPainter::write(const KernelResult& written, std::span<const PageId> pages,
                          LayerTextures& layer) {
  PagePool& pool = layer.pool();
  outcome_.written_min = written.written_min;
  outcome_.written_max = written.written_max;
  outcome_.tiles.reserve(written.tiles.size());
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const auto& [address, mask] = written.tiles[i];
    TileData& tile =
        outcome_.tiles.emplace_back(WrittenTile{address, mask, TileData(layer.type())}).after;
    if (pages[i] == shader::kNoPage) continue;
    const bool fresh = layer.page(address) == shader::kNoPage;
    if (!fresh) {
      pool.read(pages[i], tile);
      outcome_.bytes_down += pool.bytes_per_page();
    }
    write_texels(mask, stroke_.value_bits, stroke_.erase, tile);
    if (!tile.valid.any()) {
      layer.free_page(address);
      continue;
    }
    pool.upload(pages[i], tile);
    outcome_.bytes_up += pool.bytes_per_page();
    if (fresh) layer.put_page(address, pages[i]);
  }
}

}  // namespace strata::render
