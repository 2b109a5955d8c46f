// Measures the memory of a layer without values, of a partly painted layer and of a fully painted
// layer.
#include <bit>
#include <cmath>
#include <cstdio>
#include <random>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "domain/layers/revision.h"
#include "query/maps/point_splats.h"

namespace strata::bench {
namespace {

struct Options {
  std::string model = "excavation", cache = "build/bench", json;
  std::vector<int> textures{2048, 4096, 8192};
  std::vector<double> percents{0, 1, 10, 100};
};

// Returns a connected patch of the surface around one point, similar to a painted area. `radius` is
// in model units.
std::map<TileAddress, TileData> patch(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                      float radius, ValueType type) {
  auto slot = static_cast<std::uint32_t>(map.block_of_slot.size() / 2);
  while (map.surface_mask[slot] == 0) ++slot;
  const int texel = std::countr_zero(map.surface_mask[slot]);
  const query::PointSplat splat{slot * 64 + static_cast<std::uint32_t>(texel),
                                map.position(slot, texel), 7};
  return must(query::paint_point_splats(map, graph, std::span(&splat, 1), radius, type));
}

std::uint64_t texel_count(const std::map<TileAddress, TileData>& tiles) {
  std::uint64_t count = 0;
  for (const auto& [address, tile] : tiles) count += static_cast<std::uint64_t>(tile.valid.count());
  return count;
}

std::map<TileAddress, TileData> all_of(const mesh::SurfaceMap& map, ValueType type) {
  std::map<TileAddress, TileData> tiles;
  const int side = map.resolution / kTileSize;
  for (int i = 0; i < side * side; ++i) {
    const TileAddress address{static_cast<std::uint16_t>(i % side),
                              static_cast<std::uint16_t>(i / side)};
    const TileMask owned = map.owned_in_tile(address);
    if (!owned.any()) continue;
    TileData& tile = tiles.try_emplace(address, type).first->second;
    for (int texel = 0; texel < kTexelsPerTile; ++texel)
      if (owned.test(texel)) tile.write(texel, 7);
  }
  return tiles;
}

// Paints a patch that covers about `percent` of all texels that can have a value. Finds the radius
// of the patch by bisection.
std::map<TileAddress, TileData> painted(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                        const mesh::Geometry& geometry, ValueType type,
                                        double percent) {
  if (percent <= 0) return {};
  auto all = all_of(map, type);
  if (percent >= 100) return all;
  const auto target =
      static_cast<std::uint64_t>(static_cast<double>(texel_count(all)) * percent / 100);
  float low = 0, high = glm::length(geometry.box_max - geometry.box_min);
  std::map<TileAddress, TileData> best;
  for (int step = 0; step < 16; ++step) {
    const float middle = (low + high) / 2;
    best = patch(map, graph, middle, type);
    (texel_count(best) < target ? low : high) = middle;
  }
  return best;
}

// Returns the stored size of a tile with the same valid texels and incompressible values.
std::size_t stored_as_noise(TileData tile) {
  std::mt19937 random(1);
  for (int i = 0; i < kTexelsPerTile; ++i)
    if (tile.valid.test(i)) tile.write(i, static_cast<std::uint32_t>(random()));
  return encode_tile(tile).size();
}

int run(const Options& options) {
  const auto renderer = start_renderer();
  const auto gpu = renderer->info();
  const BenchMesh mesh = must(load_bench_mesh(options.model, {options.cache}));
  const auto model = await<render::ModelHandle>([&](auto done) {
    renderer->add_model({mesh.geometry, {}}, std::move(done));
  });
  const auto view =
      await<render::ViewHandle>([&](auto done) { renderer->add_view(model, std::move(done)); });
  nlohmann::json results = nlohmann::json::array();
  Progress progress;
  std::printf("%s: bytes of one layer, MB\n%8s %6s %9s %7s %12s %8s %12s %9s %9s\n",
              mesh.name.c_str(), "texture", "type", "painted %", "tiles", "whole layer", "GPU",
              "main memory", "database", "as noise");
  for (const int texture : options.textures) {
    const auto map = must(mesh::bake_surface_map(*mesh.geometry, texture, progress));
    const auto graph = must(mesh::build_texel_graph(*mesh.geometry, map, progress));
    for (const ValueType type : {ValueType::u8, ValueType::u16, ValueType::u32})
      for (const double percent : options.percents) {
        auto mirror = std::make_shared<TileMirror>(type, texture);
        TileMap tiles;
        std::uint64_t stored = 0, noise = 0;
        for (auto& [address, tile] : painted(map, graph, *mesh.geometry, type, percent)) {
          stored += encode_tile(tile).size();
          noise += stored_as_noise(tile);
          tiles[address] = std::make_shared<const TileData>(std::move(tile));
        }
        mirror->put(tiles, 1);
        const auto layer = await<render::LayerHandle>(
            [&](auto done) { renderer->add_layer(model, mirror, std::move(done)); });
        render::FrameRequest request;
        request.view = view;
        request.camera = look_at(*mesh.geometry, {0.4, -1, 0.6}, 320, 240);
        request.width = 320;
        request.height = 240;
        request.style.layers = {{layer, std::make_shared<Palette>(default_palette(type, true)), 1}};
        await<render::SharedFrame>([&](auto done) { renderer->draw(request, std::move(done)); });
        const std::uint64_t on_gpu = renderer->layer_bytes_used(layer), in_memory = mirror->bytes();
        renderer->remove_layer(layer);
        const auto whole = std::uint64_t{static_cast<unsigned>(texture)} *
                           static_cast<unsigned>(texture) *
                           static_cast<unsigned>(bytes_per_texel(type) + 1);
        std::printf("%8d %6s %9g %7zu %12.2f %8.3f %12.3f %9.3f %9.3f\n", texture,
                    name(type).data(), percent, tiles.size(), static_cast<double>(whole) / 1e6,
                    static_cast<double>(on_gpu) / 1e6, static_cast<double>(in_memory) / 1e6,
                    static_cast<double>(stored) / 1e6, static_cast<double>(noise) / 1e6);
        results.push_back({{"model", mesh.name},
                           {"texture", texture},
                           {"type", name(type)},
                           {"painted_percent", percent},
                           {"tiles", tiles.size()},
                           {"whole_layer_bytes", whole},
                           {"gpu_bytes", on_gpu},
                           {"main_memory_bytes", in_memory},
                           {"database_bytes_of_one_value", stored},
                           {"database_bytes_of_noise", noise}});
      }
  }
  write_result(options.json, machine(&gpu), results);
  return 0;
}

}  // namespace

Command add_memory(CLI::App& app) {
  auto* command = app.add_subcommand(
      "memory", "Bytes of a layer where 0, 1, 10 and 100 % of the surface is painted");
  auto options = std::make_shared<Options>();
  command
      ->add_option("--model", options->model,
                   "pot[:TRIANGLES], vessel, excavation, amazon, thai, or a file")
      ->capture_default_str();
  command->add_option("--texture", options->textures, "Resolutions")
      ->delimiter(',')
      ->check(CLI::IsMember({2048, 4096, 8192, 16384}))
      ->capture_default_str();
  command->add_option("--painted", options->percents, "Percent of the surface")
      ->delimiter(',')
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
